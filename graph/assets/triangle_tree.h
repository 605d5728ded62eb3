// Triangles in a tree of boxes: which triangles are near, which a ray meets, which cut each other, and what
// they go around.
//
// A binary tree over the triangles' middles, halved along the longest side of their box until four are left;
// the nodes stand in one array, a left child right behind its parent. Building sorts in place, O(n log n),
// the halves of large nodes side by side.
//
// The generalized winding number of a point (Jacobson, Kavan, Sorkine-Hornung, "Robust Inside-Outside
// Segmentation using Generalized Winding Numbers", 2013) is the sum of the signed solid angles of all
// triangles, over 4 pi: 1 within a closed mesh, 0 outside, and something between near its holes. Far
// triangles are taken together as one dipole for each node (Barill et al., "Fast Winding Numbers for Soups
// and Clouds", 2018, first order).
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
#include <optional>
#include <span>
#include <vector>

namespace fw {

/// The nearest point of a triangle.
struct NearestPoint {
    double squared;  ///< its squared distance
    glm::dvec3 point;
    glm::dvec3 weights;  ///< of the corners: the point's barycentric coordinates
    int feature;         ///< 0: within the triangle; 1, 2, 3: on the side ab, bc, ca; 4, 5, 6: at a, b, c
};
/// Of a triangle that may be a segment or a point.
NearestPoint nearestOnTriangle(const glm::dvec3& p, const std::array<glm::dvec3, 3>& triangle);

/// The signed solid angle of the triangle as seen from the origin, of which 1 is all around: positive if it
/// winds clockwise from there, as a closed mesh's faces do from inside (van Oosterom and Strackee 1983).
double solidAngle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);

/// Whether two triangles of a mesh cut each other, given their three corners in `positions`: those with one
/// in common do if they meet elsewhere too, those with two do not.
bool trianglesCut(std::span<const glm::vec3> positions, const uint32_t* one, const uint32_t* other);

/// What a ray meets first.
struct RayHit {
    double distance;
    uint32_t triangle;
};

class TriangleTree {
  public:
    /// Only a tree that was made for them tells winding numbers.
    enum class Purpose { distances, winding };
    /// `indices` are three a triangle, all below positions.size(). Triangles with two equal corners are left
    /// out.
    TriangleTree(std::span<const glm::vec3> positions, std::span<const uint32_t> indices,
                 Purpose purpose = Purpose::winding);

    static constexpr uint32_t kNoGuess = ~0u;

    bool empty() const { return order.empty(); }
    /// The distance from the point to the nearest triangle, in metres; infinite if there is none.
    double distance(const glm::dvec3& point) const;
    /// The triangle that is nearest to the point; of those equally near, any. `guess` is one that may be
    /// near, or kNoGuess. Only for a tree that is not empty.
    uint32_t nearest(const glm::dvec3& point, uint32_t guess, NearestPoint& on) const;
    /// The first triangle on the way from `from` along a direction of unit length, as far as `reach`,
    /// whatever its side; `but` is not looked at. Through an edge between two of them it goes at most by
    /// rounding.
    std::optional<RayHit> firstHit(const glm::dvec3& from, const glm::dvec3& along, double reach,
                                   uint32_t but = kNoGuess) const;
    /// The generalized winding number, to some 0.02.
    double windingNumber(const glm::dvec3& point) const;
    /// Pairs of triangles that cut each other, of which the first is one of those from `begin` to `end` in
    /// the tree's order: for all pairs from 0 to size(). Each pair counts once (trianglesCut).
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
    /// What a node's triangles are from afar: their area vectors' sum, at the middle of their areas, all of
    /// them within `radius` of it.
    struct Dipole {
        glm::dvec3 area{0.0}, middle{0.0};
        double radius = 0.0;
    };

    /// A triangle while the tree is built: beside its box, so that sorting reads what it moves.
    struct Item {
        Box box;
        uint32_t triangle;
    };

    void build(uint32_t index, uint32_t first, std::span<Item> items);
    void findDipoles();
    std::array<glm::dvec3, 3> corners(uint32_t triangle) const;

    std::span<const glm::vec3> positions;
    std::span<const uint32_t> indices;
    std::vector<uint32_t> order;  ///< triangles, by the leaves
    std::vector<Node> nodes;
    std::vector<Dipole> dipoles;  ///< of the nodes
};

}  // namespace fw
