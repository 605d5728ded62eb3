#include "runtime/render/clusters.h"

#include <array>

namespace fw {

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
    reserve(commands.device, clusters.clusters, count * sizeof(gpu::Cluster));
    reserve(commands.device, clusters.seen, 4ull * count);
    reserve(commands.device, clusters.indices, 12ull * CLUSTER_TRIANGLES * count);
    const Descriptor bound[] = {{0, mesh.vertices}, {1, mesh.triangles}, {2, clusters.clusters}};
    dispatch(commands, clusters.bound, {groupsFor(count, 64), 1, 1}, triangles, bound);
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
    const gpu::ClusterCounts none{{0, 1, 1}, {0, 1, 0, 0, 0}};
    vkCmdUpdateBuffer(commands.handle, clusters.counts.handle, 0, sizeof none, &none);
    barrier(commands);
    const Descriptor culled[] = {{0, clusters.clusters}, {1, clusters.seen}, {2, clusters.counts}};
    dispatch(commands, clusters.cull, {groupsFor(push.clusters, 64), 1, 1}, push, culled);
    barrier(commands);
    const Descriptor gathered[] = {{0, mesh.triangles}, {1, clusters.seen}, {2, clusters.indices}};
    dispatchIndirect(commands, clusters.gather, clusters.counts, offsetof(gpu::ClusterCounts, seen),
                     clusters.triangles, gathered);
    barrier(commands);
}

}  // namespace fw
