// Flat shapes, endless along z, and the two nodes that make solids of them.
#include "graph/nodes/inputs.h"

namespace fw {

std::vector<NodeType> shape2dNodes() {
    return {
        {.id = "circle",
         .label = "Circle",
         .category = Category::shape2d,
         .doc = "A disc in the xy plane, centred at the origin.",
         .inputs = {positionInput(), length("radius", 0.5, "Distance from the centre to the rim.")},
         .outputs = {{"surface", Type::surface}},
         .exactness = always(kExact),
         .body = "return length(p.xy) - radius;"},
    };
}

}  // namespace fw
