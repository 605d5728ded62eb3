// Of the commands that read and explain graphs.
#include "runtime/cli/options/groups.h"
#include "runtime/cli/options/options.h"
#include "runtime/cli/options/words.h"

namespace fw::cli {

CLI::App* addImport(CLI::App& program, ImportOptions& options) {
    CLI::App* command = program.add_subcommand(
        "import",
        "Make a graph of a 3MF file with implicit functions: level sets, functions as groups, image stacks, "
        "meshes; what of it has no counterpart is told");
    command->footer("Try:  fieldwright import part.3mf -o part.field.json");
    command->add_option("FILE", options.path, "The .3mf file")->required()->check(something());
    command
        ->add_option(
            "-o,--output", options.output,
            "The graph; pictures and meshes that it names go into a folder beside it, called after it "
            "(default: as FILE, but .field.json)")
        ->check(something());
    command->add_flag("--overwrite", options.overwrite, "Replace a graph that is there");
    return command;
}

CLI::App* addCheck(CLI::App& program, std::vector<std::string>& paths) {
    CLI::App* command =
        program.add_subcommand("check", "List every problem of graph files, with file:line:column");
    command->add_option("GRAPH", paths, "The graph files")->required();
    return command;
}

CLI::App* addEval(CLI::App& program, EvalOptions& options) {
    CLI::App* command =
        program.add_subcommand("eval", "Evaluate a graph's field on the CPU, in double precision");
    addMoment(command, options.graph);
    CLI::Option* at =
        command->add_option("--at", options.at, "The point: x y z. Prints the distance (negative inside)")
            ->expected(3)
            ->check(finite());
    CLI::Option* gradient = command->add_flag("--gradient", options.gradient,
                                              "Print the gradient too, with --points behind the distance");
    CLI::Option* interval = command
                                ->add_option("--interval", options.interval,
                                             "A box: x0 y0 z0 x1 y1 z1. Prints bounds of the field over it")
                                ->expected(6)
                                ->check(finite());
    CLI::Option* points =
        command
            ->add_option(
                "--points", options.points,
                "A file with a point a line, x y z, parted by blanks or commas; what is behind a # is "
                "passed over. Prints a line for each, in order. - is standard input")
            ->check(something())
            ->excludes(at)
            ->excludes(interval);
    command
        ->add_option("--boxes", options.boxes,
                     "A file with a box a line, x0 y0 z0 x1 y1 z1. Prints bounds for each, in order. - is "
                     "standard input")
        ->check(something())
        ->excludes(at)
        ->excludes(interval)
        ->excludes(points)
        ->excludes(gradient);
    return command;
}

CLI::App* addCompile(CLI::App& program, CompileCommandOptions& options) {
    CLI::App* command = program.add_subcommand("compile", "Show what a graph compiles to");
    addMoment(command, options.graph);
    command->add_option("--emit", options.emit, "What to print: glsl, ir, or spirv (binary)")
        ->check(oneOf({"glsl", "ir", "spirv"}))
        ->default_str("glsl");
    command
        ->add_flag(
            "--cost", options.cost,
            "Print what each node adds to the field instead: operations, what a sample of them costs and "
            "what code they are, in additions; and about how long meshes of it take")
        ->excludes("--emit");
    command
        ->add_option("--live", options.live, "Keep this input a parameter instead of folding it: node.input")
        ->take_all()
        ->allow_extra_args(false);
    return command;
}

CLI::App* addParameters(CLI::App& program, ParametersOptions& options) {
    CLI::App* command = program.add_subcommand(
        "parameters", "List what --set can change of a graph: name, value, range, input");
    command->add_option("GRAPH", options.path, "The graph file")->required();
    command->add_flag("--json", options.json, "As a list of objects");
    return command;
}

CLI::App* addNodes(CLI::App& program, NodesFormat& format) {
    CLI::App* command = program.add_subcommand("nodes", "List the node library");
    CLI::Option* json = command->add_flag_callback(
        "--json", [&] { format = NodesFormat::json; }, "Every node with its inputs, as JSON");
    command
        ->add_flag_callback(
            "--markdown", [&] { format = NodesFormat::markdown; }, "The reference page")
        ->excludes(json);
    return command;
}

CLI::App* addInfo(CLI::App& program, bool& devicesOnly) {
    CLI::App* command = program.add_subcommand("info", "Show the version, devices, caches and limits");
    command->add_flag("--devices", devicesOnly, "What each device can do, what it lacks, and what follows");
    return command;
}

}  // namespace fw::cli
