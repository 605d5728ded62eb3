// What the renderer's shaders are told of the view; C++ includes this file too. After shared.h.
#ifndef FW_RENDER_H
#define FW_RENDER_H

#ifdef __cplusplus
namespace fw::gpu {
#endif

#define RENDER_SAMPLES 2   // depth samples along each side of a pixel
#define RENDER_GROUP_X 16  // pixels of one work group of shade.comp
#define RENDER_GROUP_Y 4

// With v = p - eye: a point's place in the picture is (right . v, up . v) / (forward . v), each from -1 to 1
// and +1 upwards; its depth is near / (forward . v), so 1 is near and 0 infinitely far.
struct RenderPush {
    vec3 eye;
    float near;       // metres
    vec3 right;       // divided by the tangent of half the angle of view along x
    float ground;     // height of the ground, metres
    vec3 up;          // the same along y
    float radius;     // of what is seen, metres: the scale of soft shadows
    vec3 forward;     // unit length
    float stepScale;  // makes the field's value a distance that a ray may safely go
    vec3 lo;          // the region that was meshed: the solid is cut there
    float cellSize;   // of the mesh, metres
    vec3 hi;
    uint firstRow;       // of the rows that this dispatch shades
    vec3 centre;         // of what is seen
    uint width, height;  // of the picture, in pixels
};

#ifdef __cplusplus
}  // namespace fw::gpu
#endif
#endif
