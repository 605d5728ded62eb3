// From a Program to GLSL: the text that answers `#include "field.glsl"` in every shader.
//
// The interface and its sections are documented in shaders/field.glsl. Four meanings of one Ir are emitted:
// value, interval, value with gradient (forward mode), and the value in stages for sampling whole rows: what
// depends on z alone is computed once a plane, on x and z once a row, the rest at each y. Constants are
// literals; live parameters are globals that fieldBegin() loads once per invocation.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "graph/compile/compile.h"

namespace fw {

/// Binding (set 0) of the storage buffer with the live parameters, one float a slot.
inline constexpr int kFieldParametersBinding = 15, kFieldParametersBeforeBinding = 26;
/// Binding of the storage buffer with the words of all images, one image after the other in the order of
/// Ir::images().
inline constexpr int kFieldImagesBinding = 14;
/// Binding of the texel buffer with fieldTexels().
inline constexpr int kFieldVolumesBinding = 16;

/// The texels of all volumes and then of all outlines, each one after the other in the order of Ir::volumes()
/// and Ir::outlines(), four words each. Never empty.
std::vector<uint32_t> fieldTexels(const Ir& ir);

/// The field's text. Equal programs (by structureHash) give equal text.
std::string emitField(const Program& program);

}  // namespace fw
