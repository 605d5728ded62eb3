// Checks of a mesh that a benchmark timed: a wrong mesh is quick to make.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace fw::bench {

/// Empty if every index names a vertex, every vertex is used, and every directed edge occurs once and is
/// paired with its reverse, so that the surface is closed and oriented; else what is wrong, as a sentence.
std::string faultOf(std::span<const uint32_t> indices, std::size_t vertexCount);

}  // namespace fw::bench
