#include "runtime/stages/collapse.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>

#include "graph/assets/triangle_tree.h"
#include "graph/base/parallel.h"
#include "runtime/mesh/corners.h"
#include "runtime/stages/collapse_state.h"

namespace fw {

namespace {

constexpr std::size_t kVertices = 4096, kCollapses = 256;  // that one thread takes at a time
constexpr uint32_t kNoOne = ~0u;
constexpr double kShare = 0.4;      // of the vertices that could go, of which a round takes some
constexpr double kFew = 0.05;       // of a round: if fewer went, the next one takes from all
constexpr double kStart = 0.25;     // of an edge: the distance with which it begins, if it may grow
constexpr double kRough = 8;        // edges: if it grows beyond them, creases and borders are given up,
constexpr double kLittle = 0.1;     // and also if fewer of the triangles went for a distance twice as large
constexpr double kMost = 0.5;       // of the mesh's size, beyond which it does not grow
constexpr double kSamples = 65536;  // points at which all of the surface would be asked
constexpr int kMostSamples = 256;   // of a triangle
constexpr float kFaces = 0.01f;     // the least cosine to a direction that a triangle faces along
constexpr std::size_t kAtOnce = 2048;

/// Edges that are new in a round.
class NewEdges {
  public:
    explicit NewEdges(std::size_t most) : keys(std::bit_ceil(2 * most + 16), kFree) {}
    bool has(uint32_t a, uint32_t b) const { return keys[place(key(a, b))] != kFree; }
    void add(uint32_t a, uint32_t b) { keys[place(key(a, b))] = key(a, b); }

  private:
    static constexpr uint64_t kFree = ~uint64_t{0};
    static uint64_t key(uint32_t a, uint32_t b) { return uint64_t(std::min(a, b)) << 32 | std::max(a, b); }
    /// Where the key is or would be.
    std::size_t place(uint64_t wanted) const {
        std::size_t at = (wanted * 0x9e3779b97f4a7c15u >> 20) & (keys.size() - 1);
        while (keys[at] != kFree && keys[at] != wanted) at = (at + 1) & (keys.size() - 1);
        return at;
    }
    std::vector<uint64_t> keys;
};

NormalCone coneOf(const CollapseFace& face) {
    return face.area > 0.0f ? NormalCone{face.normal, 0.0f} : NormalCone{};
}

/// A new triangle.
struct Made {
    Made(std::span<const glm::vec3> positions, const std::array<uint32_t, 3>& corners_)
        : corners(corners_), origin(positions[corners[0]]) {
        for (const uint32_t corner : corners) box.add(positions[corner]);
        normal = glm::cross(glm::dvec3(positions[corners[1]]) - origin,
                            glm::dvec3(positions[corners[2]]) - origin);
    }
    /// False where a look at either plane tells that they do not cut: two corners are common, or all of one's
    /// are on one side of the other.
    bool mayCut(std::span<const glm::vec3> positions, const std::array<uint32_t, 3>& other) const {
        const auto isCorner = [&](uint32_t corner) {
            return corner == corners[0] || corner == corners[1] || corner == corners[2];
        };
        const int shared = isCorner(other[0]) + isCorner(other[1]) + isCorner(other[2]);
        if (shared > 1) return false;
        int above = shared, below = shared;
        for (const uint32_t corner : other) {
            if (isCorner(corner)) continue;
            const double side = glm::dot(normal, glm::dvec3(positions[corner]) - origin);
            above += side > 0.0;
            below += side < 0.0;
        }
        if (above == 3 || below == 3) return false;
        const glm::dvec3 from(positions[other[0]]);
        const glm::dvec3 across =
            glm::cross(glm::dvec3(positions[other[1]]) - from, glm::dvec3(positions[other[2]]) - from);
        above = below = shared;
        for (const uint32_t corner : corners) {
            if (corner == other[0] || corner == other[1] || corner == other[2]) continue;
            const double side = glm::dot(across, glm::dvec3(positions[corner]) - from);
            above += side > 0.0;
            below += side < 0.0;
        }
        return above < 3 && below < 3;
    }

    std::array<uint32_t, 3> corners;
    glm::dvec3 origin, normal;
    NearBox box;
};

class Rounds {
  public:
    Rounds(const Mesh& mesh, const CollapseLimits& wanted) : limits(wanted), state(mesh, wanted) {}

