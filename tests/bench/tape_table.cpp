// Tapes: what evaluating a field on the host takes, beside an interpreter as simple as can be.
#include <filesystem>
#include <random>

#include "editor/viewport/pick.h"
#include "graph/bounds/region.h"
#include "graph/document/json.h"
#include "graph/evaluate/evaluate.h"
#include "runtime/mesher/host.h"
#include "tests/bench/tables.h"

namespace fw::bench {
namespace {

constexpr std::size_t kPoints = 96 * 512;
constexpr std::size_t kLargest = 5;  // samples

/// Every operation up to the root, whether it is needed or not, with a row of numbers for each; a batch at a
/// time.
struct Simple {
    const Program& program;
    std::vector<double> parameters = program.parameters();
    static constexpr std::size_t kBatch = 96;
    std::vector<std::array<double, kBatch>> rows =
        std::vector<std::array<double, kBatch>>(program.distance() + 1);

    void run(std::span<const Point> points, std::span<double> values) {
        for (std::size_t first = 0; first < points.size(); first += kBatch)
            for (IrId id = 0; id <= program.distance(); ++id) {
                const IrNode& node = program.ir[id];
                const OpInfo& info = opInfo(node.op);
                const double own =
                    node.op == Op::parameter ? parameters[std::size_t(node.number)] : node.number;
                for (std::size_t k = 0; k < kBatch; ++k) {
                    double x[kMaxArity] = {};
                    for (int i = 0; i < info.arity; ++i) x[i] = rows[node.operands[std::size_t(i)]][k];
                    rows[id][k] = id < 3            ? points[first + k][id]
                                  : info.arity == 0 ? own
                                                    : info.value(x, program.ir.layer(node));
                }
                if (id == program.distance()) std::copy_n(rows[id].begin(), kBatch, &values[first]);
            }
    }
    std::size_t bytes() const { return rows.size() * sizeof(rows[0]); }
};

struct NamedField {
    std::string name;
    Graph graph;
    Program program;
};

/// The samples with most operations, and a chain of two hundred nodes.
std::vector<NamedField> fieldsOf(Bench& bench) {
    std::vector<NamedField> fields;
    const std::filesystem::path samples =
        std::filesystem::path(FIELDWRIGHT_BENCH_GRAPHS) / "../../../samples";
    for (const auto& entry : std::filesystem::directory_iterator(samples)) {
        if (!entry.path().string().ends_with(".field.json")) continue;
        const Result<Graph> graph = readGraph(entry.path(), nullptr);
        Result<Program> program = graph ? compile(*graph, {.bake = draftInPlace}) : graph.error();
        if (!program) {
            bench.fail(format(program.error()));
            continue;
        }
        const std::string name = entry.path().filename();
        fields.push_back({name.substr(0, name.find('.')), *graph, std::move(*program)});
    }
    std::ranges::sort(fields, std::greater(), [](const auto& field) { return field.program.ir.size(); });
    fields.erase(fields.begin() + std::ptrdiff_t(std::min(fields.size(), kLargest)), fields.end());
    const Graph chain = chainOfBoxes(200, 0.001);
    Result<Program> program = compile(chain);
    if (!program) throw SystemError(format(program.error()));
    fields.push_back({"200 nodes", chain, std::move(*program)});
    return fields;
}

/// What the field is seen as from far enough to see all of it.
editor::Seen seenOf(const Graph& graph, const Box& box) {
    editor::Seen seen{.graph = std::make_shared<const Graph>(graph), .region = box};
    const double away = longestSide(box);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double middle = 0.5 * (box.lo[axis] + box.hi[axis]);
        seen.camera.target[axis] = middle;
        seen.camera.position[axis] = middle + away * (axis == 1 ? 0.7 : 1.0);
    }
    return seen;
}

}  // namespace

void tapesTable(Bench& bench) {
    Table table{.title = "Fields on the host, one thread: " + count(kPoints) + " points (ms)",
                .header = {"field", "operations", "registers", "bytes an operation: simple", "tape", "simple",
                           "double", "single", "gradients", "region", "pick", "next"}};
    for (const auto& [name, graph, program] : fieldsOf(bench)) {
        const std::vector<double> parameters = program.parameters();
        const Tape tape = makeTape(program.ir, program.distance(), parameters);
        const Region region = findRegion(program.ir, program.distance(), parameters);
        const Box box = region.extent == Extent::bounded ? region.box : Box{{-2, -2, -2}, {2, 2, 2}};
        std::mt19937 random(1);
        std::vector<Point> points(kPoints);
        for (Point& point : points)
            for (std::size_t axis = 0; axis < 3; ++axis)
                point[axis] = std::lerp(box.lo[axis], box.hi[axis], double(random() >> 8) / double(1 << 24));
        std::vector<double> expected(kPoints), values(kPoints);
        std::vector<ValueGradient> gradients(kPoints);
        Simple simple{program};
        TapeMachine<double> machine, descending;
        TapeMachine<float> single;
        const auto timed = [&](auto work) {
            return measure(bench.options.repeats, [&] {
                const auto start = Clock::now();
                work();
                return millisecondsSince(start);
            });
        };
        const Figure before = timed([&] { simple.run(points, expected); });
        const Figure doubles = timed([&] { machine.evaluate(tape, points, values); });
        if (values != expected) bench.fail(name + ": the tape has other values");
        const Figure floats = timed([&] { single.evaluate(tape, points, values); });
        const Figure slopes = timed([&] { evaluateGradient(machine, tape, points, gradients); });
        const Figure regions = timed([&] { findRegion(program.ir, program.distance(), parameters); });
        const editor::Seen seen = seenOf(graph, box);
        editor::Picker picker;
        const Figure first = timed([&] { editor::Picker().pick(seen, 0.0, 0.0); });
        const Figure next = timed([&] { picker.pick(seen, 0.0, 0.0); });
        // What a thread of the mesher holds: the whole tape on intervals, a brick's on points.
        descending.interval(tape, box);
        Tape own = descending.shortened(tape);
        Box part = box;
        for (int halving = 0; halving < 12; ++halving) {
            const std::size_t axis = std::size_t(halving % 3);
            part.hi[axis] = 0.5 * (part.lo[axis] + part.hi[axis]);
            descending.interval(own, part);
            own = descending.shortened(own);
        }
        descending.value(own, 81);
        const double operations = double(tape.steps.size());
        table.rows.push_back(
            {name, count(tape.steps.size()), count(tape.registers),
             number(double(simple.bytes()) / operations),
             number(double(descending.bytes() + tape.steps.size() * sizeof(TapeStep)) / operations),
             text(before), text(doubles), text(floats), text(slopes), text(regions), text(first),
             text(next)});
    }
    table.notes = {
        "Operations are those that the field needs at each point. Simple: the op table's values, a row of 96 "
        "numbers for "
        "each operation. The tape's bytes are those of a thread of the mesher, with the tape itself.",
        "Pick: the node in the middle of the picture; next: the same asked again.",
        "Values in double are the simple interpreter's, bit for bit (checked)."};
    print(table, bench.options.markdown);
}

}  // namespace fw::bench
