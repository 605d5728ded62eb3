// `fieldwright`: reads the command line and runs one command.
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <new>

#include "graph/base/own_files.h"
#include "graph/base/words.h"
#include "runtime/cli/commands.h"
#include "runtime/cli/options/options.h"
#include "runtime/cli/options/pages.h"
#include "runtime/cli/options/words.h"
#include "runtime/gpu/driver_cache.h"
#include "runtime/gpu/drivers.h"
#include "runtime/system/interruption.h"
#include "runtime/system/version.h"

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
    MergeOptions mergeOptions;
    RenderCommandOptions renderOptions;
    JobOptions jobOptions;
    PlayOptions playOptions;
    SimulateOptions simulateOptions;
    ImportOptions importOptions;
    std::vector<std::string> checkPaths;
    EvalOptions evalOptions;
    CompileCommandOptions compileOptions;
    ParametersOptions parametersOptions;
    NodesFormat nodesFormat = NodesFormat::list;
    serve::ServeOptions serveOptions;
    bool devicesOnly = false;
    const CLI::App* exportCommand = addExport(app, exportOptions);
    const CLI::App* mergeCommand = addMerge(app, mergeOptions);
    const CLI::App* renderCommand = addRender(app, renderOptions);
    const CLI::App* jobCommand = addJob(app, jobOptions);
    const CLI::App* playCommand = addPlay(app, playOptions);
    const CLI::App* simulateCommand = addSimulate(app, simulateOptions);
    const CLI::App* importCommand = addImport(app, importOptions);
    const CLI::App* checkCommand = addCheck(app, checkPaths);
    const CLI::App* evalCommand = addEval(app, evalOptions);
    const CLI::App* compileCommand = addCompile(app, compileOptions);
    const CLI::App* parametersCommand = addParameters(app, parametersOptions);
    const CLI::App* nodesCommand = addNodes(app, nodesFormat);
    const CLI::App* serveCommand = addServe(app, serveOptions);
    app.add_subcommand("bench", "Measure this machine: the tables of docs/benchmarks.md (fieldwright-bench)");
    const CLI::App* infoCommand = addInfo(app, devicesOnly);

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
        if (parametersCommand->parsed()) return runParameters(parametersOptions);
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
        if (exportCommand->parsed() && exportOptions.particles.empty() && !exportOptions.animated)
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
