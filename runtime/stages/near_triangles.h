// Which triangles are near: boxes of boxes over triangles that are in an order where neighbours are near.
//
// The order is the array's own: each four triangles have a box, each four of these another, and so on. So a
// tree is made again in one pass over the triangles, without sorting, as long as those that go leave the
// others in order. Four boxes lie side by side, so that one look compares them all.
//
// Each box has a cone about the normals of what is in it (Shirman and Abi-Ezzi, "The Cone of Normals
// Technique", 1993). Where all triangles that come into a box of space face along one direction, the surface
// of a solid is a height field there: a line along that direction leaves the solid where it passes the
// surface, and to leave it again it would first have to enter it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

#include "graph/base/parallel.h"

namespace fw {

struct NearBox {
    glm::vec3 lo{std::numeric_limits<float>::infinity()}, hi{-std::numeric_limits<float>::infinity()};

    void add(const glm::vec3& point) {
        lo = glm::min(lo, point);
        hi = glm::max(hi, point);
    }
    void add(const NearBox& other) {
        lo = glm::min(lo, other.lo);
        hi = glm::max(hi, other.hi);
    }
    /// Whether they overlap or touch.
    bool meets(const NearBox& other) const {
        return lo.x <= other.hi.x && lo.y <= other.hi.y && lo.z <= other.hi.z && hi.x >= other.lo.x &&
               hi.y >= other.lo.y && hi.z >= other.lo.z;
    }
};

/// Directions that are within an angle below 90 degrees of an axis, or any.
struct NormalCone {
    glm::vec3 axis{0.0f};  ///< unit length
    float sine = kAny;     ///< of the angle
    static constexpr float kAny = 2.0f;

    /// Whether all of them are within 90 degrees of a direction of unit length.
    bool faces(const glm::vec3& direction) const { return glm::dot(axis, direction) > sine; }

    /// The one that has some others in it.
    template <std::size_t count>
    static NormalCone around(const std::array<NormalCone, count>& cones) {
        glm::vec3 sum(0.0f);
        for (const NormalCone& cone : cones) {
            if (cone.sine >= kAny) return {};
            sum += cone.axis;
        }
        const float length = glm::length(sum);
        if (!(length > 0.1f)) return {};
        const glm::vec3 axis = sum / length;
        float least = 1.0f;  // the cosine of the angle
        for (const NormalCone& cone : cones) {
            if (cone.axis == glm::vec3(0.0f)) continue;
            const float cosine = std::min(glm::dot(cone.axis, axis), 1.0f);
            least = std::min(least, cosine * std::sqrt(1.0f - cone.sine * cone.sine) -
                                        std::sqrt(1.0f - cosine * cosine) * cone.sine);
        }
        constexpr float kRounding = 1e-3f;
        least -= kRounding;
        if (!(least > kRounding)) return {};
        return {axis, std::sqrt(1.0f - least * least)};
    }
};

/// A triangle, or more of them.
struct NearTriangle {
    NearBox box;
    NormalCone normals;
};

class NearTriangles {
  public:
    /// triangleOf(number) is asked from several threads.
    template <class TriangleOf>
    void build(std::size_t count, const TriangleOf& triangleOf) {
        if (levels.empty()) levels.emplace_back();
        const auto fill = [](std::vector<Boxes>& level, std::size_t items, const auto& itemOf) {
            level.resize((items + kBoxes - 1) / kBoxes);
            forBlocks(level.size(), 4096, [&](std::size_t, std::size_t first, std::size_t last) {
                for (std::size_t i = first; i < last; ++i) {
                    level[i] = {};
                    for (std::size_t k = 0; k < kBoxes && kBoxes * i + k < items; ++k)
                        level[i].set(k, itemOf(kBoxes * i + k));
                }
            });
        };
        fill(levels[0], count, triangleOf);
        std::size_t depth = 1;
        for (; levels[depth - 1].size() > 1; ++depth) {
            if (levels.size() == depth) levels.emplace_back();
            const std::vector<Boxes>& below = levels[depth - 1];
            fill(levels[depth], below.size(), [&](std::size_t i) { return below[i].all(); });
        }
        levels.resize(depth);
    }

