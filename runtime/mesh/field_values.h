// Values of a field at many points, on the host.
//
// Points that follow each other should lie near each other: a batch of them has a box of its own, and so a
// short tape (graph/evaluate/tape.h). Batches are shared among all processors; the values do not depend on
// how.
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "graph/evaluate/tape.h"

namespace fw {

/// Of all roots of the tape, in single precision: those of a point behind each other. Points in metres.
std::vector<float> fieldValues(const Tape& field, std::span<const glm::vec3> points);

/// The box of some points, at least one.
Box boxOf(std::span<const glm::vec3> points);

/// The tape for a box; the whole one, where that is no longer.
Tape tapeFor(TapeMachine<float>& machine, const Tape& field, const Box& box);

}  // namespace fw
