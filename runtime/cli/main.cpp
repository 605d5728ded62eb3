// `fieldwright`: reads the command line and runs one command.
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <CLI/CLI.hpp>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <map>
#include <new>

#include "graph/base/own_files.h"
#include "graph/base/words.h"
#include "graph/document/timeline.h"
#include "graph/library/node_type.h"
#include "runtime/cli/commands.h"
#include "runtime/cli/option_words.h"
#include "runtime/cli/pages.h"
#include "runtime/cli/progress_lines.h"
#include "runtime/cli/sequence.h"
#include "runtime/export/export.h"
#include "runtime/export/points.h"
#include "runtime/gpu/driver_cache.h"
#include "runtime/gpu/drivers.h"
#include "runtime/serve/server.h"
#include "runtime/system/interruption.h"
#include "runtime/system/version.h"
#include "runtime/window/viewer.h"

namespace fw::cli {

namespace {

/// The arguments with "-.5" as "-0.5": the parser takes a minus before a point for an option's name.
std::vector<std::string> readableNumbers(int count, char** arguments) {
    std::vector<std::string> words(arguments + 1, arguments + count);
    for (std::string& word : words)
        if (word.size() > 2 && word[0] == '-' && word[1] == '.' && word[2] >= '0' && word[2] <= '9')
            word.insert(1, "0");
    return words;
}

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

/// What a command takes that makes a file for every frame.
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

/// What of it one of several machines makes.
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
            "What the mesh file must be, parted by commas; if it is not, the exit status is 1: " +
                requirementNames())
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

/// The benchmarks are a program of their own, beside this one. Returns only if it cannot be started.
int becomeBench(char** arguments) {
    const std::string program = programFolder() / "fieldwright-bench";
    arguments[0] = const_cast<char*>(program.c_str());
    execv(program.c_str(), arguments);
    std::fprintf(stderr,
                 "fieldwright: cannot start %s: %s\nIt is built by: cmake --build --preset release --target "
                 "fieldwright-bench\n",
                 program.c_str(), std::strerror(errno));
    return kSystemFailure;
}

/// `job`: of a command that is not run but shared out.
int run(std::vector<std::string> words, const JobOptions* job = nullptr) {
    CLI::App app{"Fieldwright: procedural solids from graphs of signed distance fields", "fieldwright"};
    app.set_version_flag("--version", std::string("fieldwright ") + kVersionAndBuild);
    addPages(app);
    app.require_subcommand(1);
    app.failure_message(usageMessage);
    app.footer(
        "Exit status: 0 done, 1 the input is at fault, 2 usage, 3 the device or system failed, 130 "
        "interrupted (Ctrl-C), 143 ended (SIGTERM).\n"
        "Try:  fieldwright export samples/tower.field.json -o tower.glb");

    ExportOptions exportOptions;
    CLI::App* exportCommand = app.add_subcommand(
        "export",
        "Turn a graph into a mesh file, with --from, --to or --fps into one for every frame; "
        "or its particles into points");
    addMesh(exportCommand, exportOptions.mesh);
    std::string endings;
    for (const ExportFormat& format : exportFormats())
        endings += (endings.empty() ? "" : " ") + std::string(format.ending);
    std::string pointEndings;
    for (const char* ending : kPointEndings)
        pointEndings += (pointEndings.empty() ? "" : " ") + std::string(ending);
    exportCommand
        ->add_option("-o,--output", exportOptions.output,
                     "The mesh file; its ending says the format: " + endings + "; of particles: " +
                         pointEndings + "; of a sequence or a sweep the folder, for 000000.glb and so on")
        ->required();
    exportCommand->add_flag("--manifold", exportOptions.manifold,
                            "Mark the mesh of a .glb or .gltf as a solid (EXT_mesh_manifold), for programs "
                            "that compute with solids; an error if it is none");
    exportCommand->add_flag(
        "--compress", exportOptions.compress,
        "Of a .glb or .gltf: few bits a number and meshoptimizer's code "
        "(KHR_mesh_quantization, EXT_meshopt_compression), a sixth of the size; three.js, "
        "Babylon and game engines read it");
    exportCommand->add_flag(
        "--split-materials", exportOptions.splitMaterials,
        "Cut the faces of a .glb, .gltf or .obj where the materials of two nodes meet, so "
        "that each is of one");
    CLI::Option* textures =
        exportCommand->add_option("--textures", exportOptions.textures,
                                  "Unwrap the mesh of a .glb, .gltf or .obj, and bake its colours, finish, "
                                  "light, occlusion and normals "
                                  "from the field into textures of so many texels a side: 64, 128, ... 8192");
    textures->type_name("TEXELS")->check(something());
    CLI::Option* lods =
        exportCommand
            ->add_option(
                "--lods", exportOptions.lods,
                "Levels of detail in a .glb or .gltf, each with a quarter of the triangles of the one "
                "before, as nodes whose names end in _LOD0 and so on; they share materials and textures")
            ->check(whole(1, kMostLevels));
    exportCommand->add_flag("--parts", exportOptions.parts,
                            "Of a .glb or .gltf: what touches nowhere is a node of its own");
    CLI::Option* instances =
        exportCommand
            ->add_option("--instances", exportOptions.instances,
                         "Of a .glb or .gltf: copies that stand apart, as repeat, scatter and polar_repeat "
                         "make them, share one mesh; as nodes, which every program reads, or gpu "
                         "(EXT_mesh_gpu_instancing), smaller, for game engines, three.js and Babylon")
            ->type_name("[FORM]")
            ->expected(0, 1)
            ->default_str("nodes")
            ->check(oneOf({"nodes", "gpu"}));
    std::vector<std::string> units;
    for (const LengthUnit& unit : lengthUnits()) units.emplace_back(unit.name);
    exportCommand
        ->add_option(
            "--unit", exportOptions.placement.unit,
            "Of lengths in a .stl, .obj, .ply or .vdb (default: the document's, of which glTF and 3MF "
            "are scaled to theirs, metres and millimetres)")
        ->check(oneOf(units));
    exportCommand
        ->add_option("--up", exportOptions.placement.up, "The axis that points up in the file (default: y)")
        ->check(oneOf({"y", "z"}));
    exportCommand
        ->add_option("--for", exportOptions.placement.purpose,
                     "print: millimetres and +Z up, as slicers have it; of a .stl or .3mf")
        ->check(oneOf({"print"}))
        ->excludes("--unit")
        ->excludes("--up");
    CLI::Option* particles =
        exportCommand
            ->add_option(
                "--particles", exportOptions.particles,
                "Write the particles that this node of the document itself gives at the time, or at every "
                "frame, in place of a mesh: their places, velocities and numbers, as points that a "
                "particle_file reads; NODE.OUTPUT of a group that has several outputs")
            ->type_name("NODE")
            ->check(something());
    addMeasures(exportCommand, exportOptions);
    addOpenJd(exportCommand);
    addSequence(exportCommand, exportOptions.sequence);
    addPart(exportCommand, exportOptions.sequence);
    exportCommand->parse_complete_callback([exportCommand] { oneMomentOrMany(exportCommand); });
    std::vector<std::string> formats;
    for (const ExportFormat& format : exportFormats()) formats.emplace_back(format.ending + 1);
    for (const char* ending : kPointEndings)
        if (!exportFormat(std::string("a") + ending)) formats.emplace_back(ending + 1);
    exportCommand
        ->add_option(
            "--format", exportOptions.format,
            "Of a sequence or a sweep: what each of its meshes is (default: glb), or its particles (ply)")
        ->check(oneOf(formats));
    CLI::Option* animated = exportCommand->add_flag(
        "--animated", exportOptions.animated,
        "Write all frames into one .glb or .gltf (default: of the whole timeline); or, where the mesh keeps "
        "its triangles, as an .obj and the places of its points, .pc2 or .mdd");
    for (const char* ofOne : {"--time", "--overwrite", "--format", "--frames"})
        animated->excludes(exportCommand->get_option(ofOne));
    CLI::Option* sweep =
        exportCommand
            ->add_option(
                "--sweep", exportOptions.sweep,
                "Write a mesh for every value of a parameter, into a folder: name=from:to:count; of "
                "several every combination; or FILE.csv, whose first line has names and each further "
                "one values")
            ->take_all()
            ->allow_extra_args(false)
            ->check(something());
    for (const char* ofSequences : {"--from", "--to", "--fps", "--range", "--animated"})
        sweep->excludes(exportCommand->get_option(ofSequences));
    exportCommand
        ->add_option("--triangles", exportOptions.mesh.triangles,
                     "Decimate each mesh to at most so many triangles, behind whatever the graph does to it")
        ->check(whole(1, 1 << 24));
    exportCommand
        ->add_option("--tiles", exportOptions.tiles,
                     "Mesh in tiles, about this many along the longest side, each by itself: memory is "
                     "bounded by a few (default: above 1,024 cells and where the surface is too much at "
                     "once)")
        ->check(whole(1, 64));
    exportCommand
        ->add_option(
            "--tile", exportOptions.share,
            "Mesh only part i of n of the tiles: i/n. The output is a .part file, for fieldwright merge; a "
            "part that was stopped goes on where it was")
        ->check(something());
    CLI::Option* implicit = exportCommand->add_flag("--implicit", exportOptions.implicit,
                                                    "Write the field itself into the .3mf, as functions "
                                                    "(volumetric and implicit extensions) in place of a "
                                                    "mesh, +Z up; what they cannot say is named");
    for (const char* ofMeshes : {"--resolution", "--method",    "--manifold",  "--split-materials",
                                 "--compress",   "--parts",     "--unit",      "--up",
                                 "--for",        "--report",    "--require",   "--triangles",
                                 "--tiles",      "--tile",      "--animated",  "--sweep",
                                 "--textures",   "--lods",      "--instances", "--particles",
                                 "--from",       "--to",        "--fps",       "--range",
                                 "--frames",     "--overwrite", "--format"})
        implicit->excludes(exportCommand->get_option(ofMeshes));
    for (const char* ofMeshes : {"--resolution", "--region", "--method", "--manifold", "--split-materials",
                                 "--compress", "--parts", "--unit", "--up", "--for", "--report", "--require",
                                 "--triangles", "--tiles", "--tile", "--animated", "--sweep"})
        particles->excludes(exportCommand->get_option(ofMeshes));
    for (const char* ofWholes : {"--from", "--to", "--fps", "--range", "--frames", "--overwrite",
                                 "--animated", "--sweep", "--triangles"})
        for (const char* ofOne : {"--tiles", "--tile"})
            exportCommand->get_option(ofWholes)->excludes(exportCommand->get_option(ofOne));

    for (const char* ofOneMesh :
         {"--from", "--to", "--fps", "--range", "--frames", "--overwrite", "--animated", "--sweep", "--tiles",
          "--tile", "--textures", "--lods", "--manifold", "--parts", "--triangles", "--particles"})
        instances->excludes(exportCommand->get_option(ofOneMesh));
    for (const char* without : {"--animated", "--tiles", "--tile", "--particles"})
        lods->excludes(exportCommand->get_option(without));
    for (const char* without : {"--split-materials", "--particles"})
        textures->excludes(exportCommand->get_option(without));

    MergeOptions mergeOptions;
    CLI::App* mergeCommand =
        app.add_subcommand("merge", "Join the parts that export --tile wrote into one mesh file");
    mergeCommand->add_option("PART", mergeOptions.parts, "The part files, all of one mesh, in any order")
        ->required();
    mergeCommand
        ->add_option("-o,--output", mergeOptions.output,
                     "The mesh file; its ending says the format: .glb .gltf .stl .ply .obj")
        ->required();
    addMeasures(mergeCommand, mergeOptions);
    addOpenJd(mergeCommand);

    RenderCommandOptions renderOptions;
    CLI::App* renderCommand = app.add_subcommand(
        "render",
        "Make a picture of a graph, or with --from, --to, --fps or --turntable one for every frame");
    addMesh(renderCommand, renderOptions.mesh);
    renderCommand
        ->add_option("-o,--output", renderOptions.output,
                     "The picture, a .png or .exr file; of a sequence the folder, for 000000.png and so on")
        ->required();
    addOpenJd(renderCommand);
    addSequence(renderCommand, renderOptions.sequence);
    addPart(renderCommand, renderOptions.sequence);
    renderCommand
        ->add_option("--turntable", renderOptions.turntable,
                     "A camera that goes once around the solid in so many seconds; --time says what it shows")
        ->check(finite())
        ->check(CLI::Range(0.001, 3600.0))
        ->excludes("--from")
        ->excludes("--to")
        ->excludes("--range");
    renderCommand->parse_complete_callback([renderCommand] {
        if (renderCommand->count("--turntable") == 0) oneMomentOrMany(renderCommand);
    });
    static const std::map<std::string, PictureFormat> pictureFormats = {{"png", PictureFormat::png},
                                                                        {"exr", PictureFormat::exr}};
    renderCommand
        ->add_option_function<std::string>(
            "--format", [&](const std::string& name) { renderOptions.format = pictureFormats.at(name); },
            "png: what a display shows; exr: linear light before exposure and tone map, with depth, normals, "
            "materials and alpha (default: as the output ends, else png)")
        ->check(oneOf({"png", "exr"}));
    renderCommand->add_option("--size", renderOptions.size, "Width and height in pixels: WxH")
        ->default_str(renderOptions.size);
    renderCommand
        ->add_option("--samples", renderOptions.picture.samples,
                     "Frames that a picture is the mean of: of edges, soft shadows and ambient occlusion")
        ->check(CLI::Range(1, kMostSamples))
        ->default_str(std::to_string(renderOptions.picture.samples));
    renderCommand
        ->add_option(
            "--view", renderOptions.view,
            "What is shown: picture, or a look inside: ao, normals, color, shadow, steps (of sphere "
            "tracing), slice (the field with lines of equal distance), exactness (red where the field "
            "is steeper than a distance, blue where flatter), cells (of the mesher), thickness (of walls), "
            "gap (between walls), wireframe; or particles as points or spheres, in place of their surface")
        ->check(oneOf(renderViews()))
        ->default_str(renderOptions.view);
    renderCommand
        ->add_option("--least", renderOptions.picture.leastWidth,
                     "Of the views thickness and gap: what is narrower is red, with a unit or in the "
                     "document's (default: a power of ten that suits the solid)")
        ->type_name("LENGTH")
        ->check(length());
    renderCommand->add_flag(
        "--transparent", renderOptions.picture.transparent,
        "The solid alone, with alpha: no sky, wall or ground behind it, nor its shadow there");
    addQuality(renderCommand, renderOptions.picture.quality);
    renderCommand->add_flag(
        "--reference", renderOptions.picture.reference,
        "The ground truth: sees the field itself, without a mesh, with 64 rays of ambient "
        "occlusion a sample (1,024 a pixel), each traced to its end; or, with --bounces, where light "
        "passes through something, or the scene has bounce or reflections, whole paths of light, one a "
        "sample");
    renderCommand
        ->add_option("--bounces", renderOptions.picture.bounces,
                     "Of --reference: paths of light that are reflected by up to so many opaque surfaces")
        ->check(CLI::Range(1, kMostBounces));

    JobOptions jobOptions;
    CLI::App* jobCommand =
        app.add_subcommand("job",
                           "Share an export, a render or a simulation out among machines: write what an "
                           "engine that runs jobs takes, and a program "
                           "`submit` that hands it in");
    jobCommand->footer(
        "Behind -- comes the command, as you would type it. A job waits in DIR until DIR/submit is run.\n"
        "Try:  fieldwright job --for slurm -o job -- render moving.field.json -o frames --from 0");
    jobCommand->add_option("--for", jobOptions.engine, "Slurm, OpenJobDescription or GNU parallel")
        ->required()
        ->check(oneOf(jobEngines()));
    jobCommand
        ->add_option("-o,--output", jobOptions.folder,
                     "The folder for the job, where all machines see it by the same name")
        ->required()
        ->check(something());
    CLI::Option* chunk = jobCommand
                             ->add_option("--chunk", jobOptions.sharing.chunk,
                                          "Frames or variants a task (default: 10 frames, 100 variants)")
                             ->check(whole(1, kMostFrames));
    jobCommand
        ->add_option("--tasks", jobOptions.sharing.tasks,
                     "So many tasks: of one mesh parts of its tiles, which are merged in the end")
        ->check(whole(1, kMostJobTasks))
        ->excludes(chunk);
    jobCommand
        ->add_option("--program", jobOptions.program,
                     "fieldwright as the machines call it (default: this one)")
        ->check(something());

    PlayOptions playOptions;
    CLI::App* playCommand = app.add_subcommand(
        "play",
        "Play a graph's timeline in a window; the graph's file is watched, a change is played at once");
    std::string keys = "In the window:";
    for (const KeyHelp& help : viewerKeys())
        keys += "\n  " + std::string(help.key) +
                std::string(14 - std::min<std::size_t>(std::strlen(help.key), 13), ' ') + help.does;
    playCommand->footer(keys);
    addMesh(playCommand, playOptions.mesh);
    addQuality(playCommand, playOptions.quality);
    playCommand->add_option("--size", playOptions.size, "Width and height in pixels: WxH")
        ->default_str(playOptions.size);
    playCommand->add_flag("--headless", playOptions.headless,
                          "Open no window: make the frames, and say how fast that went");
    playCommand
        ->add_option("--frames", playOptions.frames,
                     "End after as many frames (default: with --headless once through the timeline)")
        ->check(whole(1, 1'000'000));

    SimulateOptions simulateOptions;
    CLI::App* simulateCommand = app.add_subcommand("simulate",
                                                   "Run a graph's fluids and particles once, into a cache "
                                                   "that render, export, play and the editor read");
    addGraph(simulateCommand, simulateOptions.graph);
    simulateCommand
        ->add_option("-o,--output", simulateOptions.output,
                     "The cache, a folder. One of the same simulation goes on where it was stopped; its "
                     "particles.cache is what a node's cache names")
        ->required()
        ->check(something());
    simulateCommand
        ->add_option("--node", simulateOptions.node,
                     "Only the particles that this node of the document itself gives (default: all that the "
                     "graph shows)")
        ->check(something());
    addSequence(simulateCommand, simulateOptions.sequence);
    addOpenJd(simulateCommand);
    simulateCommand->add_option("--device", simulateOptions.device,
                                "Index or part of the name of the device (see fieldwright info)");

    ImportOptions importOptions;
    CLI::App* importCommand = app.add_subcommand(
        "import",
        "Make a graph of a 3MF file with implicit functions: level sets, functions as groups, image stacks, "
        "meshes; what of it has no counterpart is told");
    importCommand->footer("Try:  fieldwright import part.3mf -o part.field.json");
    importCommand->add_option("FILE", importOptions.path, "The .3mf file")->required()->check(something());
    importCommand
        ->add_option(
            "-o,--output", importOptions.output,
            "The graph; pictures and meshes that it names go into a folder beside it, called after it "
            "(default: as FILE, but .field.json)")
        ->check(something());
    importCommand->add_flag("--overwrite", importOptions.overwrite, "Replace a graph that is there");

    std::vector<std::string> checkPaths;
    CLI::App* checkCommand =
        app.add_subcommand("check", "List every problem of graph files, with file:line:column");
    checkCommand->add_option("GRAPH", checkPaths, "The graph files")->required();

    EvalOptions evalOptions;
    CLI::App* evalCommand =
        app.add_subcommand("eval", "Evaluate a graph's field on the CPU, in double precision");
    addMoment(evalCommand, evalOptions.graph);
    CLI::Option* at =
        evalCommand
            ->add_option("--at", evalOptions.at, "The point: x y z. Prints the distance (negative inside)")
            ->expected(3)
            ->check(finite());
    CLI::Option* gradient = evalCommand->add_flag(
        "--gradient", evalOptions.gradient, "Print the gradient too, with --points behind the distance");
    CLI::Option* interval = evalCommand
                                ->add_option("--interval", evalOptions.interval,
                                             "A box: x0 y0 z0 x1 y1 z1. Prints bounds of the field over it")
                                ->expected(6)
                                ->check(finite());
    CLI::Option* points =
        evalCommand
            ->add_option(
                "--points", evalOptions.points,
                "A file with a point a line, x y z, parted by blanks or commas; what is behind a # is "
                "passed over. Prints a line for each, in order. - is standard input")
            ->check(something())
            ->excludes(at)
            ->excludes(interval);
    evalCommand
        ->add_option("--boxes", evalOptions.boxes,
                     "A file with a box a line, x0 y0 z0 x1 y1 z1. Prints bounds for each, in order. - is "
                     "standard input")
        ->check(something())
        ->excludes(at)
        ->excludes(interval)
        ->excludes(points)
        ->excludes(gradient);

    CompileCommandOptions compileOptions;
    CLI::App* compileCommand = app.add_subcommand("compile", "Show what a graph compiles to");
    addMoment(compileCommand, compileOptions.graph);
    compileCommand->add_option("--emit", compileOptions.emit, "What to print: glsl, ir, or spirv (binary)")
        ->check(oneOf({"glsl", "ir", "spirv"}))
        ->default_str("glsl");
    compileCommand
        ->add_flag(
            "--cost", compileOptions.cost,
            "Print what each node adds to the field instead: operations, what a sample of them costs and "
            "what code they are, in additions; and about how long meshes of it take")
        ->excludes("--emit");
    compileCommand
        ->add_option("--live", compileOptions.live,
                     "Keep this input a parameter instead of folding it: node.input")
        ->take_all()
        ->allow_extra_args(false);

    std::string parametersPath;
    CLI::App* parametersCommand =
        app.add_subcommand("parameters", "List what --set can change of a graph: name, value, range, input");
    parametersCommand->add_option("GRAPH", parametersPath, "The graph file")->required();
    bool parametersAsJson = false;
    parametersCommand->add_flag("--json", parametersAsJson, "As a list of objects");

    NodesFormat nodesFormat = NodesFormat::list;
    CLI::App* nodesCommand = app.add_subcommand("nodes", "List the node library");
    CLI::Option* json = nodesCommand->add_flag_callback(
        "--json", [&] { nodesFormat = NodesFormat::json; }, "Every node with its inputs, as JSON");
    nodesCommand
        ->add_flag_callback(
            "--markdown", [&] { nodesFormat = NodesFormat::markdown; }, "The reference page")
        ->excludes(json);

    serve::ServeOptions serveOptions;
    CLI::App* serveCommand = app.add_subcommand(
        "serve", "Answer other programs: open graphs, set parameters, mesh, make pictures, measure, export");
    serveCommand->footer(
        "Messages are JSON-RPC 2.0, one a line, on standard input and output, with blobs of bytes behind "
        "them: "
        "docs/server.md.\n" +
        serve::limitsInWords() + "\nTry:  fieldwright serve --root samples");
    serveCommand
        ->add_option("--root", serveOptions.roots,
                     "A folder that may be read and written in; of several the first is where paths begin. "
                     "Nothing outside is opened (default: the current folder)")
        ->type_name("FOLDER")
        ->take_all()
        ->allow_extra_args(false)
        ->check(something());
    serveCommand
        ->add_option(
            "--socket", serveOptions.socket,
            "Listen at this local socket, for several clients, in place of standard input and output")
        ->type_name("PATH")
        ->check(something());
    serveCommand
        ->add_flag(
            "--mcp", serveOptions.assistant,
            "Speak the Model Context Protocol: an assistant lists nodes, writes graphs, looks at them, "
            "measures and exports")
        ->excludes("--socket");
    serveCommand->add_option("--device", serveOptions.device,
                             "Index or part of the name of the device (see fieldwright info)");

    app.add_subcommand("bench", "Measure this machine: the tables of docs/benchmarks.md (fieldwright-bench)");

    CLI::App* infoCommand = app.add_subcommand("info", "Show the version, devices, caches and limits");
    bool devicesOnly = false;
    infoCommand->add_flag("--devices", devicesOnly,
                          "What each device can do, what it lacks, and what follows");

    std::vector<std::string> shared;  // behind "--": the command that is a job's
    if (const auto dashes = std::find(words.begin(), words.end(), "--");
        !job && !words.empty() && words[0] == "job" && dashes != words.end()) {
        shared.assign(dashes + 1, words.end());
        words.erase(dashes, words.end());
    }
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
    const bool isOption = !words.empty() && words[0].starts_with('-');
    if (isOption) names = {"--help", "-h", "--version", "--manual", "--completion"};
    if (!words.empty() && std::find(names.begin(), names.end(), words[0]) == names.end()) {
        const std::string near = nearestName(words[0], names);
        std::fprintf(stderr, "fieldwright: there is no %s %s%s\nTry: fieldwright --help\n",
                     isOption ? "option" : "command", inQuotes(words[0]).c_str(),
                     near.empty() ? "" : (": did you mean '" + near + "'?").c_str());
        return kBadUsage;
    }
    try {
        std::reverse(words.begin(), words.end());  // the parser takes them from the back
        app.parse(words);
    } catch (const CLI::ParseError& error) { return app.exit(error) == 0 ? kDone : kBadUsage; }

    if (jobCommand->parsed()) {
        if (!shared.empty() && (shared[0] == "export" || shared[0] == "render" || shared[0] == "simulate")) {
            std::erase(shared, "--openjd");  // a template has it anyhow, and nothing is made now
            return run(std::move(shared), &jobOptions);
        }
        std::fprintf(
            stderr,
            "fieldwright job: it shares out an export, a render or a simulate: write that behind --, as you "
            "would type it\nTry: fieldwright job --help\n");
        return kBadUsage;
    }

    const bool writes = exportCommand->parsed() || mergeCommand->parsed() || renderCommand->parsed() ||
                        simulateCommand->parsed();
    if (!checkCommand->parsed() && !importCommand->parsed() && !nodesCommand->parsed() &&
        !parametersCommand->parsed()) {
        makeRoomForDriverCache();
        passOverDriversWithoutCards();
    }
    const WhenEnded nothingYet{.said = writes ? kNothingWritten : ""};
    endOnSignals(nothingYet);
    const auto command = [&] {
        exportOptions.mesh.byShape = exportOptions.textures.has_value();
        if (exportCommand->parsed()) return runExport(exportOptions);
        if (mergeCommand->parsed()) return runMerge(mergeOptions);
        if (renderCommand->parsed()) return runRender(renderOptions);
        if (playCommand->parsed()) return runPlay(playOptions);
        if (simulateCommand->parsed()) return runSimulate(simulateOptions);
        if (importCommand->parsed()) return runImport(importOptions);
        if (checkCommand->parsed()) return runCheck(checkPaths);
        if (evalCommand->parsed()) return runEval(evalOptions);
        if (compileCommand->parsed()) return runCompile(compileOptions);
        if (parametersCommand->parsed()) return runParameters(parametersPath, parametersAsJson);
        if (nodesCommand->parsed()) return runNodes(nodesFormat);
        if (infoCommand->parsed()) return runInfo(devicesOnly);
        if (serveCommand->parsed()) {
            const Done served = serve::serve(serveOptions);
            return served ? kDone : (print(served.error()), kBadUsage);
        }
        return kBadUsage;
    };
    if (job) {
        JobWork work;
        if (exportCommand->parsed() && particles->count() == 0 && !exportOptions.animated)
            work.parts = job->sharing.tasks.value_or(1);
        exportOptions.mesh.planned = renderOptions.mesh.planned = &work;
        simulateOptions.planned = true;
        const int checked = command();
        return checked == kDone ? runJob(*job, typedCommand(*app.get_subcommands().front()), work) : checked;
    }
    return onceMoreIfLost(command, [&] {
        noteLost("beginning again");
        whenEnded(nothingYet);
    });
}

/// The status, unless what was printed did not reach standard output.
int afterOutput(int status) {
    errno = 0;
    const bool lost = std::fflush(stdout) != 0;
    const int cause = errno;
    if (!lost && !std::ferror(stdout) && std::cout) return status;
    std::fprintf(stderr, "fieldwright: cannot write the results to standard output%s%s\n",
                 lost && cause ? ": " : "", lost && cause ? std::strerror(cause) : "");
    return kSystemFailure;
}

}  // namespace
}  // namespace fw::cli

int main(int count, char** arguments) {
    std::signal(SIGXFSZ, SIG_IGN);  // a full quota is a write that fails, which has a message
    try {
        if (count > 1 && std::string_view(arguments[1]) == "bench")
            return fw::cli::becomeBench(arguments + 1);
        return fw::cli::afterOutput(fw::cli::run(fw::cli::readableNumbers(count, arguments)));
    } catch (const fw::SystemError& error) {
        std::fprintf(stderr, "fieldwright: %s\n", error.what());
    } catch (const std::bad_alloc&) {
        std::fprintf(
            stderr,
            "fieldwright: out of memory: export with --tiles, lower --resolution or shrink --region\n");
    }
    return fw::cli::kSystemFailure;
}
