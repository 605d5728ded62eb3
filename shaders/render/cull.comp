// Lists the clusters that a pass may see: not wholly beside the picture, and not wholly facing away. In any order: depth is the
// same in each.
#include "shared.h"
#include "render/render.h"
#include "lib/groups.glsl"

layout(local_size_x = 64) in;
layout(binding = 0, scalar) readonly buffer Clusters { Cluster clusters[]; };
layout(binding = 1, scalar) writeonly buffer Seen { uint seen[]; };
layout(binding = 2, scalar) buffer Counts { ClusterCounts counts; };
layout(push_constant, scalar) uniform Push { CullPush push; };

void main() {
    uint index = linearGroup() * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
    Cluster cluster = clusters[min(index, push.clusters - 1)];
    vec3 centre = 0.5 * (cluster.lo + cluster.hi), half_ = 0.5 * (cluster.hi - cluster.lo);
    bool keep = index < push.clusters;
    uint i = 0;
    do {
        vec4 side = push.sides[i];
        keep = keep && dot(side.xyz, centre) + dot(abs(side.xyz), half_) + side.w >= 0.0;
    } while (++i < 4);
    // A triangle faces away if the ray to any of its points has its normal's direction.
    vec3 ray = push.eye.w != 0.0 ? centre - push.eye.xyz : push.eye.xyz;
    vec3 least = min(cluster.normalLo * ray, cluster.normalHi * ray);
    bool back = least.x + least.y + least.z > push.eye.w * length(half_);
    keep = keep && !(back && push.backs != 0);

    uint mine = subgroupExclusiveAdd(keep ? 1 : 0), all = subgroupAdd(keep ? 1 : 0), base = 0;
    if (all > 0 && subgroupElect()) {
        base = atomicAdd(counts.clusters, all);
        atomicMax(counts.seen.x, min(base + all, MOST_GROUPS));
        atomicAdd(counts.draw[0], all * CLUSTER_TRIANGLES * 3);
    }
    base = subgroupBroadcastFirst(base);
    if (keep) seen[base + mine] = index;
}
