// What primary.comp and the ambient occlusion kernels are told of a frame; C++ includes this file too. After
// shared.h.
#ifndef FW_AMBIENT_H
#define FW_AMBIENT_H

#ifdef __cplusplus
#include <glm/mat4x4.hpp>

namespace fw::gpu {
using mat4 = glm::mat4;
#endif

#define AMBIENT_TILE 16       // pixels along each side of a tile, one work group
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

// A view for primary.comp. A pixel at (x, y) of -1 to 1, y downwards, sees along forward + x right + y down.
struct PrimaryPush {
    vec3 eye;
    float near;    // metres along forward, where depth is 0
    vec3 forward;  // unit length
    float far;     // where depth is 1
    vec3 right;    // times the tangent of half the angle of view
    float pixel;   // half a pixel's width at a distance of 1: a field below it is a hit
    vec3 down;
    float stepScale;
    uint width, height;
    uint steps;  // at most
};

#ifdef __cplusplus
}  // namespace fw::gpu
#endif
#endif
