#include "runtime/mesh/octahedral.h"

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>

namespace fw {

uint32_t packOctahedral(glm::dvec3 n) {
    n /= std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
    const glm::dvec2 folded(n.z >= 0 ? n.x : std::copysign(1 - std::abs(n.y), n.x),
                            n.z >= 0 ? n.y : std::copysign(1 - std::abs(n.x), n.y));
    const auto fraction = [](double x) { return uint32_t(uint16_t(int16_t(std::lround(x * 32767)))); };
    return fraction(folded.x) | fraction(folded.y) << 16;
}

glm::vec3 unpackOctahedral(uint32_t word) {
    auto fraction = [](uint32_t bits) { return std::max(float(int16_t(bits & 0xffff)) / 32767.0f, -1.0f); };
    glm::vec3 n(fraction(word), fraction(word >> 16), 0.0f);
    n.z = 1.0f - std::abs(n.x) - std::abs(n.y);
    float fold = std::max(-n.z, 0.0f);
    n.x += n.x < 0 ? fold : -fold;
    n.y += n.y < 0 ? fold : -fold;
    return n / std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
}

}  // namespace fw
