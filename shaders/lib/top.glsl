// The top of the histopyramid: one work group sums the counts of all groups below, in place. Each lane walks a
// contiguous part twice, once for its sum and once to write the sums before each entry. Needs TOP_SUMS, their binding.
#define HISTOPYRAMID_LANES 256
#define HISTOPYRAMID_TYPE uvec2
#include "lib/histopyramid.glsl"

layout(local_size_x = HISTOPYRAMID_LANES) in;
layout(binding = TOP_SUMS, scalar) buffer Sums { uvec4 sums[]; };

/// Replaces x and y of sums[0..count) by the sums before each; returns the sum of all.
uvec2 sumUp(uint count) {
    uint each = max((count + HISTOPYRAMID_LANES - 1) / HISTOPYRAMID_LANES, 1);
    uint first = min(gl_LocalInvocationIndex * each, count), last = min(first + each, count);
    uvec2 part = uvec2(0);
    uint i = first;
    do {
        if (i < last) part += sums[i].xy;
    } while (++i < first + each);
    uvec2 total;
    uvec2 before = sumBefore(part, total);
    i = first;
    do {
        uvec4 own = i < last ? sums[i] : uvec4(0);
        if (i < last) sums[i] = uvec4(before, own.zw);
        before += own.xy;
    } while (++i < first + each);
    return total;
}
