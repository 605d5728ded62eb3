// What a surface looks like.
#include "graph/nodes/inputs.h"

namespace fw {

std::vector<NodeType> materialNodes() {
    return {
        {.id = "material",
         .label = "Material",
         .category = Category::material,
         .doc = "Gives a surface its colour and finish.",
         .inputs = {surfaceInput("surface", "The surface to paint."),
                    color("base_color", {0.8, 0.8, 0.8}, "Colour of the surface."),
                    share("roughness", 0.5, "0 is a mirror, 1 is chalk."),
                    share("metallic", 0, "0 is plastic, stone or wood; 1 is metal."),
                    color("emission", {0, 0, 0}, "Light that the surface gives off by itself.")},
         .outputs = {{"surface", Type::surface}},
         .exactness = sameAs("surface"),
         .body = "return with_material(surface, base_color, roughness, metallic, emission);"},
    };
}

}  // namespace fw