    std::vector<uint32_t> run();

  private:
    bool reached() const { return limits.triangles > 0 && state.triangles() <= limits.triangles; }
    std::size_t toGo() const {
        return limits.triangles > 0 ? (state.triangles() - limits.triangles + 1) / 2 : ~std::size_t{0};
    }
    void askSurface();
    void choose(bool all);
    void check();
    void claim();
    void verify();
    std::size_t apply();
    void compact();
    bool cutsNone(uint32_t number, std::vector<Made>& made) const;
    void ask(std::size_t first, std::size_t last);

    const CollapseLimits& limits;
    CollapseState state;
    NearTriangles near;
    double distance = 0;  ///< of this round
    float dearest = 0;    ///< that a collapse of this round may cost
    double samplesPerArea = 0;
    std::vector<float> tried;  ///< of a vertex: what costs no more was refused, and nothing has changed since
    std::vector<Collapse> chosen;               ///< of this round, by their vertices
    std::vector<char> refused;                  ///< of these
    std::vector<uint32_t> owners;               ///< of each triangle: which of them changes it
    std::vector<std::vector<float>> distances;  ///< of each of them: of the triangles that it changes
};

/// How far each triangle is away from the surface as it is.
void Rounds::askSurface() {
    double area = 0.0;
    for (const CollapseFace& face : state.faces) area += face.area;
    samplesPerArea = area > 0.0 ? kSamples / area : 0.0;
    forBlocks(state.triangles(), kAtOnce, [&](std::size_t, std::size_t first, std::size_t last) {
        std::vector<glm::dvec3> points;
        std::vector<double> found(last - first);
        for (std::size_t t = first; t < last; ++t) {
            glm::dvec3 sum(0.0);
            for (std::size_t k = 0; k < 3; ++k) sum += glm::dvec3(state.positions[state.indices[3 * t + k]]);
            points.push_back(sum / 3.0);
        }
        limits.fromSurface(points, found);
        for (std::size_t t = first; t < last; ++t) state.faces[t].distance = float(found[t - first]);
    });
}

/// The cheapest vertices of which no two are neighbours.
void Rounds::choose(bool all) {
    struct Candidate {
        float cost;
        uint32_t vertex;
    };
    const std::size_t vertices = state.positions.size();
    std::vector<std::vector<Candidate>> parts((vertices + kVertices - 1) / kVertices);
    forBlocks(vertices, kVertices, [&](std::size_t block, std::size_t first, std::size_t last) {
        std::vector<Collapse> options;
        for (auto v = uint32_t(first); v < last; ++v) {
            if (state.stays[v] || state.stars.at(v).empty()) continue;
            state.findOptions(v, options);
            const auto next =
                std::ranges::find_if(options, [&](const Collapse& option) { return option.cost > tried[v]; });
            if (next != options.end()) parts[block].push_back({next->cost, v});
        }
    });
    std::vector<Candidate> candidates;
    for (const std::vector<Candidate>& part : parts)
        candidates.insert(candidates.end(), part.begin(), part.end());
    chosen.clear();
    if (candidates.empty()) return;
    const auto before = [](const Candidate& a, const Candidate& b) {
        return a.cost != b.cost ? a.cost < b.cost : a.vertex < b.vertex;
    };
    std::size_t count = all ? candidates.size() : std::size_t(kShare * double(candidates.size())) + 64;
    if (limits.triangles > 0) count = std::min(count, 4 * toGo() + 64);
    dearest = std::numeric_limits<float>::infinity();
    if (count < candidates.size()) {
        std::ranges::nth_element(candidates, candidates.begin() + std::ptrdiff_t(count), before);
        dearest = candidates[count].cost;
        candidates.resize(count);
    }
    std::ranges::sort(candidates, before);
    std::vector<char> beside(vertices);  // those that go
    for (const Candidate& candidate : candidates) {
        if (beside[candidate.vertex]) continue;
        chosen.push_back({candidate.vertex, kNoOne, candidate.cost});
        for (const Spoke& spoke : state.stars.at(candidate.vertex)) beside[spoke.next] = 1;
    }
    std::ranges::sort(chosen, {}, &Collapse::from);  // neighbours are near in memory
}

/// Onto which neighbour each may go, if onto any.
void Rounds::check() {
    refused.assign(chosen.size(), 0);
    forBlocks(chosen.size(), kCollapses, [&](std::size_t, std::size_t first, std::size_t last) {
        std::vector<Collapse> options;
        for (std::size_t i = first; i < last; ++i) {
            const uint32_t vertex = chosen[i].from;
            state.findOptions(vertex, options);
            const auto found = std::ranges::find_if(options, [&](const Collapse& option) {
                return option.cost > tried[vertex] && option.cost <= dearest &&
                       state.allows(option, distance);
            });
            refused[i] = found == options.end();
            if (refused[i])
                tried[vertex] = dearest;
            else
                chosen[i] = *found;
        }
    });
}

/// Leaves out what would make an edge, or a triangle, that another makes too; and of a part of few triangles
/// all but one, which are checked alone.
void Rounds::claim() {
    std::size_t most = 0;
    for (const Collapse& one : chosen) most += state.stars.at(one.from).size();
    NewEdges edges(most);
    owners.assign(state.triangles(), kNoOne);
    std::vector<std::pair<uint32_t, uint32_t>> made;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        if (refused[i]) continue;
        const auto [from, to, cost] = chosen[i];
        const std::span<const Spoke> star = state.stars.at(from);
        refused[i] = std::ranges::any_of(state.fewFaces(chosen[i]).all(),
                                         [&](uint32_t triangle) { return owners[triangle] != kNoOne; });
        if (refused[i]) continue;
        made.clear();
        if (star.size() == 3) {
            for (const Spoke& spoke : star) made.emplace_back(spoke.next, spoke.previous);
        } else {
            std::array<uint32_t, 2> wings{};
            for (const Spoke& spoke : star) {
                if (spoke.next == to) wings[0] = spoke.previous;
                if (spoke.previous == to) wings[1] = spoke.next;
            }
            for (const Spoke& spoke : star)
                if (spoke.next != to && spoke.next != wings[0] && spoke.next != wings[1])
                    made.emplace_back(to, spoke.next);
        }
        refused[i] = std::ranges::any_of(made, [&](const auto& e) { return edges.has(e.first, e.second); });
        if (refused[i]) continue;
        for (const auto& [a, b] : made) edges.add(a, b);
        for (const Spoke& spoke : star) owners[spoke.triangle()] = uint32_t(i);
    }
}

/// Whether the new triangles cut none as they are, nor those that collapses before this one would make.
bool Rounds::cutsNone(uint32_t number, std::vector<Made>& made) const {
    const uint32_t from = chosen[number].from, to = chosen[number].to;
    NearBox all;
    made.clear();
    forChanged(state.stars.at(from), to, [&](const Spoke& spoke) {
        made.emplace_back(state.positions, std::array{to, spoke.next, spoke.previous});
        all.add(made.back().box);
    });
    glm::dvec3 sum(0.0);
    for (const Made& one : made) sum += glm::normalize(one.normal);
    const glm::vec3 along(glm::normalize(sum));
    const auto faces = [&](const Made& one) {
        return glm::dot(glm::vec3(glm::normalize(one.normal)), along) > kFaces;
    };
    if (state.closed && std::ranges::all_of(made, faces) && near.allFace(all, along)) return true;
    bool cuts = false;
    near.at(all, [&](uint32_t t) {
        const uint32_t owner = owners[t];
        if (cuts || owner == number) return;
        std::array<uint32_t, 3> other;
        std::copy_n(&state.indices[3 * std::size_t(t)], 3, other.begin());
        const NearBox box = near.boxOf(t);
        const auto cutsIt = [&](const Made& one) {
            return one.box.meets(box) && one.mayCut(state.positions, other) &&
                   trianglesCut(state.positions, one.corners.data(), other.data());
        };
        cuts = std::ranges::any_of(made, cutsIt);
        if (cuts || owner >= number) return;
        std::ranges::replace(other, chosen[owner].from, chosen[owner].to);
        cuts = !collapsed(other.data()) && std::ranges::any_of(made, cutsIt);
    });
    return !cuts;
}

/// Of collapses from `first` to before `last` that are not refused, refuses those that lead away from the
/// surface.
void Rounds::ask(std::size_t first, std::size_t last) {
    struct Asked {
        std::size_t collapse, triangle;
    };
    std::vector<Asked> asked;
    std::vector<glm::dvec3> points;
    for (std::size_t i = first; i < last; ++i) {
        distances[i].clear();
        if (refused[i]) continue;
        const uint32_t to = chosen[i].to;
        forChanged(state.stars.at(chosen[i].from), to, [&](const Spoke& spoke) {
            const glm::dvec3 a(state.positions[to]), b(state.positions[spoke.next]),
                c(state.positions[spoke.previous]);
            const double area = 0.5 * glm::length(glm::cross(b - a, c - a));
            const int count = 1 + int(std::min(area * samplesPerArea, double(kMostSamples - 1)));
            double u = 1.0 / 3.0, v = 1.0 / 3.0;  // and then along a sequence that fills the square evenly
            for (int k = 0; k < count; ++k) {
                const bool fold = u + v > 1.0;
                points.push_back(a + (fold ? 1.0 - u : u) * (b - a) + (fold ? 1.0 - v : v) * (c - a));
                asked.push_back({i, distances[i].size()});
                u = std::fmod(u + 0.7548776662466927, 1.0);
                v = std::fmod(v + 0.5698402909980532, 1.0);
            }
            distances[i].push_back(0.0f);
        });
    }
    std::vector<double> found(points.size());
    for (std::size_t at = 0; at < points.size(); at += kAtOnce) {
        const std::size_t count = std::min(kAtOnce, points.size() - at);
        limits.fromSurface(std::span(points).subspan(at, count), std::span(found).subspan(at, count));
    }
    for (std::size_t k = 0; k < asked.size(); ++k) {
        float& most = distances[asked[k].collapse][asked[k].triangle];
        most =
            std::max(most, std::isnan(found[k]) ? std::numeric_limits<float>::infinity() : float(found[k]));
    }
    for (std::size_t i = first; i < last; ++i) {
        if (refused[i]) continue;
        float most = float(limits.distance);
        for (const Spoke& spoke : state.stars.at(chosen[i].from))
            most = std::max(most, state.faces[spoke.triangle()].distance);
        refused[i] = std::ranges::any_of(distances[i], [&](float one) { return !(one <= most); });
    }
}

void Rounds::verify() {
    near.build(state.triangles(), [&](std::size_t t) {
        const uint32_t* const corner = &state.indices[3 * t];
        NearTriangle triangle{.box = {}, .normals = coneOf(state.faces[t])};
        for (std::size_t k = 0; k < 3; ++k) triangle.box.add(state.positions[corner[k]]);
        if (owners[t] == kNoOne) return triangle;
        const Collapse& owner = chosen[owners[t]];
        triangle.box.add(state.positions[owner.to]);
        std::array<uint32_t, 3> then{corner[0], corner[1], corner[2]};
        std::ranges::replace(then, owner.from, owner.to);
        if (!collapsed(then.data()))
            triangle.normals = NormalCone::around(
                std::array{triangle.normals, coneOf(faceOf(state.positions[then[0]], state.positions[then[1]],
                                                           state.positions[then[2]]))});
        return triangle;
    });
    const std::vector<char> before = refused;
    if (limits.fromSurface) distances.resize(std::max(distances.size(), chosen.size()));
    forBlocks(chosen.size(), kCollapses, [&](std::size_t, std::size_t first, std::size_t last) {
        std::vector<Made> made;
        for (std::size_t i = first; i < last; ++i)
            if (!refused[i]) refused[i] = !cutsNone(uint32_t(i), made);
        if (limits.fromSurface) ask(first, last);
        for (std::size_t i = first; i < last; ++i)
            if (refused[i] && !before[i]) tried[chosen[i].from] = chosen[i].cost;
    });
}

/// What is not refused, as far as it is wanted; how many those are.
std::size_t Rounds::apply() {
    std::vector<uint32_t> wanted;
    for (uint32_t i = 0; i < chosen.size(); ++i)
        if (!refused[i]) wanted.push_back(i);
    if (wanted.size() > toGo()) {
        std::ranges::stable_sort(wanted, {}, [&](uint32_t i) { return chosen[i].cost; });
        for (std::size_t k = toGo(); k < wanted.size(); ++k) refused[wanted[k]] = 1;
        wanted.resize(toGo());
    }
    for (const uint32_t i : wanted) {
        const auto [from, to, cost] = chosen[i];
        state.quadrics[to].add(state.quadrics[from]);
        state.areas[to] += state.areas[from];
        state.partTriangles[state.parts[from]] -= 2;
        for (const Spoke& spoke : state.stars.at(from)) {
            state.indices[spoke.corner] = to;
            tried[spoke.next] = -1.0f;
        }
    }
    forBlocks(chosen.size(), kCollapses, [&](std::size_t, std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            if (refused[i]) continue;
            const std::span<const Spoke> star = state.stars.at(chosen[i].from);
            const glm::dvec3 apex = state.placeOf(chosen[i].to);
            std::size_t number = 0;
            if (limits.fromSurface)
                forChanged(star, chosen[i].to, [&](const Spoke& spoke) {
                    state.faces[spoke.triangle()].distance = distances[i][number++];
                });
            const auto nearest = [&](const CarriedPoints::Point& point) {
                double least = std::numeric_limits<double>::infinity();
                uint32_t triangle = kNoOne;
                forChanged(star, chosen[i].to, [&](const Spoke& spoke) {
                    const double squared =
                        nearestWeights(glm::dvec3(point.place) - state.middle, apex,
                                       state.placeOf(spoke.next), state.placeOf(spoke.previous))
                            .squared;
                    if (triangle == kNoOne || squared < least) least = squared, triangle = spoke.triangle();
                });
                return triangle;
            };
            state.carried.move(star, nearest);
        }
    });
    compact();
    return wanted.size();
}

