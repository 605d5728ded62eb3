// One iteration of Laplacian smoothing: (4 v + sum of neighbours) / (4 + number of neighbours). A vertex with all its
// neighbours close by stays: small parts shrink with each iteration, and must not become a line or a point.
#include "mesh/around.glsl"

layout(binding = 5, scalar) writeonly buffer Moved { uvec4 moved[]; };  // MeshVertex

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
    if (item() < push.vertices) moved[v] = uvec4(floatBitsToUint(p), own.w);
}
