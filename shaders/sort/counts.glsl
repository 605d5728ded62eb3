// Prefix sums over the counts of keys, in three dispatches: sum.comp, top.comp, place.comp.
#include "sort/sort.glsl"
#define HISTOPYRAMID_LANES SORT_SUM_LANES
#define HISTOPYRAMID_TYPE uint
#include "lib/histopyramid.glsl"

layout(local_size_x = SORT_SUM_LANES) in;
layout(binding = 0, rgba32ui) restrict readonly uniform uimageBuffer counts;  // of four keys each

const int kTexelsOfLane = SORT_SUM_EACH / 4;
uint groupsOfCounts() { return (push.keys + SORT_SUM_LANES * SORT_SUM_EACH - 1) / (SORT_SUM_LANES * SORT_SUM_EACH); }
int texelsOfCounts() { return int((push.keys + 3) / 4); }
int firstOfLane() { return int(linearGroup() * SORT_SUM_LANES + gl_LocalInvocationIndex) * kTexelsOfLane; }
uvec4 countsAt(int texel) {
    uvec4 keys = 4 * uint(texel) + uvec4(0, 1, 2, 3), four = imageLoad(counts, min(texel, texelsOfCounts() - 1));
    return mix(uvec4(0), four, lessThan(keys, uvec4(push.keys)));
}
uint sumOf(uvec4 four) { return four.x + four.y + four.z + four.w; }
uint sumOfLane() {
    int i = 0;
    uint sum = 0;
    do {
        sum += sumOf(countsAt(firstOfLane() + i));
    } while (++i < kTexelsOfLane);
    return sum;
}
