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

struct DensityPush {
    ivec3 size;  // samples
    uint particles;
    vec3 origin;  // of the samples, metres
    float cell;
    ivec3 buckets;  // of exact densities, of the side `radius`, around all samples and a radius more
    float radius;   // metres
    vec3 first;     // corner of the first bucket
    int reach;      // cells that a particle reaches from its own; not of exact densities
    float unit;     // 1 in the whole numbers that positions and weights are added up as
};

#ifdef __cplusplus
}  // namespace fw::gpu
#endif
#endif
