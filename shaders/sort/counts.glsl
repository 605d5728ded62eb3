// Prefix sums over the counts of keys, in three dispatches: sum.comp, top.comp, place.comp.
#include "sort/sort.glsl"
#define HISTOPYRAMID_LANES SORT_SUM_LANES
#define HISTOPYRAMID_TYPE uint
#include "lib/histopyramid.glsl"

layout(local_size_x = SORT_SUM_LANES) in;
layout(binding = 0, scalar) readonly buffer Counts { uint counts[]; };

uint groupsOfCounts() { return (push.keys + SORT_SUM_LANES * SORT_SUM_EACH - 1) / (SORT_SUM_LANES * SORT_SUM_EACH); }
/// The first of the keys that this lane sums.
uint firstOfLane() { return (linearGroup() * SORT_SUM_LANES + gl_LocalInvocationIndex) * SORT_SUM_EACH; }
uint countAt(uint key) { return key < push.keys ? counts[key] : 0; }
uint sumFrom(uint first) {
    uint key = first, sum = 0;
    do {
        sum += countAt(key);
    } while (++key < first + SORT_SUM_EACH);
    return sum;
}
