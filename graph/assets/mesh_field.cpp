#include "graph/assets/mesh_field.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <filesystem>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <mutex>
#include <utility>

#include "graph/assets/grid_around.h"
#include "graph/assets/image.h"
#include "graph/base/hash.h"
#include "graph/base/parallel.h"

namespace fw {

namespace {

constexpr double kThin = 2.5;  // cells: what is thinner loses parts
constexpr int kCoarse = 4;     // cells between the samples from which membranes are looked for
constexpr float kCrossing =
    1.05f;  // cells: two neighbours are no farther from what is between them, taken together
constexpr double kFlat = 0.99;    // cosine between the normals of a face and of an edge that is none
constexpr double kAside = 0.02;   // cells from a triangle, where it is asked whether it is an inner wall
constexpr float kInside = 0.55f;  // a sheet alone has winding numbers up to one half on one of its sides

void boundsOf(const TriangleMesh& mesh, glm::dvec3& lo, glm::dvec3& hi) {
    lo = glm::dvec3(std::numeric_limits<double>::infinity()), hi = -lo;
    for (const glm::vec3& p : mesh.positions)
        lo = glm::min(lo, glm::dvec3(p)), hi = glm::max(hi, glm::dvec3(p));
}

Result<VolumeGrid> gridOf(const MeshFieldRecipe& recipe) {
    glm::dvec3 lo, hi;
    boundsOf(*recipe.mesh, lo, hi);
    const VolumeGrid grid = gridAround(lo, hi, recipe.resolution, recipe.margin);
    if (!hasUsableCells(grid)) {
        const glm::dvec3 size = hi - lo;
        return Error{.message = meshName(*recipe.mesh) + " is " +
                                (!(grid.cell > 1.0) ? "a single point, or nearly: scale it"
                                 : recipe.margin > 0.5 * std::max({size.x, size.y, size.z})
                                     ? "lost in its margin: lower that"
                                     : "too large: scale it")};
    }
    if (kTexelBytes * grid.samples() > kMostVolumeBytes)
        return Error{.message = meshName(*recipe.mesh) + " would take more than " +
                                std::to_string(kMostVolumeBytes >> 20) +
                                " MiB as a field: lower the resolution"};
    return grid;
}

/// Calls work(x, y, z, index) for all samples, slice by slice on all processors.
template <class Work>
void forSamples(const VolumeGrid& grid, const Work& work) {
    forBlocks(std::size_t(grid.size.z), 1, [&](std::size_t z, std::size_t, std::size_t) {
        std::size_t index = z * std::size_t(grid.size.x) * std::size_t(grid.size.y);
        for (int y = 0; y < grid.size.y; ++y)
            for (int x = 0; x < grid.size.x; ++x) work(x, y, int(z), index++);
    });
}

std::array<std::size_t, 3> strides(const VolumeGrid& grid) {
    return {1, std::size_t(grid.size.x), std::size_t(grid.size.x) * std::size_t(grid.size.y)};
}

/// The point as a sample at `p` keeps it, off by kLeastDistance at least or not at all.
glm::vec3 keptPoint(const glm::dvec3& p, const NearestPoint& on, const glm::dvec3& normal, bool flat,
                    bool inside) {
    if (on.squared >= double(kLeastDistance) * kLeastDistance) return glm::vec3(on.point);
    if (!flat) return glm::vec3(p);
    return glm::vec3(p + normal * (inside ? double(kLeastDistance) : -double(kLeastDistance)));
}

NearestPoints unknown(const VolumeGrid& grid) {
    return {std::vector<float>(grid.samples(), kUnreached), std::vector<glm::vec3>(grid.samples()),
            std::vector<uint32_t>(grid.samples(), 0)};
}

/// Measures every sample against the triangles, with the sign of the nearest feature's normal.
NearestPoints nearestByTree(const MeshInGrid& mesh) {
    const TriangleTree tree(mesh.solid.positions, mesh.solid.indices);
    const std::vector<FeatureNormals> normals = featureNormals(mesh.solid);
    NearestPoints nearest = unknown(mesh.grid);
    forSamples(mesh.grid, [&](int x, int y, int z, std::size_t index) {
        const glm::dvec3 p(x, y, z);
        NearestPoint on;
        const uint32_t t = tree.nearest(p, x > 0 ? nearest.triangle[index - 1] : 0, on);
        const glm::dvec3 normal(normals[t][std::size_t(on.feature)]);
        const bool inside = mesh.byNormals && glm::dot(p - on.point, normal) < 0.0;
        nearest.triangle[index] = t;
        const bool flat = glm::dot(normal, glm::dvec3(normals[t][0])) > kFlat;
        nearest.point[index] = keptPoint(p, on, normal, flat, inside);
        nearest.distance[index] = float(inside ? -std::sqrt(on.squared) : std::sqrt(on.squared));
    });
    return nearest;
}

/// Whether two neighbours have unlike signs though the surface is not between them.
bool signsContradict(const VolumeGrid& grid, const NearestPoints& nearest) {
    const auto stride = strides(grid);
    std::atomic<bool> found = false;
    forSamples(grid, [&](int x, int y, int z, std::size_t index) {
        const int at[3] = {x, y, z};
        const float here = nearest.distance[index];
        for (int axis = 0; axis < 3; ++axis) {
            if (at[axis] + 1 == grid.size[axis]) continue;
            const float there = nearest.distance[index + stride[std::size_t(axis)]];
            if (std::signbit(here) != std::signbit(there) && std::abs(here) + std::abs(there) > kCrossing)
                found = true;
        }
    });
    return found;
}

/// Hands nearest points on from slice to slice along one axis, both ways.
void sweepAxis(const VolumeGrid& grid, NearestPoints& nearest, int axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const int step : {1, -1})
        for (int i = 1; i < grid.size[axis]; ++i)
            forBlocks(std::size_t(grid.size[v]), 16, [&](std::size_t, std::size_t first, std::size_t last) {
                glm::ivec3 at, before;
                at[axis] = step > 0 ? i : grid.size[axis] - 1 - i;
                before[axis] = at[axis] - step;
                for (at[v] = int(first); at[v] < int(last); ++at[v])
                    for (at[u] = 0; at[u] < grid.size[u]; ++at[u]) {
                        const std::size_t index = grid.index(at.x, at.y, at.z);
                        float& own = nearest.distance[index];
                        for (int n = 0; n < 9; ++n) {
                            before[u] = std::clamp(at[u] + n % 3 - 1, 0, grid.size[u] - 1);
                            before[v] = std::clamp(at[v] + n / 3 - 1, 0, grid.size[v] - 1);
                            const std::size_t from = grid.index(before.x, before.y, before.z);
                            if (nearest.distance[from] == kUnreached) continue;
                            const float tried = glm::length(glm::vec3(at) - nearest.point[from]);
                            if (tried >= std::abs(own)) continue;
                            own = std::copysign(tried, own == kUnreached ? nearest.distance[from] : own);
                            nearest.point[index] = nearest.point[from];
                            nearest.triangle[index] = nearest.triangle[from];
                        }
                    }
            });
}

/// The winding numbers of some samples.
class Windings {
  public:
    Windings(const MeshInGrid& mesh, const TriangleTree& tree_)
        : grid(mesh.grid), tree(tree_), values(grid.samples(), std::numeric_limits<float>::quiet_NaN()) {}

