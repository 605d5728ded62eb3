// How large a mesh is, and what it weighs.
//
// Volume and centre are sums over the tetrahedra between each triangle and the middle of the mesh's box,
// signed by which way the triangle faces, so hollows count as none: those of what is enclosed if the mesh is
// closed. Sums are taken in blocks of fixed size, in double, so that they do not depend on the number of
// threads.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "graph/library/units.h"

namespace fw {

/// In the mesh's own unit of length.
struct MeshSize {
    double volume = 0, area = 0;
    std::array<double, 3> centre{};  ///< of the volume; the middle of the box if there is none
    std::array<double, 3> boundsMin{}, boundsMax{};

    std::array<double, 3> extent() const;
};

/// `indices` are three a triangle, all below positions.size(). All zero for a mesh without triangles.
MeshSize sizeOf(std::span<const glm::vec3> positions, std::span<const uint32_t> indices);

/// Of a volume in cubes of that unit, of so many g/cm³.
double grams(double volume, const LengthUnit& lengths, double density);

/// What a person is told, name and value: "Size" "40 × 20 × 10 mm", "Volume", "Area", "Centre of mass"; with
/// a density "Mass" as well.
std::vector<std::pair<std::string, std::string>> sizeRows(const MeshSize& size, const LengthUnit& lengths,
                                                          std::optional<double> density);

}  // namespace fw
