// Normals from connectivity: the mean over a vertex's triangles, weighted by their area. One without any keeps its own.
#include "mesh/around.glsl"
#include "lib/octahedral.glsl"

layout(binding = 4, scalar) readonly buffer Previous { uint previous[]; };
layout(binding = 5, scalar) writeonly buffer Words { uint words[]; };  // MeshVertex, whose fourth word is the normal

void main() {
    uint v = min(item(), push.vertices - 1), count = counts[v], first = starts[v], i = 0;
    vec3 own = positionOf(v);
    ExactSum sum = ExactSum(ivec3(0), ivec3(0));
    do {  // as long as any lane: one that is done adds nothing
        uint at = cornerOf(first, count, i);
        vec3 twice = cross(positionOf(next[at]) - own, positionOf(previous[at]) - own);
        add(sum, twice / push.unit, i < count);
    } while (subgroupAny(++i < count));
    vec3 normal = valueOf(sum);
    float size = length(normal);
    if (item() < push.vertices && size > 0.0) words[v * 4 + 3] = packOctahedral(normal / size);
}
