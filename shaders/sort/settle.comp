// Counting sort, after its last pass: the items of each key in the order of their numbers, so that the same keys give the
// same order on every run. Each item counts those before it. Of a key with very many items the order stays as it was.
#include "sort/sort.glsl"

layout(local_size_x = SORT_GROUP) in;
layout(binding = 0, scalar) readonly buffer Keys { uint keys[]; };
layout(binding = 1, scalar) readonly buffer Starts { uint starts[]; };
layout(binding = 2, scalar) readonly buffer Counts { uint counts[]; };
layout(binding = 3, scalar) readonly buffer Order { uint order[]; };
layout(binding = 4, scalar) writeonly buffer Settled { uint settled[]; };

void main() {
    uint place = linearGroup() * SORT_GROUP + gl_LocalInvocationIndex;
    if (place >= push.items) return;
    uint item = order[place], key = keys[item], start = starts[key], count = counts[key];
    uint at = start, before = 0, end = start + (count <= SORT_MOST_SETTLED ? count : 1);
    do {  // on some drivers a lane that has ended goes on beside its neighbours: it counts no more
        before += at < end && order[at] < item ? 1 : 0;
    } while (++at < end);
    settled[count <= SORT_MOST_SETTLED ? start + before : place] = item;
}
