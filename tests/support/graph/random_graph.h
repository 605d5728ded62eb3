// Random graphs over the whole node library, the same for the same seed.
#pragma once

#include <cstdint>
#include <optional>

#include "graph/compile/compile.h"

namespace fw::test {

/// A graph of 1 to `maxNodes` nodes beside its output: every input random within its range, linked to an
/// earlier node where the types allow, or left to its default; some nodes muted, some inside a group, some
/// expressions.
Graph randomGraph(uint32_t seed, int maxNodes);

/// What a random graph compiles to; none if it does not, or to more operations than a driver soon makes
/// shaders of.
std::optional<Program> randomProgram(uint32_t seed, int maxNodes);
/// So many operations: such graphs are sound, and the nodes in them are covered by smaller ones.
inline constexpr std::size_t kMostOperations = 3000;

}  // namespace fw::test
