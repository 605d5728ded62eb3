// Unit vectors in a word, as shaders/lib/octahedral.glsl packs them: the octahedron unfolded into a square.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

#include "shaders/shared.h"

namespace fw {

uint32_t packOctahedral(glm::dvec3 vector);
glm::vec3 unpackOctahedral(uint32_t word);
/// The same of many vertices' normals, to the last bit, at a fifth of the time each. `normals` has a place
/// for each.
void unpackNormals(std::span<const gpu::MeshVertex> vertices, std::span<glm::vec3> normals);

}  // namespace fw
