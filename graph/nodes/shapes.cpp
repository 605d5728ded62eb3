// Solids: the exact and bounding distance functions of the field.
#include "graph/nodes/inputs.h"

namespace fw {

std::vector<NodeType> shapeNodes() {
    return {
        {.id = "sphere",
         .label = "Sphere",
         .category = Category::shape,
         .doc = "A ball centred at the origin.",
         .inputs = {positionInput(), length("radius", 1, "Distance from the centre to the surface.")},
         .outputs = {{"surface", Type::surface}},
         .exactness = always(kExact),
         .body = "return length(p) - radius;",
         .aliases = {"ball"}},
        {.id = "box",
         .label = "Box",
         .category = Category::shape,
         .doc = "A box centred at the origin, its edges rounded if wished.",
         .inputs = {positionInput(),
                    lengths("half_extents", {1, 1, 1}, "Half the size along x, y and z, rounding included."),
                    length("rounding", 0,
                           "Radius of the rounded edges; at most the smallest half size is used.")},
         .outputs = {{"surface", Type::surface}},
         .exactness = always(kExact),
         .body = R"(
float r = min(rounding, min(half_extents.x, half_extents.y, half_extents.z));
vec3 q = abs(p) - (half_extents - r);
return length(max(q, 0.0)) + min(max(q.x, q.y, q.z), 0.0) - r;)",
         .aliases = {"cube", "cuboid"}},
    };
}

}  // namespace fw
