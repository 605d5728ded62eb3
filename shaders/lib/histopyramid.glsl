// Prefix sums over a work group: one level of the histopyramid that gives every active element its place.
//
// The talk's histopyramid sums counts level by level and walks down again for each output. Here the base level is the
// work group (its counts never leave registers), the level above it one sum a group, and the top is summed by one
// group alone (topSums.glsl). Reading down is two additions, and the places are the same on every run.
//
// Needs: HISTOPYRAMID_LANES, the size of the work group.

shared uvec4 histopyramidSums[HISTOPYRAMID_LANES / 4];  // no device has subgroups of less than four

/// Sum over the lanes before this one; `total` is that of all lanes. Every lane of the group must call it.
uvec4 sumBefore(uvec4 value, out uvec4 total) {
    uvec4 before = subgroupExclusiveAdd(value);
    if (gl_SubgroupInvocationID == gl_SubgroupSize - 1) histopyramidSums[gl_SubgroupID] = before + value;
    barrier();
    uvec4 sum = uvec4(0), mine = uvec4(0);
    uint i = 0;
    do {
        if (i == gl_SubgroupID) mine = sum;
        sum += histopyramidSums[i];
    } while (++i < gl_NumSubgroups);
    total = sum;
    return mine + before;
}
