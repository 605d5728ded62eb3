// How far each particle must give way for its density to be that at rest, at most: Macklin and Mueller's lambda. With ADD_ERRORS,
// how much too dense all are.
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "particles/fluid.glsl"

layout(local_size_x = FLUID_GROUP) in;
layout(binding = 0, rgba32ui) restrict readonly uniform uimageBuffer guesses;
layout(binding = 1, rgba32ui) restrict readonly uniform uimageBuffer planes;
layout(binding = 2, rgba32ui) restrict readonly uniform uimageBuffer lists;
layout(binding = 3, scalar) readonly buffer Counts { uint counts[]; };
layout(binding = 4, scalar) writeonly buffer Weighed { vec4 weighed[]; };  // the guess, about, and lambda
layout(binding = 5, scalar) writeonly buffer Densities { float densities[]; };
layout(binding = 6, scalar) readonly buffer Far { float far[]; };  // density of those that are not listed
#ifdef ADD_ERRORS
layout(binding = 7, scalar) buffer Errors { uint errors[FLUID_ERROR_SUMS]; };
#endif

void main() {
    uint index = item();
    if (index >= push.particles) return;
    vec3 p = uintBitsToFloat(imageLoad(guesses, int(index)).xyz);
    vec4 walls = wallsAt(p, uintBitsToFloat(imageLoad(planes, int(index))));
    uint texels = (counts[index] + 3) / 4, turns = subgroupMax(texels), t = 0;  // all lanes end together
    float weights = 1.0, squares = 0.0;
    vec3 offs = vec3(0.0);
    int texel = firstTexel(index);
    do {  // a lane that is done while others go on adds nothing: it meets itself
        uvec4 four = t < texels ? imageLoad(lists, texel) : uvec4(index);
        for (int k = 0; k < 4; ++k) {
            vec3 off = p - uintBitsToFloat(imageLoad(guesses, int(four[k])).xyz);
            float apart = dot(off, off), u = leftOf(apart), slope = slopeShape(u);
            weights += four[k] != index ? weightShape(u) : 0.0;
            squares += slope * slope * apart;
            offs += slope * off;
        }
        texel += kNextTexel;
    } while (++t < turns);
    float density = push.weight * weights + walls.w + far[index];
    vec3 gradient = push.slope * offs + walls.xyz;
    squares *= push.slope * push.slope;
    float lambda = -push.relaxation * max(density - 1.0, 0.0) / (squares + dot(gradient, gradient) + push.soft);
    // Each a little to the side of its own, so that particles in one place part.
    vec3 aside = vec3(index * uvec3(3518319155u, 2882110345u, 2360945575u)) * (1e-5 / 4294967296.0 * push.support);
    weighed[index] = vec4(p + aside, lambda);
    densities[index] = density;
#ifdef ADD_ERRORS
    uint error = subgroupAdd(uint(clamp(density - 1.0, 0.0, 1.0) * FLUID_ERROR_UNIT));
    if (subgroupElect()) atomicAdd(errors[index / FLUID_GROUP % FLUID_ERROR_SUMS], error);
#endif
}
