// New particles of foam: about the way that a particle of the fluid came in the step before, for all foam moves on by a step yet.
// They take the free slots in their order; where there are fewer slots than births, some of the births all over the fluid.
#include "particles/foam.glsl"
#include "lib/random.glsl"

layout(local_size_x = FLUID_GROUP) in;
layout(binding = 1, rgba32ui) restrict readonly uniform uimageBuffer fluidPlaces;
layout(binding = 2, rgba32ui) restrict readonly uniform uimageBuffer fluidVelocities;
layout(binding = 3, scalar) readonly buffer Before { uint before[]; };  // births of the fluid's particles; at the end all
layout(binding = 4, scalar) readonly buffer FreeBefore { uint freeBefore[]; };  // at the end all
layout(binding = 5, scalar) readonly buffer Free { uint free[]; };
layout(binding = 6, scalar) writeonly buffer Places { vec4 places[]; };
layout(binding = 7, scalar) writeonly buffer Velocities { vec4 velocities[]; };
layout(binding = 8, scalar) buffer Ids { uint ids[]; };  // of the slots; then how many births there were, by the step's parity

const float kSpread = 0.25;  // of the speed, at most, across it

void main() {
    uint index = item();
    if (index >= push.particles) return;
    vec3 p = uintBitsToFloat(imageLoad(fluidPlaces, int(index)).xyz), v = uintBitsToFloat(imageLoad(fluidVelocities, int(index)).xyz);
    float fast = length(v), radius = 0.25 * push.support;
    vec3 way = v / max(fast, 1e-9);
    vec3 side = normalize(cross(way, abs(way.y) < 0.8 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0))), up = cross(side, way);
    uint births = before[push.particles], room = freeBefore[foam.slots];
    uint born = ids[foam.slots + (foam.step & 1)];
    if (index == 0) ids[foam.slots + (~foam.step & 1)] = born + births;
    float share = min(float(room) / float(max(births, 1)), 1.0);
    uint number = before[index], end = before[index + 1];
    uint state = randomStart(index, randomStart(foam.step, foam.seed));
    for (; number < end; ++number) {
        float turn = 6.2831853 * random(state), far = sqrt(random(state)), since = random(state), luck = random(state);
        vec3 aside = far * (cos(turn) * side + sin(turn) * up);
        uint place = uint(float(number) * share);
        if (uint(float(number + 1) * share) == place || place >= room) continue;
        uint slot = free[place];
        ids[slot] = born + number;
        places[slot] = vec4(inTank(p + radius * aside - (1.0 + since) * push.step * v), 0.0);
        velocities[slot] = vec4(v + kSpread * fast * aside, float(FOAM_FOAM) + 0.999 * luck);
    }
}
