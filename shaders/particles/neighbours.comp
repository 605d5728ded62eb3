// Lists the neighbours of each particle: those nearer than the support, in the 125 cells around it, of which five in a row lie in
// one piece. The k-th of particle i is at place k * particles + i.
#include "particles/fluid.glsl"

layout(local_size_x = FLUID_GROUP) in;
layout(binding = 0, rgba32ui) restrict readonly uniform uimageBuffer guesses;
layout(binding = 1, scalar) readonly buffer Starts { uint starts[]; };
layout(binding = 2, scalar) writeonly buffer Lists { uint lists[]; };
layout(binding = 3, scalar) writeonly buffer Counts { uint counts[]; };

void main() {
    uint index = item();
    if (index >= push.particles) return;
    vec3 p = uintBitsToFloat(imageLoad(guesses, int(index)).xyz);
    ivec3 own = cellOf(p);
    float most = push.support * push.support;
    uint found = 0;
    int row = 0;
    do {
        uint cell = cellIndex(own + ivec3(-2, row % 5 - 2, row / 5 - 2));
        uint i = starts[cell], last = starts[cell + 5];
        do {
            vec3 off = p - uintBitsToFloat(imageLoad(guesses, int(min(i, push.particles - 1))).xyz);
            bool near = i < last && i != index && dot(off, off) < most && found < FLUID_MOST_NEIGHBOURS;
            if (near) lists[found * push.particles + index] = i;
            found += near ? 1 : 0;
        } while (++i < last);
    } while (++row < 25);
    counts[index] = found;
}
