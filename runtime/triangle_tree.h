// Triangles in a tree of boxes: which triangles are near, and which cut each other.
//
// A binary tree over the triangles' middles, halved along the longest side of their box until four are left;
// the nodes stand in one array, a left child right behind its parent. Building sorts in place, O(n log n).
//
// Whether two triangles cut each other is decided by the signs of determinants of their corners in double.
// The corners are floats; a determinant within its own rounding error counts as zero, and zero as not
// cutting: what touches, or lies in one plane, is not reported, and no pair is reported that does not cut.
//
// Lifetime: the tree refers to the mesh's arrays, which must stay as they are.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace fw {

class TriangleTree {
  public:
    /// `indices` are three a triangle, all below positions.size(). Triangles with two equal corners are left
    /// out.
    TriangleTree(std::span<const glm::vec3> positions, std::span<const uint32_t> indices);

    bool empty() const { return order.empty(); }
    /// The distance from the point to the nearest triangle, in metres; infinite if there is none.
    double distance(const glm::dvec3& point) const;
    /// Pairs of triangles that cut each other, of which the first is one of those from `begin` to `end` in
    /// the tree's order: for all pairs from 0 to size(). Each pair counts once. Triangles with a corner in
    /// common do so if they meet elsewhere too; those with two do not.
    uint64_t selfIntersections(std::size_t begin, std::size_t end) const;
    std::size_t size() const { return order.size(); }

  private:
    struct Box {
        glm::vec3 lo, hi;
    };
    struct Node {
        Box box;
        uint32_t first, count;  ///< triangles of `order`; none in an inner node
        uint32_t right;         ///< child of an inner node
    };

    uint32_t build(uint32_t first, uint32_t count, std::vector<Box>& boxes);
    std::array<glm::dvec3, 3> corners(uint32_t triangle) const;
    bool cut(uint32_t a, uint32_t b) const;

    std::span<const glm::vec3> positions;
    std::span<const uint32_t> indices;
    std::vector<uint32_t> order;  ///< triangles, by the leaves
    std::vector<Node> nodes;
};

}  // namespace fw
