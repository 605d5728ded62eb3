// The sum of the counts before each.
#include "mesh/counts.glsl"

layout(binding = 4, scalar) readonly buffer Sums { uvec4 sums[]; };
layout(binding = 5, scalar) writeonly buffer Starts { uint starts[]; };

void main() {
    uint first = firstOfLane(), total, vertex = first;
    uint before = sumBefore(sumFrom(first), total) + sums[min(linearGroup(), groupsOfCounts() - 1)].x;
    do {
        uint own = countAt(vertex);
        if (vertex < push.vertices) starts[vertex] = before;
        before += own;
    } while (++vertex < first + MESH_SUM_EACH);
}
