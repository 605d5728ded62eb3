// The field's text where it has families (families.h): loops over tables in place of straight code for every
// member. In shaders that know where in space they are (FIELD_PRUNED) the loops go over lists of the members
// that matter there, in others over all. shaders/field.glsl tells the interface.
#pragma once

#include <string>

#include "graph/compile/compile.h"

namespace fw {

/// Binding (set 0) of the storage buffer with a list's first entry and length, for each place and family.
inline constexpr int kFieldHeadsBinding = 12;
/// Binding of the one with the lists: numbers of members.
inline constexpr int kFieldListsBinding = 11;
/// Binding of the texel buffer with the tables of all families, one after the other.
inline constexpr int kFieldTablesBinding = 9;

/// The functions of the distance. Expects a program with families.
std::string emitFamilies(const Program& program);

}  // namespace fw
