// Sources of values that may vary over space and time, and the bridges between numbers and surfaces.
#include "graph/nodes/inputs.h"

namespace fw {

std::vector<NodeType> fieldNodes() {
    return {
        {.id = "position",
         .label = "Position",
         .category = Category::field,
         .doc = "The place at which the graph is being evaluated.",
         .inputs = {},
         .outputs = {{"position", Type::vec3}},
         .body = "return p;"},
        {.id = "value",
         .label = "Value",
         .category = Category::field,
         .doc = "A number to share between several nodes.",
         .inputs = {scalar("value", 0, "The number.")},
         .outputs = {{"value", Type::scalar}},
         .body = "return value;"},
    };
}

}  // namespace fw
