// Where a picture is seen from.
//
// The camera is the scene's; without one it looks down from three quarters, from the side of +x and +z, as
// near as all that is to be seen stays in the picture.
#pragma once

#include <glm/mat4x4.hpp>
#include <span>

#include "graph/document/scene.h"
#include "shaders/shared.h"
// after shared.h
#include "shaders/render/render.h"

namespace fw {

inline glm::vec3 vector(const Triple& from) { return {float(from[0]), float(from[1]), float(from[2])}; }

/// A sphere about what is seen, metres, and its lowest point.
struct SeenBounds {
    glm::vec3 centre{0.0f};
    float radius = 1.0f;
    float foot = -1.0f;
};

/// What walls and gaps are to be at least in a picture where nobody says: a power of ten, up to a fiftieth of
/// the solid's longest side.
float usualWidth(float longest);

/// Bounds of the points; those of a unit ball if there are none.
SeenBounds boundsOf(std::span<const gpu::MeshVertex> points);

/// Looks from `eye` to `target`, y upwards; `fov` is vertical, radians; `aspect` is width / height.
gpu::View lookFrom(glm::vec3 eye, glm::vec3 target, float fov, float aspect, float near = 0.05f);

/// The camera's view; `near` suits what is within the bounds.
gpu::View cameraView(const Camera& camera, const SeenBounds& bounds, float aspect);

/// How far from the camera things are sharp, metres along the view.
float focusOf(const Camera& camera, const gpu::View& view);

/// The view from a place on the camera's lens (`place`: of the unit disc), which sees what is in focus where
/// the view does.
gpu::View throughLens(gpu::View view, const Camera& camera, glm::vec2 place);

/// The view from three quarters that has all points in the picture. There is at least one.
gpu::View framingView(std::span<const gpu::MeshVertex> points, float aspect);

/// The camera of framingView, aimed at the middle of the points.
Camera framingCamera(std::span<const gpu::MeshVertex> points, float aspect);

/// To clip space, y upwards, of what the view sees.
glm::mat4 toClip(const gpu::View& view);

/// Rays for trace.comp, of the whole picture; the region, scale and size are left to the caller.
gpu::TracePush raysOf(const gpu::View& view);

}  // namespace fw
