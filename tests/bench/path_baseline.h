// The plain C++ program that whole paths of light are measured against: the same estimator as
// shaders/render/path.comp of an opaque solid under a sky with a sun, of one field and one material that are
// compiled in, on two threads.
//
// Written as a competent programmer would on a first day: a path after the other, glm's vectors, no
// intrinsics; the compiler has -O3 -march=native. Its normals are differences of four samples. Pixels without
// surface end after the region's box is missed, as there.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace fw::bench {

struct PathBaseline {
    glm::ivec2 size;                    ///< pixels
    glm::vec3 eye, forward, right, up;  ///< of the view: shaders/render/render.h
    glm::vec3 zenith, horizon, below;   ///< of the sky
    glm::vec3 sun, sunLight;            ///< towards it; irradiance
    float sunWide;                      ///< how much the cosine of its edge is less than 1
    glm::vec3 base;                     ///< of the material
    float roughness, radius;            ///< of that; of the solid, metres
    int bounces;
};

struct PathBaselineResult {
    double milliseconds = 0;
    glm::dvec3 mean{};  ///< radiance of the picture
};

/// So many paths of each pixel, of the tower.
PathBaselineResult tracePaths(const PathBaseline& scene, int paths);

}  // namespace fw::bench
