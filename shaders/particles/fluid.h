// What the kernels of runtime/particles/fluid.h share with C++. After shared.h.
#ifndef FW_FLUID_H
#define FW_FLUID_H
#ifdef __cplusplus
namespace fw::gpu {
#endif

#define FLUID_GROUP 256           // particles of a work group
#define FLUID_MOST_NEIGHBOURS 64  // that a particle feels; more than that are only where it is far too dense

#define FLUID_DRAIN_BLOCK 1024  // particles of a key where they keep their order

// Errors of densities are added up as whole numbers, whose sums are the same in any order, in so many sums.
// No sum is too great: an error counts as 1 at most.
#define FLUID_ERROR_SUMS 256
#define FLUID_ERROR_UNIT 131072.0

// Share of the squared gradients of the density in the energy of surface tension: with more, a particle of
// the surface would rather be alone; with less, lattices yield too late for drops to get round.
#define FLUID_LEVELLING 1.75

// Gradient of the pressure, in weights of the fluid and pulls of its tension, by which a particle may gain
// energy that none of its neighbours has. With twice as much, drops leap.
#define FLUID_MOST_PRESSURE 1.0

// What the groups of a step's turns are read from.
struct FluidTurns {
    uvec3 groups;  // of kernels for all particles; none once the error is small enough,
    uvec3 one;     // as of the one that finds that
    uint taken;
};

struct FluidPush {
    vec3 first;    // corner of the first cell, metres
    vec3 perCell;  // cells a metre
    ivec3 cells;
    uint particles;
    uint from;    // the first whose neighbours are listed
    vec3 lo, hi;  // the walls of the tank, metres
    vec3 gravity;
    float step;        // s
    float support;     // of the kernel, metres
    float near;        // nearer neighbours are listed, metres
    float perSupport;  // 1/metre
    float weight;      // the kernel times a particle's volume is this at distance 0,
    float slope;       // and its gradient near 0 this times the offset, 1/m^2
    float soft;        // added to the sum of squared gradients, 1/m^2
    float relaxation;
    float viscosity;  // share of the difference of velocities that this step takes away
    float tension;    // m/s: velocity that pairs gain where they attract each other most
    float vorticity;  // metres: velocity that swirls gain for each 1/s of the curl
    float error;      // the mean of densities above that at rest, at which turns end
};

#ifdef __cplusplus
}  // namespace fw::gpu
#endif
#endif
