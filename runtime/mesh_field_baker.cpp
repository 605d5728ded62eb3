#include "runtime/mesh_field_baker.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <mutex>
#include <optional>

#include "graph/parallel.h"
#include "runtime/clock.h"
#include "shaders/shared.h"

#include "shaders/bake/bake.h"

namespace fw {

namespace {

static_assert(float(BAKE_BAND) == kBand);

constexpr int kSweepRounds = 2;
constexpr uint32_t kGroupsAlong = 32768;  // x, of a dispatch

struct Kernels {
    Pipeline scatter, list, sign, sweep, pack, packColors;
};

Kernels createKernels(const Device& device) {
    const ShaderOptions shaders[] = {{.name = "bake/scatter.comp"}, {.name = "bake/list.comp"},
                                     {.name = "bake/sign.comp"},    {.name = "bake/sweep.comp"},
                                     {.name = "bake/pack.comp"},    {.name = "bake/pack.comp", .defines = {"COLORS"}},
                                     {.name = "bake/bounds.comp"}};
    std::vector<Pipeline> made = createComputePipelines(device, shaders);
    return {std::move(made[0]), std::move(made[1]), std::move(made[2]), std::move(made[3]),
            std::move(made[4]), std::move(made[5])};
}

glm::uvec3 groupsOf(std::size_t items) {
    const auto groups = uint32_t((items + BAKE_GROUP - 1) / BAKE_GROUP);
    return {std::min(groups, kGroupsAlong), (groups + kGroupsAlong - 1) / kGroupsAlong, 1};
}

/// The rows that each triangle is measured in.
std::vector<gpu::BakeItem> itemsOf(const MeshInGrid& mesh) {
    std::vector<gpu::BakeItem> items;
    items.reserve(2 * mesh.elements.size());
    for (uint32_t t = 0; t < mesh.elements.size(); ++t) {
        const auto& [a, b, c] = mesh.elements[t];
        const glm::ivec3 lo = glm::max(glm::ivec3(glm::ceil(glm::min(a, glm::min(b, c)) - kBand)), glm::ivec3(0));
        const glm::ivec3 hi =
            glm::min(glm::ivec3(glm::floor(glm::max(a, glm::max(b, c)) + kBand)), mesh.grid.size - 1);
        for (int z = lo.z; z <= hi.z; z += BAKE_ROWS)
            for (int y = lo.y; y <= hi.y; y += BAKE_ROWS)
                items.push_back({t, uint32_t(y) | uint32_t(z) << 16});
    }
    return items;
}

std::vector<glm::vec4> cornerTexels(const std::vector<std::array<glm::vec3, 3>>& elements) {
    std::vector<glm::vec4> texels;
    texels.reserve(3 * elements.size());
    for (const auto& element : elements)
        for (const glm::vec3& corner : element) texels.emplace_back(corner, 0.0f);
    return texels;
}

/// Linear light at the corners of each triangle, in the order of the elements' corners.
std::vector<glm::vec4> colorTexels(const TriangleMesh& source, const SolidMesh& solid, const VolumeGrid& grid) {
    std::vector<glm::vec4> texels;
    texels.reserve(solid.indices.size());
    for (std::size_t t = 0; t < solid.source.size(); ++t) {
        const uint32_t* own = &source.indices[3 * std::size_t(solid.source[t])];
        for (std::size_t k = 0; k < 3; ++k) {
            // The corner may have been turned or rotated since.
            const glm::vec3& corner = solid.positions[solid.indices[3 * t + k]];
            const uint32_t* nearest = std::min_element(own, own + 3, [&](uint32_t a, uint32_t b) {
                const auto far = [&](uint32_t vertex) {
                    const glm::vec3 off =
                        glm::vec3((glm::dvec3(source.positions[vertex]) - grid.origin) / grid.cell) - corner;
                    return std::abs(off.x) + std::abs(off.y) + std::abs(off.z);
                };
                return far(a) < far(b);
            });
            texels.emplace_back(source.colors[*nearest], 0.0f);
        }
    }
    return texels;
}

/// One field being made.
class Bake {
  public:
    Bake(const Device& device_, const Kernels& kernels_, const BakeOptions& options_, const MeshFieldRecipe& recipe_,
         MeshInGrid& mesh_)
        : device(device_), kernels(kernels_), options(options_), recipe(recipe_), mesh(mesh_) {
        const std::size_t samples = mesh.grid.samples();
        nearest = createBuffer(device, 8 * samples);
        state = createBuffer(device, 16 * samples);
        band = createBuffer(device, 4 * samples);
        counts = createBuffer(device, sizeof(gpu::BakeCounts), Memory::readback);
        words = createBuffer(device, 8 * samples, Memory::readback);
    }

