#include "runtime/play/step_constant.h"

#include <cmath>
#include <utility>

namespace fw {

namespace {

/// The constant by which rays step: the declared or proven one, unless the proven one is too large.
double usedConstant(const Program& program, double constant, double maxProven) {
    const bool declared = std::isfinite(program.exactness.lipschitz);
    return declared || constant <= maxProven ? constant : kUnknownLipschitz;
}

}  // namespace

double stepConstantWithin(const Program& program, const Box& box, double maxProven) {
    return usedConstant(program, lipschitzWithin(program, box), maxProven);
}

double StepConstant::of(const Program& program, const Box& box, double maxProven, bool thorough) {
    if (std::isfinite(program.exactness.lipschitz)) return program.exactness.lipschitz;
    std::vector<double> values = program.parameters();
    const bool same = known && known->structureHash == program.structureHash && known->box == box &&
                      known->values == values;
    if (!same || (thorough && !known->thorough))
        known = Known{program.structureHash, std::move(values), box, thorough,
                      lipschitzWithin(program, box, thorough ? kThoroughSteps : kQuickSteps)};
    return usedConstant(program, known->constant, maxProven);
}

}  // namespace fw
