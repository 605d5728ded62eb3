// Nodes that move, repeat and deform the space in which a surface stands, or offset the surface itself.
#include "graph/nodes/inputs.h"

namespace fw {

std::vector<NodeType> domainNodes() {
    return {
        {.id = "translate",
         .label = "Translate",
         .category = Category::domain,
         .doc = "Moves a surface.",
         .inputs = {surfaceInput("surface", "The surface to move."),
                    place("offset", {0, 0, 0}, "How far to move along x, y and z.")},
         .outputs = {{"surface", Type::surface}},
         .exactness = sameAs("surface"),
         .body = "return surface(p - offset);",
         .aliases = {"move"}},
    };
}

}  // namespace fw
