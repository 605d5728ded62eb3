// Births: places and velocities of new particles, by chances that their numbers and the seed decide alone.
#include "shared.h"
#include "particles/motion.h"
#include "lib/groups.glsl"

layout(local_size_x = MOTION_GROUP) in;
layout(push_constant, scalar) uniform PushConstants { EmitPush push; };
layout(binding = 0, scalar) writeonly buffer Places { vec4 places[]; };  // metres, and the age in seconds
layout(binding = 1, scalar) writeonly buffer Velocities { vec4 velocities[]; };  // m/s

const float kPi = 3.14159265;
uint state;
// From 0 to 1: PCG (O'Neill 2014), a step a call.
float chance() {
    state = state * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return float((word >> 22u ^ word) >> 8u) * (1.0 / 16777216.0);
}

vec3 direction() {
    float z = 2.0 * chance() - 1.0, turn = 2.0 * kPi * chance(), r = sqrt(max(1.0 - z * z, 0.0));
    return vec3(r * cos(turn), z, r * sin(turn));
}

void main() {
    uint index = linearGroup() * MOTION_GROUP + gl_LocalInvocationIndex;
    if (index >= push.count) return;
    uint number = push.number + index;
    state = number * 2654435769u ^ push.seed * 2246822519u;
    chance();
    vec3 way = direction(), box = 2.0 * vec3(chance(), chance(), chance()) - 1.0;
    float far = chance();
    vec3 disc = sqrt(far) * vec3(way.x, 0.0, way.z) / max(length(way.xz), 1e-6);
    vec3 unit = push.shape == EMIT_BALL   ? way * pow(far, 1.0 / 3.0)
                : push.shape == EMIT_BOX  ? box
                : push.shape == EMIT_DISC ? disc
                                          : vec3(0.0);
    vec3 velocity = push.velocity + push.spread * pow(chance(), 1.0 / 3.0) * direction();
    float age = max(push.age - push.sooner * float(index), 0.0);
    vec3 place = push.position + push.size * unit + age * velocity;
    uint slot = (push.first + index) % push.slots;
    places[slot] = vec4(place, age);
    velocities[slot] = vec4(velocity, 0.0);
}
