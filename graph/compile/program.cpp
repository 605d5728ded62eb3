#include "graph/compile/program.h"

#include <algorithm>
#include <utility>

#include "graph/evaluate/local_lipschitz.h"

namespace fw {

namespace {

/// Parts of a box over which a Lipschitz constant is proven.
constexpr int kMaxLipschitzParts = 1025;

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

Exactness exactnessWithin(const Program& program, const Box& box) {
    Exactness exactness = program.exactness;
    if (exactness.bound()) return exactness;
    const Tape tape = makeTape(program.ir, program.distance(), program.parameters());
    exactness.lipschitz = std::min(exactness.lipschitz, lipschitzOver(tape, box, kMaxLipschitzParts));
    return exactness;
}

}  // namespace fw
