// Keys by which particles in an outflow come last, and the others keep their order.
#include "particles/fluid.glsl"
#define FIELD_VALUE
#include "field.glsl"

layout(local_size_x = FLUID_GROUP) in;
layout(binding = 0, rgba32ui) restrict readonly uniform uimageBuffer places;
layout(binding = 1, scalar) writeonly buffer Keys { uint keys[]; };

void main() {
    fieldBegin();
    uint index = item();
    if (index >= push.particles) return;
    vec3 place = uintBitsToFloat(imageLoad(places, int(index)).xyz);
    uint last = (push.particles + FLUID_DRAIN_BLOCK - 1) / FLUID_DRAIN_BLOCK;
    keys[index] = fieldValue(place) < 0.0 ? last : index / FLUID_DRAIN_BLOCK;
}
