// `fieldwright-editor`: reads the command line and runs the editor.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <new>

#include "editor/editor.h"
#include "graph/json.h"

namespace fw::editor {

namespace {

enum Status { kDone = 0, kBadInput = 1, kBadUsage = 2, kSystemFailure = 3 };
constexpr double kLongestRest = 1.0;  // seconds without a look at what happens outside of the window

struct Options {
    std::string graph;
    ShellOptions shell;
};

/// "1280x800".
std::string readSize(const std::string& text, ShellOptions& shell) {
    int width = 0, height = 0, end = 0;
    if (std::sscanf(text.c_str(), "%dx%d%n", &width, &height, &end) != 2 || end != int(text.size()) ||
        width < 1 || height < 1 || width > kMostPictureSide || height > kMostPictureSide)
        return inQuotes(text) + " is no size: write WIDTHxHEIGHT in pixels, such as 1280x800";
    shell.width = width, shell.height = height;
    return {};
}

int run(const Options& options) {
    Graph graph;
    if (!options.graph.empty()) {
        std::vector<Error> warnings;
        Result<Graph> read = readGraph(options.graph, &warnings);
        for (const Error& warning : warnings) std::fprintf(stderr, "%s\n", format(warning).c_str());
        if (!read) {
            std::fprintf(stderr, "%s\n", format(read.error()).c_str());
            return kBadInput;
        }
        graph = std::move(*read);
    }
    Shell shell(options.shell);
    if (!shell.fonts().missing.empty())
        std::fprintf(stderr, "fieldwright-editor: %s\n", shell.fonts().missing.c_str());
    Editor editor(shell, std::move(graph), {.pick = options.shell.device});
    startFiles(editor);
    try {
        while (!editor.quit) {
            if (shell.closed()) {
                shell.keepOpen();
                proceed(editor, Files::Next::quit);
            }
            const bool asked = shell.waitEvents(moves(editor) ? 0.0 : kLongestRest);
            const bool fresh = exchange(editor);
            if (asked || fresh || moves(editor)) shell.frame([&] { showEditor(editor); });
        }
    } catch (const SystemError&) {
        if (editor.document.unsaved() && editor.files.recovery.keepNow(editor.document.graph()))
            std::fprintf(stderr,
                         "fieldwright-editor: the unsaved changes are kept, and offered at the next start\n");
        throw;
    }
    editor.files.recovery.discard();
    return kDone;
}

int main(int count, char** arguments) {
    CLI::App app("The node-graph editor of Fieldwright.", "fieldwright-editor");
    app.set_version_flag("--version", "fieldwright-editor " FIELDWRIGHT_VERSION);
    Options options;
    app.add_option("GRAPH", options.graph, "the file to open: *.field.json");
    app.add_option("--device", options.shell.device, "index or part of the name of the Vulkan device");
    app.add_option("--size", "of the window in pixels")
        ->type_name("WxH")
        ->check([&](const std::string& text) { return readSize(text, options.shell); });
    app.add_option("--scale", options.shell.scale, "of the interface; without it, the display's")
        ->check(CLI::Range(0.5f, 4.0f));
    try {
        app.parse(count, arguments);
    } catch (const CLI::ParseError& error) { return app.exit(error) == 0 ? kDone : kBadUsage; }
    return run(options);
}

}  // namespace

}  // namespace fw::editor

int main(int count, char** arguments) {
    try {
        return fw::editor::main(count, arguments);
    } catch (const fw::SystemError& error) {
        std::fprintf(stderr, "fieldwright-editor: %s\n", error.what());
    } catch (const std::bad_alloc&) { std::fprintf(stderr, "fieldwright-editor: out of memory\n"); }
    return fw::editor::kSystemFailure;
}
