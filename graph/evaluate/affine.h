// Affine maps of space, which is what nodes that move, turn and scale do to the position of the fields before
// them.
#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>

#include "graph/ir/ir.h"

namespace fw {

/// p becomes linear * p + offset.
struct Affine {
    glm::dmat3 linear{1.0};
    glm::dvec3 offset{0.0};
};

/// The map from the position to three values, with `parameters` in their slots; none if one of the values is
/// not built as an affine function of the position, or if the map has no inverse.
std::optional<Affine> affineOf(const Ir& ir, const std::array<IrId, 3>& values,
                               std::span<const double> parameters);

/// The map back. Requires one that affineOf() found.
Affine inverse(const Affine& map);

}  // namespace fw
