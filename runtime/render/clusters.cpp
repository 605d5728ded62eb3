#include "runtime/render/clusters.h"

#include <algorithm>
#include <array>

#include "runtime/mesher/sizes.h"

namespace fw {
namespace {

constexpr uint64_t kClusterBytes = 12 * CLUSTER_TRIANGLES;  // of its indices

}  // namespace

Clusters createClusters(const Device& device) {
    const std::array shaders = {ShaderOptions{.name = "render/clusters.comp"},
                                ShaderOptions{.name = "render/cull.comp"},
                                ShaderOptions{.name = "render/gather.comp"}};
    std::vector<Pipeline> pipelines = createComputePipelines(device, shaders);
    Clusters clusters;
    clusters.bound = std::move(pipelines[0]);
    clusters.cull = std::move(pipelines[1]);
    clusters.gather = std::move(pipelines[2]);
    clusters.counts = createBuffer(device, sizeof(gpu::ClusterCounts));
    return clusters;
}

void boundClusters(Commands& commands, Clusters& clusters, const MesherBuffers& mesh, uint32_t triangles,
                   uint64_t content) {
    if (clusters.content == content && clusters.triangles == triangles) return;
    clusters.content = content;
    clusters.triangles = triangles;
    if (triangles == 0) return;
    const uint32_t count = groupsFor(triangles, CLUSTER_TRIANGLES);
    const DeviceLimits& limits = commands.device.limits;
    clusters.whole = kClusterBytes * count > limits.storageRange ||
                     mesh.vertices.size > DeviceLimits::kTexelBytes * limits.texels();
    if (clusters.whole) return;
    // With room for more: a mesh that grows a little with each frame would be waited for each time.
    const auto most = uint32_t(limits.storageRange / kClusterBytes);
    const uint64_t room = std::min(mesher::grown(uint32_t(clusters.seen.size / 4), count, most), most);
    reserve(commands.device, clusters.clusters, room * sizeof(gpu::Cluster));
    reserve(commands.device, clusters.seen, 4 * room);
    reserve(commands.device, clusters.indices, kClusterBytes * room);
    const Descriptor bound[] = {
        {0, mesh.vertices}, {1, mesh.triangles, 0, 12ull * triangles}, {2, clusters.clusters}};
    dispatch(commands, clusters.bound, spread(commands.device, groupsFor(count, 64)), triangles, bound);
    barrier(commands);
}

void cullClusters(Commands& commands, Clusters& clusters, const MesherBuffers& mesh, const glm::mat4& clip,
                  const glm::vec4& eye, bool backs) {
    const auto row = [&](int i) { return glm::vec4(clip[0][i], clip[1][i], clip[2][i], clip[3][i]); };
    gpu::CullPush push{};
    push.sides[0] = row(3) + row(0);
    push.sides[1] = row(3) - row(0);
    push.sides[2] = row(3) + row(1);
    push.sides[3] = row(3) - row(1);
    push.eye = eye;
    push.clusters = groupsFor(clusters.triangles, CLUSTER_TRIANGLES);
    push.backs = backs ? 0 : 1;
    if (clusters.whole) {
        const gpu::ClusterCounts all{0, {0, 1, 1}, {3 * clusters.triangles, 1, 0, 0, 0}};
        vkCmdUpdateBuffer(commands.handle, clusters.counts.handle, 0, sizeof all, &all);
        return barrier(commands);
    }
    const gpu::ClusterCounts none{0, {0, 1, 1}, {0, 1, 0, 0, 0}};
    vkCmdUpdateBuffer(commands.handle, clusters.counts.handle, 0, sizeof none, &none);
    barrier(commands);
    const Descriptor culled[] = {{0, clusters.clusters}, {1, clusters.seen}, {2, clusters.counts}};
    dispatch(commands, clusters.cull, spread(commands.device, groupsFor(push.clusters, 64)), push, culled);
    barrier(commands);
    const Descriptor gathered[] = {{0, mesh.triangles, 0, 12ull * clusters.triangles},
                                   {1, clusters.seen},
                                   {2, clusters.indices},
                                   {3, clusters.counts}};
    dispatchIndirect(commands, clusters.gather, clusters.counts, offsetof(gpu::ClusterCounts, seen),
                     clusters.triangles, gathered);
    barrier(commands);
}

const Buffer& indicesOf(const Clusters& clusters, const MesherBuffers& mesh) {
    return clusters.whole ? mesh.triangles : clusters.indices;
}

}  // namespace fw
