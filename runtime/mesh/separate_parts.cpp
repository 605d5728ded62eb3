#include "runtime/mesh/separate_parts.h"

#include <cstdint>

#include "runtime/mesh/joined_sets.h"

namespace fw {

std::vector<Mesh> separateParts(const Mesh& mesh) {
    JoinedSets sets(mesh.positions.size());
    joinPlaces(mesh.positions, sets);
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
        for (std::size_t k = 1; k < 3; ++k) sets.join(mesh.indices[i], mesh.indices[i + k]);

    constexpr uint32_t kNone = ~0u;
    std::vector<Mesh> separate;
    std::vector<uint32_t> part(mesh.positions.size(), kNone), place(mesh.positions.size(), kNone);
    const auto partOf = [&](uint32_t vertex) -> Mesh& {
        uint32_t& number = part[sets.root(vertex)];
        if (number == kNone) {
            number = uint32_t(separate.size());
            separate.emplace_back();
            separate.back().baseColor = mesh.baseColor;
            separate.back().material = mesh.material;
            separate.back().materialName = mesh.materialName;
            separate.back().textures = mesh.textures;
        }
        return separate[number];
    };
    const auto addCorner = [&](Mesh& to, uint32_t vertex) {
        if (place[vertex] == kNone) {
            place[vertex] = uint32_t(to.positions.size());
            to.positions.push_back(mesh.positions[vertex]);
            if (!mesh.normals.empty()) to.normals.push_back(mesh.normals[vertex]);
            if (!mesh.colors.empty()) to.colors.push_back(mesh.colors[vertex]);
            if (!mesh.uvs.empty()) to.uvs.push_back(mesh.uvs[vertex]);
            if (!mesh.tangents.empty()) to.tangents.push_back(mesh.tangents[vertex]);
        }
        to.indices.push_back(place[vertex]);
    };
    std::size_t triangle = 0;
    const auto addTriangles = [&](std::size_t end, const MeshPart* of) {
        for (; triangle < end; ++triangle) {
            Mesh& to = partOf(mesh.indices[3 * triangle]);
            for (std::size_t k = 0; k < 3; ++k) addCorner(to, mesh.indices[3 * triangle + k]);
            if (!of) continue;
            if (to.parts.empty() || to.parts.back().name != of->name ||
                !(to.parts.back().material == of->material))
                to.parts.push_back({of->material, 0, of->name});
            ++to.parts.back().triangles;
        }
    };
    if (mesh.parts.empty()) addTriangles(mesh.triangleCount(), nullptr);
    for (const MeshPart& of : mesh.parts) addTriangles(triangle + of.triangles, &of);
    for (Mesh& one : separate)
        if (one.parts.size() == 1) {
            one.material = one.parts[0].material;
            one.materialName = one.parts[0].name;
            one.parts.clear();
        }
    return separate;
}

}  // namespace fw
