#include "graph/assets/triangle_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

namespace fw {

namespace {

constexpr uint32_t kLeaf = 4;

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

/// Whether the open segment passes through the open triangle.
bool passesThrough(const glm::dvec3& p, const glm::dvec3& q, const Triangle& triangle) {
    const glm::dvec3 &a = triangle[0], &b = triangle[1], &c = triangle[2];
    if (orientation(a, b, c, p) * orientation(a, b, c, q) >= 0.0) return false;
    const double ab = orientation(p, q, a, b), bc = orientation(p, q, b, c), ca = orientation(p, q, c, a);
    return (ab > 0.0 && bc > 0.0 && ca > 0.0) || (ab < 0.0 && bc < 0.0 && ca < 0.0);
}

double squaredDistance(const glm::dvec3& p, const glm::vec3& lo, const glm::vec3& hi) {
    const glm::dvec3 off = glm::max(glm::max(glm::dvec3(lo) - p, p - glm::dvec3(hi)), glm::dvec3(0.0));
    return glm::dot(off, off);
}

/// Beyond so many radii a node is a dipole.
constexpr double kFar = 3.0;

}  // namespace

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

TriangleTree::TriangleTree(std::span<const glm::vec3> positions_, std::span<const uint32_t> indices_)
    : positions(positions_), indices(indices_) {
    std::vector<Box> boxes(indices.size() / 3);
    for (std::size_t t = 0; t < boxes.size(); ++t) {
        const uint32_t* corner = &indices[3 * t];
        if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) continue;
        const glm::vec3 &a = positions[corner[0]], &b = positions[corner[1]], &c = positions[corner[2]];
        boxes[t] = {glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))};
        order.push_back(uint32_t(t));
    }
    if (order.empty()) return;
    nodes.reserve(order.size());
    build(0, uint32_t(order.size()), boxes);
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

uint32_t TriangleTree::build(uint32_t first, uint32_t count, std::vector<Box>& boxes) {
    const auto index = uint32_t(nodes.size());
    Box box = boxes[order[first]];
    for (uint32_t i = first + 1; i < first + count; ++i)
        box = {glm::min(box.lo, boxes[order[i]].lo), glm::max(box.hi, boxes[order[i]].hi)};
    nodes.push_back({box, first, count, 0});
    if (count <= kLeaf) return index;
    const glm::vec3 size = box.hi - box.lo;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto middle = order.begin() + first + count / 2;
    std::nth_element(order.begin() + first, middle, order.begin() + first + count,
                     [&](uint32_t a, uint32_t b) {
                         return boxes[a].lo[axis] + boxes[a].hi[axis] < boxes[b].lo[axis] + boxes[b].hi[axis];
                     });
    nodes[index].count = 0;
    build(first, count / 2, boxes);
    const uint32_t right = build(first + count / 2, count - count / 2, boxes);
    nodes[index].right = right;
    return index;
}

std::array<glm::dvec3, 3> TriangleTree::corners(uint32_t triangle) const {
    return {glm::dvec3(positions[indices[3 * std::size_t(triangle)]]),
            glm::dvec3(positions[indices[3 * std::size_t(triangle) + 1]]),
            glm::dvec3(positions[indices[3 * std::size_t(triangle) + 2]])};
}

double TriangleTree::distance(const glm::dvec3& point) const {
    if (empty()) return std::numeric_limits<double>::infinity();
    NearestPoint on;
    nearest(point, order[0], on);
    return std::sqrt(on.squared);
}

uint32_t TriangleTree::nearest(const glm::dvec3& point, uint32_t guess, NearestPoint& on) const {
    uint32_t found = guess;
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

bool TriangleTree::cut(uint32_t a, uint32_t b) const {
    const uint32_t *cornersA = &indices[3 * std::size_t(a)], *cornersB = &indices[3 * std::size_t(b)];
    const Triangle first = corners(a), second = corners(b);
    int shared = 0;
    std::size_t atA = 0, atB = 0;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            if (cornersA[i] == cornersB[j]) ++shared, atA = i, atB = j;
    if (shared > 1) return false;
    if (shared == 1)  // the side across from the corner in common
        return passesThrough(first[(atA + 1) % 3], first[(atA + 2) % 3], second) ||
               passesThrough(second[(atB + 1) % 3], second[(atB + 2) % 3], first);
    for (std::size_t i = 0; i < 3; ++i)
        if (passesThrough(first[i], first[(i + 1) % 3], second) ||
            passesThrough(second[i], second[(i + 1) % 3], first))
            return true;
    return false;
}

uint64_t TriangleTree::selfIntersections(std::size_t begin, std::size_t end) const {
    uint64_t found = 0;
    std::vector<uint32_t> open;
    for (std::size_t place = begin; place < end; ++place) {
        const Triangle mine = corners(order[place]);
        const glm::vec3 lo(glm::min(mine[0], glm::min(mine[1], mine[2]))),
            hi(glm::max(mine[0], glm::max(mine[1], mine[2])));
        open.assign(1, 0);
        while (!open.empty()) {
            const Node& node = nodes[open.back()];
            const uint32_t index = open.back();
            open.pop_back();
            if (lo.x > node.box.hi.x || lo.y > node.box.hi.y || lo.z > node.box.hi.z ||
                hi.x < node.box.lo.x || hi.y < node.box.lo.y || hi.z < node.box.lo.z)
                continue;
            if (node.count == 0) {
                open.push_back(index + 1);
                open.push_back(node.right);
            }
            for (uint32_t i = std::max(node.first, uint32_t(place + 1)); i < node.first + node.count; ++i)
                found += cut(order[place], order[i]);
        }
    }
    return found;
}

}  // namespace fw
