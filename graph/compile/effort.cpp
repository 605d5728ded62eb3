#include "graph/compile/effort.h"

#include <algorithm>
#include <vector>

namespace fw {

namespace {

constexpr double kSecondsAWeight = 1e-3;       // of the mesher's kernels together
constexpr double kWeightOfTwice = 8000;        // at which an operation costs twice as much as in short code
constexpr double kTapeSecondsAWeight = 2e-10;  // and point
constexpr double kPointsASquare = 120;  // evaluated for each square of a cell in a section of the region

double weightOf(Op op) {
    switch (op) {
        case Op::constant:
        case Op::parameter:
        case Op::positionX:
        case Op::positionY:
        case Op::positionZ: return 0;
        case Op::sine:
        case Op::cosine:
        case Op::arcTangent2: return 5;
        case Op::tangent: return 10;
        case Op::power: return 7;
        case Op::gradientNoise: return 60;
        case Op::simplexNoise: return 45;
        case Op::worleyNoise: return 110;
        case Op::cellHash: return 25;
        default: return 1;
    }
}

double weightOf(const Program& program, bool families) {
    const Ir& ir = program.ir;
    std::vector<bool> needed(ir.size());
    needed[program.distance()] = true;
    double weight = 0;
    for (IrId id = program.distance() + 1; id-- > 0;) {
        if (!needed[id]) continue;
        const auto group = program.families.groups.find(id);
        if (!families || group == program.families.groups.end()) {
            weight += weightOf(ir[id].op);
            for (int i = 0; i < opInfo(ir[id].op).arity; ++i) needed[ir[id].operands[i]] = true;
            continue;
        }
        for (const IrId other : group->second.others) needed[other] = true;
        for (const uint32_t number : group->second.families) {
            const Family& family = program.families.all[number];
            for (const IrId step : family.steps) weight += weightOf(ir[step].op);
            for (const IrId input : family.inputs) needed[input] = true;
        }
    }
    return weight;
}

}  // namespace

double codeWeight(const Program& program) { return weightOf(program, true); }

double secondsToCompile(const Program& program) {
    const double weight = codeWeight(program);
    return kSecondsAWeight * weight * (1 + weight / kWeightOfTwice);
}

double secondsByTapes(const Program& program, int resolution) {
    const double points = kPointsASquare * double(resolution) * double(resolution);
    return kTapeSecondsAWeight * points * weightOf(program, false);
}

}  // namespace fw
