// The editor's interface in a real window: a frame with many nodes, opening, undo, editing for long, rest.
#include <sys/resource.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>

#include "editor/document/edits.h"
#include "editor/editor.h"
#include "editor/files/files.h"
#include "editor/timeline/actions.h"
#include "graph/document/json.h"
#include "tests/bench/tables.h"

namespace fw::bench {
namespace {

namespace fs = std::filesystem;

constexpr int kWindowWidth = 1280, kWindowHeight = 800;
constexpr int kFew = 100, kMany = 1000, kWindowChanges = 12, kFrames = 60, kEdits = 10000;
constexpr int kCodeLines = 5000;
constexpr double kRest = 3.0;  // seconds
constexpr int kTracks = 10, kKeys = 10'000;
constexpr int kParts = 500;
constexpr double kMostCurves = 16, kMostCode = 16, kMostLibrary = 16, kMostCheck = 250, kMostFew = 14,
                 kMostMany = 20, kMostStart = 600, kMostOpen = 1000, kMostUndo = 50, kMostWindowChange = 100,
                 kMostMeanwhile = 50, kMostRest = 0.01;

double processorSeconds() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
    return seconds(used.ru_utime) + seconds(used.ru_stime);
}

double residentMiB() {
    std::ifstream file("/proc/self/statm");
    double pages = 0, resident = 0;
    file >> pages >> resident;
    return resident * double(sysconf(_SC_PAGESIZE)) / 1048576.0;
}

/// So many nodes in a grid that the canvas shows whole.
Graph grid(int nodes, double difference = 0.0) {
    Graph graph = chainOfBoxes(nodes - 1, difference);
    const int columns = nodes > kFew ? 40 : 10;
    for (int i = 0; i < int(graph.nodes.size()); ++i)
        graph.nodes[std::size_t(i)].at = {double(i % columns) * (nodes > kFew ? 78.0 : 250.0),
                                          double(i / columns) * (nodes > kFew ? 110.0 : 200.0)};
    return graph;
}

/// An expression of so many lines, few of which matter to the solid.
Graph longCode(int lines) {
    std::string code = "float d = length(p) - 1; // the solid\n";
    for (int i = 0; i < lines - 2; ++i) {
        const std::string n = std::to_string(i);
        code += "vec3 v" + n + " = clamp(vec3(" + n + ".5, p.y, time), 0.0, abs(p.x)) * 0.25; /* line " + n +
                " */\n";
    }
    code += "return d;\n";
    Graph graph;
    Node expression, output;
    expression.id = "code", expression.type = "expression", expression.code = std::move(code);
    output.id = "out", output.type = "output", output.at = {300, 0};
    expression.at = {0, 0};
    InputValue link;
    link.value = Link{"code", ""};
    output.set("surface", link);
    graph.nodes = {expression, output};
    return graph;
}

/// The same few nodes with keys in tracks of vectors.
Graph moving() {
    Graph graph = grid(4 * kTracks);
    std::mt19937 random(3);
    const auto number = [&] { return 0.1 + double(random() >> 8) / double(1 << 24); };
    Json tracks = Json::array();
    for (const Node& node : graph.nodes) {
        if (node.type != "translate" || tracks.size() == std::size_t(kTracks)) continue;
        Json keys = Json::array();
        for (int i = 0; i < kKeys / kTracks; ++i)
            keys.push_back({{"time", 0.1 * i}, {"value", {number(), number(), number()}}});
        tracks.push_back(
            {{"node", node.id}, {"input", "offset"}, {"interpolation", "cubic"}, {"keys", keys}});
    }
    graph.timeline = Json{{"length", 0.1 * kKeys / kTracks}, {"tracks", tracks}};
    return graph;
}

/// The editor in a window, and its loop as main() has it.
struct Window {
    Window(const Bench& bench, Graph graph)
        : shell({.device = bench.options.device,
                 .width = kWindowWidth,
                 .height = kWindowHeight,
                 .scale = 1.0f}),
          editor(shell, std::move(graph), {.pick = bench.options.device}) {}

    double frame() {
        const auto start = Clock::now();
        shell.frame([&] { editor::showEditor(editor); });
        return millisecondsSince(start);
    }
    /// Until the picture is there and nothing is under way.
    void settle() {
        while (!editor.viewport.texture || editor.preview.busy()) {
            const bool asked = shell.waitEvents(0.1);
            if (editor::exchange(editor) || asked) frame();
        }
    }
    /// Frames one after the other, as while a hand moves on the canvas.
    Figure frames(const std::function<void(int)>& before = {}) {
        settle();
        Figure figure;
        for (int i = -5; i < kFrames; ++i) {
            shell.waitEvents(0.0);
            if (before) before(i);
            const double took = frame();
            if (i >= 0) figure.runs.push_back(took);
        }
        std::sort(figure.runs.begin(), figure.runs.end());
        return figure;
    }

