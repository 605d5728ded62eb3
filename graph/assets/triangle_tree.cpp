#include "graph/assets/triangle_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <future>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <optional>

namespace fw {

namespace {

constexpr uint32_t kLeaf = 4;
constexpr uint32_t kWorthAThread = 1 << 15;  // triangles below a node
constexpr std::size_t kTogether = 8;         // triangles that look for others in one walk

using Triangle = std::array<glm::dvec3, 3>;

/// Six times the volume of a, b, c, d: positive if d lies on the side of a, b, c from which they turn
/// clockwise. Zero if its sign is not known. (Shewchuk 1997 bounds the error of this form by 7.8e-16 of the
/// sum of its terms' sizes; the differences of floats that it starts from may be rounded once more.)
double orientation(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
    const glm::dvec3 x = a - d, y = b - d, z = c - d;
    const double p = y.x * z.y, q = z.x * y.y, r = z.x * x.y, s = x.x * z.y, t = x.x * y.y, u = y.x * x.y;
    const double value = x.z * (p - q) + y.z * (r - s) + z.z * (t - u);
    const double size = std::abs(x.z) * (std::abs(p) + std::abs(q)) +
                        std::abs(y.z) * (std::abs(r) + std::abs(s)) +
                        std::abs(z.z) * (std::abs(t) + std::abs(u));
    return std::abs(value) > 2e-15 * size ? value : 0.0;
}

/// A triangle's plane: its normal, as long as twice its area, and what went into that, for bounds of
/// rounding.
struct Plane {
    explicit Plane(const Triangle& t) : corner(t[0]) {
        const glm::dvec3 u = t[1] - t[0], v = t[2] - t[0];
        const glm::dvec3 plus(u.y * v.z, u.z * v.x, u.x * v.y), minus(u.z * v.y, u.x * v.z, u.y * v.x);
        normal = plus - minus;
        size = glm::abs(plus) + glm::abs(minus);
    }
    /// Positive on the side from which the corners turn clockwise, as orientation(); zero if it is not known.
    double side(const glm::dvec3& point) const {
        const glm::dvec3 off = corner - point;
        const double value = glm::dot(normal, off);
        return std::abs(value) > 2e-15 * glm::dot(size, glm::abs(off)) ? value : 0.0;
    }
    glm::dvec3 sides(const Triangle& t) const { return {side(t[0]), side(t[1]), side(t[2])}; }

