// What the kernels of runtime/particles/fluid.h share with C++. After shared.h.
#ifndef FW_FLUID_H
#define FW_FLUID_H
#ifdef __cplusplus
namespace fw::gpu {
#endif

#define FLUID_GROUP 64            // particles of a work group
#define FLUID_MOST_NEIGHBOURS 96  // that a particle feels; more than that are only where it is far too dense

struct FluidPush {
    vec3 first;  // corner of the first cell, metres
    float cell;  // half of `support`
    ivec3 cells;
    uint particles;
    vec3 lo, hi;  // the walls of the tank, metres
    vec3 gravity;
    float step;     // s
    float support;  // of the kernel, metres
    float volume;   // of a particle, m^3
    float viscosity;
    float tension;
    float soft;  // added to the sum of squared gradients, 1/m^2
};

#ifdef __cplusplus
}  // namespace fw::gpu
#endif
#endif
