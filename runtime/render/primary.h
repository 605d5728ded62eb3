// Depth and normals of a view, traced through the field without a mesh.
//
// Sphere tracing (Hart 1996): a ray steps by the field's value over its Lipschitz constant, until the value
// is less than half a pixel's width. It gives what drawAmbient needs.
#pragma once

#include "runtime/render/ambient.h"

namespace fw {

/// Looks from `eye` to `target`, y upwards.
struct PrimaryCamera {
    glm::vec3 eye{0, 0, 4}, target{0};
    float fieldOfView = 0.7f;       ///< vertical, radians
    float near = 0.05f, far = 100;  ///< metres
};

/// The camera's matrices for a picture of `aspect` = width / height.
CameraView viewOf(const PrimaryCamera& camera, float aspect);

/// `field` is the text that answers #include "field.glsl", empty for the default field.
Pipeline createPrimary(const Device& device, std::string_view field);

/// Fills `depth` (R32_SFLOAT, 0 to 1 where nothing is) and `normal` (R32_UINT, octahedral), both of one size
/// and in VK_IMAGE_LAYOUT_GENERAL. `parameters` are the live ones, where the field has some.
void drawPrimary(Commands& commands, const Pipeline& primary, const PrimaryCamera& camera, float lipschitz,
                 const Image& depth, const Image& normal, const Buffer* parameters = nullptr);

}  // namespace fw
