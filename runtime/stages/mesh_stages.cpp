#include "runtime/stages/mesh_stages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <limits>
#include <span>
#include <string>

#include "runtime/mesh/creases.h"
#include "runtime/mesh/crumbs.h"
#include "runtime/mesh/octahedral.h"
#include "runtime/system/clock.h"

namespace fw {

namespace {

constexpr uint64_t kMostTriangles = 1u << 24;
constexpr float kStill = 1.0f / 16;  // of a cell; of half a cell after a subdivision, and so on

/// A power of two that is at least as large.
float powerAbove(float size) { return std::exp2(std::ceil(std::log2(std::max(size, 1e-30f)))); }

/// Triangles and vertices that stages can be run on: what they read is bound as a whole.
struct Most {
    uint64_t triangles, vertices;
};
Most mostOf(const Device& device) {
    const uint64_t range = device.limits.storageRange;
    const uint64_t texels = device.limits.texels();
    return {std::min(kMostTriangles, range / 12), std::min(range / sizeof(gpu::MeshVertex), texels)};
}

std::string thousands(uint64_t count) {
    std::string digits = std::to_string(count);
    for (std::size_t at = digits.size(); at > 3; at -= 3) digits.insert(at - 3, " ");
    return digits;
}

/// What one run of the stages knows of the mesh.
struct Run {
    const Device& device;
    MeshStageBuffers& buffers;
    MesherBuffers& mesh;
    MesherResult& result;
    const MeshStageConfig& config;
    Most most = mostOf(device);
    float still = kStill * config.cellSize;  ///< MeshPush's
    bool sorted = false;                     ///< the lists are those of the mesh's triangles
    bool stale = false;                      ///< normals are not those of the mesh as it is
    bool smoothed = false;

