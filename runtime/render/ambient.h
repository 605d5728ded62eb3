// Ambient occlusion traced through the field, with a history.
//
// After Matt Swoboda's "Advanced Procedural Rendering in DirectX 11" (GDC 2012), Illumination;
// shaders/render/ambient.comp says what it does and where it deviates. It needs depth and normals of the
// frame, however they were made, and gives for each pixel the part of the hemisphere, weighted by the cosine,
// from which rays up to `radius` long are open.
//
// Lifetime: an Ambient belongs to one field and remembers one view's frames; it takes the size of what it is
// given, and starts anew when that changes.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <string_view>

#include "runtime/gpu/commands.h"
#include "shaders/shared.h"

namespace fw {

/// Clip depth runs from 0 (near) to 1 (far), y downwards.
struct CameraView {
    glm::mat4 viewProjection{1.0f}, inverseViewProjection{1.0f};
    glm::vec3 eye{0.0f};
    bool operator==(const CameraView&) const = default;
};

struct AmbientOptions {
    float radius = 1.0f;  ///< length of a ray, metres
    float bias = 0.005f;  ///< of a ray's start off the surface, metres: about half a cell of the mesh
    int samples = 16;     ///< of the field along a ray, at most
    int raysNew = 16;     ///< of a pixel without history, 1 to 16
    int raysKept = 1;     ///< of a pixel with history
    int mostKept = 64;  ///< rays that a moving view's history counts for at most: more is smoother, and lags
    int enough = 1024;  ///< rays a pixel after which a resting view is done
    bool reproject = true;  ///< keep a history at all
    bool balance = true;    ///< share the rays of a tile among its lanes
};

struct AmbientFrame {
    const Image& depth;   ///< R32_SFLOAT, clip depth, 1 where nothing was drawn; in VK_IMAGE_LAYOUT_GENERAL
    const Image& normal;  ///< R32_UINT, octahedral (lib/octahedral.glsl); ditto
    CameraView view;
    float lipschitz = 1.0f;              ///< of the field
    const Buffer* parameters = nullptr;  ///< live ones, where the field has some
};

struct Ambient {
    AmbientOptions options;
    Pipeline tiles, trace;
    Image history[2];
    Image result;  ///< R32_SFLOAT, 1 is open; in VK_IMAGE_LAYOUT_GENERAL after drawAmbient
    Buffer view, tileList, arguments;
    CameraView before;
    uint32_t frame = 0;  ///< drawn since the last start
    int rays = 0;        ///< a pixel has had since the view came to rest
    bool hasHistory = false;
};

/// `field` is the text that answers #include "field.glsl", empty for the default field.
Ambient createAmbient(const Device& device, std::string_view field, const AmbientOptions& options);

/// Records one frame. The recording must be submitted before the next frame is recorded.
void drawAmbient(Commands& commands, Ambient& ambient, const AmbientFrame& frame);

/// What was seen or the field has changed otherwise than by the view: the history is of no use.
void forgetHistory(Ambient& ambient);

/// The view rests and has had enough rays: drawing it again would change nothing to see.
bool converged(const Ambient& ambient);

}  // namespace fw
