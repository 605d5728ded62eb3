// Ambient occlusion traced through the field, with a history.
//
// After Matt Swoboda's "Advanced Procedural Rendering in DirectX 11" (GDC 2012), Illumination;
// shaders/render/ambient.comp says what it does and where it deviates. It needs the G-buffer of this frame
// and of the one before, and gives for each pixel the part of the hemisphere, weighted by the cosine, from
// which rays up to `radius` long are open.
//
// Lifetime: an Ambient belongs to one field and remembers one view's frames.
#pragma once

#include "runtime/render/gbuffer.h"

namespace fw {

struct AmbientOptions {
    float radius = 1.0f;    ///< length of a ray, metres
    float bias = 0.005f;    ///< of a ray's start off the surface, metres: about half a cell of the mesh
    int samples = 16;       ///< of the field along a ray, at most, 2 or more
    int samplesMoving = 8;  ///< ditto while the view moves
    int raysNew = 16;       ///< of a pixel without history, 1 to RENDER_MOST_RAYS
    int raysKept = 1;       ///< of a pixel with history
    int raysResting = 1;    ///< of a pixel with history while the view rests
    int mostKept = 64;  ///< rays that a moving view's history counts for at most: more is smoother, and lags
    int enough = 1024;  ///< rays a pixel after which a resting view is done
    bool reproject = true;  ///< keep a history at all
    bool balance = true;    ///< share the rays of pixels without history among all lanes
};

struct Ambient {
    AmbientOptions options;
    Pipeline trace, addRays;
    Image history[2];  ///< R32_UINT: openness in the lower 16 bits, the rays that it stands for above
    uint32_t current = 0;
    Buffer holes, holeCount;  ///< pixels without history, 4 bytes each; gpu::AmbientHoles
    int rays = 0;             ///< a pixel has had since the view came to rest
    bool hasHistory = false;

    const Image& now() const { return history[current]; }
};

/// `field` is the text that answers #include "field.glsl", empty for the default field.
Ambient createAmbient(const Device& device, std::string_view field, const AmbientOptions& options);
/// Without the pipelines.
Ambient createAmbient(const Device& device);

/// Fills in what ambient occlusion is told of a frame; `resting` is already set, as is the number.
void describeAmbient(const Ambient& ambient, gpu::RenderFrame& frame);

/// Records one frame. `described` is what the buffer `frame` holds. Before the first frame, and whenever
/// `anew`, nothing is kept. If the commands are cancelled, now() is not to be used.
void drawAmbient(Commands& commands, Ambient& ambient, const GBuffer& gbuffer,
                 const gpu::RenderFrame& described, const Buffer& frame, const FieldBuffers& field);

/// Images for the history of a frame that is drawn without ambient occlusion.
void resizeHistory(Commands& commands, Ambient& ambient, VkExtent3D extent);

/// What was seen or the field has changed otherwise than by the view: the history is of no use.
void forgetHistory(Ambient& ambient);

/// The view rests and has had enough rays: drawing it again would change nothing to see.
bool converged(const Ambient& ambient);

}  // namespace fw