    bool known(std::size_t index) const { return !std::isnan(values[index]); }
    /// One half is the surface.
    float above(std::size_t index) const { return values[index] - 0.5f; }
    bool inside(std::size_t index) const { return above(index) > 0.0f; }
    void find(const glm::ivec3& at, std::size_t index) {
        // Never in a triangle's plane, where its solid angle jumps.
        values[index] = float(tree.windingNumber(glm::dvec3(at) + glm::dvec3(1.1e-5, 1.7e-5, 2.3e-5)));
    }
    /// Those of a list, without twins.
    void find(const std::vector<std::size_t>& list) {
        forBlocks(list.size(), 256, [&](std::size_t, std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) find(placeOf(list[i]), list[i]);
        });
    }
    /// Whether the surface passes through `point`, which is on a triangle; `off` leads away from it. An inner
    /// wall has the inside on both of its sides.
    bool passes(const glm::dvec3& point, const glm::dvec3& off) const {
        const glm::ivec3 cell = glm::clamp(glm::ivec3(glm::floor(point)), glm::ivec3(0), grid.size - 2);
        int within = 0, outside = 0;
        for (int k = 0; k < 8; ++k) {
            const std::size_t corner = grid.index(cell.x + (k & 1), cell.y + (k >> 1 & 1), cell.z + (k >> 2));
            if (known(corner)) ++(inside(corner) ? within : outside);
        }
        if (within > 0 && outside > 0) return true;
        const double length = glm::length(off);
        if (length == 0.0) return true;
        const glm::dvec3 step = off * (kAside / length);
        return (tree.windingNumber(point + step) > 0.5) != (tree.windingNumber(point - step) > 0.5);
    }
    glm::ivec3 placeOf(std::size_t index) const {
        const auto x = std::size_t(grid.size.x), y = std::size_t(grid.size.y);
        return {int(index % x), int(index / x % y), int(index / (x * y))};
    }

