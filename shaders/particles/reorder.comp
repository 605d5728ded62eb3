// All that is known of the particles, in the order of their cells. Behind each place goes the particle's number.
#include "particles/fluid.glsl"

layout(local_size_x = FLUID_GROUP) in;
layout(binding = 0, scalar) readonly buffer Order { uint order[]; };
layout(binding = 1, rgba32ui) restrict readonly uniform uimageBuffer places;
layout(binding = 2, rgba32ui) restrict readonly uniform uimageBuffer guesses;
layout(binding = 3, rgba32ui) restrict readonly uniform uimageBuffer planes;
layout(binding = 4, scalar) writeonly buffer SortedPlaces { uvec4 sortedPlaces[]; };
layout(binding = 5, scalar) writeonly buffer SortedGuesses { uvec4 sortedGuesses[]; };
layout(binding = 6, scalar) writeonly buffer SortedPlanes { uvec4 sortedPlanes[]; };
layout(binding = 7, rgba32ui) restrict readonly uniform uimageBuffer velocities;  // and numbers

void main() {
    uint index = item();
    if (index >= push.particles) return;
    int from = int(order[index]);
    sortedPlaces[index] = uvec4(imageLoad(places, from).xyz, imageLoad(velocities, from).w);
    sortedGuesses[index] = imageLoad(guesses, from);
    sortedPlanes[index] = imageLoad(planes, from);
}