    glm::dvec3 corner, normal, size;
};

constexpr double kRounded = 1e-12;

/// How far the triangle is along a ray (Möller and Trumbore, Fast, minimum storage ray/triangle intersection,
/// 1997); its edges are a little wide, so that nothing slips through between two triangles.
std::optional<double> meets(const glm::dvec3& from, const glm::dvec3& along, const Triangle& t) {
    const glm::dvec3 ab = t[1] - t[0], ac = t[2] - t[0], across = glm::cross(along, ac);
    const double determinant = glm::dot(ab, across);
    if (determinant == 0.0) return std::nullopt;
    const glm::dvec3 off = from - t[0];
    const double u = glm::dot(off, across) / determinant;
    if (!(u >= -kRounded && u <= 1.0 + kRounded)) return std::nullopt;
    const glm::dvec3 turned = glm::cross(off, ab);
    const double v = glm::dot(along, turned) / determinant;
    if (!(v >= -kRounded && u + v <= 1.0 + kRounded)) return std::nullopt;
    const double distance = glm::dot(ac, turned) / determinant;
    return distance > 0.0 ? std::optional(distance) : std::nullopt;
}

/// Whether the open segment, whose ends are on both sides of the open triangle's plane, passes through it.
bool passesThrough(const glm::dvec3& p, const glm::dvec3& q, const Triangle& triangle) {
    const glm::dvec3 &a = triangle[0], &b = triangle[1], &c = triangle[2];
    const double ab = orientation(p, q, a, b), bc = orientation(p, q, b, c), ca = orientation(p, q, c, a);
    return (ab > 0.0 && bc > 0.0 && ca > 0.0) || (ab < 0.0 && bc < 0.0 && ca < 0.0);
}

/// A triangle by the numbers of its corners, with what tells whether others cut it.
struct Facet {
    Facet(std::span<const glm::vec3> positions, const uint32_t* numbers)
        : index(numbers),
          corners{glm::dvec3(positions[index[0]]), glm::dvec3(positions[index[1]]),
                  glm::dvec3(positions[index[2]])},
          plane(corners) {}
    const uint32_t* index;
    Triangle corners;
    Plane plane;
};

bool cut(const Facet& a, const Facet& b) {
    int shared = 0;
    std::size_t atA = 0, atB = 0;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            if (a.index[i] == b.index[j]) ++shared, atA = i, atB = j;
    if (shared > 1) return false;
    // Of those with a corner in common only the side across from it.
    const auto pierces = [shared](const Facet& one, const glm::dvec3& sides, std::size_t common,
                                  const Facet& other) {
        for (std::size_t k = shared == 1 ? 1 : 0; k < (shared == 1 ? 2 : 3); ++k) {
            const std::size_t p = (common + k) % 3, q = (p + 1) % 3;
            if (sides[int(p)] * sides[int(q)] < 0.0 &&
                passesThrough(one.corners[p], one.corners[q], other.corners))
                return true;
        }
        return false;
    };
    const glm::dvec3 sides = b.plane.sides(a.corners);
    if (std::min({sides.x, sides.y, sides.z}) > 0.0 || std::max({sides.x, sides.y, sides.z}) < 0.0)
        return false;
    return pierces(a, sides, atA, b) || pierces(b, a.plane.sides(b.corners), atB, a);
}

double squaredDistance(const glm::dvec3& p, const glm::vec3& lo, const glm::vec3& hi) {
    const glm::dvec3 off = glm::max(glm::max(glm::dvec3(lo) - p, p - glm::dvec3(hi)), glm::dvec3(0.0));
    return glm::dot(off, off);
}

/// Of the tree over so many triangles.
uint32_t nodesOf(uint32_t triangles) {
    // All subtrees of one depth have one of two sizes, next to each other.
    uint32_t size = triangles, smaller = 1, larger = 0, nodes = 0;  // trees of `size`, and of one more
    while (size > kLeaf) {
        nodes += smaller + larger;
        const uint32_t all = 2 * (smaller + larger), half = size / 2;
        // An even size gives two halves, an odd one a half and one more.
        larger = size % 2 == 0 ? larger : smaller + 2 * larger;
        smaller = all - larger;
        size = half;
    }
    // Of those with one triangle more than a leaf holds, each has two leaves.
    return nodes + smaller + larger + (size == kLeaf ? 2 * larger : 0);
}

/// Beyond so many radii a node is a dipole.
constexpr double kFar = 3.0;

}  // namespace

bool trianglesCut(std::span<const glm::vec3> positions, const uint32_t* one, const uint32_t* other) {
    return cut(Facet(positions, one), Facet(positions, other));
}

double solidAngle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const double x = glm::length(a), y = glm::length(b), z = glm::length(c);
    const double above = glm::dot(a, glm::cross(b, c));
    const double below = x * y * z + glm::dot(a, b) * z + glm::dot(b, c) * x + glm::dot(c, a) * y;
    return std::atan2(above, below) / (2.0 * std::numbers::pi);
}

