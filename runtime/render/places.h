// Pictures of fields with many members (graph/ir/families.h).
//
// A ray asks for the field at any place, near the surface and far from it, where a minimum of a thousand
// members costs all of them. So space is parted into boxes around the region (shaders/render/places.glsl),
// and for each the members are listed that can matter at some point in it, found by intervals as the mesher
// finds them for its bricks. A step of a ray then pays for its box's list, to the same bits.
//
// Lifetime: the kernel belongs to a field, the lists to a content.
#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "runtime/gpu/field_buffers.h"

namespace fw {

struct Places {
    Pipeline list;  ///< of a field with families, otherwise none
    FieldLists lists;
    Buffer listed;                    ///< uint32: entries in use
    std::optional<uint64_t> content;  ///< number of the field that the lists are of
};

/// Lists what matters in each box, for the region from `lo` to `hi`, unless the lists are of that `content`
/// already. `field` is without lists. There are families, and their kernel.
void listPlaces(Commands& commands, Places& places, const Families& families, const FieldBuffers& field,
                glm::vec3 lo, glm::vec3 hi, uint64_t content);

}  // namespace fw
