// Viscosity: each pair's velocities come nearer to each other. With TENSION, surface tension too: the step's share of minus the
// gradient of its energy (runtime/particles/fluid.h), by which pairs attract each other and densities level. All by equal and
// opposite amounts. And no particle gains more energy than runtime/particles/fluid.h allows.
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "particles/fluid.glsl"

layout(local_size_x = FLUID_GROUP) in;
layout(binding = 0, rgba32ui) restrict readonly uniform uimageBuffer guesses;
layout(binding = 1, rgba32ui) restrict readonly uniform uimageBuffer velocities;
layout(binding = 2, rgba32ui) restrict readonly uniform uimageBuffer lists;
layout(binding = 3, scalar) readonly buffer Counts { uint counts[]; };
layout(binding = 4, scalar) writeonly buffer Smoothed { uvec4 smoothed[]; };  // floats, and the number
#ifdef TENSION
layout(binding = 5, rgba32ui) restrict readonly uniform uimageBuffer planes;
layout(binding = 6, rgba32ui) restrict readonly uniform uimageBuffer gradients;

// The force of cohesion between two, over its greatest, by the share of the support that is left: Akinci et al. (2013).
float cohesion(float u) {
    float q = u * (1.0 - u), shape = 64.0 * q * q * q;
    return u < 0.5 ? shape : 2.0 * shape - 1.0;
}

// The kernel's second derivatives, times the difference of two gradients.
vec3 bentAlong(vec3 off, float u, vec3 by) {
    float r = max((1.0 - u) * push.support, 1e-6 * push.support);
    return u * u * (u * by - 3.0 * push.perSupport / r * dot(off, by) * off);
}
#endif

void main() {
    uint index = item();
    if (index >= push.particles) return;
    vec4 own = uintBitsToFloat(imageLoad(guesses, int(index)));
    float most = own.w;  // energy
    uvec4 fast = imageLoad(velocities, int(index));
    vec3 p = own.xyz, v = uintBitsToFloat(fast.xyz);
    vec3 change = vec3(0.0);
#ifdef TENSION
    vec3 gradient = uintBitsToFloat(imageLoad(gradients, int(index)).xyz), pull = vec3(0.0), level = vec3(0.0);
#endif
    uint texels = (counts[index] + 3) / 4, turns = subgroupMax(texels), t = 0;  // all lanes end together
    int texel = firstTexel(index);
    do {
        uvec4 four = t < texels ? imageLoad(lists, texel) : uvec4(index);
        for (int k = 0; k < 4; ++k) {
            int other = int(four[k]);
            vec4 its = uintBitsToFloat(imageLoad(guesses, other));
            vec3 off = p - its.xyz;
            most = max(most, its.w);
            vec3 faster = uintBitsToFloat(imageLoad(velocities, other).xyz) - v;
            float u = leftOf(dot(off, off));
            change += weightShape(u) * (push.viscosity * faster);
#ifdef TENSION
            pull += cohesion(u) / max((1.0 - u) * push.support, 1e-6 * push.support) * off;
            level += bentAlong(off, u, gradient - uintBitsToFloat(imageLoad(gradients, other).xyz));
#endif
        }
        texel += kNextTexel;
    } while (++t < turns);
    v += push.weight * change;
    float weight = length(push.gravity), squared = dot(v, v), pressure = FLUID_MOST_PRESSURE * (push.step * weight + push.tension);
    float gained = weight > 0.0 ? max(energyAt(p, squared) - most - pressure * sqrt(squared), 0.0) : 0.0;
    v *= sqrt(max(squared - 2.0 * gained, 0.0) / max(squared, 1e-30));
#ifdef TENSION
    level = push.slope * level + wallsBent(p, uintBitsToFloat(imageLoad(planes, int(index))), gradient);
    v -= push.tension * (pull + FLUID_LEVELLING * push.support * push.support * push.support * level);
#endif
    smoothed[index] = uvec4(floatBitsToUint(v), fast.w);
}