    gpu::MeshPush push() const {
        gpu::MeshPush push{};
        push.vertices = result.vertices;
        push.triangles = result.triangles;
        push.lo = config.lo;
        push.hi = config.hi;
        push.still = still;
        const glm::vec3 reach = glm::max(glm::abs(config.lo), glm::abs(config.hi));
        const float farthest = std::max({reach.x, reach.y, reach.z});
        push.rim = 1.5f * result.rim + 4e-7f * farthest;  // and the last bits of means
        push.unit = 2.0f * powerAbove(farthest);
        return push;
    }
};

uint32_t groupsOf(uint64_t items) { return groupsFor(items, MESH_GROUP); }

/// The counting sort of corners by vertex.
void sortCorners(Commands& commands, Run& run) {
    if (std::exchange(run.sorted, true)) return;
    const Device& device = run.device;
    MeshStageBuffers& b = run.buffers;
    const gpu::MeshPush push = run.push();
    reserve(device, b.edgeCounts, 4ull * push.vertices);
    for (Buffer* perCorner : {&b.next, &b.previous}) reserve(device, *perCorner, 12ull * push.triangles);
    beginStage(commands, "sort");
    const VkDeviceSize triangles = 12ull * push.triangles;
    countKeys(commands, run.config.pipelines->counting, b.corners, {0, run.mesh.triangles, 0, triangles},
              3 * push.triangles, push.vertices);
    const Descriptor scattered[] = {{0, run.mesh.triangles, 0, triangles},
                                    {1, b.corners.starts},
                                    {2, b.corners.ranks},
                                    {3, b.next},
                                    {4, b.previous}};
    dispatchGroups(commands, run.config.pipelines->scatter, groupsOf(push.triangles), push, scattered);
    barrier(commands);
}

/// Copies `size` bytes from the start of one buffer to that of another.
void copy(Commands& commands, const Buffer& from, const Buffer& to, VkDeviceSize size) {
    const VkBufferCopy region{0, 0, size};
    vkCmdCopyBuffer(commands.handle, from.handle, to.handle, 1, &region);
}

/// How round the mesh is at each vertex, where `spare` is 1, into buffers.roundness[0].
void findRoundness(Commands& commands, Run& run, const gpu::MeshPush& push) {
    constexpr int kRings = 8;
    MeshStageBuffers& b = run.buffers;
    for (Buffer& each : b.roundness) reserve(run.device, each, 4ull * push.vertices);
    const auto go = [&](const Pipeline& kernel) {
        const Descriptor bound[] = {
            {0, run.mesh.vertices}, {1, b.corners.counts}, {2, b.corners.starts}, {3, b.next},
            {4, b.previous},        {6, b.roundness[0]},   {7, b.roundness[1]}};
        dispatchGroups(commands, kernel, groupsOf(push.vertices), push, bound);
        barrier(commands);
        std::swap(b.roundness[0], b.roundness[1]);
    };
    go(run.config.pipelines->roundness);
    for (int i = 0; i < kRings; ++i) go(run.config.pipelines->spread);
}

void smooth(Commands& commands, Run& run, const MeshStage& stage) {
    sortCorners(commands, run);
    MeshStageBuffers& b = run.buffers;
    gpu::MeshPush push = run.push();
    push.spare = float(stage.spare);
    push.within = stage.within > 0.0 ? float(stage.within) : std::numeric_limits<float>::max();
    beginStage(commands, "smooth");
    const bool sparing = stage.spare > 0.0 || stage.within > 0.0;
    const VkDeviceSize bytes = sizeof(gpu::MeshVertex) * uint64_t(push.vertices);
    reserve(run.device, b.vertices, bytes);
    if (sparing) {
        findRoundness(commands, run, push);
        reserve(run.device, b.placed, bytes);
        copy(commands, run.mesh.vertices, b.placed, bytes);
        barrier(commands);
    }
    for (int i = 0; i < stage.times; ++i) {
        const Descriptor bound[] = {
            {0, run.mesh.vertices},    {1, b.corners.counts}, {2, b.corners.starts}, {3, b.next},
            {5, b.vertices, 0, bytes}, {6, b.roundness[0]},   {7, b.placed}};
        const MeshStagePipelines& pipelines = *run.config.pipelines;
        dispatchGroups(commands, sparing ? pipelines.smoothSparing : pipelines.smooth,
                       groupsOf(push.vertices), push, std::span(bound).first(sparing ? 7 : 5));
        barrier(commands);
        std::swap(run.mesh.vertices, b.vertices);
    }
    run.stale = run.smoothed = true;
}

void findNormals(Commands& commands, Run& run) {
    if (!std::exchange(run.stale, false)) return;
    sortCorners(commands, run);
    gpu::MeshPush push = run.push();
    const glm::vec3 size = run.config.hi - run.config.lo;
    push.unit = 2.0f * powerAbove(size.x * size.x + size.y * size.y + size.z * size.z);
    beginStage(commands, "normals");
    const Descriptor bound[] = {{0, run.mesh.vertices},
                                {1, run.buffers.corners.counts},
                                {2, run.buffers.corners.starts},
                                {3, run.buffers.next},
                                {4, run.buffers.previous},
                                {5, run.mesh.vertices, 0, sizeof(gpu::MeshVertex) * uint64_t(push.vertices)}};
    dispatchGroups(commands, run.config.pipelines->normals, groupsOf(push.vertices), push, bound);
    barrier(commands);
}

void splitEdges(Commands& commands, Run& run, bool project) {
    sortCorners(commands, run);
    const MeshStagePipelines& pipelines = *run.config.pipelines;
    MeshStageBuffers& b = run.buffers;
    gpu::MeshPush push = run.push();
    const uint32_t edges = 3 * (push.triangles / 2);  // each is of two triangles
    const uint64_t vertices = uint64_t(push.vertices) + edges, triangles = 4ull * push.triangles;
    beginStage(commands, "subdivide");
    reserve(run.device, b.vertices, sizeof(gpu::MeshVertex) * vertices);
    reserve(run.device, b.triangles, 12 * triangles);
    if (run.result.colors) reserve(run.device, b.colors, 12 * vertices);
    copy(commands, run.mesh.vertices, b.vertices, sizeof(gpu::MeshVertex) * uint64_t(push.vertices));
    if (run.result.colors) copy(commands, run.mesh.colors, b.colors, 12ull * push.vertices);
    const VkDeviceSize bytes = sizeof(gpu::MeshVertex) * vertices;
    std::vector<Descriptor> bound = {
        {1, b.corners.counts}, {2, b.corners.starts}, {3, b.next}, {5, b.edgeCounts}};
    dispatchGroups(commands, pipelines.edges, groupsOf(push.vertices), push, bound);
    barrier(commands);
    sumCounts(commands, pipelines.counting, b.corners.sums, b.edgeCounts, b.edgeStarts, push.vertices);
    bound = {{0, run.mesh.vertices},
             {1, b.corners.counts},
             {2, b.corners.starts},
             {3, b.next},
             {4, b.edgeStarts},
             {5, b.vertices, 0, bytes},
             {6, run.mesh.triangles, 0, 12ull * push.triangles},
             {7, b.triangles, 0, 12 * triangles}};
    if (run.result.colors) {
        bound.push_back({8, run.mesh.colors, 0, 12ull * push.vertices});
        bound.push_back({9, b.colors, 0, 12 * vertices});
    }
    dispatchGroups(commands, run.result.colors ? pipelines.splitColored : pipelines.split,
                   groupsOf(push.triangles), push, bound);
    barrier(commands);
    if (project) {
        beginStage(commands, "project");
        push.first = push.vertices;
        push.vertices = edges;
        if (run.config.projectOnHost) {
            flush(commands);
            const std::size_t first = push.first * sizeof(gpu::MeshVertex);
            std::vector<gpu::MeshVertex> made(edges);
            downloadBytes(run.device, b.vertices, made.data(), edges * sizeof made[0], first);
            run.config.projectOnHost(push, made);
            uploadBytes(run.device, b.vertices, made.data(), edges * sizeof made[0], first);
        } else {
            bound = {{5, b.vertices, 0, bytes}};
            addField(bound, run.config.field);
            dispatchGroups(commands, pipelines.project, groupsOf(edges), push, bound);
            barrier(commands);
        }
    }
    std::swap(run.mesh.vertices, b.vertices);
    std::swap(run.mesh.triangles, b.triangles);
    if (run.result.colors) std::swap(run.mesh.colors, b.colors);
    run.result.vertices = uint32_t(vertices);
    run.result.triangles = uint32_t(triangles);
    run.sorted = false;
    run.still *= 0.5f;
    run.stale = run.stale || !project;
}

/// A stage's work, done `times` times, submitted and awaited; what it took is added to that of the same name.
template <class Record>
void runNow(Run& run, int times, Record&& record) {
    constexpr uint64_t kMany = 1u << 20;  // that a device passes over in a fraction of a second
    Commands commands(run.device, run.config.timed);
    commands.parted = !commands.timed && uint64_t(times) * run.result.triangles > kMany;
    record(commands);
    submit(commands);
    std::vector<StageTime>& all = run.result.stages;
    for (const StageTime& stage : commands.stages) {
        const auto same = std::ranges::find(all, stage.name, &StageTime::name);
        if (same == all.end())
            all.push_back(stage);
        else
            same->milliseconds += stage.milliseconds;
    }
}

/// On the host. At the end of the chain, creases are doubled as they are for a file: of few, large triangles
/// each side must be shaded by itself.
void decimate(Run& run, const MeshStage& stage, bool last) {
    const auto start = Clock::now();
    const auto wanted = uint64_t(stage.triangles);
    if (wanted > 0 && run.result.triangles <= wanted && stage.error <= 0.0) return;
    Mesh mesh = downloadMesh(run.device, run.mesh, run.result);
    const bool changed = run.config.decimate(mesh, stage);
    run.result.undecimated = wanted > 0 ? mesh.triangleCount() > wanted : !changed;
    if (changed) {
        if (last && !run.smoothed) splitCreases(mesh);
        uploadMesh(run.device, run.mesh, mesh, run.result);
        run.result.creases = !last && !run.smoothed;
        run.sorted = false;
    }
    if (run.config.timed) run.result.stages.push_back({"decimate", millisecondsSince(start)});
}

/// On the host too.
void dropCrumbs(Run& run, double least) {
    const auto start = Clock::now();
    Mesh mesh = downloadMesh(run.device, run.mesh, run.result);
    if (leaveOutCrumbs(mesh, least)) {
        uploadMesh(run.device, run.mesh, mesh, run.result);
        run.sorted = false;
    }
    if (run.config.timed) run.result.stages.push_back({"crumbs", millisecondsSince(start)});
}

/// That stages can be run on so much; `stage` is what needs it.
Done fits(const Run& run, const std::string& stage, uint64_t vertices, uint64_t triangles) {
    const bool tooMany = triangles > run.most.triangles;
    if (!tooMany && vertices <= run.most.vertices) return done();
    const uint64_t needed = tooMany ? triangles : vertices,
                   most = tooMany ? run.most.triangles : run.most.vertices;
    return Error{.message = stage + " needs " + thousands(needed) +
                            (tooMany ? " triangles, " : " vertices, ") + thousands(most) +
                            " is the most on this device: choose a lower resolution, or fewer levels of "
                            "subdivide"};
}

/// The result, as the draw of the mesh and other kernels read it.
void writeCounts(const Run& run) {
    auto counts = download<gpu::MesherCounts>(run.device, run.mesh.counts, 1)[0];
    counts.vertices = run.result.vertices;
    counts.triangles = run.result.triangles;
    counts.draw[0] = 3 * run.result.triangles;
    uploadBytes(run.device, run.mesh.counts, &counts, sizeof counts);
}

}  // namespace

MeshStagePipelines createMeshStagePipelines(const Device& device) {
    MeshStagePipelines pipelines;
    pipelines.counting = createKeyCounting(device);
    const std::array shaders = {ShaderOptions{.name = "mesh/scatter.comp"},
                                ShaderOptions{.name = "mesh/smooth.comp"},
                                ShaderOptions{.name = "mesh/smooth.comp", .defines = {"SPARING"}},
                                ShaderOptions{.name = "mesh/roundness.comp"},
                                ShaderOptions{.name = "mesh/roundness.comp", .defines = {"SPREAD"}},
                                ShaderOptions{.name = "mesh/normals.comp"},
                                ShaderOptions{.name = "mesh/edges.comp"},
                                ShaderOptions{.name = "mesh/split.comp"},
                                ShaderOptions{.name = "mesh/split.comp", .defines = {"COLORS"}}};
    std::vector<Pipeline> made = createComputePipelines(device, shaders);
    Pipeline* const places[] = {&pipelines.scatter,   &pipelines.smooth, &pipelines.smoothSparing,
                                &pipelines.roundness, &pipelines.spread, &pipelines.normals,
                                &pipelines.edges,     &pipelines.split,  &pipelines.splitColored};
    for (std::size_t i = 0; i < made.size(); ++i) *places[i] = std::move(made[i]);
    return pipelines;
}

Pipeline createProjection(const Device& device, std::string_view field) {
    return createComputePipeline(device, {.name = "mesh/project.comp", .field = field});
}

void uploadMesh(const Device& device, MesherBuffers& buffers, const Mesh& mesh, MesherResult& result) {
    std::vector<gpu::MeshVertex> packed(mesh.positions.size());
    for (std::size_t i = 0; i < packed.size(); ++i)
        packed[i] = {mesh.positions[i], packOctahedral(mesh.normals[i])};
    reserve(device, buffers.vertices, packed.size() * sizeof packed[0]);
    upload(device, buffers.vertices, packed);
    reserve(device, buffers.triangles, mesh.indices.size() * 4);
    upload(device, buffers.triangles, mesh.indices);
    result.colors = !mesh.colors.empty();
    if (result.colors) reserve(device, buffers.colors, mesh.colors.size() * 12);
    if (result.colors) upload(device, buffers.colors, mesh.colors);
    result.vertices = uint32_t(mesh.positions.size());
    result.triangles = uint32_t(mesh.triangleCount());
}

Done runMeshStages(const Device& device, MeshStageBuffers& buffers, MesherBuffers& mesh, MesherResult& result,
                   std::span<const MeshStage> stages, const MeshStageConfig& config) {
    if (result.triangles == 0) return done();
    Run run{.device = device, .buffers = buffers, .mesh = mesh, .result = result, .config = config};
    const auto refreshNormals = [&]() -> Done {
        const Done fit = fits(run, "finding normals", result.vertices, result.triangles);
        if (fit && run.stale) runNow(run, 1, [&](Commands& commands) { findNormals(commands, run); });
        return fit;
    };
    for (std::size_t i = 0; i < stages.size(); ++i) {
        const MeshStage& stage = stages[i];
        Done fit = done();
        if (stage.kind == MeshStage::Kind::decimate) {
            if (run.stale) fit = refreshNormals();
            if (fit) decimate(run, stage, i + 1 == stages.size());
        }
        if (stage.kind == MeshStage::Kind::dropCrumbs) {
            if (run.stale) fit = refreshNormals();
            if (fit) dropCrumbs(run, stage.least);
        }
        if (stage.kind == MeshStage::Kind::smooth && stage.times > 0) {
            fit = fits(run, "smooth", result.vertices, result.triangles);
            if (fit) runNow(run, stage.times, [&](Commands& commands) { smooth(commands, run, stage); });
        }
        for (int level = 1; fit && stage.kind == MeshStage::Kind::subdivide && level <= stage.times;
             ++level) {
            fit = fits(run, "level " + std::to_string(level) + " of subdivide",
                       result.vertices + 3ull * (result.triangles / 2), 4ull * result.triangles);
            if (fit) runNow(run, 4, [&](Commands& commands) { splitEdges(commands, run, stage.project); });
        }
        if (!fit) return fit.error();
    }
    if (run.stale)
        if (const Done fit = refreshNormals(); !fit) return fit.error();
    result.creases = result.creases && !run.smoothed;
    writeCounts(run);
    return done();
}

}  // namespace fw
