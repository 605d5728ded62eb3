// The grid of the talk's stages, as push constants: one text for C++ and GLSL.
#ifdef __cplusplus
#pragma once
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
namespace fw::bench {
using glm::mat4;
using glm::vec3;
using uint = uint32_t;
#endif

/// A cube of 2^levels cells a side.
struct TalkGrid {
    mat4 view;      ///< metres to clip space
    vec3 origin;    ///< of sample (0, 0, 0), metres
    float spacing;  ///< between samples, metres
    uint levels;    ///< levels of a histopyramid below its top
    uint level;     ///< the level that a reduction writes; 0 is the top
};

#ifdef __cplusplus
}
#endif
