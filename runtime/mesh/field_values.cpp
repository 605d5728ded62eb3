#include "runtime/mesh/field_values.h"

#include <glm/common.hpp>

#include "graph/base/parallel.h"

namespace fw {

Box boxOf(std::span<const glm::vec3> points) {
    glm::vec3 low = points[0], high = points[0];
    for (const glm::vec3& p : points) low = glm::min(low, p), high = glm::max(high, p);
    return {{low.x, low.y, low.z}, {high.x, high.y, high.z}};
}

Tape tapeFor(TapeMachine<float>& machine, const Tape& field, const Box& box) {
    machine.interval(field, box);
    return machine.shortens() ? machine.shortened(field) : field;
}

std::vector<float> fieldValues(const Tape& field, std::span<const glm::vec3> points) {
    constexpr std::size_t kBatch = TapeMachine<float>::kPoints;
    const std::size_t roots = field.roots.size();
    std::vector<float> values(points.size() * roots);
    forBlocks(points.size(), 32 * kBatch, [&](std::size_t, std::size_t first, std::size_t last) {
        TapeMachine<float> machine;
        for (std::size_t at = first; at < last; at += kBatch) {
            const auto batch = points.subspan(at, std::min(kBatch, last - at));
            const Tape tape = tapeFor(machine, field, boxOf(batch));
            for (int axis = 0; axis < 3; ++axis)
                for (std::size_t i = 0; i < batch.size(); ++i) machine.position(axis)[i] = batch[i][axis];
            machine.value(tape, batch.size());
            for (std::size_t k = 0; k < roots; ++k) {
                const float* of = machine.root(tape, k);
                for (std::size_t i = 0; i < batch.size(); ++i) values[(at + i) * roots + k] = of[i];
            }
        }
    });
    return values;
}

}  // namespace fw
