// Unit vectors in a word, as shaders/lib/octahedral.glsl packs them: the octahedron unfolded into a square.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

namespace fw {

uint32_t packOctahedral(glm::dvec3 vector);
glm::vec3 unpackOctahedral(uint32_t word);

}  // namespace fw