NearestPoint nearestOnTriangle(const glm::dvec3& p, const Triangle& triangle) {
    // By the region of its plane that the point is over (Ericson, Real-Time Collision Detection, 5.1.5).
    const glm::dvec3 &a = triangle[0], &b = triangle[1], &c = triangle[2];
    const auto at = [&](const glm::dvec3& weights, int feature) {
        const glm::dvec3 point = weights.x * a + weights.y * b + weights.z * c;
        const glm::dvec3 off = p - point;
        return NearestPoint{glm::dot(off, off), point, weights, feature};
    };
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double size = glm::dot(normal, normal);
    if (size > 0.0) {
        const glm::dvec3 weights =
            glm::dvec3(glm::dot(glm::cross(c - b, p - b), normal), glm::dot(glm::cross(a - c, p - c), normal),
                       glm::dot(glm::cross(b - a, p - a), normal)) /
            size;
        if (weights.x >= 0.0 && weights.y >= 0.0 && weights.z >= 0.0) return at(weights, 0);
    }
    NearestPoint least{std::numeric_limits<double>::infinity(), {}, {}, 0};
    for (int side = 0; side < 3; ++side) {
        const std::size_t first = std::size_t(side), second = (first + 1) % 3;
        const glm::dvec3 along = triangle[second] - triangle[first];
        const double length = glm::dot(along, along);
        const double t = length > 0.0 ? glm::dot(p - triangle[first], along) / length : 0.0;
        glm::dvec3 weights(0.0);
        weights[int(second)] = std::clamp(t, 0.0, 1.0);
        weights[int(first)] = 1.0 - weights[int(second)];
        const NearestPoint on = at(weights, t <= 0.0   ? 4 + int(first)
                                            : t >= 1.0 ? 4 + int(second)
                                                       : 1 + side);
        if (on.squared < least.squared) least = on;
    }
    return least;
}

TriangleTree::TriangleTree(std::span<const glm::vec3> positions_, std::span<const uint32_t> indices_,
                           Purpose purpose)
    : positions(positions_), indices(indices_) {
    std::vector<Item> items;
    items.reserve(indices.size() / 3);
    for (std::size_t t = 0; t < indices.size() / 3; ++t) {
        const uint32_t* corner = &indices[3 * t];
        if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) continue;
        const glm::vec3 &a = positions[corner[0]], &b = positions[corner[1]], &c = positions[corner[2]];
        items.push_back({{glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))}, uint32_t(t)});
    }
    if (items.empty()) return;
    order.resize(items.size());
    nodes.resize(nodesOf(uint32_t(items.size())));
    build(0, 0, items);
    if (purpose == Purpose::winding) findDipoles();
}

void TriangleTree::findDipoles() {
    dipoles.resize(nodes.size());
    for (std::size_t i = nodes.size(); i-- > 0;) {  // children stand behind their parents
        const Node& node = nodes[i];
        Dipole& dipole = dipoles[i];
        double size = 0.0;
        const auto add = [&](const glm::dvec3& area, const glm::dvec3& middle, double weight) {
            dipole.area += area;
            dipole.middle += weight * middle;
            size += weight;
        };
        for (uint32_t k = node.first; k < node.first + node.count; ++k) {
            const Triangle t = corners(order[k]);
            const glm::dvec3 area = 0.5 * glm::cross(t[1] - t[0], t[2] - t[0]);
            add(area, (t[0] + t[1] + t[2]) / 3.0, glm::length(area));
        }
        if (node.count == 0)
            for (const std::size_t child : {i + 1, std::size_t(node.right)})
                add(dipoles[child].area, dipoles[child].middle, glm::length(dipoles[child].area));
        const glm::dvec3 lo(node.box.lo), hi(node.box.hi);
        dipole.middle = size > 0.0 ? dipole.middle / size : 0.5 * (lo + hi);
        dipole.radius = glm::length(glm::max(hi - dipole.middle, dipole.middle - lo));
    }
}

