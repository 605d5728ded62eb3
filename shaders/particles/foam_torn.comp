// How many particles of foam each of the fluid's gives off in this step: as much as air is trapped where it is, or as it is on a
// crest, and as it is fast.
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "particles/foam.glsl"
#include "lib/random.glsl"

layout(local_size_x = FLUID_GROUP) in;
layout(binding = 1, rgba32ui) restrict readonly uniform uimageBuffer places;
layout(binding = 2, rgba32ui) restrict readonly uniform uimageBuffer velocities;
layout(binding = 3, rgba32ui) restrict readonly uniform uimageBuffer normals;
layout(binding = 4, rgba32ui) restrict readonly uniform uimageBuffer lists;
layout(binding = 5, scalar) readonly buffer Counts { uint counts[]; };
layout(binding = 6, scalar) writeonly buffer Given { uint given[]; };  // one more than there are particles

const float kWeights = 8.4;     // of a particle's neighbours in the fluid, together, at rest
const float kSteep = 0.2;       // of a surface's density, at least
const float kForward = 0.6;     // cosine between the normal and the way of a crest, at least
const float kMostGiven = 64.0;  // in a step

// From 0 at `least` to 1 at `most`.
float between(float value, float least, float most) { return clamp((value - least) / (most - least), 0.0, 1.0); }

void main() {
    uint index = item();
    if (index == push.particles) given[index] = 0;
    if (index >= push.particles) return;
    vec3 p = uintBitsToFloat(imageLoad(places, int(index)).xyz), v = uintBitsToFloat(imageLoad(velocities, int(index)).xyz);
    vec4 normal = uintBitsToFloat(imageLoad(normals, int(index)));
    float trapped = 0.0, bent = 0.0;
    uint texels = (counts[index] + 3) / 4, turns = subgroupMax(texels), t = 0;  // all lanes end together
    int texel = firstTexel(index);
    do {
        uvec4 four = t < texels ? imageLoad(lists, texel) : uvec4(index);
        for (int k = 0; k < 4; ++k) {
            int other = int(four[k]);
            vec3 off = p - uintBitsToFloat(imageLoad(places, other).xyz);
            vec3 apart = v - uintBitsToFloat(imageLoad(velocities, other).xyz);
            vec4 its = uintBitsToFloat(imageLoad(normals, other));
            float weight = leftOf(dot(off, off)), far = max(length(off), 1e-9);
            // Those that come nearer: all of their speed counts, twice where it is straight.
            trapped += weight * (length(apart) - dot(apart, off) / far);
            // Those behind the surface, as seen from here, turn away where it is a crest.
            bent += dot(off, normal.xyz) > 0.0 && its.w > kSteep ? weight * (1.0 - dot(normal.xyz, its.xyz)) : 0.0;
        }
        texel += kNextTexel;
    } while (++t < turns);
    float fast = length(v);
    bool crest = normal.w > kSteep && dot(v, normal.xyz) >= kForward * fast;
    float energy = between(fast * fast, foam.speed * foam.speed, 9.0 * foam.speed * foam.speed);
    float air = between(trapped / kWeights, 0.2 * foam.speed, 0.8 * foam.speed);
    float wave = crest ? between(bent, 0.5, 2.0) : 0.0;
    uint state = randomStart(index, randomStart(foam.step, foam.seed));
    given[index] = uint(min(foam.amount * energy * (air + wave), kMostGiven) + random(state));
}
