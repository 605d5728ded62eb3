// What the kernels of runtime/particles/particle_volume.h share with C++. After shared.h.
#ifndef FW_PARTICLE_VOLUME_H
#define FW_PARTICLE_VOLUME_H
#ifdef __cplusplus
namespace fw::gpu {
#endif

#define VOLUME_GROUP 32  // blocks of a work group

struct ParticleVolumePush {
    ivec3 size;      // samples
    float cell;      // metres
    ivec3 blocks;    // of 4 x 4 x 4 samples, or of the pyramid's level
    uint first;      // the volume's first texel
    ivec3 coarse;    // of 8 x 8 x 8 samples
    int axis;        // along which distances are handed on
    float radius;    // R, cells
    float least;     // the cube root of the threshold
    float most;      // of the cube root of a density, where the distance would be 0 were there no threshold
    float flattest;  // slope that values are divided by at least, which are no distances where it is less
    uint from, to;   // of the pyramid: the first block of a level, and of the next one
};

#ifdef __cplusplus
}  // namespace fw::gpu
#endif
#endif
