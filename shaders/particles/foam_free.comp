// The numbers of the slots that may be taken, in their order.
#include "particles/foam.glsl"

layout(local_size_x = FLUID_GROUP) in;
layout(binding = 1, scalar) readonly buffer Vacant { uint vacant[]; };
layout(binding = 2, scalar) readonly buffer Before { uint before[]; };  // vacant ones
layout(binding = 3, scalar) writeonly buffer Free { uint free[]; };

void main() {
    uint slot = item();
    if (slot < foam.slots && vacant[slot] != 0) free[before[slot]] = slot;
}
