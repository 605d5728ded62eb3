// The nearest points of the surface to the samples beside it, for sweeps (bake/sweep.comp): along the gradient, as far as the value
// divided by its slope says.
#include "particles/volume.glsl"
#include "bake/bake.h"

layout(local_size_x = VOLUME_GROUP) in;
layout(binding = 0, scalar) readonly buffer Field { float field[]; };  // rows padded to texels
layout(binding = 1, scalar) writeonly buffer State { vec4 state[]; };

float at(ivec3 place) { return field[(place.z * push.size.y + place.y) * 4 * texels().x + place.x]; }

void main() {
    uint index = item();
    if (index >= countOf(push.size)) return;
    ivec3 place = placeIn(push.size, index);
    float here = at(place);
    vec3 gradient;
    bool beside = false;
    for (int axis = 0; axis < 3; ++axis) {
        ivec3 before = place, next = place;
        before[axis] = max(before[axis] - 1, 0);
        next[axis] = min(next[axis] + 1, push.size[axis] - 1);
        float low = at(before), high = at(next);
        gradient[axis] = (high - low) / float(next[axis] - before[axis]);
        beside = beside || low < 0.0 != here < 0.0 || high < 0.0 != here < 0.0;
    }
    float slope = max(length(gradient), 1e-3);
    vec3 point = vec3(place) - clamp(here / slope, -1.5, 1.5) * gradient / slope;
    state[index] = vec4(beside ? point : vec3(BAKE_UNREACHED), 0.0);
}
