// An environment map on the device (shaders/render/environment.glsl): sharp, halved again and again, and as
// mirrors of some roughness and matt surfaces see it; with how bright it is where, for paths of light to look
// there (Pharr, Jakob and Humphreys, "Physically Based Rendering", 2016, 14.2.4).
//
// Lifetime: an Environment belongs to a device and has one map at a time.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <vector>

#include "graph/assets/environment.h"
#include "graph/document/scene.h"
#include "runtime/gpu/resources.h"
#include "shaders/shared.h"
// after shared.h
#include "shaders/render/render.h"

namespace fw {

struct Environment {
    EnvironmentMapPtr map;  ///< none: there is no sky's picture
    Buffer words;
    std::vector<gpu::SkyLevel> levels;  ///< the last one is that of matt surfaces
    float scale = 1.0f;                 ///< that the words' numbers are to be multiplied by
    uint32_t chances = 0, columns = 0, rows = 0;
    std::array<glm::vec3, 3> matt{};  ///< what matt surfaces get that face up, sideways and down
};

/// Makes it that of `map`, unless it is.
void useEnvironment(const Device& device, Environment& environment, const EnvironmentMapPtr& map);

/// Writes into the frame what the shaders need of it, and the colours of the sky that it has about.
void describeEnvironment(const Environment& environment, const Sky& sky, gpu::RenderFrame& frame);

}  // namespace fw
