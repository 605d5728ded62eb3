// What the kernels of a field read besides the position.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "graph/ir/families.h"
#include "runtime/gpu/commands.h"

namespace fw {

/// Of a field with families (graph/ir/families.h): the members' numbers, and for each of some places in space
/// the list of those that can matter there. Whoever numbers the places writes the lists by a kernel with
/// FIELD_PRUNE; place 0 is all of space and has all members.
struct FieldLists {
    Buffer tables, heads, lists;  ///< as in shaders/field.glsl
};

/// Whether a field's text has families with lists.
bool hasFamilies(std::string_view field);

/// Entries of the longest list there can be: so many, from the start of `lists`, belong to place 0.
uint32_t longestList(const Families& families);

/// Bytes of the heads of so many places.
uint64_t headBytes(const Families& families, uint64_t places);

/// Sizes everything for so many places, 0 among them, and so many entries besides those of place 0, as far as
/// one binding can hold them: where there is no room, the longer list that a list is made from serves.
/// Writes the tables and place 0.
void reserveLists(const Device& device, FieldLists& lists, const Families& families, uint64_t places,
                  uint64_t entries);

struct FieldBuffers {
    const Buffer* parameters = nullptr;  ///< live ones, where it has some
    const Buffer* images = nullptr;      ///< that it samples, where it does
    const Buffer* volumes = nullptr;     ///< likewise
    const FieldLists* lists = nullptr;   ///< for kernels with FIELD_PRUNED, where families of it have lists
    const Buffer* before = nullptr;      ///< live parameters of the frame before; none: they are the same
};

/// Adds them to what a kernel is given.
void addField(std::vector<Descriptor>& bound, const FieldBuffers& field);

}  // namespace fw