    editor::Shell shell;
    editor::Editor editor;
};

}  // namespace

void interfaceTable(Bench& bench) {
    if (!std::getenv("DISPLAY")) {
        std::printf("The editor's interface was not measured: there is no display. xvfb-run gives one.\n\n");
        return;
    }
    Table table{.title = "The editor's interface, window " + std::to_string(kWindowWidth) + " x " +
                         std::to_string(kWindowHeight) + " (ms)",
                .header = {"what", "median", "95 % within", "longest", "at most wanted"}};
    const auto late = [](const Figure& figure) { return figure.runs[figure.runs.size() * 95 / 100]; };
    const auto row = [&](std::string what, Figure figure, double most) {
        std::sort(figure.runs.begin(), figure.runs.end());
        table.rows.push_back({std::move(what), number(figure.median()), number(late(figure)),
                              number(figure.greatest()),
                              number(most) + (figure.median() <= most ? ", met" : ", missed")});
    };
    // A part is measured if one of its rows has the words asked for.
    const auto wished = [&](std::initializer_list<const char*> rows) {
        return std::ranges::any_of(rows, [&](std::string_view words) {
            return words.find(bench.options.rows) != std::string_view::npos;
        });
    };
    const Result<Graph> tower = readGraph(benchGraph(Field::tower), nullptr);
    if (!tower) return bench.fail(format(tower.error()));
    double resting = 0;
    if (wished({"start", "rest"})) {
        const auto start = Clock::now();
        Window window(bench, *tower);
        while (!window.editor.viewport.texture) {
            const bool asked = window.shell.waitEvents(1.0);
            if (editor::exchange(window.editor) || asked) window.frame();
        }
        row("from the start to the tower's first picture, caches warm", {{millisecondsSince(start)}},
            kMostStart);
        window.settle();
        for (int i = 0; i < 20; ++i) window.shell.waitEvents(0.05), window.frame();
        const double before = processorSeconds();
        const auto rest = Clock::now();
        while (millisecondsSince(rest) < kRest * 1e3) {
            const bool asked = window.shell.waitEvents(kRest - millisecondsSince(rest) * 1e-3);
            if (editor::exchange(window.editor) || asked) window.frame();
        }
        resting = 100.0 * (processorSeconds() - before) / kRest;
    }
    if (wished({"few nodes"})) {
        Window window(bench, grid(kFew));
        row("a frame, " + std::to_string(kFew) + " nodes on the canvas", window.frames(), kMostFew);
    }
    if (wished({"keys"})) {
        Window window(bench, moving());
        window.editor.panels.timeline = true;
        window.editor.panels.low = 0.5f;
        editor::TimelineState& state = window.editor.panelState.timelinePanel;
        row("a frame, " + std::to_string(kKeys) + " keys in rows", window.frames(), kMostCurves);
        editor::toggleCurves(window.editor);
        row("a frame of the curve editor, " + std::to_string(kKeys) + " keys of " +
                std::to_string(3 * kTracks) + " curves",
            window.frames(), kMostCurves);
        state.view.show(0.0, 10.0);
        row("the same, a tenth of the times", window.frames(), kMostCurves);
        editor::selectAllKeys(window.editor);
        row("the same, all keys selected", window.frames(), kMostCurves);
    }
    if (wished({"library"})) {
        const fs::path folder = fs::temp_directory_path() / ("fieldwright-bench-" + std::to_string(getpid()));
        const std::string part = writeGraph(chainOfBoxes(1, 0.0));
        for (int i = 0; i < kParts; ++i) {
            const fs::path room = folder / ("room " + std::to_string(i % 10));
            fs::create_directories(room);
            std::ofstream(room / ("part_" + std::to_string(i) + ".field.json")) << part;
        }
        {
            Window window(bench, *tower);
            editor::Editor& editor = window.editor;
            editor.files.preferences.library = folder.string();
            editor.panels.library = true, editor.panels.wanted = "library";
            window.settle();
            if (editor.library.parts.size() != std::size_t(kParts))
                bench.fail("the library has " + std::to_string(editor.library.parts.size()) + " parts");
            // Until those that are seen have their pictures.
            do window.shell.waitEvents(0.02), window.frame();
            while (editor.library.picture.begun());
            row("a frame, library of " + std::to_string(kParts) + " parts", window.frames(), kMostLibrary);
            editor.library.search = "7";
            row("the same, searched", window.frames(), kMostLibrary);
        }
        fs::remove_all(folder);
    }
    if (wished({"one added"})) {
        Window window(bench, grid(kMany));
        const editor::PreviewResult& shown = window.editor.viewport.shown;
        // Frames one after the other until the graph is in the picture; the longest of them, and how long.
        const auto change = [&](Graph graph, bool draft) {
            window.editor.document.apply("Change", std::move(graph));
            const auto start = Clock::now();
            double longest = 0;
            do {
                window.shell.waitEvents(0.0);
                const auto begin = Clock::now();
                editor::exchange(window.editor);
                window.frame();
                longest = std::max(longest, millisecondsSince(begin));
            } while (shown.revision != window.editor.drawn || !shown.current || (shown.draft && !draft));
            return std::pair{longest, millisecondsSince(start)};
        };
        Figure longest, changed;
        std::random_device seed;
        for (int i = 0; i < kWindowChanges + 2; ++i) {
            const Graph chain = grid(kMany - 2, double(seed()) * 1e-11);
            change(chain, true);
            const auto [frame, all] = change(withBall(chain), true);
            if (i >= 2) longest.runs.push_back(frame), changed.runs.push_back(all);
        }
        row("one of " + std::to_string(kMany) + " nodes added, to its picture in the window", changed,
            kMostWindowChange);
        row("the longest frame meanwhile", longest, kMostMeanwhile);
    }
    if (wished({"code"})) {
        Window window(bench, longCode(kCodeLines));
        editor::Editor& editor = window.editor;
        const std::string lines = "code of " + std::to_string(kCodeLines) + " lines in its large window";
        editor.canvas.select({"code"});
        window.frame();
        editor::code::toggleWindow(editor);
        window.frame();
        editor::code::CodeEditor& code = editor.code;
        const auto check = [&] {
            while (code.checked != code.text.version) {
                window.shell.waitEvents(0.002);
                editor::exchange(editor);
                window.frame();
            }
        };
        row("a frame, " + lines, window.frames(), kMostCode);
        Figure keys, checks;
        for (int i = 0; i < 22; ++i) {
            // At the start, so that all that follows moves.
            place(code.text, {i, 0});
            check();
            const uint64_t before = code.text.version;
            ImGui::GetIO().AddInputCharacter(i % 2 ? ' ' : 'v');
            const auto start = Clock::now();
            const double took = window.frame();
            if (code.text.version == before) return bench.fail("the code does not hear keys");
            check();
            if (i >= 2) keys.runs.push_back(took), checks.runs.push_back(millisecondsSince(start));
        }
        row("from a key to the frame with its letter, " + lines, keys, kMostCode);
        row("from a key to all that is wrong with the code, frames made meanwhile", checks, kMostCheck);
    }
    double early = 0, end = 0;
    if (wished({"many nodes"})) {
        const std::string text = writeGraph(grid(kMany));
        const auto start = Clock::now();
        Result<Graph> read = parseGraph(text, "many.field.json", nullptr);
        if (!read) return bench.fail(format(read.error()));
        Window window(bench, std::move(*read));
        window.frame();
        row("opening " + std::to_string(kMany) + " nodes, to their first frame", {{millisecondsSince(start)}},
            kMostOpen);
        row("a frame, " + std::to_string(kMany) + " nodes on the canvas", window.frames(), kMostMany);
        editor::toggleProbe(window.editor);
        editor::Probe& probe = window.editor.probe;
        probe.pinned = true;
        row("the same, with the probe's point moving", window.frames([&](int i) {
            probe.point = Point{0.01 * i, 0.2, 0.1};
        }),
            kMostMany);
        editor::toggleProbe(window.editor);
        editor::Document& document = window.editor.document;
        editor::NodeIds all;
        for (const Node& node : document.graph().nodes) all.push_back(node.id);
        Figure undo;
        for (int i = 0; i < 20; ++i) {
            document.apply("Move Nodes", editor::moveNodes(document.graph(), "", all, {10, 10}));
            window.frame();
            const auto begin = Clock::now();
            document.undo();
            editor::exchange(window.editor);
            window.frame();
            undo.runs.push_back(millisecondsSince(begin));
        }
        row("undo of a move of all " + std::to_string(kMany) + ", with its frame", undo, kMostUndo);
        // Each edit moves one node; the history holds the last thousand.
        for (int i = 0; i < kEdits; ++i) {
            const std::string& id = all[std::size_t(i) % all.size()];
            document.apply("Move Node", editor::moveNodes(document.graph(), "", std::span(&id, 1), {1, 0}));
            if (i % 100 == 0) editor::exchange(window.editor), window.frame();
            if (i == kEdits / 5) early = residentMiB();
        }
        window.settle();
        end = residentMiB();
    }
    table.notes = {"At rest: " + number(resting) + " % of a core, at most " + number(kMostRest) +
                       " wanted, " + (resting <= kMostRest ? "met." : "missed."),
                   "Memory after " + std::to_string(kEdits / 5) + " edits of " + std::to_string(kMany) +
                       " nodes " + number(early) + " MiB, after " + std::to_string(kEdits) + " " +
                       number(end) + " MiB."};
    print(table, bench.options.markdown);
}

}  // namespace fw::bench
