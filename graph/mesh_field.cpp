#include "graph/mesh_field.h"

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

#include "graph/image.h"
#include "graph/parallel.h"

namespace fw {

namespace {

constexpr int kPadding = 2;      // cells between the mesh's box and the grid's end
constexpr int kCoarse = 4;       // cells between the samples from which membranes are looked for
constexpr int kSweepRounds = 2;  // each of three axes, both ways

std::string nameOf(const TriangleMesh& mesh) {
    return inQuotes(std::filesystem::path(mesh.file).filename().string());
}

void boundsOf(const TriangleMesh& mesh, glm::dvec3& lo, glm::dvec3& hi) {
    lo = glm::dvec3(std::numeric_limits<double>::infinity()), hi = -lo;
    for (const glm::vec3& p : mesh.positions) lo = glm::min(lo, glm::dvec3(p)), hi = glm::max(hi, glm::dvec3(p));
}

Result<VolumeGrid> gridOf(const MeshFieldRecipe& recipe) {
    glm::dvec3 lo, hi;
    boundsOf(*recipe.mesh, lo, hi);
    const glm::dvec3 size = hi - lo + 2.0 * recipe.margin;
    const double longest = std::max({size.x, size.y, size.z});
    VolumeGrid grid;
    grid.cell = longest / (recipe.resolution - 1 - 2 * kPadding);
    // Below, squares of lengths leave the range of single precision.
    if (!(grid.cell >= 1e-15) || !(grid.cell <= 1e14))
        return Error{.message = "the mesh " + nameOf(*recipe.mesh) + " is " +
                                (grid.cell < 1.0 ? "a single point, or nearly" : "too large") + ": scale it"};
    for (int axis = 0; axis < 3; ++axis) {
        const int cells = std::max(1, int(std::ceil(size[axis] / grid.cell - 1e-9))) + 2 * kPadding;
        grid.size[axis] = std::min(cells + 1, recipe.resolution);
        grid.origin[axis] = 0.5 * (lo[axis] + hi[axis]) - 0.5 * grid.cell * (grid.size[axis] - 1);
    }
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

std::array<glm::dvec3, 3> cornersOf(const MeshInGrid& mesh, uint32_t element) {
    const auto& [a, b, c] = mesh.elements[element];
    return {glm::dvec3(a), glm::dvec3(b), glm::dvec3(c)};
}

/// Measures every sample against the triangles, with the sign of the nearest feature's normal.
NearestElements nearestByTree(const MeshInGrid& mesh, bool bandOnly) {
    const TriangleTree tree(mesh.solid.positions, mesh.solid.indices);
    std::vector<FeatureNormals> normals;
    if (mesh.byNormals) normals = featureNormals(mesh.solid);
    NearestElements nearest;
    nearest.distance.assign(mesh.grid.samples(), kUnreached);
    nearest.element.assign(mesh.grid.samples(), 0);
    forSamples(mesh.grid, [&](int x, int y, int z, std::size_t index) {
        const glm::dvec3 p(x, y, z);
        NearestPoint on;
        const uint32_t t = tree.nearest(p, x > 0 ? nearest.element[index - 1] : 0, on);
        const double distance = std::sqrt(on.squared);
        nearest.element[index] = t;
        if (bandOnly && distance > kBand) return;
        const bool inside =
            mesh.byNormals && glm::dot(p - on.point, glm::dvec3(normals[t][std::size_t(on.feature)])) < 0.0;
        nearest.distance[index] = float(inside ? -distance : distance);
    });
    return nearest;
}

/// Hands nearest elements on along one axis, both ways.
void sweepAxis(const MeshInGrid& mesh, NearestElements& nearest, int axis) {
    const VolumeGrid& grid = mesh.grid;
    const auto stride = strides(grid);
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    forBlocks(std::size_t(grid.size[v]), 1, [&](std::size_t at, std::size_t, std::size_t) {
        for (int b = 0; b < grid.size[u]; ++b)
            for (const bool forward : {true, false}) {
                uint32_t held = 0;
                float heldDistance = kUnreached;
                for (int i = 0; i < grid.size[axis]; ++i) {
                    glm::ivec3 place;
                    place[axis] = forward ? i : grid.size[axis] - 1 - i;
                    place[u] = b, place[v] = int(at);
                    const std::size_t index = std::size_t(place.x) * stride[0] + std::size_t(place.y) * stride[1] +
                                              std::size_t(place.z) * stride[2];
                    float& own = nearest.distance[index];
                    if (heldDistance != kUnreached && (own == kUnreached || nearest.element[index] != held)) {
                        const auto tried = float(
                            std::sqrt(nearestOnTriangle(glm::dvec3(place), cornersOf(mesh, held)).squared));
                        if (tried < std::abs(own)) {
                            own = std::copysign(tried, own == kUnreached ? heldDistance : own);
                            nearest.element[index] = held;
                        }
                    }
                    held = nearest.element[index], heldDistance = own;
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
        values[index] = float(tree.windingNumber(glm::dvec3(at)));
    }
    /// Those of a list, without twins.
    void find(const std::vector<std::size_t>& list) {
        forBlocks(list.size(), 256, [&](std::size_t, std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) find(placeOf(list[i]), list[i]);
        });
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

/// Finds the winding numbers on both sides of every membrane: from samples `kCoarse` cells apart, and from the band,
/// along the surface where the number passes one half.
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
                    const std::size_t other = way < 0 ? i - stride[std::size_t(axis)] : i + stride[std::size_t(axis)];
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

/// Distance, gradient and colour of each sample from the element that is nearest to it.
std::vector<uint32_t> wordsOf(const MeshFieldRecipe& recipe, const MeshInGrid& mesh,
                              const NearestElements& nearest) {
    const TriangleMesh& source = *recipe.mesh;
    const std::size_t samples = mesh.grid.samples();
    std::vector<uint32_t> words(2 * samples + (source.colors.empty() ? 0 : samples + samples % 2));
    forSamples(mesh.grid, [&](int x, int y, int z, std::size_t index) {
        const glm::dvec3 p(x, y, z);
        const uint32_t element = nearest.element[index];
        const auto corners = cornersOf(mesh, element);
        const NearestPoint on = nearestOnTriangle(p, corners);
        const double distance = std::sqrt(on.squared);
        glm::dvec3 away = p - on.point;
        if (distance > 1e-6)
            away /= std::signbit(nearest.distance[index]) ? -distance : distance;
        else
            away = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
        const double length = glm::length(away);
        const double value = std::signbit(nearest.distance[index]) ? -distance : distance;
        words[2 * index] = std::bit_cast<uint32_t>(float(value * mesh.grid.cell));
        words[2 * index + 1] = packGradient(length > 0.0 ? glm::vec3(away / length) : glm::vec3(0.0f));
        if (source.colors.empty()) return;
        const uint32_t triangle = element < mesh.solid.source.size() ? mesh.solid.source[element] : 0;
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

uint64_t MeshFieldRecipe::key() const {
    uint64_t hash = mesh->hash;
    const auto mix = [&](uint64_t word) { hash = std::rotl((hash ^ word) * 0x9e3779b97f4a7c15u, 29); };
    mix(uint64_t(resolution));
    mix(std::bit_cast<uint64_t>(margin));
    mix(uint64_t(inside));
    return hash ^ hash >> 32;
}

Result<MeshInGrid> meshInGrid(const MeshFieldRecipe& recipe) {
    const Result<VolumeGrid> grid = gridOf(recipe);
    if (!grid) return grid.error();
    MeshInGrid mesh{.grid = *grid, .solid = solidMesh(*recipe.mesh), .elements = {}, .byNormals = true};
    for (glm::vec3& p : mesh.solid.positions) p = glm::vec3((glm::dvec3(p) - grid->origin) / grid->cell);
    mesh.solid.volume /= grid->cell * grid->cell * grid->cell;
    const std::vector<uint32_t>& indices = mesh.solid.indices;
    if (indices.empty())
        return Error{.message = "the mesh " + nameOf(*recipe.mesh) +
                                " has no triangle with three different corners: nothing of it can be seen"};
    for (std::size_t i = 0; i < indices.size(); i += 3)
        mesh.elements.push_back({mesh.solid.positions[indices[i]], mesh.solid.positions[indices[i + 1]],
                                 mesh.solid.positions[indices[i + 2]]});
    mesh.byNormals = recipe.inside == MeshInside::automatic && mesh.solid.found.oriented();
    return mesh;
}

bool signsContradict(const VolumeGrid& grid, const NearestElements& nearest) {
    const auto stride = strides(grid);
    std::atomic<bool> found = false;
    forSamples(grid, [&](int x, int y, int z, std::size_t index) {
        const int at[3] = {x, y, z};
        const float here = nearest.distance[index];
        for (int axis = 0; axis < 3; ++axis) {
            if (at[axis] + 1 == grid.size[axis]) continue;
            const float there = nearest.distance[index + stride[std::size_t(axis)]];
            if (std::signbit(here) != std::signbit(there) && std::abs(here) + std::abs(there) > 1.05f) found = true;
        }
    });
    return found;
}

bool signByWinding(MeshInGrid& mesh, NearestElements& nearest) {
    const VolumeGrid& grid = mesh.grid;
    const TriangleTree tree(mesh.solid.positions, mesh.solid.indices);
    Windings windings(mesh, tree);
    std::atomic<bool> inside = false;
    forSamples(grid, [&](int x, int y, int z, std::size_t index) {
        if (nearest.distance[index] != kUnreached) windings.find({x, y, z}, index);
    });
    if (!mesh.solid.found.oriented()) traceMembranes(grid, windings);

    // What is at the surface: samples with a neighbour, also a diagonal one, on the other side.
    std::vector<uint8_t> atSurface(grid.samples(), 0);
    forSamples(grid, [&](int x, int y, int z, std::size_t index) {
        if (!windings.known(index)) return;
        if (windings.inside(index)) inside = true;
        for (int k = std::max(z - 1, 0); k <= std::min(z + 1, grid.size.z - 1); ++k)
            for (int j = std::max(y - 1, 0); j <= std::min(y + 1, grid.size.y - 1); ++j)
                for (int i = std::max(x - 1, 0); i <= std::min(x + 1, grid.size.x - 1); ++i) {
                    const std::size_t other = index + std::size_t(i - x) +
                                              std::size_t(j - y) * std::size_t(grid.size.x) +
                                              std::size_t(k - z) * std::size_t(grid.size.x) * std::size_t(grid.size.y);
                    if (windings.known(other) && windings.inside(other) != windings.inside(index))
                        atSurface[index] = 1;
                }
    });
    forSamples(grid, [&](int, int, int, std::size_t index) {
        float& distance = nearest.distance[index];
        if (!atSurface[index] && distance != kUnreached) distance = kUnreached;
        if (atSurface[index]) distance = std::copysign(distance, -windings.above(index));
    });

    // Holes: neighbours on unlike sides, no triangle between them.
    const auto stride = strides(grid);
    for (std::size_t index = 0; index < grid.samples(); ++index) {
        if (!atSurface[index]) continue;
        const glm::ivec3 at = windings.placeOf(index);
        for (int axis = 0; axis < 3; ++axis) {
            const std::size_t other = index + stride[std::size_t(axis)];
            if (at[axis] + 1 >= grid.size[axis] || !atSurface[other]) continue;
            float &here = nearest.distance[index], &there = nearest.distance[other];
            if (std::signbit(here) == std::signbit(there) || std::abs(here) + std::abs(there) <= 1.05f) continue;
            const float t =
                std::clamp(windings.above(index) / (windings.above(index) - windings.above(other)), 0.0f, 1.0f);
            glm::vec3 point(at);
            point[axis] += t;
            const auto element = uint32_t(mesh.elements.size());
            mesh.elements.push_back({point, point, point});
            if (t < std::abs(here)) here = std::copysign(t, here), nearest.element[index] = element;
            if (1.0f - t < std::abs(there)) there = std::copysign(1.0f - t, there), nearest.element[other] = element;
        }
    }
    return inside;
}

FieldVolumePtr volumeOf(const MeshFieldRecipe& recipe, const MeshInGrid& mesh, std::vector<uint32_t> words) {
    auto volume = std::make_shared<FieldVolume>(mesh.grid, std::move(words));
    volume->mesh = recipe.mesh;
    const auto note = [&](const std::string& what) {
        volume->notes.push_back("the mesh " + nameOf(*recipe.mesh) + " " + what);
    };
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
        note("lies so far from the origin that its corners are only known to a part of a cell: move it there before it "
             "is exported");
    if (mesh.byNormals && recipe.inside == MeshInside::automatic) {
        double filled = 0.0;
        for (std::size_t i = 0; i < mesh.grid.samples(); ++i)
            filled += std::clamp(0.5 - double(std::bit_cast<float>(volume->words[2 * i])) / mesh.grid.cell, 0.0, 1.0);
        if (std::abs(filled - mesh.solid.volume) > 0.02 * mesh.solid.volume)
            note("is thinner in places than the cells of its field: raise the resolution, now " +
                 std::to_string(recipe.resolution));
    }
    return volume;
}

Error nothingInside(const MeshFieldRecipe& recipe) {
    return {.message = "the mesh " + nameOf(*recipe.mesh) +
                       " encloses nothing: close its holes, or set inside to none and give the sheet a thickness with "
                       "an offset node"};
}

Result<FieldVolumePtr> bakeOnHost(const MeshFieldRecipe& recipe) {
    Result<MeshInGrid> mesh = meshInGrid(recipe);
    if (!mesh) return mesh.error();
    const bool signs = recipe.inside != MeshInside::none;
    NearestElements nearest = nearestByTree(*mesh, signs && !mesh->byNormals);
    if (mesh->byNormals && signsContradict(mesh->grid, nearest)) {
        mesh->byNormals = false;
        for (float& distance : nearest.distance)
            distance = std::abs(distance) <= kBand ? std::abs(distance) : kUnreached;
    }
    if (signs && !mesh->byNormals) {
        if (!signByWinding(*mesh, nearest)) return nothingInside(recipe);
        for (int round = 0; round < kSweepRounds; ++round)
            for (int axis = 0; axis < 3; ++axis) sweepAxis(*mesh, nearest, axis);
    }
    return volumeOf(recipe, *mesh, wordsOf(recipe, *mesh, nearest));
}

Result<FieldVolumePtr> boxInPlace(const MeshFieldRecipe& recipe) {
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
    if (!volume) return volume.error();
    const std::lock_guard lock(mutex);
    known[key] = *volume;
    return *volume;
}

}  // namespace fw
