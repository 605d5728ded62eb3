// `fieldwright-editor`: reads the command line and runs the editor.
#include <algorithm>
#include <atomic>
#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <new>

#include "editor/editor.h"
#include "editor/files/arrangement.h"
#include "editor/shell/loss.h"
#include "runtime/cli/options/pages.h"
#include "runtime/gpu/driver_cache.h"
#include "runtime/gpu/drivers.h"
#include "runtime/system/output_file.h"
#include "runtime/system/version.h"

namespace fw::editor {

namespace {

enum Status { kDone = 0, kBadInput = 1, kBadUsage = 2, kSystemFailure = 3 };
constexpr double kLongestRest = 1.0;  // seconds without a look at what happens outside of the window

struct Options {
    std::string graph;
    ShellOptions shell;
    bool sized = false;  ///< the window's size was asked for
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

void complain(const std::string& words) { std::fprintf(stderr, "fieldwright-editor: %s\n", words.c_str()); }

/// The way out when nothing can be shown any more: keeps what is unsaved, says so and leaves the process as
/// it is, since neither a lost device nor a lost display can be taken down in order.
[[noreturn]] void endAtOnce(Editor& editor, const std::string& why) {
    onDisplayLost({});
    const std::string kept = keepForNextTime(editor);
    complain(why + (kept.empty() ? "" : ". " + kept));
    OutputFile::removeUnfinished();
    std::_Exit(kSystemFailure);
}

/// A frame, with another device if its device is lost meanwhile.
void draw(Shell& shell, Editor& editor) {
    onceMoreIfLost([&] { shell.frame([&] { showEditor(editor); }); },
                   [&] {
                       // What is unsaved is kept first: nobody knows what a driver does that has crashed.
                       if (const std::string kept = keepForNextTime(editor); !kept.empty()) complain(kept);
                       shell.renewDevice();
                       say(editor, "the graphics device was lost, and opened anew");
                   });
}

int run(const Options& options) {
    // Before any other thread, which would take the signals.
    std::atomic<int> signal = 0;
    const SignalWatch signals([&](int heard) {
        signal = heard;
        Shell::wake();
    });
    Shell shell(options.shell);
    Editor editor(shell, Graph(), {.pick = options.shell.device});
    startFiles(editor, options.graph);
    if (!shell.fonts().missing.empty()) complain(shell.fonts().missing);
    const Preferences& preferences = editor.files.preferences;
    if (options.shell.scale == 0.0f) shell.setScale(preferences.scale);
    if (const auto size = windowSizeOf(preferences.panels); size && !options.sized)
        shell.resize(size->first, size->second);
    editor.windows.start.open = options.graph.empty();
    onDisplayLost([&] { endAtOnce(editor, "the display is gone"); });
    try {
        while (!editor.quit && signal == 0) {
            if (shell.closed()) {
                shell.keepOpen();
                proceed(editor, Files::Next::quit);
            }
            const double next = code::nextFrame(editor);
            const bool asked = shell.waitEvents(moves(editor) ? 0.0 : std::min(kLongestRest, next));
            const bool fresh = exchange(editor), due = next < kLongestRest;
            if (asked || fresh || due || moves(editor)) draw(shell, editor);
        }
    } catch (const std::exception& error) { endAtOnce(editor, error.what()); } catch (...) {
        endAtOnce(editor, "the editor failed");
    }
    onDisplayLost({});
    keepArrangement(editor, preferencesPath());
    if (signal == 0) return discardKept(editor), kDone;
    const std::string kept = keepForNextTime(editor);
    if (kept.empty())
        discardKept(editor);
    else
        complain("ended by a signal. " + kept);
    return 128 + signal;
}

int main(int count, char** arguments) {
    CLI::App app("The node-graph editor of Fieldwright.", "fieldwright-editor");
    app.set_version_flag("--version", std::string("fieldwright-editor ") + kVersionAndBuild);
    cli::addPages(app);
    Options options;
    app.add_option("GRAPH", options.graph, "the file to open: *.field.json");
    app.add_option("--device", options.shell.device, "index or part of the name of the Vulkan device");
    const CLI::Option* size =
        app.add_option("--size", "of the window in pixels")
            ->type_name("WxH")
            ->check([&](const std::string& text) { return readSize(text, options.shell); });
    app.add_option("--scale", options.shell.scale, "of the interface; without it, the display's")
        ->check(CLI::Range(0.5f, 4.0f));
    try {
        app.parse(count, arguments);
    } catch (const CLI::ParseError& error) { return app.exit(error) == 0 ? kDone : kBadUsage; }
    options.sized = size->count() > 0;
    return run(options);
}

}  // namespace

}  // namespace fw::editor

int main(int count, char** arguments) {
    fw::makeRoomForDriverCache();
    fw::passOverDriversWithoutCards();
    try {
        return fw::editor::main(count, arguments);
    } catch (const fw::SystemError& error) {
        std::fprintf(stderr, "fieldwright-editor: %s\n", error.what());
    } catch (const std::bad_alloc&) { std::fprintf(stderr, "fieldwright-editor: out of memory\n"); }
    return fw::editor::kSystemFailure;
}