  private:
    const VolumeGrid& grid;
    const TriangleTree& tree;
    std::vector<float> values;
};

/// Finds the winding numbers on both sides of every membrane: from samples `kCoarse` cells apart, and from
/// the band, along the surface where the number passes one half.
void traceMembranes(const VolumeGrid& grid, Windings& windings) {
    const auto stride = strides(grid);
    std::vector<std::size_t> wanted;
    const auto coarse = [&](int at, int axis) { return at % kCoarse == 0 || at == grid.size[axis] - 1; };
    for (std::size_t i = 0; i < grid.samples(); ++i) {
        const glm::ivec3 at = windings.placeOf(i);
        if (!windings.known(i) && coarse(at.x, 0) && coarse(at.y, 1) && coarse(at.z, 2)) wanted.push_back(i);
    }
    windings.find(wanted);
    // Lines between coarse samples on unlike sides.
    std::vector<std::size_t> line;
    for (const std::size_t i : wanted) {
        const glm::ivec3 at = windings.placeOf(i);
        for (int axis = 0; axis < 3; ++axis) {
            const int next = std::min(at[axis] + kCoarse, grid.size[axis] - 1);
            const std::size_t steps = std::size_t(next - at[axis]);
            if (steps == 0 || !windings.known(i + steps * stride[std::size_t(axis)]) ||
                windings.inside(i) == windings.inside(i + steps * stride[std::size_t(axis)]))
                continue;
            for (std::size_t s = 1; s < steps; ++s)
                if (!windings.known(i + s * stride[std::size_t(axis)]))
                    line.push_back(i + s * stride[std::size_t(axis)]);
        }
    }
    const auto distinct = [](std::vector<std::size_t>& list) {
        std::ranges::sort(list);
        list.erase(std::unique(list.begin(), list.end()), list.end());
    };
    distinct(line);
    windings.find(line);
    // From each pair of neighbours on unlike sides to their neighbours, until no new pair is found.
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < grid.samples(); ++i)
        if (windings.known(i)) open.push_back(i);
    std::vector<uint8_t> spread(grid.samples(), 0);
    while (!open.empty()) {
        std::vector<std::size_t> next;
        const auto around = [&](std::size_t i) {
            if (std::exchange(spread[i], uint8_t(1))) return;
            const glm::ivec3 at = windings.placeOf(i);
            for (int axis = 0; axis < 3; ++axis) {
                const std::size_t step = stride[std::size_t(axis)];
                if (at[axis] > 0 && !windings.known(i - step)) next.push_back(i - step);
                if (at[axis] + 1 < grid.size[axis] && !windings.known(i + step)) next.push_back(i + step);
            }
        };
        for (const std::size_t i : open) {
            const glm::ivec3 at = windings.placeOf(i);
            for (int axis = 0; axis < 3; ++axis)
                for (const int way : {-1, 1}) {
                    if (at[axis] + way < 0 || at[axis] + way >= grid.size[axis]) continue;
                    const std::size_t other =
                        way < 0 ? i - stride[std::size_t(axis)] : i + stride[std::size_t(axis)];
                    if (windings.known(other) && windings.inside(i) != windings.inside(other))
                        around(i), around(other);
                }
        }
        distinct(next);
        windings.find(next);
        open = std::move(next);
    }
}

uint32_t srgbWord(const glm::dvec3& linear) {
    uint32_t word = 0;
    for (int k = 0; k < 3; ++k)
        word |= uint32_t(std::lround(255.0 * encodeSrgb(std::clamp(linear[k], 0.0, 1.0)))) << (8 * k);
    return word;
}