/// Triangles with two equal corners go; the others keep their order.
void Rounds::compact() {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < state.triangles(); ++t) {
        const uint32_t* corner = &state.indices[3 * t];
        if (collapsed(corner)) continue;
        if (kept != t) {
            std::copy_n(corner, 3, &state.indices[3 * kept]);
            state.faces[kept] = state.faces[t];
            state.triangleNumbers[kept] = state.triangleNumbers[t];
            state.carried.renumber(uint32_t(t), uint32_t(kept));
        }
        ++kept;
    }
    state.indices.resize(3 * kept);
    state.faces.resize(kept);
    state.triangleNumbers.resize(kept);
    state.carried.resize(kept);
}

std::vector<uint32_t> Rounds::run() {
    if (limits.fromSurface) askSurface();
    tried.assign(state.positions.size(), -1.0f);
    const bool grows = limits.triangles > 0, bound = std::isfinite(limits.distance);
    const double any = 1e4 * state.edge * std::sqrt(double(state.triangles()));
    const double enough = std::min(limits.distance, grows ? kMost * state.size : any);
    const double start = grows ? std::min(kStart * state.edge, enough) : enough;
    distance = start;
    std::size_t before = 2 * state.triangles();  // the distance grew for the last time
    for (bool all = false; !reached();) {
        choose(all);
        std::size_t gone = 0;
        if (!chosen.empty()) {
            check();
            claim();
            verify();
            gone = apply();
            if (gone > 0) state.findAround();
        }
        const bool few = double(gone) < kFew * double(chosen.size()) || chosen.empty();
        if (few && (all || chosen.empty()) && distance < enough) {
            const bool little = double(state.triangles()) > (1.0 - kLittle) * double(before);
            if (!bound && state.features && (little || 2.0 * distance >= kRough * state.edge)) {
                state.features = false;
                distance = start;
            } else {
                distance = std::min(2.0 * distance, enough);
            }
            before = state.triangles();
            std::ranges::fill(tried, -1.0f);
            all = false;
        } else if (chosen.empty()) {
            break;
        } else {
            all = all || few;
        }
    }
    struct Left {
        uint32_t number, place;
    };
    std::vector<Left> left;
    for (std::size_t t = 0; t < state.triangles(); ++t)
        left.push_back({state.triangleNumbers[t], uint32_t(t)});
    std::ranges::sort(left, {}, &Left::number);
    std::vector<uint32_t> indices;
    indices.reserve(state.indices.size());
    for (const Left& one : left)
        for (std::size_t k = 0; k < 3; ++k)
            indices.push_back(state.vertexNumbers[state.indices[3 * std::size_t(one.place) + k]]);
    return indices;
}

}  // namespace

std::vector<uint32_t> collapse(const Mesh& mesh, const CollapseLimits& limits) {
    return Rounds(mesh, limits).run();
}

}  // namespace fw