    Result<FieldVolumePtr> run() {
        const bool signs = recipe.inside != MeshInside::none;
        measureBand();
        progress(0.3);
        if (signs && !mesh.byNormals && !wind()) return nothingInside(recipe);
        fillRest();
        if (mesh.byNormals && counts.as<gpu::BakeCounts>()[0].contradictions != 0) {
            mesh.byNormals = false;
            if (!wind()) return nothingInside(recipe);
            fillRest();
        }
        const auto start = Clock::now();
        Result<FieldVolumePtr> volume = finish();
        stage("finish", start);
        progress(1.0);
        return volume;
    }

  private:
    gpu::BakePush push() const {
        gpu::BakePush all{};
        all.size = mesh.grid.size;
        all.cell = float(mesh.grid.cell);
        all.signs = mesh.byNormals;
        all.triangles = uint32_t(mesh.solid.source.size());
        return all;
    }
    void progress(double share) const {
        if (options.progress) options.progress(share);
    }
    void stage(const char* name, Clock::time_point start) const {
        if (options.stages) options.stages->push_back({name, millisecondsSince(start)});
    }
    void finishStages(const Commands& commands) const {
        if (options.stages)
            options.stages->insert(options.stages->end(), commands.stages.begin(), commands.stages.end());
    }

    void uploadElements() {
        const std::vector<glm::vec4> texels = cornerTexels(mesh.elements);
        reserve(device, corners, texels.size() * sizeof texels[0]);
        upload(device, corners, texels);
    }

    void measureBand() {
        auto start = Clock::now();
        const std::vector<gpu::BakeItem> list = itemsOf(mesh);
        items = createBuffer(device, list.size() * sizeof list[0]);
        upload(device, items, list);
        uploadElements();
        std::vector<FeatureNormals> of;
        if (mesh.byNormals) of = featureNormals(mesh.solid);
        of.resize(mesh.solid.source.size());
        normals = createBuffer(device, of.size() * sizeof of[0]);
        upload(device, normals, of);
        stage("prepare", start);

        Commands commands(device, options.timed);
        gpu::BakePush all = push();
        all.items = uint32_t(list.size());
        const Descriptor bound[] = {{0, corners}, {1, items}, {2, nearest}, {3, nearest},
                                    {4, state},   {5, band},  {6, counts},  {7, normals}};
        beginStage(commands, "scatter");
        fill(commands, nearest, ~0u);
        fill(commands, counts, 0);
        barrier(commands);
        dispatch(commands, kernels.scatter, groupsOf(list.size()), all, bound);
        barrier(commands);
        beginStage(commands, "list");
        dispatch(commands, kernels.list, groupsOf(mesh.grid.samples()), all, bound);
        barrier(commands);
        flush(commands);
        const uint32_t listed = counts.as<gpu::BakeCounts>()[0].listed;
        beginStage(commands, "sign");
        dispatch(commands, kernels.sign, groupsOf(listed), all, bound);
        submit(commands);
        finishStages(commands);
    }

    /// Lets winding numbers decide what is inside.
    bool wind() {
        const auto start = Clock::now();
        NearestElements found;
        found.distance.resize(mesh.grid.samples());
        found.element.resize(mesh.grid.samples());
        const std::vector<glm::uvec2> pairs = download<glm::uvec2>(device, nearest, mesh.grid.samples());
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            const bool known = pairs[i].y != ~0u;
            found.distance[i] = known ? std::sqrt(std::bit_cast<float>(pairs[i].y)) : kUnreached;
            found.element[i] = known ? pairs[i].x : 0;
        }
        if (!signByWinding(mesh, found)) return false;
        std::vector<glm::uvec4> texels(pairs.size());
        forBlocks(std::size_t(mesh.grid.size.z), 1, [&](std::size_t z, std::size_t, std::size_t) {
            std::size_t i = mesh.grid.index(0, 0, int(z));
            for (int y = 0; y < mesh.grid.size.y; ++y)
                for (int x = 0; x < mesh.grid.size.x; ++x, ++i) {
                    texels[i] = {std::bit_cast<uint32_t>(float(BAKE_UNREACHED)), 0, 0, 0};
                    if (std::abs(found.distance[i]) >= kUnreached) continue;
                    const auto& [a, b, c] = mesh.elements[found.element[i]];
                    const glm::vec3 point(
                        nearestOnTriangle({x, y, double(z)}, {glm::dvec3(a), glm::dvec3(b), glm::dvec3(c)}).point);
                    for (int axis = 0; axis < 3; ++axis) texels[i][axis] = std::bit_cast<uint32_t>(point[axis]);
                    texels[i].w = found.element[i] | (std::signbit(found.distance[i]) ? BAKE_INSIDE : 0u);
                }
        });
        upload(device, state, texels);
        stage("winding", start);
        progress(0.6);
        return true;
    }

