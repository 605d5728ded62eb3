#include "graph/compile/effort.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "graph/evaluate/tape.h"

namespace fw {

namespace {

constexpr double kSecondsAWeight = 1e-3;       // of the mesher's kernels together
constexpr double kWeightOfTwice = 8000;        // at which an operation costs twice as much as in short code
constexpr double kTapeSecondsAWeight = 2e-10;  // and point
constexpr double kTraceSecondsAWeight = 1e-3;  // measured: 0.4 to 2.2 of it
constexpr int kHalvedForWeight = 3;            // an eighth of the region's side
constexpr std::size_t kPartsForWeight = 12;    // looked at, of each size
constexpr double kPointsASquare = 120;  // evaluated for each square of a cell in a section of the region

/// Which of the operations that `roots` need are in the code: of a family those of one member.
std::vector<bool> inCode(const Ir& ir, std::span<const IrId> roots, const Families& families) {
    std::vector<bool> needed(ir.size()), steps(ir.size());
    for (const IrId root : roots) needed[root] = true;
    for (IrId id = static_cast<IrId>(ir.size()); id-- > 0;) {
        if (!needed[id]) continue;
        const auto group = families.groups.find(id);
        if (group == families.groups.end()) {
            for (int i = 0; i < opInfo(ir[id].op).arity; ++i) needed[ir[id].operands[i]] = true;
            continue;
        }
        for (const IrId other : group->second.others) needed[other] = true;
        for (const uint32_t number : group->second.families) {
            const Family& family = families.all[number];
            for (const IrId step : family.steps) steps[step] = true;
            for (const IrId input : family.inputs) needed[input] = true;
        }
    }
    for (IrId id = 0; id < ir.size(); ++id) needed[id] = needed[id] || steps[id];
    return needed;
}

double weightOf(const Ir& ir, const std::vector<bool>& needed) {
    double weight = 0;
    for (IrId id = 0; id < ir.size(); ++id)
        if (needed[id]) weight += opInfo(ir[id].op).weight;
    return weight;
}

}  // namespace

double codeWeight(const Ir& ir, IrId distance, const Families& families) {
    return weightOf(ir, inCode(ir, std::span(&distance, 1), families));
}

double secondsToCompile(double weight) { return kSecondsAWeight * weight * (1 + weight / kWeightOfTwice); }

double secondsToCompile(const Program& program) {
    return secondsToCompile(codeWeight(program.ir, program.distance(), program.families));
}

double secondsByTapes(const Program& program, int resolution) {
    const double points = kPointsASquare * double(resolution) * double(resolution);
    return kTapeSecondsAWeight * points * codeWeight(program.ir, program.distance(), {});
}

double weightAtSurface(const Ir& ir, IrId distance, const Families& families,
                       std::span<const double> parameters, const Box& region) {
    const double code = codeWeight(ir, distance, families);
    if (families.empty()) return code;
    struct Part {
        Box box;
        Tape tape;
    };
    TapeMachine<double> machine;
    std::vector<Part> parts = {{region, makeTape(ir, distance, parameters)}};
    for (int halved = 0; halved < kHalvedForWeight; ++halved) {
        std::vector<Part> smaller;
        for (const Part& part : parts)
            for (int octant = 0; octant < 8; ++octant) {
                Box box = part.box;
                for (std::size_t axis = 0; axis < 3; ++axis)
                    (octant >> axis & 1 ? box.lo : box.hi)[axis] = 0.5 * (box.lo[axis] + box.hi[axis]);
                if (machine.interval(part.tape, box).contains(0))
                    smaller.push_back({box, machine.shortened(part.tape)});
            }
        if (smaller.empty()) break;
        // Some of them, from all over the region.
        parts.clear();
        const std::size_t step = (smaller.size() + kPartsForWeight - 1) / kPartsForWeight;
        for (std::size_t i = 0; i < smaller.size(); i += step) parts.push_back(std::move(smaller[i]));
    }
    double sum = 0;
    for (const Part& part : parts)
        for (const TapeStep& step : part.tape.steps) sum += opInfo(step.op).weight;
    return code + sum / double(parts.size());
}

double weightAtSurface(const Program& program, const Box& region) {
    return weightAtSurface(program.ir, program.distance(), program.families, program.parameters(), region);
}

double secondsToTrace(double weight) { return kTraceSecondsAWeight * weight; }

std::vector<NodeEffort> effortByNode(const Program& program) {
    const Ir& ir = program.ir;
    const std::vector<bool> sampled = inCode(ir, program.roots(), {}),
                            coded = inCode(ir, program.roots(), program.families);
    std::vector<NodeEffort> all(program.origins.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i].node = program.origins[i];
    for (IrId id = 0; id < ir.size(); ++id) {
        if ((!sampled[id] && !coded[id]) || opInfo(ir[id].op).arity == 0) continue;
        const double part = 1.0 / double(1 + ir.furtherOrigins(id).size());
        const auto add = [&](uint32_t origin) {
            NodeEffort& effort = all[origin];
            effort.operations += sampled[id] ? part : 0;
            effort.sample += sampled[id] ? part * opInfo(ir[id].op).weight : 0;
            effort.code += coded[id] ? part * opInfo(ir[id].op).weight : 0;
        };
        add(ir.origin(id));
        for (const uint32_t origin : ir.furtherOrigins(id)) add(origin);
    }
    std::erase_if(all, [](const NodeEffort& effort) { return effort.operations == 0; });
    std::ranges::stable_sort(all, std::greater(),
                             [](const NodeEffort& effort) { return std::pair(effort.code, effort.sample); });
    return all;
}

}  // namespace fw
