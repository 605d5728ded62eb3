// Whether a box of the grid may hold surface: interval arithmetic over the field.
#define FIELD_INTERVAL
#include "field.glsl"

/// Box from sample `first`, `size` cells a side. A box that reaches the outside layer has surface as soon as any part of
/// it is inside. NaN counts as surface: only a box that is known to be empty is dropped.
bool mayHoldSurface(uvec3 first, uint size) {
    uvec3 last = first + size;
    vec3 low = samplePosition(max(first, uvec3(1)));
    vec3 high = samplePosition(min(last, push.cells + 1));
    vec2 f = fieldInterval(low, high);
    bool atRim = any(equal(first, uvec3(0))) || any(greaterThan(last, push.cells + 1));
    bool outside = f.x >= push.margin;
    bool inside = f.y < -push.margin && !atRim;
    bool inGrid = all(lessThan(first, push.cells + 2));
    return inGrid && !outside && !inside;
}
