// The sum of the counts before each.
#include "sort/counts.glsl"

layout(binding = 4, scalar) readonly buffer Sums { uvec4 sums[]; };
layout(binding = 5, scalar) writeonly buffer Starts { uint starts[]; };

void main() {
    uint first = firstOfLane(), total, key = first;
    uint before = sumBefore(sumFrom(first), total) + sums[min(linearGroup(), groupsOfCounts() - 1)].x;
    do {
        uint own = countAt(key);
        if (key < push.keys) starts[key] = before;
        before += own;
    } while (++key < first + SORT_SUM_EACH);
}
