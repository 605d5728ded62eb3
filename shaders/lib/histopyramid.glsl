// Prefix sums over a work group: one level of the histopyramid that gives every active element its place.
//
// The talk's histopyramid sums counts level by level and walks down again for each output. Here the base level is the
// work group (its counts never leave registers), the level above it one sum a group, and the top is summed by one
// group alone (lib/top.glsl). Reading down is two additions, and the places are the same on every run.
//
// Needs: HISTOPYRAMID_LANES, the size of the work group, and HISTOPYRAMID_TYPE, what is counted: uint to uvec4.

shared HISTOPYRAMID_TYPE histopyramidSums[HISTOPYRAMID_LANES / 4];  // no device has subgroups of less than four

/// Sum over the lanes before this one; `total` is that of all lanes. Every lane of the group must call it.
HISTOPYRAMID_TYPE sumBefore(HISTOPYRAMID_TYPE value, out HISTOPYRAMID_TYPE total) {
    HISTOPYRAMID_TYPE before = subgroupExclusiveAdd(value);
    HISTOPYRAMID_TYPE all = subgroupAdd(value);  // a subgroup may be larger than the group: no lane is the last by its number
    if (subgroupElect()) histopyramidSums[gl_SubgroupID] = all;
    barrier();
    HISTOPYRAMID_TYPE sum = HISTOPYRAMID_TYPE(0), mine = HISTOPYRAMID_TYPE(0);
    uint i = 0;
    do {
        if (i == gl_SubgroupID) mine = sum;
        sum += histopyramidSums[i];
    } while (++i < gl_NumSubgroups);
    total = sum;
    return mine + before;
}
