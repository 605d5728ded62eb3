// The sum of each group of counts.
#include "sort/counts.glsl"

layout(binding = 4, scalar) writeonly buffer Sums { uvec4 sums[]; };

void main() {
    uint total;
    sumBefore(sumOfLane(), total);
    if (gl_LocalInvocationIndex == 0 && firstOfLane() < texelsOfCounts()) sums[linearGroup()] = uvec4(total, 0, 0, 0);
}
