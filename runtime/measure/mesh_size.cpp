#include "runtime/measure/mesh_size.h"

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "graph/base/parallel.h"
#include "graph/base/words.h"

namespace fw {

std::array<double, 3> MeshSize::extent() const {
    return {boundsMax[0] - boundsMin[0], boundsMax[1] - boundsMin[1], boundsMax[2] - boundsMin[2]};
}

MeshSize sizeOf(std::span<const glm::vec3> positions, std::span<const uint32_t> indices) {
    constexpr std::size_t kTriangles = 65536;
    struct Part {
        double volume = 0, area = 0;
        glm::dvec3 moment{0.0};
    };
    MeshSize size;
    if (indices.empty()) return size;
    glm::dvec3 low(positions[indices[0]]), high = low;
    for (const uint32_t index : indices) {
        low = glm::min(low, glm::dvec3(positions[index]));
        high = glm::max(high, glm::dvec3(positions[index]));
    }
    // Volumes of tetrahedra to a far origin cancel; to the middle of the mesh they hardly do.
    const glm::dvec3 middle = (low + high) * 0.5;
    const std::size_t count = indices.size() / 3;
    std::vector<Part> parts((count + kTriangles - 1) / kTriangles);
    forBlocks(count, kTriangles, [&](std::size_t block, std::size_t first, std::size_t last) {
        Part& part = parts[block];
        for (std::size_t t = first; t < last; ++t) {
            const glm::dvec3 a = glm::dvec3(positions[indices[3 * t]]) - middle,
                             b = glm::dvec3(positions[indices[3 * t + 1]]) - middle,
                             c = glm::dvec3(positions[indices[3 * t + 2]]) - middle;
            const glm::dvec3 normal = glm::cross(b - a, c - a);
            const double volume = glm::dot(a, normal) / 6.0;
            part.area += glm::length(normal) * 0.5;
            part.volume += volume;
            part.moment += volume * 0.25 * (a + b + c);
        }
    });
    glm::dvec3 moment(0.0);
    for (const Part& part : parts) size.volume += part.volume, size.area += part.area, moment += part.moment;
    const glm::dvec3 off = size.volume != 0.0 ? moment / size.volume : glm::dvec3(0.0);
    for (int k = 0; k < 3; ++k) {
        const auto axis = static_cast<std::size_t>(k);
        size.boundsMin[axis] = low[k], size.boundsMax[axis] = high[k];
        size.centre[axis] = middle[k] + off[k];
    }
    return size;
}

double grams(double volume, const LengthUnit& lengths, double density) {
    return volume * std::pow(100.0 * lengths.metres, 3) * density;
}

std::vector<std::pair<std::string, std::string>> sizeRows(const MeshSize& size, const LengthUnit& lengths,
                                                          std::optional<double> density) {
    const std::string unit = " " + std::string(lengths.name);
    const auto extent = size.extent();
    std::vector<std::pair<std::string, std::string>> rows = {
        {"Size",
         shortNumber(extent[0]) + " × " + shortNumber(extent[1]) + " × " + shortNumber(extent[2]) + unit},
        {"Volume", shortNumber(size.volume) + unit + "³"},
        {"Area", shortNumber(size.area) + unit + "²"}};
    if (density) {
        const double mass = grams(size.volume, lengths, *density);
        rows.emplace_back("Mass", (std::abs(mass) < 1000.0 ? shortNumber(mass) + " g"
                                                           : shortNumber(mass / 1000.0) + " kg") +
                                      " at " + shortNumber(*density) + " g/cm³");
    }
    // What is next to nothing beside the mesh is nothing.
    const double most = std::max({extent[0], extent[1], extent[2]});
    std::string centre;
    for (const double at : size.centre)
        centre += (centre.empty() ? "" : ", ") + shortNumber(std::abs(at) < 1e-6 * most ? 0.0 : at);
    rows.emplace_back("Centre of mass", centre + unit);
    return rows;
}

}  // namespace fw
