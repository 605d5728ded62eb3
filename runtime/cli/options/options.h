// The options of every command, as the parser has them: their words, what they take, what excludes what. Each
// function adds a command to the program; `options` is filled when the program's line is parsed, and must be
// there until then.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "runtime/cli/commands.h"
#include "runtime/serve/server.h"

namespace fw::cli {

CLI::App* addExport(CLI::App& program, ExportOptions& options);
CLI::App* addMerge(CLI::App& program, MergeOptions& options);
CLI::App* addRender(CLI::App& program, RenderCommandOptions& options);
CLI::App* addPlay(CLI::App& program, PlayOptions& options);
CLI::App* addSimulate(CLI::App& program, SimulateOptions& options);
CLI::App* addJob(CLI::App& program, JobOptions& options);
CLI::App* addImport(CLI::App& program, ImportOptions& options);
CLI::App* addCheck(CLI::App& program, std::vector<std::string>& paths);
CLI::App* addEval(CLI::App& program, EvalOptions& options);
CLI::App* addCompile(CLI::App& program, CompileCommandOptions& options);
CLI::App* addParameters(CLI::App& program, ParametersOptions& options);
CLI::App* addNodes(CLI::App& program, NodesFormat& format);
CLI::App* addServe(CLI::App& program, serve::ServeOptions& options);
/// `devicesOnly`: as runInfo() takes it.
CLI::App* addInfo(CLI::App& program, bool& devicesOnly);

}  // namespace fw::cli
