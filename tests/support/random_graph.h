// Random graphs over the whole node library, the same for the same seed.
#pragma once

#include <cstdint>

#include "graph/graph.h"

namespace fw::test {

/// A graph of 1 to `maxNodes` nodes beside its output: every input random within its range, linked to an
/// earlier node where the types allow, or left to its default; some nodes muted, some inside a group, some
/// expressions.
Graph randomGraph(uint32_t seed, int maxNodes);

}  // namespace fw::test
