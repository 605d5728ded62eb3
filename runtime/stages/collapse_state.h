// What a collapse knows of the mesh between two rounds, and whether one vertex may go onto another.
#pragma once

#include <array>
#include <glm/geometric.hpp>
#include <span>

#include "runtime/stages/carried_points.h"
#include "runtime/stages/collapse.h"
#include "runtime/stages/near_triangles.h"
#include "runtime/stages/quadric.h"
#include "runtime/stages/stars.h"

namespace fw {

struct CollapseFace {
    glm::vec3 normal{0.0f};  ///< unit length; of a triangle without area nothing
    float area = 0;
    float shape = 0;     ///< twice the area of the square of its longest side: 0.87 at most, 0 of a sliver
    float distance = 0;  ///< the most that a point of it was found away from the surface, metres
};
CollapseFace faceOf(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

/// A vertex that goes, and onto which neighbour.
struct Collapse {
    uint32_t from, to;
    float cost;
};

/// The triangles of a part of the mesh that touches no other, if there are few: it could turn inside out
/// while each of them turns only a little.
struct FewFaces {
    std::array<uint32_t, 16> triangles{};
    std::size_t count = 0;  ///< 0: there are more
    std::span<const uint32_t> all() const { return {triangles.data(), count}; }
};

struct CollapseState {
    /// Vertices and triangles in an order where neighbours are near; vertices that no triangle uses are left
    /// out.
    CollapseState(const Mesh& mesh, const CollapseLimits& limits);

    std::vector<glm::vec3> positions, colors;  ///< of colours none, or as many
    std::vector<uint32_t> labels;              ///< none, or as many
    std::vector<uint32_t> vertexNumbers;       ///< of the mesh
    std::vector<uint32_t> parts;               ///< which one of the mesh hangs together with each vertex
    std::vector<uint32_t> partTriangles;       ///< of each part, by such a number
    std::vector<char> stays;                   ///< vertices that must
    std::vector<char> bordering;               ///< vertices at a border between two looks

    std::vector<uint32_t> indices;
    std::vector<uint32_t> triangleNumbers;  ///< of the mesh
    std::vector<CollapseFace> faces;        ///< as findFaces() found them

    Stars stars;
    std::vector<Quadric> quadrics;  ///< of vertices, about `middle`
    std::vector<float> areas;       ///< of the triangles that they stand for
    CarriedPoints carried{0};
    glm::dvec3 middle{0.0};
    double size = 0.0;     ///< of the mesh's box from corner to corner
    double edge = 0.0;     ///< mean length of the mesh's edges as it was
    bool closed = true;    ///< the stars of all vertices are
    bool features = true;  ///< creases and borders are kept

    glm::dvec3 placeOf(uint32_t vertex) const { return glm::dvec3(positions[vertex]) - middle; }
    std::size_t triangles() const { return indices.size() / 3; }

    /// Stars and faces of the triangles as they are.
    void findAround();
    /// The neighbours onto which a vertex may go as far as creases and borders say, cheapest first.
    void findOptions(uint32_t vertex, std::vector<Collapse>& options) const;
    /// Of the part in which it is.
    FewFaces fewFaces(const Collapse& collapse) const;
    /// Whether the mesh stays closed and manifold, its triangles as they face, its parts outside out, and its
    /// points within `distance` of it and their allowances.
    bool allows(const Collapse& collapse, double distance) const;

  private:
    /// How much two vertices differ in colour and material; 1 for another material.
    float difference(uint32_t a, uint32_t b) const;
    void findParts();
    void findBorders();
    void findQuadrics();
    void carryPoints(const CollapseLimits& limits);
    bool keepsTopology(const Collapse& collapse) const;
    bool keepsFaces(const Collapse& collapse) const;
    bool keepsInside(const Collapse& collapse) const;
    bool keepsPoints(const Collapse& collapse, double distance) const;
    bool keepsLook(const CarriedPoints::Point& point, std::span<const uint32_t, 3> corners,
                   const glm::dvec3& weights, double distance) const;
};

/// Calls visit(spoke) for the triangles that stay when `from` goes onto `to`: of them `from` becomes `to`.
template <class Visit>
void forChanged(std::span<const Spoke> star, uint32_t to, const Visit& visit) {
    for (const Spoke& spoke : star)
        if (spoke.next != to && spoke.previous != to) visit(spoke);
}

}  // namespace fw
