// Counting sort, its last pass: each item's number to its place.
#include "sort/sort.glsl"

layout(local_size_x = SORT_GROUP) in;
layout(binding = 0, scalar) readonly buffer Keys { uint keys[]; };
layout(binding = 1, scalar) readonly buffer Starts { uint starts[]; };
layout(binding = 2, scalar) readonly buffer Ranks { uint ranks[]; };
layout(binding = 3, scalar) writeonly buffer Order { uint order[]; };

void main() {
    uint item = linearGroup() * SORT_GROUP + gl_LocalInvocationIndex;
    if (item < push.items) order[starts[keys[item]] + ranks[item]] = item;
}
