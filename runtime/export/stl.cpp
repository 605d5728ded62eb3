// Binary STL: 80 bytes of text, a count, and 50 bytes a triangle: normal, three corners, two spare bytes.
//
// The normal is that of the flat triangle; where it collapsed to a line it is zero, which readers take as
// "compute it". The text must not start with "solid": that marks the ASCII form.
#include <algorithm>
#include <array>
#include <cstring>
#include <glm/geometric.hpp>

#include "runtime/export/blocks.h"
#include "runtime/export/formats.h"

namespace fw {

void writeStlHeader(uint64_t triangles, const Placement& placement, OutputFile& file) {
    std::array<char, 80> header{};
    const std::string text = generatorName() + ", binary STL, " + placement.words();
    std::memcpy(header.data(), text.data(), std::min(text.size(), header.size()));
    file.write(header.data(), header.size());
    const auto count = static_cast<uint32_t>(triangles);
    file.write(&count, sizeof count);
}

void writeStlFacets(const Mesh& mesh, OutputFile& file) {
    constexpr std::size_t kRecord = 50;
    const auto format = [&](char* out, std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i, out += kRecord) {
            const uint32_t* corner = &mesh.indices[i * 3];
            const glm::vec3 a = mesh.positions[corner[0]], b = mesh.positions[corner[1]],
                            c = mesh.positions[corner[2]];
            // Double: the area of a sliver underflows a float, and its normal is wanted all the same.
            const glm::dvec3 area = glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a));
            const double length = glm::length(area);
            const double scale = length > 0.0 ? 1.0 / length : 0.0;
            const std::array<glm::vec3, 4> facet = {glm::vec3(area * scale), a, b, c};
            std::memcpy(out, facet.data(), 48);
            out[48] = out[49] = 0;
        }
        return out;
    };
    writeBlocks(mesh.triangleCount(), kRecord, format, file);
}

void writeStl(const Mesh& mesh, const Placement& placement, OutputFile& file) {
    writeStlHeader(mesh.triangleCount(), placement, file);
    writeStlFacets(mesh, file);
}

}  // namespace fw
