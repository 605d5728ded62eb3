// Arithmetic on fields, and the expression node.
#include "graph/nodes/inputs.h"

namespace fw {

std::vector<NodeType> mathsNodes() {
    return {
        {.id = "expression",
         .label = "Expression",
         .category = Category::maths,
         .doc = "Code in the field language, with inputs that you name yourself.",
         .inputs = {},
         .outputs = {{"result", Type::surface}},
         .aliases = {"code"},
         .open = true},
    };
}

}  // namespace fw