/// Distance, gradient and colour of each sample from the point that is nearest to it.
std::vector<uint32_t> wordsOf(const MeshFieldRecipe& recipe, const MeshInGrid& mesh,
                              const NearestPoints& nearest) {
    const TriangleMesh& source = *recipe.mesh;
    const std::size_t samples = mesh.grid.samples();
    std::vector<uint32_t> words(2 * samples + (source.colors.empty() ? 0 : samples + samples % 2));
    forSamples(mesh.grid, [&](int x, int y, int z, std::size_t index) {
        const glm::dvec3 p(x, y, z);
        const double distance = glm::length(p - glm::dvec3(nearest.point[index])) * mesh.grid.cell;
        words[2 * index] =
            std::bit_cast<uint32_t>(float(std::signbit(nearest.distance[index]) ? -distance : distance));
        words[2 * index + 1] = packGradient(awayFromSurface(mesh.grid, nearest, {x, y, z}));
        if (source.colors.empty()) return;
        const uint32_t triangle = mesh.solid.source[nearest.triangle[index]];
        std::array<glm::dvec3, 3> own, colors;
        for (std::size_t k = 0; k < 3; ++k) {
            const uint32_t vertex = source.indices[3 * std::size_t(triangle) + k];
            own[k] = (glm::dvec3(source.positions[vertex]) - mesh.grid.origin) / mesh.grid.cell;
            colors[k] = source.colors[vertex];
        }
        const glm::dvec3 weights = nearestOnTriangle(p, own).weights;
        words[2 * samples + index] =
            srgbWord(weights.x * colors[0] + weights.y * colors[1] + weights.z * colors[2]);
    });
    return words;
}

}  // namespace

std::string meshName(const TriangleMesh& mesh) {
    return "the mesh " + inQuotes(std::filesystem::path(mesh.file).filename().string());
}

uint64_t MeshFieldRecipe::key() const {
    uint64_t hash = mesh->hash;
    const auto mix = [&](uint64_t word) { hash = mixed(hash, word); };
    mix(uint64_t(resolution));
    mix(std::bit_cast<uint64_t>(margin));
    mix(uint64_t(inside));
    return hash ^ hash >> 32;
}

glm::vec3 awayFromSurface(const VolumeGrid& grid, const NearestPoints& nearest, const glm::ivec3& at,
                          float band) {
    const std::size_t index = grid.index(at.x, at.y, at.z);
    const glm::dvec3 off = glm::dvec3(at) - glm::dvec3(nearest.point[index]);
    const double distance = glm::length(off);
    if (distance <= band)
        return distance > 0.0
                   ? glm::vec3(off / (std::signbit(nearest.distance[index]) ? -distance : distance))
                   : glm::vec3(0.0f);
    // A point that was handed on is as far as the nearest, or nearly, but not in the same direction.
    glm::dvec3 away;
    for (int axis = 0; axis < 3; ++axis) {
        glm::ivec3 before = at, next = at;
        before[axis] = std::max(before[axis] - 1, 0);
        next[axis] = std::min(next[axis] + 1, grid.size[axis] - 1);
        away[axis] = double(nearest.distance[grid.index(next.x, next.y, next.z)] -
                            nearest.distance[grid.index(before.x, before.y, before.z)]) /
                     (next[axis] - before[axis]);
    }
    return glm::vec3(away / std::max(glm::length(away), 1.0));
}

void sweep(const VolumeGrid& grid, NearestPoints& nearest) {
    for (int axis = 0; axis < 3; ++axis) sweepAxis(grid, nearest, axis);
}

Result<MeshInGrid> meshInGrid(const MeshFieldRecipe& recipe) {
    const Result<VolumeGrid> grid = gridOf(recipe);
    if (!grid) return grid.error();
    MeshInGrid mesh{.grid = *grid, .solid = solidMesh(*recipe.mesh)};
    for (glm::vec3& p : mesh.solid.positions) p = glm::vec3((glm::dvec3(p) - grid->origin) / grid->cell);
    mesh.solid.volume /= grid->cell * grid->cell * grid->cell;
    if (mesh.solid.indices.empty())
        return Error{.message = meshName(*recipe.mesh) +
                                " has no triangle with three different corners: nothing of it can be seen"};
    mesh.byNormals = recipe.inside == MeshInside::automatic && mesh.solid.found.oriented();
    return mesh;
}

