// A place in space, and a box along the axes; metres.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace fw {

using Point = std::array<double, 3>;

struct Box {
    Point lo{}, hi{};
    bool operator==(const Box&) const = default;
};

/// The smallest box that contains both.
inline Box joined(const Box& a, const Box& b) {
    Box box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        box.lo[axis] = std::min(a.lo[axis], b.lo[axis]);
        box.hi[axis] = std::max(a.hi[axis], b.hi[axis]);
    }
    return box;
}

/// Enlarges `all`, which may be nothing yet, to contain the box too, if there is one.
inline void joinInto(std::optional<Box>& all, const std::optional<Box>& box) {
    if (box) all = all ? joined(*all, *box) : *box;
}

/// What both contain; nothing if they do not touch.
inline std::optional<Box> common(const Box& a, const Box& b) {
    Box box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        box.lo[axis] = std::max(a.lo[axis], b.lo[axis]);
        box.hi[axis] = std::min(a.hi[axis], b.hi[axis]);
        if (box.lo[axis] > box.hi[axis]) return std::nullopt;
    }
    return box;
}

/// The box's longest side; 0 if none has a length.
inline double longestSide(const Box& box) {
    return std::max({0.0, box.hi[0] - box.lo[0], box.hi[1] - box.lo[1], box.hi[2] - box.lo[2]});
}

/// Whether some side has no length, but for rounding.
inline bool isFlat(const Box& box) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (box.hi[axis] - box.lo[axis] <= 1e-12 * std::max(std::abs(box.lo[axis]), std::abs(box.hi[axis])))
            return true;
    return false;
}

inline Point centreOf(const Box& box) {
    Point centre;
    for (std::size_t axis = 0; axis < 3; ++axis) centre[axis] = 0.5 * (box.lo[axis] + box.hi[axis]);
    return centre;
}

/// The cube around the origin with sides of 2 `size`.
inline Box cubeAround(double size) { return {{-size, -size, -size}, {size, size, size}}; }

/// The two halves of a box across its longest side.
inline std::array<Box, 2> halvesOf(const Box& box) {
    std::size_t axis = 0;
    for (const std::size_t other : {1, 2})
        if (box.hi[other] - box.lo[other] > box.hi[axis] - box.lo[axis]) axis = other;
    std::array<Box, 2> halves = {box, box};
    halves[0].hi[axis] = halves[1].lo[axis] = 0.5 * (box.lo[axis] + box.hi[axis]);
    return halves;
}

/// Up to six boxes that fill `outer` around `inner`, which lies within it; `outer` itself if there is no
/// inner.
inline std::vector<Box> boxesAround(Box outer, const std::optional<Box>& inner) {
    if (!inner) return {outer};
    std::vector<Box> boxes;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (outer.lo[axis] < inner->lo[axis]) {
            boxes.push_back(outer);
            boxes.back().hi[axis] = outer.lo[axis] = inner->lo[axis];
        }
        if (outer.hi[axis] > inner->hi[axis]) {
            boxes.push_back(outer);
            boxes.back().lo[axis] = outer.hi[axis] = inner->hi[axis];
        }
    }
    return boxes;
}

}  // namespace fw
