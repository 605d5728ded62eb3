// Where on the field's surface a texel lies.
#pragma once

#include <span>
#include <vector>

#include "graph/evaluate/tape.h"
#include "runtime/textures/texels.h"

namespace fw {

/// Of a texel's middle: on the mesh, and on the surface nearby.
struct SurfacePlace {
    uint32_t triangle;
    glm::vec3 shares;  ///< of its corners
    glm::vec3 position, normal;
    float slope;  ///< the field's there, 0 if the place is the mesh's own
};

/// Leads places of the mesh to the surface. Refers to what it is made of; serves several threads.
class SurfaceSeeker {
  public:
    /// `reach`: how far a place may go; `near`: at what distance from the surface it is there. Metres.
    SurfaceSeeker(const Mesh& mesh, const Texels& texels, const Tape& distance, float reach, float near);

    /// Of texels that have a triangle and lie near each other.
    std::vector<SurfacePlace> find(TapeMachine<float>& machine, std::span<const std::size_t> of) const;

  private:
    const Mesh& mesh;
    const Texels& texels;
    const Tape& distance;
    float reach, near;
};

}  // namespace fw
