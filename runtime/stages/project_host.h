// project.comp on the host: what leads the new vertices of a subdivision onto a field that is evaluated from
// tapes. The same steps, on as many threads as there are processors.
#pragma once

#include <span>

#include "graph/evaluate/tape.h"
#include "shaders/shared.h"

#include "shaders/mesh/stages.h"  // after shared.h

namespace fw {

/// `tape` is the distance's. The vertices are those that split.comp made: each in the middle of its edge,
/// with the edge's length in place of a normal. `push` as the kernel's.
void projectOnHost(const Tape& tape, const gpu::MeshPush& push, std::span<gpu::MeshVertex> vertices);

}  // namespace fw
