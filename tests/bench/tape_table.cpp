// Tapes: what evaluating a field on the host takes, beside an interpreter as simple as can be.
#include <filesystem>
#include <random>

#include "graph/document/json.h"
#include "graph/evaluate/evaluate.h"
#include "graph/evaluate/region.h"
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

/// The samples with most operations, and a chain of two hundred nodes.
std::vector<std::pair<std::string, Program>> fieldsOf(Bench& bench) {
    std::vector<std::pair<std::string, Program>> fields;
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
        fields.emplace_back(name.substr(0, name.find('.')), std::move(*program));
    }
    std::ranges::sort(fields, std::greater(), [](const auto& field) { return field.second.ir.size(); });
    fields.resize(std::min(fields.size(), kLargest));
    Result<Program> chain = compile(chainOfBoxes(200, 0.001));
    if (!chain) throw SystemError(format(chain.error()));
    fields.emplace_back("200 nodes", std::move(*chain));
    return fields;
}

}  // namespace

void tapesTable(Bench& bench) {
    Table table{.title = "Fields on the host, one thread: " + count(kPoints) + " points (ms)",
                .header = {"field", "operations", "registers", "bytes an operation: simple", "tape", "simple",
                           "double", "single", "gradients", "region"}};
    for (const auto& [name, program] : fieldsOf(bench)) {
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
             text(before), text(doubles), text(floats), text(slopes), text(regions)});
    }
    table.notes = {
        "Operations are those that the field needs at each point. Simple: the op table's values, a row of 96 "
        "numbers for "
        "each operation. The tape's bytes are those of a thread of the mesher, with the tape itself.",
        "Values in double are the simple interpreter's, bit for bit (checked)."};
    print(table, bench.options.markdown);
}

}  // namespace fw::bench
