// What the ambient occlusion kernels are told of a frame; C++ includes this file too. After shared.h.
#ifndef FW_AMBIENT_H
#define FW_AMBIENT_H

#ifdef __cplusplus
#include <glm/mat4x4.hpp>

namespace fw::gpu {
using mat4 = glm::mat4;
#endif

#define AMBIENT_TILE 16      // pixels along each side of a tile, one work group
#define AMBIENT_MOST_RAYS 16  // of a pixel in one frame

// Clip depth runs from 0 (near) to 1 (far), y downwards.
struct AmbientView {
    mat4 inverseNow;     // clip space to metres
    mat4 before;         // metres to the clip space of the frame before
    mat4 inverseBefore;  // and back
    vec3 eye;
    float radius;     // a ray's length, metres
    float bias;       // metres that a ray starts off the surface
    float stepScale;  // makes the field's value a distance that a ray may safely go
    uint width, height;
    uint frame;     // turns the rays
    uint samples;   // of the field, along a ray at most
    uint raysNew;   // of a pixel without history, up to AMBIENT_MOST_RAYS
    uint raysKept;  // of one with history
    uint mostKept;  // rays that the history counts for at most
    uint balance;   // 1: the lanes of a tile share its rays evenly; 0: each traces its own pixel's
};

#ifdef __cplusplus
}  // namespace fw::gpu
#endif
#endif
