#include "runtime/mesh/octahedral.h"

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>

namespace fw {

namespace {

/// The two fractions of a word, times 32767.
float firstOf(uint32_t word) { return float(int16_t(word & 0xffff)); }
float secondOf(uint32_t word) { return float(int16_t(word >> 16)); }

/// Of these fractions, times 32767, the unit vector. Of choices and no branches, so that a loop becomes
/// vectors.
void unfold(float& x, float& y, float& z) {
    float a = x / 32767.0f, b = y / 32767.0f;
    a = a < -1.0f ? -1.0f : a, b = b < -1.0f ? -1.0f : b;
    const float c = 1.0f - std::abs(a) - std::abs(b);
    const float fold = c < 0.0f ? -c : 0.0f;
    a += a < 0 ? fold : -fold, b += b < 0 ? fold : -fold;
    const float length = std::sqrt(a * a + b * b + c * c);
    x = a / length, y = b / length, z = c / length;
}

}  // namespace

uint32_t packOctahedral(glm::dvec3 n) {
    n /= std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
    const glm::dvec2 folded(n.z >= 0 ? n.x : std::copysign(1 - std::abs(n.y), n.x),
                            n.z >= 0 ? n.y : std::copysign(1 - std::abs(n.x), n.y));
    const auto fraction = [](double x) { return uint32_t(uint16_t(int16_t(std::lround(x * 32767)))); };
    return fraction(folded.x) | fraction(folded.y) << 16;
}

glm::vec3 unpackOctahedral(uint32_t word) {
    glm::vec3 n(firstOf(word), secondOf(word), 0.0f);
    unfold(n.x, n.y, n.z);
    return n;
}

void unpackNormals(std::span<const gpu::MeshVertex> vertices, std::span<glm::vec3> normals) {
    // Axis by axis: vectors are made of numbers that lie one behind the other.
    constexpr std::size_t kTogether = 256;
    float x[kTogether], y[kTogether], z[kTogether];
    for (std::size_t first = 0; first < vertices.size(); first += kTogether) {
        const std::size_t count = std::min(kTogether, vertices.size() - first);
        for (std::size_t i = 0; i < count; ++i) {
            x[i] = firstOf(vertices[first + i].normal);
            y[i] = secondOf(vertices[first + i].normal);
        }
        for (std::size_t i = 0; i < count; ++i) unfold(x[i], y[i], z[i]);
        for (std::size_t i = 0; i < count; ++i) normals[first + i] = {x[i], y[i], z[i]};
    }
}

}  // namespace fw
