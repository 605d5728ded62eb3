// One iteration of Laplacian smoothing: (4 v + sum of neighbours) / (4 + number of neighbours).
#include "mesh/around.glsl"

layout(binding = 5, scalar) writeonly buffer Moved { uvec4 moved[]; };  // MeshVertex

void main() {
    uint v = min(item(), push.vertices - 1), count = counts[v], first = starts[v], i = 0;
    uvec4 own = imageLoad(vertices, int(v));
    ExactSum sum = ExactSum(ivec3(0), ivec3(0));
    do {  // as long as any lane: one that is done adds nothing
        add(sum, positionOf(next[first + min(i, count - 1)]) / push.unit, i < count);
    } while (subgroupAny(++i < count));
    vec3 p = (4.0 * uintBitsToFloat(own.xyz) + valueOf(sum) * push.unit) / float(4 + count);
    if (item() < push.vertices) moved[v] = uvec4(floatBitsToUint(p), own.w);
}
