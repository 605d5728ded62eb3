#include "runtime/cli/options/groups.h"

#include "runtime/cli/options/words.h"
#include "runtime/cli/progress_lines.h"

namespace fw::cli {

void addGraph(CLI::App* command, GraphOptions& graph) {
    command->add_option("GRAPH", graph.path, "The graph file (*.field.json)")->required();
    command->add_option("--set", graph.assignments, "Set an exposed parameter: name=value, or name=x,y,z")
        ->take_all()
        ->allow_extra_args(false)
        ->check(assignment());
}

void addMoment(CLI::App* command, GraphOptions& graph) {
    addGraph(command, graph);
    command->add_option("--time", graph.time, "Seconds at which the graph and its timeline are evaluated")
        ->default_val(0.0)
        ->check(finite());
    command
        ->add_option("--cache", graph.cache,
                     "A particle cache that fieldwright simulate wrote of this graph, read in place of "
                     "simulating (default: those that the graph's nodes name)")
        ->type_name("FOLDER")
        ->check(something());
}

void addMesh(CLI::App* command, MeshOptions& mesh) {
    addMoment(command, mesh.graph);
    command
        ->add_option("--resolution", mesh.resolution,
                     "Cells along the region's longest side (default: the output node's, else 128)")
        ->check(whole(1, 4096));
    command
        ->add_option("--region", mesh.region,
                     "Mesh only this box: x0 y0 z0 x1 y1 z1, in metres (default: found from the field)")
        ->expected(6)
        ->check(finite());
    command
        ->add_option_function<std::string>(
            "--method", [&mesh](const std::string& name) { mesh.method = meshMethod(name); },
            "How the surface becomes triangles: dual-contouring keeps edges and corners sharp (default: as "
            "the graph says, else marching-cubes)")
        ->check(oneOf({std::begin(kMeshMethodNames), std::end(kMeshMethodNames)}));
    command->add_option("--device", mesh.device,
                        "Index or part of the name of the device (see fieldwright info)");
}

void addSequence(CLI::App* command, SequenceOptions& sequence) {
    command->add_option("--from", sequence.frames.from, "Seconds of the first frame (default: 0)")
        ->check(finite());
    command
        ->add_option("--to", sequence.frames.to,
                     "Seconds that the frames stay below (default: the timeline's length)")
        ->check(finite());
    command
        ->add_option("--fps", sequence.frames.framesPerSecond,
                     "Frames a second (default: the timeline's, else 30); frame n shows the time n / fps")
        ->check(finite())
        ->check(CLI::Range(0.001, kMostFramesPerSecond));
    command->add_flag("--range", sequence.frames.range,
                      "The frames of the timeline's range (default: of all of it)");
    if (CLI::Option* moment = command->get_option_no_throw("--time"))
        for (const char* many : {"--from", "--to", "--range"}) command->get_option(many)->excludes(moment);
    command->add_flag("--overwrite", sequence.overwrite,
                      "Make frames anew that are there already (default: skip them)");
}

void addPart(CLI::App* command, SequenceOptions& sequence) {
    command
        ->add_option_function<std::string>(
            "--frames",
            [&sequence](const std::string& text) {
                sequence.frames.part = readFramePart(text);
                if (!sequence.frames.part)
                    throw CLI::ValidationError("--frames", inQuotes(text) + ": write FIRST-LAST, as 0-9");
            },
            "Only those of all the files, by their numbers: FIRST-LAST, both among them")
        ->type_name("FIRST-LAST");
}

void oneMomentOrMany(const CLI::App* command) {
    if (command->count("--time") > 0 && command->count("--fps") > 0)
        throw CLI::ExcludesError("--time", "--fps");
}

void addMeasures(CLI::App* command, MeshOutput& output) {
    command
        ->add_option(
            "--report", output.report,
            "Write what the mesh file holds, measured from it, to this file: as JSON, or as words to a .txt")
        ->check(something());
    command
        ->add_option_function<std::string>(
            "--require",
            [&output](const std::string& list) {
                Result<std::vector<Requirement>> required = parseRequirements(list);
                if (!required) throw CLI::ValidationError("--require", required.error().message);
                output.required = std::move(*required);
            },
            "Requirements for the mesh file, separated by commas; if one fails, the exit status is 1: " +
                requirementNames() +
                ". complete: no solid is outside the meshed region; closed includes it, unless the region is "
                "given")
        ->type_name("LIST");
}

void addOpenJd(CLI::App* command) {
    command->add_flag_callback("--openjd", showProgressToOpenJd,
                               "Say how far it is in lines that sessions of the Open Job Description read");
}

void addQuality(CLI::App* command, FieldBy& quality) {
    static const std::map<std::string, FieldBy> names = {
        {"auto", FieldBy::sooner}, {"full", FieldBy::kernels}, {"draft", FieldBy::tapes}};
    command
        ->add_option_function<std::string>(
            "--quality", [&quality](const std::string& name) { quality = names.at(name); },
            "full: light is traced through the field; draft: of the mesh alone, sooner; auto: full, but a "
            "draft where the driver would take long to compile the field, or a software device to trace it")
        ->check(oneOf({"auto", "full", "draft"}))
        ->default_str("auto");
}

}  // namespace fw::cli
