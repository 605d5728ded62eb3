#include "graph/compile/program.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "graph/evaluate/local_lipschitz.h"

namespace fw {

namespace {

/// Parts of a box over which a Lipschitz constant is proven. A search with fewer is not worth its start.
constexpr std::size_t kMaxLipschitzParts = 1025, kMinLipschitzParts = 9;

}  // namespace

std::array<IrId, 2 * kSurfaceComponents> Program::roots() const {
    std::array<IrId, 2 * kSurfaceComponents> all;
    std::ranges::copy(opaque, std::ranges::copy(surface, all.begin()).out);
    return all;
}

bool Program::hasMaterial() const {
    for (std::size_t i = 0; i + 1 < painterComponent; ++i)
        if (!ir.isConstant(surface[i + 1], kDefaultMaterial[i])) return true;
    return false;
}

std::vector<double> Program::parameters() const {
    std::vector<double> values;
    for (const LiveParameter& parameter : live) values.push_back(parameter.value);
    return values;
}

std::vector<float> Program::numbers() const {
    std::vector<float> all;
    for (const LiveParameter& parameter : live) all.push_back(static_cast<float>(parameter.value));
    for (const Family& family : families.all) all.insert(all.end(), family.table.begin(), family.table.end());
    all.resize(std::max<std::size_t>(all.size(), 1));
    return all;
}

Region findRegion(const Program& program, std::stop_token stop) {
    return findRegion(program.ir, program.distance(), program.parameters(), program.exactness.lipschitz,
                      std::move(stop));
}

double lipschitzWithin(const Program& program, const Box& box, std::size_t maxSteps) {
    double constant = program.exactness.lipschitz;
    if (std::isfinite(constant)) return constant;
    constant = 0.0;
    const std::size_t roots = program.transmits() ? 2 : 1;
    for (std::size_t i = 0; i < roots && std::isfinite(constant); ++i) {
        const IrId root = (i ? program.opaque : program.surface)[distanceComponent];
        const Tape tape = makeTape(program.ir, root, program.parameters());
        const std::size_t parts = maxSteps / roots / (tape.steps.size() + 1);
        if (parts < kMinLipschitzParts) return kUnknownLipschitz;
        constant = std::max(constant, lipschitzOver(tape, box, int(std::min(parts, kMaxLipschitzParts))));
    }
    return constant;
}

}  // namespace fw
