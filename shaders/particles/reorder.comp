// All that is known of the particles, in the order of their cells.
#include "particles/fluid.glsl"

layout(local_size_x = FLUID_GROUP) in;
layout(binding = 0, scalar) readonly buffer Order { uint order[]; };
layout(binding = 1, rgba32ui) restrict readonly uniform uimageBuffer places;
layout(binding = 2, rgba32ui) restrict readonly uniform uimageBuffer guesses;
layout(binding = 3, rgba32ui) restrict readonly uniform uimageBuffer planes;
layout(binding = 4, rgba32ui) restrict writeonly uniform uimageBuffer sortedPlaces;
layout(binding = 5, rgba32ui) restrict writeonly uniform uimageBuffer sortedGuesses;
layout(binding = 6, rgba32ui) restrict writeonly uniform uimageBuffer sortedPlanes;

void main() {
    uint index = item();
    if (index >= push.particles) return;
    int from = int(order[index]), to = int(index);
    imageStore(sortedPlaces, to, imageLoad(places, from));
    imageStore(sortedGuesses, to, imageLoad(guesses, from));
    imageStore(sortedPlanes, to, imageLoad(planes, from));
}
