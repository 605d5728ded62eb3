// Structs and constants that shaders and C++ share; both include this file. Everything is laid out as scalars
// (4-byte alignment), which is what C++ does with these members and what `scalar` blocks do in GLSL.
#ifndef FW_SHARED_H
#define FW_SHARED_H

#ifdef __cplusplus
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace fw::gpu {
using uint = uint32_t;
using uvec2 = glm::uvec2;
using uvec3 = glm::uvec3;
using uvec4 = glm::uvec4;
using ivec3 = glm::ivec3;
using vec2 = glm::vec2;
using vec3 = glm::vec3;
using vec4 = glm::vec4;
#endif

#define FIELD_PARAMETERS 15  // binding of the live parameters, in every shader that includes field.glsl
#define FIELD_PARAMETERS_BEFORE 26  // of those of the frame before
#define FIELD_IMAGES \
    14  // binding of the images that the field samples, likewise; no shader has another there

#define FIELD_VOLUMES 16  // and of its volumes

#define FIELD_HEADS 12  // bindings of the lists of members that matter at a place, in shaders that prune
#define FIELD_LISTS 11
#define FIELD_TABLES 9  // binding of the members' numbers

struct DispatchArguments {
    uint x, y, z;
};

// A vertex of the mesh as the device stores it; the normal is octahedral, two 16-bit signed fractions.
struct MeshVertex {
    vec3 position;
    uint normal;
};

#ifdef __cplusplus
}  // namespace fw::gpu
#endif
#endif
