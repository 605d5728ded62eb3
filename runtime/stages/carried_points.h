// Points of the surface as it was, each carried by the triangle that now stands for its place.
//
// A collapse changes the triangles around one vertex and their points with them: each point goes to the
// nearest of the new ones. How far a point is from the triangle that carries it bounds its distance from the
// mesh, and what colour that has there is compared with what it was. (Ciampalini, Cignoni, Montani and
// Scopigno, "Multiresolution decimation based on global error", 1997, carry the removed vertices likewise.)
#pragma once

#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <utility>
#include <vector>

namespace fw {

/// Where a triangle is nearest to a point, by the weights of its corners.
struct NearestWeights {
    double squared;  ///< the distance, metres squared
    glm::dvec3 weights;
};
NearestWeights nearestWeights(const glm::dvec3& point, const glm::dvec3& a, const glm::dvec3& b,
                              const glm::dvec3& c);

class CarriedPoints {
  public:
    struct Point {
        glm::vec3 place;
        float allowance;  ///< metres that it may be away from what carries it
        uint32_t vertex;  ///< that it was, whose colour it has; kNone
        uint32_t behind;  ///< the next one of its triangle; kNone
    };
    static constexpr uint32_t kNone = ~0u;

    explicit CarriedPoints(std::size_t triangles) : firsts(triangles, kNone) {}

    void add(uint32_t triangle, const glm::vec3& place, float allowance, uint32_t vertex) {
        points.push_back({place, allowance, vertex, firsts[triangle]});
        firsts[triangle] = uint32_t(points.size() - 1);
    }

    /// Calls visit(point) for those of a triangle until it says false; whether it never did.
    template <class Visit>
    bool all(uint32_t triangle, const Visit& visit) const {
        for (uint32_t i = firsts[triangle]; i != kNone; i = points[i].behind)
            if (!visit(points[i])) return false;
        return true;
    }
    /// Takes the points of some triangles to others: toOf(point) says to which, one of the same perhaps.
    template <class Triangles, class ToOf>
    void move(const Triangles& triangles, const ToOf& toOf) {
        uint32_t chain = kNone;
        for (const auto& each : triangles)
            for (uint32_t i = std::exchange(firsts[each.triangle()], kNone); i != kNone;)
                i = std::exchange(points[i].behind, std::exchange(chain, i));
        while (chain != kNone) {
            const uint32_t i = chain, to = toOf(points[i]);
            chain = std::exchange(points[i].behind, firsts[to]);
            firsts[to] = i;
        }
    }
    /// Triangle `from` becomes number `to`, which is not larger.
    void renumber(uint32_t from, uint32_t to) { firsts[to] = firsts[from]; }
    void resize(std::size_t triangles) { firsts.resize(triangles); }

  private:
    std::vector<Point> points;
    std::vector<uint32_t> firsts;  ///< of each triangle
};

}  // namespace fw
