// What is in a GLB, from its bytes.
#pragma once

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace fw::test {

inline nlohmann::json jsonOfGlb(const std::string& glb) {
    uint32_t length = 0;
    std::memcpy(&length, glb.data() + 12, 4);
    return nlohmann::json::parse(glb.substr(20, length));
}

/// The floats of an accessor of a GLB whose buffers are not interleaved.
inline std::vector<float> floatsOf(const std::string& glb, const nlohmann::json& document,
                                   std::size_t accessor) {
    uint32_t length = 0;
    std::memcpy(&length, glb.data() + 12, 4);
    const nlohmann::json& of = document["accessors"][accessor];
    const nlohmann::json& view = document["bufferViews"][of["bufferView"].get<std::size_t>()];
    const std::size_t parts = of["type"] == "VEC4" ? 4 : of["type"] == "VEC3" ? 3 : 1;
    std::vector<float> values(parts * of["count"].get<std::size_t>());
    std::memcpy(values.data(),
                glb.data() + 28 + length + view.value("byteOffset", 0u) + of.value("byteOffset", 0u),
                values.size() * sizeof(float));
    return values;
}

}  // namespace fw::test