bool signByWinding(const MeshInGrid& mesh, NearestPoints& nearest) {
    const VolumeGrid& grid = mesh.grid;
    const TriangleTree tree(mesh.solid.positions, mesh.solid.indices);
    Windings windings(mesh, tree);
    std::atomic<bool> inside = false;
    forSamples(grid, [&](int x, int y, int z, std::size_t index) {
        if (nearest.distance[index] != kUnreached) windings.find({x, y, z}, index);
    });
    if (!mesh.solid.found.oriented()) traceMembranes(grid, windings);

    // What is at the surface: samples with a neighbour, also a diagonal one, on the other side.
    const auto stride = strides(grid);
    std::vector<uint8_t> atSurface(grid.samples(), 0);
    forSamples(grid, [&](int x, int y, int z, std::size_t index) {
        if (!windings.known(index)) return;
        if (windings.above(index) > kInside - 0.5f) inside = true;
        for (int k = std::max(z - 1, 0); k <= std::min(z + 1, grid.size.z - 1); ++k)
            for (int j = std::max(y - 1, 0); j <= std::min(y + 1, grid.size.y - 1); ++j)
                for (int i = std::max(x - 1, 0); i <= std::min(x + 1, grid.size.x - 1); ++i) {
                    const std::size_t other = grid.index(i, j, k);
                    if (windings.known(other) && windings.inside(other) != windings.inside(index))
                        atSurface[index] = 1;
                }
    });
    forSamples(grid, [&](int x, int y, int z, std::size_t index) {
        float& distance = nearest.distance[index];
        if (distance == kUnreached) return;
        const auto corners = mesh.solid.corners(nearest.triangle[index]);
        const glm::dvec3 p(x, y, z), normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
        const double size = glm::length(normal);
        const NearestPoint on = nearestOnTriangle(p, corners);
        if (!atSurface[index] && !windings.passes(on.point, p - on.point)) {
            distance = kUnreached;
            return;
        }
        nearest.point[index] =
            keptPoint(p, on, normal / std::max(size, 1e-30), on.feature == 0, windings.inside(index));
        distance = std::copysign(distance, -windings.above(index));
    });

    // Holes: neighbours on unlike sides, no triangle between them.
    for (std::size_t index = 0; index < grid.samples(); ++index) {
        if (!atSurface[index]) continue;
        const glm::ivec3 at = windings.placeOf(index);
        for (int axis = 0; axis < 3; ++axis) {
            const std::size_t other = index + stride[std::size_t(axis)];
            if (at[axis] + 1 >= grid.size[axis] || !atSurface[other] ||
                windings.inside(index) == windings.inside(other) ||
                std::abs(nearest.distance[index]) + std::abs(nearest.distance[other]) <= kCrossing)
                continue;
            const float t = windings.above(index) / (windings.above(index) - windings.above(other));
            glm::vec3 point(at);
            point[axis] += std::clamp(t, kLeastDistance, 1.0f - kLeastDistance);
            for (const std::size_t end : {index, other}) {
                const float distance = std::abs(float(windings.placeOf(end)[axis]) - point[axis]);
                if (distance >= std::abs(nearest.distance[end])) continue;
                if (nearest.distance[end] == kUnreached) nearest.triangle[end] = 0;
                nearest.distance[end] = std::copysign(distance, -windings.above(end));
                nearest.point[end] = point;
            }
        }
    }
    return inside;
}

FieldVolumePtr volumeOf(const MeshFieldRecipe& recipe, const MeshInGrid& mesh, std::vector<uint32_t> words) {
    auto volume = std::make_shared<FieldVolume>(mesh.grid, std::move(words));
    volume->mesh = recipe.mesh;
    const auto note = [&](const std::string& what) { volume->notes.push_back(what); };
    const MeshFindings& found = mesh.solid.found;
    if (recipe.inside == MeshInside::automatic) {
        const std::string text = found.text();
        if (!text.empty())
            note("has " + text + (mesh.byNormals ? "" : ": its winding number tells what is inside"));
        else if (!mesh.byNormals)
            note("has parts that overlap or faces that cross: its winding number tells what is inside");
    }
    double farthest = 0.0;
    for (const glm::vec3& p : recipe.mesh->positions)
        farthest = std::max({farthest, double(std::abs(p.x)), double(std::abs(p.y)), double(std::abs(p.z))});
    if (farthest * 0x1p-24 > 0.01 * mesh.grid.cell)
        note(
            "lies so far from the origin that its corners are only known to a part of a cell: move it there "
            "before it "
            "is exported");
    if (mesh.byNormals && recipe.inside == MeshInside::automatic) {
        // The mean thickness of a plate with this volume and area.
        double area = 0.0;
        for (std::size_t t = 0; t < mesh.solid.source.size(); ++t) {
            const auto [a, b, c] = mesh.solid.corners(t);
            area += 0.5 * glm::length(glm::cross(b - a, c - a));
        }
        if (2.0 * mesh.solid.volume < kThin * area)
            note("is thinner in places than the cells of its field: raise the resolution, now " +
                 std::to_string(recipe.resolution) + (recipe.margin > 0.0 ? ", or lower the margin" : ""));
    }
    return volume;
}

