// Booleans and blends of two surfaces.
#include "graph/nodes/inputs.h"

namespace fw {

std::vector<NodeType> combineNodes() {
    const std::vector<InputSpec> inputs = {
        surfaceInput("a", "The first surface."),
        surfaceInput("b", "The second surface."),
        length("radius", 0, "Width of the blend where the two meet; 0 keeps the edge sharp."),
        choice("profile", {"round", "chamfer", "stairs"}, "Cross-section of the blend."),
        integer("steps", 4, 1, 64, "Number of steps of the stairs profile."),
    };
    return {
        {.id = "union",
         .label = "Union",
         .category = Category::combine,
         .doc = "Both surfaces together.",
         .inputs = inputs,
         .outputs = {{"surface", Type::surface}},
         .exactness = always(kBound),
         .body = "return with_distance(a.distance < b.distance ? a : b, min(a.distance, b.distance));"},
        {.id = "subtract",
         .label = "Subtract",
         .category = Category::combine,
         .doc = "The first surface with the second cut out of it.",
         .inputs = inputs,
         .outputs = {{"surface", Type::surface}},
         .exactness = always(kBound),
         .body = "return with_distance(a, max(a.distance, -b.distance));"},
    };
}

}  // namespace fw
