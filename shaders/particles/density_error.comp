// How far each particle must give way for its density to be that at rest, at most: Macklin and Mueller's lambda.
#include "particles/fluid.glsl"

layout(local_size_x = FLUID_GROUP) in;
layout(binding = 0, rgba32ui) restrict readonly uniform uimageBuffer guesses;
layout(binding = 1, rgba32ui) restrict readonly uniform uimageBuffer planes;
layout(binding = 2, scalar) readonly buffer Lists { uint lists[]; };
layout(binding = 3, scalar) readonly buffer Counts { uint counts[]; };
layout(binding = 4, rgba32ui) restrict writeonly uniform uimageBuffer weighed;  // floats: the guess, and lambda
layout(binding = 5, scalar) writeonly buffer Densities { float densities[]; };

void main() {
    uint index = item();
    if (index >= push.particles) return;
    vec3 p = uintBitsToFloat(imageLoad(guesses, int(index)).xyz);
    vec4 walls = wallsAt(p, uintBitsToFloat(imageLoad(planes, int(index))));
    float density = weightAt(0.0) + walls.w, squares = 0.0;
    vec3 gradient = walls.xyz;
    uint count = counts[index], k = 0;
    do {
        uint other = lists[k * push.particles + index];
        vec3 off = p - uintBitsToFloat(imageLoad(guesses, int(k < count ? other : index)).xyz);
        float r = length(off);
        vec3 slope = slopeAt(r) * off;
        bool counts_ = k < count;
        density += counts_ ? weightAt(r) : 0.0;
        squares += counts_ ? dot(slope, slope) : 0.0;
        gradient += counts_ ? slope : vec3(0.0);
    } while (++k < count);
    float lambda = -max(density - 1.0, 0.0) / (squares + dot(gradient, gradient) + push.soft);
    imageStore(weighed, int(index), floatBitsToUint(vec4(p, lambda)));
    densities[index] = density;
}