void TriangleTree::build(uint32_t index, uint32_t first, std::span<Item> items) {
    const auto count = uint32_t(items.size());
    Box box = items[0].box;
    for (const Item& item : items) box = {glm::min(box.lo, item.box.lo), glm::max(box.hi, item.box.hi)};
    nodes[index] = {box, first, count, 0};
    if (count <= kLeaf) {
        for (uint32_t i = 0; i < count; ++i) order[first + i] = items[i].triangle;
        return;
    }
    const glm::vec3 size = box.hi - box.lo;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    std::nth_element(items.begin(), items.begin() + count / 2, items.end(),
                     [axis](const Item& a, const Item& b) {
                         return a.box.lo[axis] + a.box.hi[axis] < b.box.lo[axis] + b.box.hi[axis];
                     });
    const uint32_t left = count / 2, right = index + 1 + nodesOf(left);
    nodes[index].count = 0;
    nodes[index].right = right;
    const auto buildLeft = [&] { build(index + 1, first, items.first(left)); };
    std::future<void> beside;
    if (count >= kWorthAThread)
        beside = std::async(std::launch::async, buildLeft);
    else
        buildLeft();
    build(right, first + left, items.subspan(left));
    if (beside.valid()) beside.get();
}

std::array<glm::dvec3, 3> TriangleTree::corners(uint32_t triangle) const {
    return {glm::dvec3(positions[indices[3 * std::size_t(triangle)]]),
            glm::dvec3(positions[indices[3 * std::size_t(triangle) + 1]]),
            glm::dvec3(positions[indices[3 * std::size_t(triangle) + 2]])};
}

double TriangleTree::distance(const glm::dvec3& point) const {
    if (empty()) return std::numeric_limits<double>::infinity();
    NearestPoint on;
    nearest(point, kNoGuess, on);
    return std::sqrt(on.squared);
}

uint32_t TriangleTree::nearest(const glm::dvec3& point, uint32_t guess, NearestPoint& on) const {
    uint32_t found = guess = guess == kNoGuess ? order[0] : guess;
    on = nearestOnTriangle(point, corners(guess));
    struct Open {
        uint32_t node;
        double squared;
    };
    std::array<Open, 64> open;  // the tree is balanced
    std::size_t count = 0;
    open[count++] = {0, 0.0};
    while (count > 0) {
        const Open next = open[--count];
        if (next.squared >= on.squared) continue;
        const Node& node = nodes[next.node];
        for (uint32_t i = node.first; i < node.first + node.count; ++i) {
            const NearestPoint candidate = nearestOnTriangle(point, corners(order[i]));
            if (candidate.squared < on.squared) on = candidate, found = order[i];
        }
        if (node.count > 0) continue;
        const auto far = [&](uint32_t child) {
            return Open{child, squaredDistance(point, nodes[child].box.lo, nodes[child].box.hi)};
        };
        Open near = far(next.node + 1), other = far(node.right);
        if (other.squared < near.squared) std::swap(near, other);
        open[count++] = other;
        open[count++] = near;
    }
    return found;
}

std::optional<RayHit> TriangleTree::firstHit(const glm::dvec3& from, const glm::dvec3& along, double reach,
                                             uint32_t but) const {
    if (empty()) return std::nullopt;
    const glm::dvec3 inverse = 1.0 / along;
    // Where the ray comes into a box; infinite if it does not within the reach.
    const auto entry = [&](const Box& box) {
        double in = 0.0, out = reach;
        for (int axis = 0; axis < 3; ++axis) {
            double near = (double(box.lo[axis]) - from[axis]) * inverse[axis],
                   far = (double(box.hi[axis]) - from[axis]) * inverse[axis];
            if (inverse[axis] < 0.0) std::swap(near, far);
            // Of a ray within a face the product is no number, and says nothing.
            if (near > in) in = near;
            if (far < out) out = far;
        }
        return in <= out * (1.0 + kRounded) ? in : std::numeric_limits<double>::infinity();
    };
    std::optional<RayHit> hit;
    struct Open {
        uint32_t node;
        double entry;
    };
    std::array<Open, 64> open;  // the tree is balanced
    std::size_t count = 0;
    open[count++] = {0, entry(nodes[0].box)};
    while (count > 0) {
        const Open next = open[--count];
        if (!(next.entry < reach)) continue;
        const Node& node = nodes[next.node];
        for (uint32_t i = node.first; i < node.first + node.count; ++i) {
            if (order[i] == but) continue;
            const Triangle t = corners(order[i]);
            if (const auto distance = meets(from, along, t); distance && *distance < reach)
                reach = *distance, hit = RayHit{reach, order[i]};
        }
        if (node.count > 0) continue;
        Open near{next.node + 1, entry(nodes[next.node + 1].box)},
            other{node.right, entry(nodes[node.right].box)};
        if (other.entry < near.entry) std::swap(near, other);
        open[count++] = other;
        open[count++] = near;
    }
    return hit;
}

