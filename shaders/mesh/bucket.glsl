// A vertex's bucket of the sorted list, four entries at a time: from place `first` to before `last`.
layout(binding = 3, rgba32ui) readonly uniform uimageBuffer next;  // list of the vertices after each corner

/// Texels that hold some of the bucket.
uvec3 texelsOf(uvec3 first, uvec3 last) { return (max(last, first + 1) - 1) / 4 - first / 4 + 1; }
/// How many of the bucket's entries in its i-th texel, none beyond the last, are between two vertices.
uint countBetween(uint first, uint last, uint i, uint low, uint high) {
    uint texel = first / 4 + i;
    uvec4 entry = imageLoad(next, int(min(texel, (max(last, first + 1) - 1) / 4))), place = texel * 4 + uvec4(0, 1, 2, 3);
    uvec4 counts = uvec4(greaterThanEqual(place, uvec4(first))) * uvec4(lessThan(place, uvec4(last))) *
                   uvec4(greaterThan(entry, uvec4(low))) * uvec4(lessThan(entry, uvec4(high)));
    return counts.x + counts.y + counts.z + counts.w;
}
