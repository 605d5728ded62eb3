// Secondary rays: indirect light, reflections, and what is seen through solids that transmit
// (shaders/render/secondary.comp, which has the theory), one ray of each kind a
// pixel and frame, in stills four.
//
// Lifetime: a Secondary belongs to one field and remembers one view's frames, as Ambient does.
#pragma once

#include <optional>

#include "runtime/render/gbuffer.h"

namespace fw {

/// Which rays there are beside those that a field that transmits needs.
struct SecondaryKinds {
    bool bounce = false, reflections = false;
    bool lamps = false;        ///< whether what is hit is lit by lamps
    bool environment = false;  ///< the sky is a picture's
    bool operator==(const SecondaryKinds&) const = default;
};

/// What the scene needs of a field through which light passes, or not; none if nothing.
std::optional<SecondaryKinds> secondaryKinds(const Scene& scene, bool transmits);

struct Secondary {
    Pipeline trace, filter;
    SecondaryKinds kinds;  ///< of `trace`
    /// RGBA16_SFLOAT: mean radiance, and the rays that it is the mean of; as it is traced, and as it is
    /// filtered, in this frame and the one before.
    Image rawBounce, rawReflection, bounce[2], reflection[2];
    Image passed, sunlight;  ///< of a field that transmits
    uint32_t current = 0;    ///< of the two
    bool hasHistory = false;
};

/// The kernel; `field` is the text that answers #include "field.glsl".
ShaderOptions secondaryShader(std::string_view field, const SecondaryKinds& kinds);

/// Records one frame, after the shadow map and the G-buffer. `frame` is a uniform buffer of a
/// gpu::RenderFrame; `environment` has the words of Environment, if the kinds ask for it. If the commands are
/// cancelled, what it made is not to be used.
void drawSecondary(Commands& commands, Secondary& secondary, const GBuffer& gbuffer, const Image& shadowMap,
                   const Buffer& frame, const Buffer& environment, const FieldBuffers& field, bool transmits);

/// What it made, as light.comp reads it.
void addSecondary(std::vector<Descriptor>& bound, const Secondary& secondary, bool transmits);

}  // namespace fw
