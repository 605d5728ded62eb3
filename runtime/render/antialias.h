// Temporal antialiasing of a live view that moves (shaders/render/antialias.comp); at rest the picture is the
// mean of jittered frames anyway.
//
// Lifetime: an Antialias remembers one view's frames, as Ambient does.
#pragma once

#include "runtime/render/gbuffer.h"

namespace fw {

/// Places within a pixel that frames look through in turn.
inline constexpr int kAntialiasPlaces = 8;

struct Antialias {
    Pipeline mix;
    Image shown[2];  ///< RGBA16_SFLOAT: sRGB
    Image drawn;     ///< R32_UINT: the frame alone
    uint32_t current = 0;
    bool hasHistory = false;
};

/// Records the mixing of `pixels`, which were drawn of a frame with jitter, with those before; `seen` is the
/// frame's depth. Without history they are what is known of the next.
void antialias(Commands& commands, Antialias& antialias, Image& pixels, const Image& seen,
               const Buffer& frame);

}  // namespace fw
