// The editor's preview: from a hand's movement to the picture, and from a changed structure.
#include <condition_variable>
#include <random>

#include "editor/preview/preview.h"
#include "graph/document/json.h"
#include "graph/document/named_parameters.h"
#include "tests/bench/tables.h"

namespace fw::bench {
namespace {

using editor::Preview;
using editor::PreviewResult;
using editor::PreviewWish;

constexpr int kPreviewCells = 128, kPreviewWidth = 800, kPreviewHeight = 600;
constexpr int kDrags = 60, kChanges = 12, kNodes = 200;
constexpr double kMostDrag = 40, kMostLateDrag = 60, kMostChange = 250, kMostAsk = 1;

/// A preview, and what it costs the thread that asks.
struct Asked {
    explicit Asked(std::string device)
        : preview({.pick = std::move(device)}, [this] {
              std::lock_guard lock(mutex);
              woken = true;
              wake.notify_all();
          }) {}

    /// Asks, and waits for a picture of that wish, or one with all its kernels. Milliseconds.
    double ask(const Graph& graph, std::set<std::string> held, bool full) {
        auto shared = std::make_shared<const Graph>(graph);
        const auto start = Clock::now();
        preview.ask({.graph = std::move(shared),
                     .revision = ++revision,
                     .held = std::move(held),
                     .width = kPreviewWidth,
                     .height = kPreviewHeight,
                     .resolution = kPreviewCells,
                     .others = others});
        longest = std::max(longest, millisecondsSince(start));
        return wait(start, full);
    }
    double wait(Clock::time_point start, bool full) {
        for (;;) {
            const auto taking = Clock::now();
            std::optional<PreviewResult> result = preview.take();
            longest = std::max(longest, millisecondsSince(taking));
            if (result) take(std::move(*result));
            if (!latest.failure.empty()) throw SystemError(latest.failure);
            if (latest.revision == revision && !latest.current) throw SystemError(latest.findings[0].message);
            if (latest.revision == revision && !(full && latest.draft)) return millisecondsSince(start);
            std::unique_lock lock(mutex);
            wake.wait(lock, [&] { return woken; });
            woken = false;
        }
    }

    void take(PreviewResult result) {
        for (std::size_t i = 0; i < result.others.size(); ++i)
            ofOthers += i >= latest.others.size() || latest.others[i].picture != result.others[i].picture;
        latest = std::move(result);
    }

    std::vector<editor::PreviewEye> others;
    int ofOthers = 0;  ///< pictures
    std::mutex mutex;
    std::condition_variable wake;
    bool woken = false;
    uint64_t revision = 0;
    double longest = 0;  ///< that a call took
    PreviewResult latest;
    Preview preview;
};

double late(const Figure& figure) { return figure.runs[figure.runs.size() * 95 / 100]; }

Figure sorted(Figure figure) {
    std::sort(figure.runs.begin(), figure.runs.end());
    return figure;
}

std::string verdict(double value, double most) {
    return "at most " + number(most) + " wanted, " + (value <= most ? "met" : "missed");
}

}  // namespace

Graph withBall(Graph chain) {
    Node ball, both;
    ball.id = "ball", ball.type = "sphere";
    both.id = "both", both.type = "union";
    InputValue link;
    link.value = Link{"ball", ""};
    both.set("a", link);
    Node& output = chain.nodes.back();
    both.set("b", *output.input("surface"));
    link.value = Link{"both", ""};
    output.set("surface", link);
    chain.nodes.insert(chain.nodes.end() - 1, {ball, both});
    return chain;
}

void editorTable(Bench& bench) {
    const Result<Graph> tower = readGraph(benchGraph(Field::tower), nullptr);
    if (!tower) return bench.fail(format(tower.error()));
    Asked asked(bench.options.device);
    Graph graph = *tower;
    const std::optional<NamedParameter> slider = findParameter(graph, "tubes");
    if (!slider) return bench.fail("the tower has no parameter 'tubes'");
    const std::set<std::string> held = {slider->node + "." + slider->input};
    const auto place = [&](int step) {
        InputValue value;
        value.value = 0.1 + 0.05 * double(step % 20) / 20.0;
        graph.node(slider->node)->set(slider->input, value);
    };
    place(0);
    const double first = asked.ask(graph, {}, true);
    place(1);
    asked.ask(graph, held, true);
    int coarsest = kPreviewCells;
    const auto drag = [&] {
        Figure drags;
        for (int i = 0; i < kDrags + 5; ++i) {
            place(i + 2);
            const double took = asked.ask(graph, held, true);
            if (i >= 5)
                drags.runs.push_back(took), coarsest = std::min(coarsest, asked.latest.statistics.resolution);
        }
        return sorted(std::move(drags));
    };
    const Figure drags = drag();
    // Two more, from the front and the right.
    Camera front, right;
    front.position = {0, 0, 12}, right.position = {12, 0, 0};
    for (const Camera& camera : {front, right})
        asked.others.push_back({camera, kPreviewWidth / 2, kPreviewHeight / 2});
    asked.ask(graph, held, true);
    asked.ofOthers = 0;
    const Figure three = drag();
    const int ofOthers = asked.ofOthers;
    asked.others.clear();

    Figure changes, complete;
    std::random_device seed;
    for (int i = 0; i < kChanges + 2; ++i) {
        const Graph chain = chainOfBoxes(kNodes - 2, double(seed()) * 1e-11);
        if (asked.ask(chain, {}, true) <= 0) return;
        const Graph more = withBall(chain);
        const auto start = Clock::now();
        const double draft = asked.ask(more, {}, false), all = asked.wait(start, true);
        if (i >= 2) changes.runs.push_back(draft), complete.runs.push_back(all);
    }
    changes = sorted(std::move(changes));
    complete = sorted(std::move(complete));

    Table table{.title = "The editor's preview, " + std::to_string(kPreviewWidth) + " x " +
                         std::to_string(kPreviewHeight) + ", " + std::to_string(kPreviewCells) +
                         " cells (ms)",
                .header = {"what", "median", "95 % within", "longest"}};
    const auto row = [&](std::string what, const Figure& figure) {
        table.rows.push_back(
            {std::move(what), number(figure.median()), number(late(figure)), number(figure.greatest())});
    };
    row("tower: a held slider moves, to its picture", drags);
    row("the same with two more views of half the size", three);
    row(std::to_string(kNodes) + " nodes: one added and wired, to the first picture", changes);
    row("the same, to the picture with its kernels", complete);
    table.notes = {"A held slider: " + verdict(drags.median(), kMostDrag) +
                       "; 95 %: " + verdict(late(drags), kMostLateDrag) + ". The coarsest mesh had " +
                       std::to_string(coarsest) + " cells.",
                   "The two more views had " + std::to_string(ofOthers) + " pictures meanwhile.",
                   "A changed structure: " + verdict(changes.median(), kMostChange) + ".",
                   "The thread that asks waited " + number(asked.longest) + " ms at most in a call, " +
                       verdict(asked.longest, kMostAsk) + "; from the start to the first full picture " +
                       number(first) + "."};
    print(table, bench.options.markdown);
}

}  // namespace fw::bench
