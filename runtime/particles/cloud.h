// Particles on the device, for what draws them.
//
// Lifetime: belongs to the simulation that the buffer is of, until that takes its next step.
#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>

#include "runtime/gpu/resources.h"

namespace fw {

struct ParticleCloud {
    const Buffer* places = nullptr;  ///< four floats each, of which three are the place; NaN: there is none
    const Buffer* velocities = nullptr;  ///< ditto, metres per second; null: they rest
    uint32_t slots = 0;
    float radius = 0.0f;      ///< of the surface about a particle alone, metres
    glm::mat4 toWorld{1.0f};  ///< affine: from where particles are simulated to where their field is
};

}  // namespace fw
