#include "runtime/bake/mesh_field_baker.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <glm/common.hpp>
#include <optional>

#include "graph/base/algorithm_version.h"
#include "runtime/bake/sweep.h"
#include "runtime/system/cache_file.h"
#include "runtime/system/clock.h"
#include "shaders/shared.h"

#include "shaders/bake/bake.h"

namespace fw {

namespace {

static_assert(float(BAKE_BAND) == kBand && float(BAKE_LEAST) == kLeastDistance);

struct Kernels {
    Pipeline scatter, list, sign, sweep, pack, packColors;
};

Kernels createKernels(const Device& device) {
    const ShaderOptions shaders[] = {{.name = "bake/scatter.comp"},
                                     {.name = "bake/list.comp"},
                                     {.name = "bake/sign.comp"},
                                     {.name = "bake/pack.comp"},
                                     {.name = "bake/pack.comp", .defines = {"COLORS"}}};
    std::vector<Pipeline> made = createComputePipelines(device, shaders);
    return {std::move(made[0]),  std::move(made[1]), std::move(made[2]),
            createSweep(device), std::move(made[3]), std::move(made[4])};
}

/// The rows that each triangle is measured in.
std::vector<gpu::BakeItem> itemsOf(const MeshInGrid& mesh) {
    std::vector<gpu::BakeItem> items;
    items.reserve(2 * mesh.solid.source.size());
    for (uint32_t t = 0; t < mesh.solid.source.size(); ++t) {
        const auto [a, b, c] = mesh.solid.corners(t);
        const glm::ivec3 lo =
            glm::max(glm::ivec3(glm::ceil(glm::min(a, glm::min(b, c)) - double(kBand))), glm::ivec3(0));
        const glm::ivec3 hi =
            glm::min(glm::ivec3(glm::floor(glm::max(a, glm::max(b, c)) + double(kBand))), mesh.grid.size - 1);
        for (int z = lo.z; z <= hi.z; z += BAKE_ROWS)
            for (int y = lo.y; y <= hi.y; y += BAKE_ROWS)
                items.push_back({t, uint32_t(y) | uint32_t(z) << 16});
    }
    return items;
}

std::vector<glm::vec4> cornerTexels(const SolidMesh& solid) {
    std::vector<glm::vec4> texels;
    texels.reserve(solid.indices.size());
    for (const uint32_t index : solid.indices) texels.emplace_back(solid.positions[index], 0.0f);
    return texels;
}

/// Linear light at the corners of each triangle, in the order of its corners.
std::vector<glm::vec4> colorTexels(const TriangleMesh& source, const SolidMesh& solid,
                                   const VolumeGrid& grid) {
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
    Bake(const Device& device_, const Kernels& kernels_, const BakeOptions& options_,
         const MeshFieldRecipe& recipe_, MeshInGrid& mesh_)
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

    void measureBand() {
        auto start = Clock::now();
        const std::vector<gpu::BakeItem> list = itemsOf(mesh);
        items = createBuffer(device, list.size() * sizeof list[0]);
        upload(device, items, list);
        const std::vector<glm::vec4> texels = cornerTexels(mesh.solid);
        corners = createBuffer(device, texels.size() * sizeof texels[0]);
        upload(device, corners, texels);
        std::vector<FeatureNormals> of;
        if (mesh.byNormals) of = featureNormals(mesh.solid);
        of.resize(mesh.solid.source.size());
        normals = createBuffer(device, of.size() * sizeof of[0]);
        upload(device, normals, of);
        stage("prepare", start);

        Commands commands(device, options.timed);
        commands.parted = !options.timed;
        gpu::BakePush all = push();
        all.items = uint32_t(list.size());
        const Descriptor bound[] = {{0, corners}, {1, items}, {2, nearest}, {3, nearest},
                                    {4, state},   {5, band},  {6, counts},  {7, normals}};
        beginStage(commands, "scatter");
        fill(commands, nearest, ~0u);
        fill(commands, counts, 0);
        barrier(commands);
        dispatchGroups(commands, kernels.scatter, groupsFor(list.size(), BAKE_GROUP), all, bound);
        barrier(commands);
        beginStage(commands, "list");
        dispatchGroups(commands, kernels.list, groupsFor(mesh.grid.samples(), BAKE_GROUP), all, bound);
        barrier(commands);
        flush(commands);
        const uint32_t listed = counts.as<gpu::BakeCounts>()[0].listed;
        beginStage(commands, "sign");
        dispatchGroups(commands, kernels.sign, groupsFor(listed, BAKE_GROUP), all, bound);
        submit(commands);
        finishStages(commands);
    }

    /// Lets winding numbers decide what is inside.
    bool wind() {
        const auto start = Clock::now();
        const std::size_t samples = mesh.grid.samples();
        const std::vector<glm::uvec2> pairs = download<glm::uvec2>(device, nearest, samples);
        NearestPoints found{std::vector<float>(samples, kUnreached), std::vector<glm::vec3>(samples),
                            std::vector<uint32_t>(samples)};
        for (std::size_t i = 0; i < samples; ++i)
            if (pairs[i].y != ~0u)
                found.distance[i] = std::sqrt(std::bit_cast<float>(pairs[i].y)),
                found.triangle[i] = pairs[i].x;
        if (!signByWinding(mesh, found)) return false;
        std::vector<glm::uvec4> texels(samples, {std::bit_cast<uint32_t>(float(BAKE_UNREACHED)), 0, 0, 0});
        for (std::size_t i = 0; i < samples; ++i) {
            if (found.distance[i] == kUnreached) continue;
            for (int axis = 0; axis < 3; ++axis)
                texels[i][axis] = std::bit_cast<uint32_t>(found.point[i][axis]);
            texels[i].w = found.triangle[i] | (std::signbit(found.distance[i]) ? BAKE_INSIDE : 0u);
        }
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
        commands.parted = !options.timed;
        gpu::BakePush all = push();
        std::vector<Descriptor> bound = {{0, corners}, {4, state}, {6, counts}, {8, words}};
        if (colored) bound.push_back({10, colors}), bound.push_back({11, colorWords});
        beginStage(commands, "sweep");
        recordSweeps(commands, kernels.sweep, state, mesh.grid.size);
        beginStage(commands, "pack");
        fill(commands, counts, 0);
        barrier(commands);
        dispatchGroups(commands, colored ? kernels.packColors : kernels.pack,
                       groupsFor(mesh.grid.samples(), BAKE_GROUP), all, bound);
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
    Buffer nearest;  // of each sample: the triangle, and the bits of the squared distance; all ones: none
    Buffer state;    // the nearest point, its triangle and the side
    Buffer band;     // samples of it
    Buffer counts, words;
    Buffer colors, colorWords;
};

bool fits(const Device& device, const MeshInGrid& mesh) {
    const DeviceLimits& limits = device.limits;
    return device.has.int64Atomics && 8 * mesh.grid.samples() <= limits.storageRange &&
           mesh.grid.samples() <= limits.texels() && mesh.solid.indices.size() <= limits.texels() &&
           sizeof(FeatureNormals) * mesh.solid.source.size() <= limits.storageRange;
}

// ---- What was made before

constexpr uint32_t kVersion = 6;  // of the file's words

std::string pathOf(const MeshFieldRecipe& recipe) {
    char name[24];
    std::snprintf(name, sizeof name, "%016llx", static_cast<unsigned long long>(recipe.key()));
    return cachePath("fields", name);
}

template <class T>
void put(std::vector<uint32_t>& to, const T& value) {
    static_assert(sizeof value % 4 == 0);
    const auto words = std::bit_cast<std::array<uint32_t, sizeof value / 4>>(value);
    to.insert(to.end(), words.begin(), words.end());
}

void put(std::vector<uint32_t>& to, const std::string& text) {
    put(to, uint32_t(text.size()));
    const std::size_t at = to.size();
    to.resize(at + (text.size() + 3) / 4);
    std::memcpy(&to[at], text.data(), text.size());
}

/// Reads what put() wrote; the file's checksum was right.
class Taken {
  public:
    explicit Taken(std::span<const uint32_t> words_) : words(words_) {}
    template <class T>
    T take() {
        std::array<uint32_t, sizeof(T) / 4> own;
        std::copy_n(words.begin(), own.size(), own.begin());
        words = words.subspan(own.size());
        return std::bit_cast<T>(own);
    }
    std::string text() {
        const auto size = take<uint32_t>();
        std::string text(reinterpret_cast<const char*>(words.data()), size);
        words = words.subspan((size + 3) / 4);
        return text;
    }
    std::span<const uint32_t> words;
};

FieldVolumePtr readMade(const MeshFieldRecipe& recipe) {
    const std::string path = pathOf(recipe);
    const std::vector<uint32_t> words = readCacheFile(path, recipe.key() + kVersion);
    if (words.empty()) return nullptr;
    std::error_code ignored;
    std::filesystem::last_write_time(path, std::filesystem::file_time_type::clock::now(), ignored);
    Taken file(words);
    if (file.take<uint32_t>() != kAlgorithmVersion) return nullptr;
    VolumeGrid grid;
    for (glm::dvec3* of : {&grid.origin, &grid.inset})
        for (int axis = 0; axis < 3; ++axis) (*of)[axis] = file.take<double>();
    grid.cell = file.take<double>();
    for (int axis = 0; axis < 3; ++axis) grid.size[axis] = file.take<int32_t>();
    std::vector<std::string> notes(file.take<uint32_t>());
    for (std::string& note : notes) note = file.text();
    auto volume =
        std::make_shared<FieldVolume>(grid, std::vector<uint32_t>(file.words.begin(), file.words.end()));
    volume->mesh = recipe.mesh;
    volume->notes = std::move(notes);
    return volume;
}

/// Removes the files that were not used for longest while all take too much.
void tidy(const std::filesystem::path& folder) {
    struct File {
        std::filesystem::file_time_type used;
        std::uintmax_t size;
        std::filesystem::path path;
    };
    std::vector<File> files;
    std::error_code error;
    std::uintmax_t all = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
        File file{entry.last_write_time(error), entry.file_size(error), entry.path()};
        if (error) continue;  // it has just gone
        all += file.size;
        files.push_back(std::move(file));
    }
    std::ranges::sort(files, {}, &File::used);
    for (const File& file : files) {
        if (all <= kMostCachedBytes) return;
        std::filesystem::remove(file.path, error);
        all -= file.size;
    }
}

void keepMade(const MeshFieldRecipe& recipe, const FieldVolume& volume) {
    const std::string path = pathOf(recipe);
    if (path.empty()) return;
    std::vector<uint32_t> words;
    words.reserve(volume.words.size() + 256);
    put(words, kAlgorithmVersion);
    for (const glm::dvec3* of : {&volume.grid.origin, &volume.grid.inset})
        for (int axis = 0; axis < 3; ++axis) put(words, (*of)[axis]);
    put(words, volume.grid.cell);
    for (int axis = 0; axis < 3; ++axis) put(words, int32_t(volume.grid.size[axis]));
    put(words, uint32_t(volume.notes.size()));
    for (const std::string& note : volume.notes) put(words, note);
    words.insert(words.end(), volume.words.begin(), volume.words.end());
    writeCacheFile(path, recipe.key() + kVersion, words);
    tidy(std::filesystem::path(path).parent_path());
}

Result<FieldVolumePtr> bake(const Device* device, std::optional<Kernels>& kernels, const BakeOptions& options,
                            const MeshFieldRecipe& recipe) {
    if (!device) return bakeOnHost(recipe);
    const auto start = Clock::now();
    Result<MeshInGrid> mesh = meshInGrid(recipe);
    if (!mesh) return mesh.error();
    if (options.stages) options.stages->push_back({"topology", millisecondsSince(start)});
    if (!fits(*device, *mesh)) return bakeOnHost(recipe);
    if (!kernels) kernels = createKernels(*device);
    return Bake(*device, *kernels, options, recipe, *mesh).run();
}

}  // namespace

MeshFieldBaker meshFieldBaker(std::function<const Device*()> device, const BakeOptions& options) {
    return [device = std::move(device), options, kernels = std::make_shared<std::optional<Kernels>>()](
               const MeshFieldRecipe& recipe) -> Result<FieldVolumePtr> {
        if (options.cached)
            if (FieldVolumePtr made = readMade(recipe)) return made;
        Result<FieldVolumePtr> made = bake(device(), *kernels, options, recipe);
        if (made && options.cached) keepMade(recipe, **made);
        return made;
    };
}

}  // namespace fw
