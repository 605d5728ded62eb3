#include "runtime/mesh/joined.h"

#include <algorithm>

namespace fw {

namespace {

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
    to.insert(to.end(), from.begin(), from.end());
}

/// The parts of a mesh, one of all of it if it has none.
std::vector<MeshPart> partsOf(const Mesh& mesh) {
    if (!mesh.parts.empty()) return mesh.parts;
    return {{mesh.material, mesh.triangleCount(), mesh.materialName}};
}

}  // namespace

Mesh joined(std::span<const Mesh> meshes) {
    Mesh whole;
    const bool colored = std::ranges::any_of(meshes, [&](const Mesh& mesh) {
        return !mesh.colors.empty() || mesh.baseColor != meshes[0].baseColor;
    });
    if (!meshes.empty()) whole.baseColor = meshes[0].baseColor;
    std::vector<std::vector<uint32_t>> indices;  // of each part
    for (const Mesh& mesh : meshes) {
        const auto before = uint32_t(whole.positions.size());
        append(whole.positions, mesh.positions);
        append(whole.normals, mesh.normals);
        if (colored && mesh.colors.empty())
            whole.colors.resize(whole.positions.size(), mesh.baseColor);
        else
            append(whole.colors, mesh.colors);
        std::size_t at = 0;
        for (const MeshPart& part : partsOf(mesh)) {
            const auto same = std::ranges::find_if(whole.parts, [&](const MeshPart& known) {
                return known.material == part.material && known.name == part.name;
            });
            const auto number = std::size_t(same - whole.parts.begin());
            if (same == whole.parts.end())
                whole.parts.push_back({part.material, 0, part.name}), indices.emplace_back();
            whole.parts[number].triangles += part.triangles;
            for (const std::size_t end = at + 3 * part.triangles; at < end; ++at)
                indices[number].push_back(before + mesh.indices[at]);
        }
    }
    for (const std::vector<uint32_t>& of : indices) append(whole.indices, of);
    if (whole.parts.size() == 1) {
        whole.material = whole.parts[0].material;
        whole.materialName = whole.parts[0].name;
        whole.parts.clear();
    }
    return whole;
}

}  // namespace fw
