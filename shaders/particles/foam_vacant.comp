// Ones for the slots that may be taken.
#include "particles/foam.glsl"

layout(local_size_x = FLUID_GROUP) in;
layout(binding = 1, rgba32ui) restrict readonly uniform uimageBuffer velocities;
layout(binding = 2, scalar) writeonly buffer Vacant { uint vacant[]; };  // one more than there are slots

void main() {
    uint slot = item();
    if (slot > foam.slots) return;
    bool taken = uintBitsToFloat(imageLoad(velocities, int(min(slot, foam.slots - 1))).w) >= 0.0;
    vacant[slot] = slot < foam.slots && !taken ? 1 : 0;
}
