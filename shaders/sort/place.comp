// The sum of the counts before each.
#include "sort/counts.glsl"

layout(binding = 4, scalar) readonly buffer Sums { uvec4 sums[]; };
layout(binding = 5, scalar) writeonly buffer Starts { uvec4 starts[]; };  // of four keys each

void main() {
    uint total, before = sumBefore(sumOfLane(), total) + sums[min(linearGroup(), groupsOfCounts() - 1)].x;
    int texel = firstOfLane(), end = texel + kTexelsOfLane;
    do {
        uvec4 own = countsAt(texel);
        if (texel < texelsOfCounts()) starts[texel] = before + uvec4(0, own.x, own.x + own.y, own.x + own.y + own.z);
        before += sumOf(own);
    } while (++texel < end);
}