    /// Whether all triangles whose boxes meet this one face along a direction of unit length.
    bool allFace(const NearBox& box, const glm::vec3& direction) const {
        bool all = true;
        walk(
            box,
            [&](const Boxes& boxes, uint32_t k, bool isTriangle) {
                const bool faces = boxes.normals[k].faces(direction);
                all = all && (faces || !isTriangle);
                return all && !faces;
            },
            [](uint32_t) {});
        return all;
    }

    /// As build() was told it.
    NearBox boxOf(std::size_t triangle) const { return levels[0][triangle / kBoxes].at(triangle % kBoxes); }

    /// Calls visit(triangle) for those whose boxes meet this one.
    template <class Visit>
    void at(const NearBox& box, const Visit& visit) const {
        walk(
            box, [&](const Boxes&, uint32_t, bool) { return true; }, visit);
    }

  private:
    static constexpr uint32_t kBoxes = 4;

    /// Those that are not set meet none, and have no normals.
    struct Boxes {
        using Row = std::array<float, kBoxes>;
        static constexpr Row all(float value) { return {value, value, value, value}; }
        static constexpr float kMost = std::numeric_limits<float>::infinity();
        std::array<Row, 3> lo{all(kMost), all(kMost), all(kMost)}, hi{all(-kMost), all(-kMost), all(-kMost)};
        std::array<NormalCone, kBoxes> normals{kNone, kNone, kNone, kNone};
        static constexpr NormalCone kNone{glm::vec3(0.0f), 0.0f};

        void set(std::size_t k, const NearTriangle& item) {
            for (std::size_t axis = 0; axis < 3; ++axis)
                lo[axis][k] = item.box.lo[int(axis)], hi[axis][k] = item.box.hi[int(axis)];
            normals[k] = item.normals;
        }
        NearBox at(std::size_t k) const {
            return {{lo[0][k], lo[1][k], lo[2][k]}, {hi[0][k], hi[1][k], hi[2][k]}};
        }
        NearTriangle all() const {
            NearBox box = at(0);
            for (std::size_t k = 1; k < kBoxes; ++k) box.add(at(k));
            return {box, NormalCone::around(normals)};
        }
        std::array<uint32_t, kBoxes> meet(const NearBox& box) const {
            std::array<uint32_t, kBoxes> met;
            for (std::size_t k = 0; k < kBoxes; ++k)
                met[k] = uint32_t(lo[0][k] <= box.hi.x) & uint32_t(lo[1][k] <= box.hi.y) &
                         uint32_t(lo[2][k] <= box.hi.z) & uint32_t(hi[0][k] >= box.lo.x) &
                         uint32_t(hi[1][k] >= box.lo.y) & uint32_t(hi[2][k] >= box.lo.z);
            return met;
        }
    };

    /// From the root down through boxes that meet this one, as long as enter(boxes, k, isTriangle) says so.
    template <class Enter, class Visit>
    void walk(const NearBox& box, const Enter& enter, const Visit& visit) const {
        struct Open {
            uint32_t depth, place;
        };
        std::array<Open, 64> open;  // of each depth three at most
        std::size_t count = 0;
        if (!levels.empty() && !levels[0].empty()) open[count++] = {uint32_t(levels.size()) - 1, 0};
        while (count > 0) {
            const auto [depth, place] = open[--count];
            const Boxes& boxes = levels[depth][place];
            const std::array<uint32_t, kBoxes> met = boxes.meet(box);
            for (uint32_t k = 0; k < kBoxes; ++k) {
                if (met[k] == 0 || !enter(boxes, k, depth == 0)) continue;
                if (depth == 0)
                    visit(kBoxes * place + k);
                else
                    open[count++] = {depth - 1, kBoxes * place + k};
            }
        }
    }

    std::vector<std::vector<Boxes>> levels;  ///< of triangles, and then each of the level below
};

}  // namespace fw
