// Of the commands that do work for others: simulations kept, jobs, a server.
#include "runtime/cli/options/groups.h"
#include "runtime/cli/options/options.h"
#include "runtime/cli/options/words.h"

namespace fw::cli {

CLI::App* addSimulate(CLI::App& program, SimulateOptions& options) {
    CLI::App* command = program.add_subcommand("simulate",
                                               "Run a graph's fluids and particles once, into a cache "
                                               "that render, export, play and the editor read");
    addGraph(command, options.graph);
    command
        ->add_option("-o,--output", options.output,
                     "The cache, a folder. One of the same simulation goes on where it was stopped; its "
                     "particles.cache is what a node's cache names")
        ->required()
        ->check(something());
    command
        ->add_option("--node", options.node,
                     "Only the particles that this node of the document itself gives (default: all that the "
                     "graph shows)")
        ->check(something());
    addSequence(command, options.sequence);
    addOpenJd(command);
    command->add_option("--device", options.device,
                        "Index or part of the name of the device (see fieldwright info)");
    return command;
}

CLI::App* addJob(CLI::App& program, JobOptions& options) {
    CLI::App* command =
        program.add_subcommand("job",
                               "Share an export, a render or a simulation out among machines: write what an "
                               "engine that runs jobs takes, and a program "
                               "`submit` that hands it in");
    command->footer(
        "Behind -- comes the command, as you would type it. A job waits in DIR until DIR/submit is run.\n"
        "Try:  fieldwright job --for slurm -o job -- render moving.field.json -o frames --from 0");
    command->add_option("--for", options.engine, "Slurm, OpenJobDescription or GNU parallel")
        ->required()
        ->check(oneOf(jobEngines()));
    command
        ->add_option("-o,--output", options.folder,
                     "The folder for the job, where all machines see it by the same name")
        ->required()
        ->check(something());
    CLI::Option* chunk = command
                             ->add_option("--chunk", options.sharing.chunk,
                                          "Frames or variants a task (default: 10 frames, 100 variants)")
                             ->check(whole(1, kMostFrames));
    command
        ->add_option("--tasks", options.sharing.tasks,
                     "So many tasks: of one mesh parts of its tiles, which are merged in the end")
        ->check(whole(1, kMostJobTasks))
        ->excludes(chunk);
    command
        ->add_option("--program", options.program, "fieldwright as the machines call it (default: this one)")
        ->check(something());
    return command;
}

CLI::App* addServe(CLI::App& program, serve::ServeOptions& options) {
    CLI::App* command = program.add_subcommand(
        "serve", "Answer other programs: open graphs, set parameters, mesh, make pictures, measure, export");
    command->footer(
        "Messages are JSON-RPC 2.0, one a line, on standard input and output, with blobs of bytes behind "
        "them: "
        "docs/server.md.\n" +
        serve::limitsInWords() + "\nTry:  fieldwright serve --root samples");
    command
        ->add_option("--root", options.roots,
                     "A folder that may be read and written in; of several the first is where paths begin. "
                     "Nothing outside is opened (default: the current folder)")
        ->type_name("FOLDER")
        ->take_all()
        ->allow_extra_args(false)
        ->check(something());
    command
        ->add_option(
            "--socket", options.socket,
            "Listen at this local socket, for several clients, in place of standard input and output")
        ->type_name("PATH")
        ->check(something());
    command
        ->add_flag(
            "--mcp", options.assistant,
            "Speak the Model Context Protocol: an assistant lists nodes, writes graphs, looks at them, "
            "measures and exports")
        ->excludes("--socket");
    command->add_option("--device", options.device,
                        "Index or part of the name of the device (see fieldwright info)");
    return command;
}

}  // namespace fw::cli
