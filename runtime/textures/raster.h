// Which texels a triangle of a texture covers.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>

namespace fw {

/// Calls use(x, y) for each texel whose middle, (x + 0.5, y + 0.5), lies in the triangle, as far as it is in
/// 0 .. width - 1 and 0 .. height - 1. Of triangles that share an edge one has a middle upon it, whichever
/// way they wind: for both the edge meets a row at the same place, to the bit.
template <class Use>
void forTexels(glm::vec2 a, glm::vec2 b, glm::vec2 c, int width, int height, const Use& use) {
    const glm::vec2 corners[] = {a, b, c};
    const auto before = [](float at) { return std::ceil(at - 0.5f); };  // the first middle not before it
    const auto within = [](float at, int most) { return int(std::clamp(at, 0.0f, float(most))); };
    const int first = within(before(std::min({a.y, b.y, c.y})), height),
              last = within(before(std::max({a.y, b.y, c.y})), height);
    for (int y = first; y < last; ++y) {
        const float middle = float(y) + 0.5f;
        float left = 1e30f, right = -1e30f;
        for (int i = 0; i < 3; ++i) {
            glm::vec2 from = corners[i], to = corners[(i + 1) % 3];
            if (to.y < from.y) std::swap(from, to);
            if (!(from.y <= middle && middle < to.y)) continue;
            const float x = from.x + (to.x - from.x) * ((middle - from.y) / (to.y - from.y));
            left = std::min(left, x);
            right = std::max(right, x);
        }
        if (!(left <= right)) continue;
        for (int x = within(before(left), width), end = within(before(right), width); x < end; ++x) use(x, y);
    }
}

}  // namespace fw
