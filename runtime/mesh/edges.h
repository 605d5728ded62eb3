// The edges of triangles, each once: what a program that keeps a mesh by its edges, as Blender does, would
// otherwise have to find itself.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

namespace fw {

/// In the order in which the triangles come upon them.
struct Edges {
    std::vector<glm::uvec2> ends;    ///< the two vertices, the lower one first
    std::vector<uint32_t> ofCorner;  ///< at each corner the edge from it to the next corner of its triangle
};

/// Of triangles over so many vertices. Where n edges meet at a vertex, finding them takes n^2 steps: a
/// handful, in what a mesher makes. A side of a collapsed triangle is an edge like others.
Edges edgesOf(std::span<const uint32_t> indices, std::size_t vertices);

}  // namespace fw
