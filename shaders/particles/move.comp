// A step of particles: forces, then the way, along which they bounce off the obstacle. Particles that have lived long enough get a
// place that is no number.
//
// The way is gone in four parts, each as far as the distance to the obstacle allows, or, if more, until the obstacle's plane is
// reached, but no more than the rest divided by the parts that are left. So none passes through a wall, however thin, that is flat for
// as far as a fourth of a step.
#include "shared.h"
#include "particles/motion.h"
#include "lib/groups.glsl"
#ifdef OBSTACLE
#define FIELD_GRADIENT
#include "field.glsl"
#endif

layout(local_size_x = MOTION_GROUP) in;
layout(push_constant, scalar) uniform PushConstants { MotionPush push; };
layout(binding = 0, rgba32ui) readonly uniform uimageBuffer places;      // floats: metres, and the age in seconds
layout(binding = 1, rgba32ui) readonly uniform uimageBuffer velocities;  // floats: m/s
layout(binding = 2, scalar) writeonly buffer NextPlaces { vec4 nextPlaces[]; };  // the same, and so are these
layout(binding = 3, scalar) writeonly buffer NextVelocities { vec4 nextVelocities[]; };

// A flow without sources, after Arnold, Beltrami and Childress: three octaves that move against each other.
vec3 swirl(vec3 p, float time) {
    vec3 sum = vec3(0.0);
    for (int octave = 0; octave < 3; ++octave) {
        float finer = float(1 << octave);
        vec3 q = finer * p + time * vec3(0.7, -0.9, 0.8) + 1.7 * finer;
        sum += (sin(q.zxy) + cos(q.yzx)) * (0.5 / finer);
    }
    return sum;
}

void main() {
#ifdef OBSTACLE
    fieldBegin();
#endif
    uint index = linearGroup() * MOTION_GROUP + gl_LocalInvocationIndex;
    if (index >= push.slots) return;
    vec4 place = uintBitsToFloat(imageLoad(places, int(index)));
    vec3 velocity = uintBitsToFloat(imageLoad(velocities, int(index)).xyz), p = place.xyz;
    vec3 pull = push.attractor - p;
    vec3 force = push.gravity + push.attraction * pull / max(length(pull), 1e-3);
    if (push.turbulence > 0.0) force += push.turbulence * swirl(p * (3.14159265 / push.swirls), push.time);
    velocity = (velocity + push.step * force) * exp(-push.drag * push.step);
    float left = push.moves != 0 ? push.step : 0.0;
    place.w += left;
#ifdef OBSTACLE
    for (int part = 4; part > 0; --part) {
        vec4 f = fieldGradient(p);
        float slope = length(f.xyz), distance = f.w / max(slope, 1.0) - push.radius;
        vec3 normal = f.xyz / max(slope, 1e-6);
        float against = dot(velocity, normal);
        if (distance <= 0.0) {
            p -= distance * normal;
            if (against < 0.0) velocity = (1.0 - push.friction) * (velocity - against * normal) - push.bounce * against * normal;
        }
        float speed = max(length(velocity), 1e-9);
        distance = max(distance, 0.0) + 0.002 * left * speed;  // a little more, so that it is seen to be there
        float meets = distance / max(-dot(velocity, normal), 1e-9);
        float time = min(left, max(distance / speed, min(meets, left / float(part))));
        p += time * velocity;
        left -= time;
    }
    vec4 f = fieldGradient(p);
    float slope = length(f.xyz);
    p -= min(f.w / max(slope, 1.0) - push.radius, 0.0) * f.xyz / max(slope, 1e-6);
#else
    p += left * velocity;
#endif
    if (place.w > push.lifetime) p = vec3(uintBitsToFloat(0x7fc00000u));
    nextPlaces[index] = vec4(p, place.w);
    nextVelocities[index] = vec4(velocity, 0.0);
}
