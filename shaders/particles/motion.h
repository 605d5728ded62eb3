// What the kernels of runtime/particles/simulation.h share with C++. After shared.h.
#ifndef FW_MOTION_H
#define FW_MOTION_H
#ifdef __cplusplus
namespace fw::gpu {
#endif

#define MOTION_GROUP 64

// Shapes that an emitter fills, in the order of the node's choices.
#define EMIT_BALL 0
#define EMIT_BOX 1
#define EMIT_DISC 2
#define EMIT_POINT 3

// Particles have numbers in the order of their births; that of number n is in slot n % slots.
struct EmitPush {
    uint number, count;  // of the first one, and how many
    uint first, slots;   // its slot, and how many there are
    uint seed;
    vec3 position;  // metres
    int shape;
    vec3 size;
    float step;     // seconds
    vec3 velocity;  // m/s
    float spread;
    float age;     // of the particle born first, seconds
    float sooner;  // how much younger each next one is
};

struct MotionPush {
    uint slots;
    float step;        // seconds
    float time;        // at the step's end
    float lifetime;    // seconds
    vec3 gravity;      // m/s^2
    float drag;        // 1/s
    vec3 attractor;    // metres
    float attraction;  // m/s^2
    float turbulence;  // m/s^2
    float swirls;      // their size, metres
    float radius;      // metres
    float bounce;
    float friction;
    uint moves;  // whether places change too, and particles age: by the first stage of a chain alone
};

#ifdef __cplusplus
}  // namespace fw::gpu
#endif
#endif