    /// Sweeps, and makes words of what was found.
    void fillRest() {
        const bool colored = !recipe.mesh->colors.empty();
        if (colored && !colors) {
            const std::vector<glm::vec4> texels = colorTexels(*recipe.mesh, mesh.solid, mesh.grid);
            colors = createBuffer(device, texels.size() * sizeof texels[0]);
            upload(device, colors, texels);
            colorWords = createBuffer(device, 4 * mesh.grid.samples(), Memory::readback);
        }
        Commands commands(device, options.timed);
        gpu::BakePush all = push();
        std::vector<Descriptor> bound = {{0, corners}, {4, state}, {6, counts}, {8, words}};
        if (colored) bound.push_back({10, colors}), bound.push_back({11, colorWords});
        beginStage(commands, "sweep");
        for (int round = 0; round < kSweepRounds; ++round)
            for (all.axis = 0; all.axis < 3; ++all.axis) {
                const glm::ivec3& size = mesh.grid.size;
                const auto rows = std::size_t(size[(all.axis + 1) % 3]) * std::size_t(size[(all.axis + 2) % 3]);
                dispatch(commands, kernels.sweep, groupsOf(rows), all, bound);
                barrier(commands);
            }
        beginStage(commands, "pack");
        fill(commands, counts, 0);
        barrier(commands);
        dispatch(commands, colored ? kernels.packColors : kernels.pack, groupsOf(mesh.grid.samples()), all, bound);
        submit(commands);
        finishStages(commands);
        progress(0.9);
    }

    FieldVolumePtr finish() {
        const std::size_t samples = mesh.grid.samples();
        std::vector<uint32_t> all(2 * samples + (colorWords ? samples + samples % 2 : 0));
        downloadBytes(device, words, all.data(), 8 * samples);
        if (colorWords) downloadBytes(device, colorWords, all.data() + 2 * samples, 4 * samples);
        return volumeOf(recipe, mesh, std::move(all));
    }

    const Device& device;
    const Kernels& kernels;
    const BakeOptions& options;
    const MeshFieldRecipe& recipe;
    MeshInGrid& mesh;
    Buffer corners, items, normals;
    Buffer nearest;       // of each sample: the triangle, and the bits of the squared distance; all ones: none
    Buffer state;         // the nearest point, its element and the side
    Buffer band;          // samples of it
    Buffer counts, words;
    Buffer colors, colorWords;
};

bool fits(const Device& device, const MeshInGrid& mesh) {
    const VkPhysicalDeviceLimits& limits = device.properties.limits;
    return device.int64Atomics && 8 * mesh.grid.samples() <= limits.maxStorageBufferRange &&
           mesh.grid.samples() <= limits.maxTexelBufferElements &&
           3 * mesh.elements.size() <= limits.maxTexelBufferElements &&
           sizeof(FeatureNormals) * mesh.elements.size() <= limits.maxStorageBufferRange;
}

}  // namespace

MeshFieldBaker deviceBaker(const Device& device, const BakeOptions& options) {
    struct Made {
        std::once_flag once;
        std::optional<Kernels> kernels;
    };
    return [&device, options, made = std::make_shared<Made>()](const MeshFieldRecipe& recipe) -> Result<FieldVolumePtr> {
        const auto start = Clock::now();
        Result<MeshInGrid> mesh = meshInGrid(recipe);
        if (!mesh) return mesh.error();
        if (options.stages) options.stages->push_back({"topology", millisecondsSince(start)});
        if (!fits(device, *mesh)) return bakeOnHost(recipe);
        std::call_once(made->once, [&] { made->kernels = createKernels(device); });
        return Bake(device, *made->kernels, options, recipe, *mesh).run();
    };
}

}  // namespace fw
