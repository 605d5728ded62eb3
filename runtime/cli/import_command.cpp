// fieldwright import: a file of another program becomes a graph.
#include <cstdio>
#include <filesystem>

#include "graph/check/check.h"
#include "graph/document/json.h"
#include "runtime/cli/commands.h"
#include "runtime/files/import_graph.h"

namespace fw::cli {

int runImport(const ImportOptions& options) {
    std::filesystem::path output = options.output;
    if (output.empty())
        output = std::filesystem::path(options.path).replace_extension(std::string(kGraphEnding));
    if (std::error_code unknown; !options.overwrite && std::filesystem::exists(output, unknown))
        return print({.message = "is there already: name another with -o, or give --overwrite",
                      .file = output.string()}),
               kBadInput;
    const Result<ImportedFiles> made = importGraph(options.path, output.string());
    if (!made) return print(made.error()), kBadInput;
    for (const Error& warning : made->warnings) print(warning);
    // What of the file the graph cannot be compiled of is told at once, not when it is opened.
    bool sound = true;
    if (const Result<Graph> graph = readGraph(made->graph, nullptr); graph) {
        for (const Error& finding : check(*graph)) {
            print(finding);
            sound &= finding.severity != Error::Severity::error;
        }
    } else {
        print(graph.error());
        sound = false;
    }
    std::printf("%s\n", made->graph.c_str());
    for (const std::string& file : made->beside) std::printf("%s\n", file.c_str());
    return sound ? kDone : kBadInput;
}

}  // namespace fw::cli
