// Which triangles are near: boxes of boxes over triangles that are in an order where neighbours are near.
//
// The order is the array's own: each four triangles have a box, each four of these another, and so on. So a
// tree is made again in one pass over the triangles, without sorting, as long as those that go leave the
// others in order.
#pragma once

#include <array>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
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

class NearTriangles {
  public:
    /// boxOf(triangle) is asked from several threads.
    template <class BoxOf>
    void build(std::size_t count, const BoxOf& boxOf) {
        boxes.resize(count);
        forBlocks(count, 16384, [&](std::size_t, std::size_t first, std::size_t last) {
            for (std::size_t t = first; t < last; ++t) boxes[t] = boxOf(t);
        });
        std::size_t depth = 0;
        for (std::span<const NearBox> below = boxes; below.size() > kChildren; ++depth) {
            if (levels.size() == depth) levels.emplace_back();
            std::vector<NearBox>& level = levels[depth];
            level.assign((below.size() + kChildren - 1) / kChildren, {});
            for (std::size_t i = 0; i < below.size(); ++i) level[i / kChildren].add(below[i]);
            below = level;
        }
        levels.resize(depth);
    }

    /// As build() was told it.
    const NearBox& boxOf(std::size_t triangle) const { return boxes[triangle]; }

    /// Calls visit(triangle) for those whose boxes meet this one.
    template <class Visit>
    void at(const NearBox& box, const Visit& visit) const {
        struct Open {
            uint32_t depth, first;
        };
        std::array<Open, 64> open;  // of each depth three at most
        std::size_t count = 0;
        if (!boxes.empty()) open[count++] = {uint32_t(levels.size()), 0};
        while (count > 0) {
            const auto [depth, first] = open[--count];
            const std::vector<NearBox>& level = depth == 0 ? boxes : levels[depth - 1];
            const std::size_t last = std::min<std::size_t>(first + kChildren, level.size());
            for (std::size_t i = first; i < last; ++i) {
                if (!level[i].meets(box)) continue;
                if (depth == 0)
                    visit(uint32_t(i));
                else
                    open[count++] = {depth - 1, uint32_t(i * kChildren)};
            }
        }
    }

  private:
    static constexpr std::size_t kChildren = 4;
    std::vector<NearBox> boxes;                ///< of triangles
    std::vector<std::vector<NearBox>> levels;  ///< from below
};

}  // namespace fw
