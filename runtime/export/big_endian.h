// Numbers that have their high byte first.
#pragma once

#include <bit>
#include <cstdint>
#include <glm/vec3.hpp>
#include <initializer_list>
#include <string>

namespace fw {

inline char* putBig(char* out, uint32_t word) {
    for (int shift = 24; shift >= 0; shift -= 8) *out++ = static_cast<char>(word >> shift);
    return out;
}
inline char* putBig(char* out, float number) { return putBig(out, std::bit_cast<uint32_t>(number)); }
inline char* putBig(char* out, const glm::vec3& vector) {
    for (int k = 0; k < 3; ++k) out = putBig(out, vector[k]);
    return out;
}

inline std::string big(std::initializer_list<uint32_t> words) {
    std::string bytes(4 * words.size(), '\0');
    char* out = bytes.data();
    for (const uint32_t word : words) out = putBig(out, word);
    return bytes;
}

}  // namespace fw
