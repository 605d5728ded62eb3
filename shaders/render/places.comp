// Lists for each box of one of the grids of places.glsl the members of the field's families that can matter there, out of those
// listed for the box of the grid before that it is in. Each box a lane.
#define FIELD_INTERVAL
#define FIELD_PRUNE
#include "shared.h"
#include "render/render.h"
uint fieldAllocate(uint entries);
bool fieldMayHold(vec2 f) { return true; }  // what is far from the surface is asked for too
#include "render/places.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PlacesPush push; };
layout(binding = 0, scalar) buffer Listed { uint listed; };

const float kSlack = 1e-3;  // that boxes overlap by, so that rounding of a place moves no point out of its box

#define FIELD_LISTED listed
#include "lib/field_allocate.glsl"

void main() {
    fieldBegin();
    uint index = gl_GlobalInvocationID.x, side = push.side;
    bool valid = index < side * side * side;
    uvec3 box = valid ? uvec3(index % side, index / side % side, index / (side * side)) : uvec3(0);
    fieldChoose(side > RENDER_LEAST_PLACES ? placeOfBox(box / 2, side / 2) : 0);
#ifdef FIELD_FAMILIES
    vec3 low = cornerOfPlace(box, side) - kSlack, high = cornerOfPlace(box + 1, side) + kSlack;
    vec3 middle = 0.5 * (push.lo + push.hi), half_ = 0.5 * (push.hi - push.lo);
    if (valid) fieldPrune(middle + half_ * low, middle + half_ * high, placeOfBox(box, side));
#endif
}
