// Whether a box of the grid may hold surface.

/// Whether the box from sample `first`, `size` cells a side, may hold surface if the field's values there are within f. A
/// box that reaches the outside layer has surface as soon as any part of it is inside. NaN counts as surface: only a box
/// that is known to be empty is dropped.
bool mayHoldSurface(uvec3 first, uint size, vec2 f) {
    bool atRim = any(equal(first, uvec3(0))) || any(greaterThan(first + size, push.cells + 1));
    bool outside = f.x >= push.margin;
    bool inside = f.y < -push.margin && !atRim;
    bool inTile = all(lessThan(first, min(push.cells + 2, push.end * 8 + 8))) &&
                  all(greaterThan(first + size, push.first * 8));
    return inTile && !outside && !inside;
}

vec3 lowOf(uvec3 first) { return samplePosition(max(first, uvec3(1))); }
vec3 highOf(uvec3 first, uint size) { return samplePosition(min(first + size, push.cells + 1)); }
