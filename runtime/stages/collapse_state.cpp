#include "runtime/stages/collapse_state.h"

#include <algorithm>
#include <cmath>

#include "graph/base/parallel.h"
#include "runtime/mesh/corners.h"
#include "runtime/mesh/joined_sets.h"

namespace fw {

namespace {

constexpr std::size_t kBlock = 16384;
constexpr float kBorder = 0.1f;      // colours that differ by more have a border between them,
constexpr float kAlike = 0.02f;      // and what differs by less is on the same side of it
constexpr double kBorderWeight = 4;  // of a border's planes, beside the surface's
constexpr double kNearer = 1e-6;  // of neighbours at one cost the nearer one is taken, in squares of a length

bool finite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// Every third bit of the result is one of the 21.
uint64_t spread(uint32_t bits) {
    uint64_t x = bits;
    x = (x | x << 32) & 0x1f00000000ffff;
    x = (x | x << 16) & 0x1f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    return (x | x << 2) & 0x1249249249249249;
}

/// Triangles along Morton's curve, those with two equal corners left out.
std::vector<uint32_t> alongCurve(const Mesh& mesh, const NearBox& bounds) {
    struct Place {
        uint64_t key;
        uint32_t triangle;
    };
    const glm::vec3 size = glm::max(bounds.hi - bounds.lo, glm::vec3(1e-30f));
    const float longest = std::max({size.x, size.y, size.z});
    std::vector<Place> places(mesh.triangleCount());
    forBlocks(places.size(), kBlock, [&](std::size_t, std::size_t first, std::size_t last) {
        for (std::size_t t = first; t < last; ++t) {
            const uint32_t* corner = &mesh.indices[3 * t];
            const glm::vec3 sum =
                mesh.positions[corner[0]] + mesh.positions[corner[1]] + mesh.positions[corner[2]];
            uint64_t key = 0;
            for (int axis = 0; axis < 3 && finite(sum); ++axis) {
                const float at = (sum[axis] / 3.0f - bounds.lo[axis]) / longest * 2097151.0f;
                key |= spread(uint32_t(std::clamp(at, 0.0f, 2097151.0f))) << axis;
            }
            places[t] = {key, uint32_t(t)};
        }
    });
    std::erase_if(places, [&](const Place& place) { return collapsed(&mesh.indices[3 * place.triangle]); });
    const auto before = [](const Place& a, const Place& b) {
        return a.key != b.key ? a.key < b.key : a.triangle < b.triangle;
    };
    if (!std::ranges::is_sorted(places, before)) std::ranges::sort(places, before);
    std::vector<uint32_t> order;
    order.reserve(places.size());
    for (const Place& place : places) order.push_back(place.triangle);
    return order;
}

}  // namespace

CollapseFace faceOf(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const glm::dvec3 ab = glm::dvec3(b) - glm::dvec3(a), ac = glm::dvec3(c) - glm::dvec3(a), bc = ac - ab;
    const glm::dvec3 normal = glm::cross(ab, ac);
    const double twice = glm::length(normal);
    const double longest = std::max({glm::dot(ab, ab), glm::dot(ac, ac), glm::dot(bc, bc)});
    if (!(twice > 0.0)) return {};
    return {glm::vec3(normal / twice), float(0.5 * twice), float(twice / longest)};
}

CollapseState::CollapseState(const Mesh& mesh, const CollapseLimits& limits) {
    NearBox bounds;
    for (const uint32_t index : mesh.indices)
        if (finite(mesh.positions[index])) bounds.add(mesh.positions[index]);
    if (!(bounds.lo.x <= bounds.hi.x)) bounds = {glm::vec3(0.0f), glm::vec3(0.0f)};
    middle = 0.5 * (glm::dvec3(bounds.lo) + glm::dvec3(bounds.hi));
    size = glm::distance(bounds.lo, bounds.hi);
    triangleNumbers = alongCurve(mesh, bounds);
    std::vector<uint32_t> numbers(mesh.positions.size(), ~0u);
    indices.reserve(3 * triangleNumbers.size());
    for (const uint32_t t : triangleNumbers)
        for (std::size_t k = 0; k < 3; ++k) {
            uint32_t& number = numbers[mesh.indices[3 * t + k]];
            if (number == ~0u) {
                number = uint32_t(vertexNumbers.size());
                vertexNumbers.push_back(mesh.indices[3 * t + k]);
            }
            indices.push_back(number);
        }
    for (const uint32_t v : vertexNumbers) {
        positions.push_back(mesh.positions[v]);
        if (!mesh.colors.empty()) colors.push_back(mesh.colors[v]);
        if (!limits.labels.empty()) labels.push_back(limits.labels[v]);
    }
    stays.assign(positions.size(), 0);
    double sum = 0.0;
    for (std::size_t i = 0; i < indices.size(); i += 3) {
        bool known = true;
        for (std::size_t k = 0; k < 3; ++k) known = known && finite(positions[indices[i + k]]);
        for (std::size_t k = 0; k < 3; ++k)
            if (known)
                sum += glm::distance(positions[indices[i + k]], positions[indices[i + (k + 1) % 3]]);
            else
                stays[indices[i + k]] = 1;
    }
    edge = sum / double(std::max<std::size_t>(indices.size(), 1));
    faces.resize(triangles());
    findAround();
    for (std::size_t v = 0; v < positions.size(); ++v) {
        closed = closed && stars.closed(v);
        stays[v] = stays[v] || !stars.closed(v);
    }
    findParts();
    findBorders();
    findQuadrics();
    carryPoints(limits);
}

void CollapseState::findParts() {
    JoinedSets sets(positions.size());
    for (std::size_t i = 0; i < indices.size(); i += 3)
        for (std::size_t k = 1; k < 3; ++k) sets.join(indices[i], indices[i + k]);
    parts.resize(positions.size());
    for (uint32_t v = 0; v < parts.size(); ++v) parts[v] = sets.root(v);
    partTriangles.assign(positions.size(), 0);
    for (std::size_t i = 0; i < indices.size(); i += 3) ++partTriangles[parts[indices[i]]];
}

void CollapseState::findAround() {
    stars.find(indices, positions.size());
    forBlocks(triangles(), kBlock, [&](std::size_t, std::size_t first, std::size_t last) {
        for (std::size_t t = first; t < last; ++t) {
            const uint32_t* corner = &indices[3 * t];
            const float distance = faces[t].distance;
            faces[t] = faceOf(positions[corner[0]], positions[corner[1]], positions[corner[2]]);
            faces[t].distance = distance;
        }
    });
}

float CollapseState::difference(uint32_t a, uint32_t b) const {
    if (!labels.empty() && labels[a] != labels[b]) return 1.0f;
    if (colors.empty()) return 0.0f;
    const glm::vec3 off = glm::abs(colors[a] - colors[b]);
    return std::max({off.x, off.y, off.z});
}

/// A border is where neighbours are alike or quite different, and not where one colour goes over into
/// another.
void CollapseState::findBorders() {
    bordering.assign(positions.size(), 0);
    if (colors.empty() && labels.empty()) return;
    forBlocks(positions.size(), kBlock, [&](std::size_t, std::size_t first, std::size_t last) {
        for (auto v = uint32_t(first); v < last; ++v) {
            bool sides = true, across = false;
            for (const Spoke& spoke : stars.at(v)) {
                const float off = difference(v, spoke.next);
                across = across || off > kBorder;
                sides = sides && (off <= kAlike || off > kBorder);
            }
            bordering[v] = sides && across;
        }
    });
}

void CollapseState::findQuadrics() {
    quadrics.resize(positions.size());
    areas.assign(positions.size(), 0.0f);
    forBlocks(positions.size(), kBlock, [&](std::size_t, std::size_t first, std::size_t last) {
        for (auto v = uint32_t(first); v < last; ++v)
            for (const Spoke& spoke : stars.at(v)) {
                const CollapseFace& face = faces[spoke.triangle()];
                const double share = face.area / 3.0;
                quadrics[v].addPlane(glm::dvec3(face.normal), placeOf(v), share);
                areas[v] += float(share);
                if (!bordering[v] || face.area <= 0.0f) continue;
                // The border passes the triangle where two of its corners are alike: their side is held.
                for (const auto& [along, across] :
                     {std::pair(spoke.next, spoke.previous), std::pair(spoke.previous, spoke.next)}) {
                    if (difference(v, along) > kAlike || difference(v, across) <= kBorder) continue;
                    const glm::dvec3 side = placeOf(along) - placeOf(v);
                    const double length = glm::length(side);
                    if (length > 0.0)
                        quadrics[v].addPlane(glm::cross(side / length, glm::dvec3(face.normal)), placeOf(v),
                                             kBorderWeight * share);
                }
            }
    });
}

void CollapseState::carryPoints(const CollapseLimits& limits) {
    carried = CarriedPoints(triangles());
    for (uint32_t v = 0; v < positions.size(); ++v) {
        if (stars.at(v).empty() || !finite(positions[v])) continue;
        const float allowance = limits.allowances.empty() ? std::numeric_limits<float>::infinity()
                                                          : limits.allowances[vertexNumbers[v]];
        carried.add(stars.at(v)[0].triangle(), positions[v], allowance, v);
    }
    if (limits.further.empty()) return;
    std::vector<uint32_t> places(*std::ranges::max_element(triangleNumbers) + 1, CarriedPoints::kNone);
    for (uint32_t t = 0; t < triangles(); ++t) places[triangleNumbers[t]] = t;
    for (const CollapseLimits::Further& point : limits.further)
        if (point.triangle < places.size() && places[point.triangle] != CarriedPoints::kNone)
            carried.add(places[point.triangle], point.place, point.allowance, CarriedPoints::kNone);
}

void CollapseState::findOptions(uint32_t vertex, std::vector<Collapse>& options) const {
    constexpr float kCrease = 0.77f;  // the cosine of some 40 degrees
    constexpr float kSliver = 0.05f;  // whose normal says little
    constexpr std::size_t kMostAround = 64;
    options.clear();
    const std::span<const Spoke> star = stars.at(vertex);
    const auto creased = [&](std::size_t i) {
        const CollapseFace &one = faces[star[i].triangle()],
                           &other = faces[star[i == 0 ? star.size() - 1 : i - 1].triangle()];
        return one.shape > kSliver && other.shape > kSliver && glm::dot(one.normal, other.normal) < kCrease;
    };
    bool onCrease = false;
    for (std::size_t i = 0; i < star.size() && features; ++i) onCrease = onCrease || creased(i);
    // Along a border leads what is alike, with something different on one side.
    const auto bordered = [&](std::size_t i) {
        const uint32_t one = star[i].previous, other = star[i == 0 ? star.size() - 1 : i - 1].next;
        return difference(vertex, star[i].next) <= kAlike &&
               (difference(vertex, one) > kBorder || difference(vertex, other) > kBorder);
    };
    const bool onBorder = features && bordering[vertex] && std::ranges::any_of(star, [&](const Spoke& spoke) {
                              return difference(vertex, spoke.next) > kBorder;
                          });
    const glm::dvec3 here = placeOf(vertex);
    for (std::size_t i = 0; i < star.size(); ++i) {
        const uint32_t to = star[i].next;
        if (onCrease && !creased(i)) continue;
        if (onBorder && !bordered(i)) continue;
        if (star.size() + stars.at(to).size() > kMostAround) continue;
        const glm::dvec3 there = placeOf(to), way = there - here;
        const double cost =
            std::max(quadrics[vertex].at(there), 0.0) + kNearer * areas[vertex] * glm::dot(way, way);
        options.push_back({vertex, to, float(cost)});
    }
    std::ranges::sort(options, [](const Collapse& a, const Collapse& b) {
        return a.cost != b.cost ? a.cost < b.cost : a.to < b.to;
    });
}

}  // namespace fw