double TriangleTree::windingNumber(const glm::dvec3& point) const {
    if (empty()) return 0.0;
    double sum = 0.0;
    std::array<uint32_t, 64> open;
    std::size_t count = 0;
    open[count++] = 0;
    while (count > 0) {
        const uint32_t index = open[--count];
        const Node& node = nodes[index];
        const Dipole& dipole = dipoles[index];
        const glm::dvec3 off = dipole.middle - point;
        const double squared = glm::dot(off, off);
        if (squared > kFar * kFar * dipole.radius * dipole.radius) {
            sum += glm::dot(dipole.area, off) / (4.0 * std::numbers::pi * squared * std::sqrt(squared));
            continue;
        }
        for (uint32_t i = node.first; i < node.first + node.count; ++i) {
            const Triangle t = corners(order[i]);
            sum += solidAngle(t[0] - point, t[1] - point, t[2] - point);
        }
        if (node.count > 0) continue;
        open[count++] = index + 1;
        open[count++] = node.right;
    }
    return sum;
}

uint64_t TriangleTree::selfIntersections(std::size_t begin, std::size_t end) const {
    uint64_t found = 0;
    std::vector<uint32_t> open;
    const auto boxOf = [&](std::size_t place) {
        const uint32_t* corner = &indices[3 * std::size_t(order[place])];
        const glm::vec3 &a = positions[corner[0]], &b = positions[corner[1]], &c = positions[corner[2]];
        return Box{glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))};
    };
    // What only touches does not cut: so coplanar neighbours are apart wherever their plane is an axis's.
    const auto apart = [](const Box& a, const Box& b) {
        return a.lo.x >= b.hi.x || a.lo.y >= b.hi.y || a.lo.z >= b.hi.z || a.hi.x <= b.lo.x ||
               a.hi.y <= b.lo.y || a.hi.z <= b.lo.z;
    };
    for (std::size_t from = begin; from < end; from += kTogether) {
        const std::size_t to = std::min(from + kTogether, end);
        std::array<Box, kTogether> own;
        std::vector<Facet> facets;
        facets.reserve(kTogether);
        for (std::size_t place = from; place < to; ++place) {
            own[place - from] = boxOf(place);
            facets.emplace_back(positions, &indices[3 * std::size_t(order[place])]);
        }
        Box all = own[0];
        for (std::size_t k = 1; k < to - from; ++k)
            all = {glm::min(all.lo, own[k].lo), glm::max(all.hi, own[k].hi)};
        open.assign(1, 0);
        while (!open.empty()) {
            const uint32_t index = open.back();
            const Node& node = nodes[index];
            open.pop_back();
            if (apart(all, node.box)) continue;
            if (node.count == 0) {
                open.push_back(index + 1);
                open.push_back(node.right);
            }
            for (std::size_t i = std::max(std::size_t(node.first), from + 1); i < node.first + node.count;
                 ++i) {
                const Box other = boxOf(i);
                if (apart(all, other)) continue;
                std::optional<Facet> facet;
                for (std::size_t k = 0; k < std::min(to, i) - from; ++k) {
                    if (apart(own[k], other)) continue;
                    if (!facet) facet.emplace(positions, &indices[3 * std::size_t(order[i])]);
                    found += cut(facets[k], *facet);
                }
            }
        }
    }
    return found;
}

}  // namespace fw
