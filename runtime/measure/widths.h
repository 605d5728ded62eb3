// How thick a solid's walls are, and how far its parts stand from each other, measured on a mesh of it.
//
// From the middle of each triangle a ray goes along its normal: inwards until it leaves the solid, which is
// the wall there, outwards until it meets the solid again, which is the gap. What it meets counts if it faces
// the triangle, its normal turned by 120 degrees or more: so a wall is between two sides, and the edge of a
// box is none, however near to it one stands; but what tapers to a point sharper than 60 degrees is as thin
// as its tip. (The editor's tool for walls measures the same way. The sphere of the greatest size that fits,
// another measure of thickness, is as wide where the sides are parallel, and less where they are not: at the
// rounds between two walls, where nothing is weaker.)
#pragma once

#include <array>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "graph/assets/triangle_tree.h"

namespace fw {

/// The least wall or gap there is.
struct LeastWidth {
    double width = 0;
    std::array<double, 3> place{};  ///< on one side of it
};

struct Widths {
    std::optional<LeastWidth> wall, gap;  ///< none: nothing faces anything
};

/// Of every triangle as wall or gap, NaN where there is none.
enum class Across { wall, gap };
std::vector<float> widthsOf(std::span<const glm::vec3> positions, std::span<const uint32_t> indices,
                            const TriangleTree& tree, Across across);

/// The least of both. `tree` is of the mesh. The same mesh gives the same bytes.
Widths leastWidths(std::span<const glm::vec3> positions, std::span<const uint32_t> indices,
                   const TriangleTree& tree);

}  // namespace fw
