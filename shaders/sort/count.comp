// Counting sort, its first pass: how many items have each key. What the atomic addition returns is the item's place among
// them, in an order that may be another in each run.
#include "sort/sort.glsl"

layout(local_size_x = SORT_GROUP) in;
layout(binding = 0, scalar) readonly buffer Keys { uint keys[]; };
layout(binding = 1, scalar) buffer Counts { uint counts[]; };
layout(binding = 2, scalar) writeonly buffer Ranks { uint ranks[]; };

void main() {
    uint item = linearGroup() * SORT_GROUP + gl_LocalInvocationIndex;
    if (item < push.items) ranks[item] = atomicAdd(counts[keys[item]], 1);
}
