// The formulas of surfaces about particles (runtime/particles/particle_surface.h) in double, at one place
// after the other: what the device's are held against.
#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <vector>

#include "graph/compile/particle_recipe.h"

namespace fw::bench {

class SurfaceBaseline {
  public:
    /// `surface` is average or anisotropic, `drop` the radius of a particle alone, metres.
    SurfaceBaseline(std::vector<glm::vec4> places, double drop, ParticleSurface surface);
    /// The distance, metres. Where no particle is near, a length that there is none below.
    double at(const glm::dvec3& p) const;

  private:
    struct Kernel {
        glm::dvec3 centre;
        glm::dmat3 shape;
        double height;
    };
    using Bucket = std::array<int, 3>;
    using Buckets = std::map<Bucket, std::vector<std::size_t>>;
    Bucket bucketOf(const glm::dvec3& p) const;
    template <class See>
    void lookAround(const Buckets& buckets, const glm::dvec3& p, See&& see) const;
    Kernel kernelOf(const glm::dvec3& place) const;
    double averageAt(const glm::dvec3& p) const;
    double anisotropicAt(const glm::dvec3& p) const;

    std::vector<glm::vec4> places;
    double drop, reach;
    ParticleSurface surface;
    std::vector<Kernel> kernels;
    Buckets near, centres;  ///< places and kernels, by buckets as wide as the reach
};

}  // namespace fw::bench
