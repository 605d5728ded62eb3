// The places of one kind of foam.
#include "particles/foam.glsl"

layout(local_size_x = FLUID_GROUP) in;
layout(binding = 1, rgba32ui) restrict readonly uniform uimageBuffer places;
layout(binding = 2, rgba32ui) restrict readonly uniform uimageBuffer velocities;
layout(binding = 3, scalar) writeonly buffer Shown { uvec4 shown[]; };

void main() {
    uint slot = item();
    if (slot >= foam.slots) return;
    float kind = uintBitsToFloat(imageLoad(velocities, int(slot)).w);
    bool its = kind >= float(foam.shown) && kind < float(foam.shown + 1);
    shown[slot] = its ? imageLoad(places, int(slot)) : uvec4(0x7fc00000u);
}
