// libFuzzer: the first byte says the format, the others are read as a mesh file. What is read must be whole;
// what is refused must be refused with a reason.
//
//   cmake --preset fuzz && cmake --build --preset fuzz --target fuzz_mesh
//   build/fuzz/fuzz_mesh -max_total_time=60 -max_len=4096 -dict=tests/fuzz/mesh.dict CORPUS tests/fuzz/mesh

#include <cmath>
#include <cstdint>

#include "graph/assets/triangle_mesh.h"
#include "tests/fuzz/require.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) {
    constexpr const char* kNames[] = {"a.gltf", "a.glb", "a.obj", "a.stl", "a.ply"};
    if (size == 0) return 0;
    const std::string name = kNames[data[0] % 5];
    const std::string bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
    const fw::Result<fw::TriangleMesh> mesh = fw::parseTriangleMesh({bytes, name, "/nowhere/" + name});
    if (!mesh) {
        require(mesh.error().message.starts_with("the mesh '" + name + "' "), "a refusal names the file");
        return 0;
    }
    require(!mesh->indices.empty() && mesh->indices.size() % 3 == 0, "there are triangles");
    require(mesh->colors.empty() || mesh->colors.size() == mesh->positions.size(),
            "each vertex has a colour");
    for (uint32_t index : mesh->indices) require(index < mesh->positions.size(), "indices are in range");
    for (const glm::vec3& p : mesh->positions)
        require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z), "places are finite");
    for (const glm::vec3& color : mesh->colors)
        for (int k = 0; k < 3; ++k) require(color[k] >= 0 && color[k] <= 1, "colours are between 0 and 1");
    return 0;
}
