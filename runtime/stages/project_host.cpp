#include "runtime/stages/project_host.h"

#include <array>
#include <bit>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include "graph/base/parallel.h"
#include "runtime/mesh/octahedral.h"
#include "runtime/mesher/mesher.h"

namespace fw {

namespace {

using Machine = TapeMachine<float>;
constexpr std::size_t kBatch = Machine::kGradientPoints;
constexpr int kSteps = 4;  // as in project.comp

/// A vertex on its way.
struct Moving {
    glm::vec3 middle, p, side, free;
    float most;
};

Moving start(const gpu::MeshPush& push, const gpu::MeshVertex& vertex) {
    Moving moving{.middle = vertex.position, .p = vertex.position, .side = {}, .free = {}, .most = 0};
    for (int axis = 0; axis < 3; ++axis) {
        const float at = moving.middle[axis];
        moving.side[axis] = float(at >= push.hi[axis] - push.rim) - float(at <= push.lo[axis] + push.rim);
        moving.free[axis] = 1 - std::abs(moving.side[axis]);
    }
    const bool onSide = moving.side != glm::vec3(0);
    moving.most = float(onSide ? MESH_MOST_MOVED_ON_SIDE : MESH_MOST_MOVED) *
                  std::bit_cast<float>(uint32_t(vertex.normal));
    return moving;
}

/// Where Newton's step leads to, from the middle, and how far that is: 1e30 where the field tells no way.
struct Step {
    glm::vec3 moved;
    float far;
};
Step newton(const Moving& moving, glm::vec3 gradient, float value) {
    const glm::vec3 along = gradient * moving.free;
    const float slope = glm::dot(along, along);
    const glm::vec3 moved = moving.p - along * (slope > 0 ? value / slope : 0) - moving.middle;
    return {moved, slope > 0 ? glm::length(moved) : 1e30f};
}

void step(const gpu::MeshPush& push, Moving& moving, glm::vec3 gradient, float value) {
    auto [moved, far] = newton(moving, gradient, value);
    if (far > moving.most) moved *= moving.most / far;
    if (far < 1e30f) moving.p = glm::clamp(moving.middle + moved, push.lo, push.hi);
}

gpu::MeshVertex end(const Moving& moving, glm::vec3 gradient, float value) {
    const bool onSide = moving.side != glm::vec3(0);
    const bool capped = onSide && value < 0 && newton(moving, gradient, value).far > moving.most;
    const float size = glm::length(gradient);
    const bool known = size > 0 && size < 1e30f && !capped;
    const glm::vec3 normal = known     ? gradient / size
                             : !onSide ? glm::vec3(0, 1, 0)
                                       : glm::normalize(moving.side);
    return {capped ? moving.middle : moving.p, packOctahedral(normal)};
}

void projectBatch(Machine& machine, const Tape& tape, const gpu::MeshPush& push,
                  std::span<gpu::MeshVertex> vertices) {
    std::array<Moving, kBatch> moving;
    for (std::size_t i = 0; i < vertices.size(); ++i) moving[i] = start(push, vertices[i]);
    for (int steps = 0; steps <= kSteps; ++steps) {
        for (std::size_t i = 0; i < vertices.size(); ++i)
            for (int axis = 0; axis < 3; ++axis) machine.position(axis)[i] = moving[i].p[axis];
        const auto [values, slopes] = machine.gradient(tape, vertices.size());
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const glm::vec3 gradient(slopes[0][i], slopes[1][i], slopes[2][i]);
            if (steps < kSteps)
                step(push, moving[i], gradient, values[i]);
            else
                vertices[i] = end(moving[i], gradient, values[i]);
        }
    }
}

}  // namespace

void projectOnHost(const Tape& tape, const gpu::MeshPush& push, std::span<gpu::MeshVertex> vertices) {
    forBlocks(vertices.size(), 64 * kBatch, [&](std::size_t, std::size_t first, std::size_t last) {
        Machine machine;
        for (; first < last; first += kBatch)
            projectBatch(machine, tape, push, vertices.subspan(first, std::min(kBatch, last - first)));
    });
}

}  // namespace fw
