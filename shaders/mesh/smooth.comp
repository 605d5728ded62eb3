// One iteration of Laplacian smoothing: (4 v + sum of neighbours) / (4 + number of neighbours). A vertex with all its
// neighbours close by stays: small parts shrink with each iteration, and must not become a line or a point. With SPARING those stay too
// that are round, and none leaves the neighbourhood of where it was.
#include "mesh/around.glsl"

layout(binding = 5, scalar) writeonly buffer Moved { uvec4 moved[]; };  // MeshVertex
#ifdef SPARING
layout(binding = 6, scalar) readonly buffer Round { float roundness[]; };
layout(binding = 7, rgba32ui) readonly uniform uimageBuffer placed;  // MeshVertex, before any iteration
#endif

void main() {
    uint v = min(item(), push.vertices - 1), count = counts[v], first = starts[v], i = 0;
    uvec4 own = imageLoad(vertices, int(v));
    vec3 at = uintBitsToFloat(own.xyz), most = vec3(0);
    ExactSum sum = ExactSum(ivec3(0), ivec3(0));
    do {  // as long as any lane: one that is done repeats its last, which adds nothing
        vec3 neighbour = positionOf(next[cornerOf(first, count, i)]);
        most = max(most, abs(neighbour - at));
        add(sum, neighbour / push.unit, i < count);
    } while (subgroupAny(++i < count));
    vec3 p = (4.0 * at + valueOf(sum) * push.unit) / float(4 + count);
    p = max(most.x, max(most.y, most.z)) > push.still ? p : at;
#ifdef SPARING
    vec3 before = uintBitsToFloat(imageLoad(placed, int(v)).xyz);
    p = mix(p, at, smoothstep(0.5, 1.0, abs(roundness[v])));
    float away = distance(p, before);
    p = away > push.within ? before + (p - before) * (push.within / away) : p;
#endif
    if (item() < push.vertices) moved[v] = uvec4(floatBitsToUint(p), own.w);
}