Error nothingInside(const MeshFieldRecipe& recipe) {
    return {.message = meshName(*recipe.mesh) +
                       " encloses nothing: close its holes, raise the resolution if its parts are smaller "
                       "than a cell, or "
                       "set inside to none and give the sheet a thickness with an offset node"};
}

Result<FieldVolumePtr> bakeOnHost(const MeshFieldRecipe& recipe) {
    Result<MeshInGrid> mesh = meshInGrid(recipe);
    if (!mesh) return mesh.error();
    NearestPoints nearest = nearestByTree(*mesh);
    if (mesh->byNormals && signsContradict(mesh->grid, nearest)) mesh->byNormals = false;
    if (!mesh->byNormals && recipe.inside != MeshInside::none) {
        for (float& distance : nearest.distance)
            distance = std::abs(distance) <= kBand ? std::abs(distance) : kUnreached;
        if (!signByWinding(*mesh, nearest)) return nothingInside(recipe);
        sweep(mesh->grid, nearest);
    }
    return volumeOf(recipe, *mesh, wordsOf(recipe, *mesh, nearest));
}

Result<FieldVolumePtr> boxInPlace(const MeshFieldRecipe& recipe) {
    if (const Result<VolumeGrid> whole = gridOf(recipe); !whole) return whole.error();
    MeshFieldRecipe coarse = recipe;
    coarse.resolution = kLeastFieldResolution;
    const Result<VolumeGrid> grid = gridOf(coarse);
    if (!grid) return grid.error();
    std::vector<float> distances(grid->samples());
    const std::vector<glm::vec3> gradients(grid->samples(), glm::vec3(0.0f));
    std::vector<uint32_t> colors(recipe.mesh->colors.empty() ? 0 : grid->samples());
    for (int z = 0, i = 0; z < grid->size.z; ++z)
        for (int y = 0; y < grid->size.y; ++y)
            for (int x = 0; x < grid->size.x; ++x, ++i) {
                const glm::ivec3 at(x, y, z), toEnd = grid->size - 1 - at;
                const glm::ivec3 ends = glm::min(at, toEnd);
                distances[std::size_t(i)] =
                    float(grid->cell * (kPadding - std::min({ends.x, ends.y, ends.z})));
            }
    auto volume = std::make_shared<FieldVolume>(*grid, distances, gradients, colors);
    volume->mesh = recipe.mesh;
    volume->standIn = true;
    return FieldVolumePtr(volume);
}

Result<FieldVolumePtr> draftInPlace(const MeshFieldRecipe& recipe) {
    MeshFieldRecipe coarse = recipe;
    coarse.resolution = std::min(recipe.resolution, kDraftFieldResolution);
    const Result<FieldVolumePtr> made = bakeOnHost(coarse);
    if (!made) return made.error();
    auto volume = std::make_shared<FieldVolume>((*made)->grid, (*made)->words);
    volume->mesh = recipe.mesh;
    volume->standIn = true;
    return FieldVolumePtr(volume);
}

Result<FieldVolumePtr> meshField(const MeshFieldRecipe& recipe, const MeshFieldBaker& baker) {
    static std::mutex mutex;
    static std::map<std::pair<uint64_t, std::string>, std::weak_ptr<const FieldVolume>> known;
    const std::pair key(recipe.key(), recipe.mesh->file);
    {
        const std::lock_guard lock(mutex);
        if (const auto found = known.find(key); found != known.end())
            if (FieldVolumePtr held = found->second.lock()) return held;
        std::erase_if(known, [](const auto& entry) { return entry.second.expired(); });
    }
    Result<FieldVolumePtr> volume = baker(recipe);
    if (!volume || (*volume)->standIn) return volume;
    const std::lock_guard lock(mutex);
    known[key] = *volume;
    return *volume;
}

}  // namespace fw
