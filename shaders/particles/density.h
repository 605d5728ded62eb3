// What the kernels of runtime/particles/density.h share with C++. After shared.h.
#ifndef FW_DENSITY_H
#define FW_DENSITY_H
#ifdef __cplusplus
namespace fw::gpu {
#endif

#define DENSITY_GROUP 256                   // particles or samples of a work group
#define DENSITY_MOST_REACH 12               // weights of a blur beyond the middle one
#define DENSITY_MOST_UNIT 65536.0           // DensityPush::unit where there are few particles
#define DENSITY_PIECE(reach) (2 * (reach))  // samples of a line that a lane blurs: it reads twice as many

// Surfaces about particles (runtime/particles/particle_surface.h): what a place or a particle feels reaches
// so many drops' radii, which are SURFACE_SIDES sides of a bucket.
#define SURFACE_SIDES 2
#define AVERAGE_REACH 3.73
#define ANISOTROPIC_REACH 4.2
#define ANISOTROPIC_THRESHOLD 0.3165  // the density at the surface of a lattice at rest
#define ANISOTROPIC_LONE \
    1.77189  // reach of the kernel of a particle alone, of the radius 1: (1 - threshold^(1/3))^(-1/2)
#define SURFACE_LANES 8  // of a work group, which has a block of 4 x 4 x 4 samples: a lane has eight
#define SHAPE_WORDS 12   // of a particle's kernel

struct DensityPush {
    ivec3 size;  // samples
    uint particles;
    vec3 origin;  // of the samples, metres
    float cell;
    ivec3 buckets;  // of the side `radius`, around all samples and some more; not of blurs and proxies
    float radius;   // metres
    vec3 first;     // corner of the first bucket
    int reach;      // cells that a particle reaches from its own; not of exact densities
    float drop,
        none;  // of surfaces: in sides of a bucket, a drop's radius, and the length where no particle is near
    float unit;  // 1 in the whole numbers that positions and weights are added up as
};

#ifdef __cplusplus
}  // namespace fw::gpu
#endif
#endif
