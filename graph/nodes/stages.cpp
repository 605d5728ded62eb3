// Stages that turn a field into triangles, and the nodes that give a graph its structure.
#include "graph/compile.h"
#include "graph/nodes/inputs.h"

namespace fw {

std::vector<NodeType> stageNodes() {
    const InputSpec resolution =
        integer("resolution", 128, 1, 4096, "Number of cells along the longest side of the region.");
    const InputSpec method =
        choice("method", {std::begin(kMeshMethodNames), std::end(kMeshMethodNames)},
               "How the surface is turned into triangles. Dual contouring keeps edges and corners sharp.");
    return {
        {.id = "polygonize",
         .label = "Polygonize",
         .category = Category::mesh,
         .doc = "Turns a surface into triangles.",
         .inputs = {surfaceInput("surface", "The surface to turn into triangles."),
                    {.name = "region_min",
                     .type = Type::vec3,
                     .value = {},
                     .unit = "m",
                     .doc = "Lowest corner of the region; found from the surface if not given."},
                    {.name = "region_max",
                     .type = Type::vec3,
                     .value = {},
                     .unit = "m",
                     .doc = "Highest corner of the region; found from the surface if not given."},
                    resolution,
                    method},
         .outputs = {{"mesh", Type::mesh}}},
        {.id = "output",
         .label = "Output",
         .category = Category::mesh,
         .doc = "What is seen, played and exported.",
         .inputs = {surfaceInput("surface", "The finished surface, unless a mesh is given."),
                    {.name = "mesh",
                     .type = Type::mesh,
                     .value = {},
                     .doc =
                         "The finished mesh, in place of a surface; resolution and method are then its own."},
                    resolution,
                    method},
         .outputs = {}},
        {.id = "reroute",
         .label = "Reroute",
         .category = Category::structure,
         .doc = "A bend in a wire: passes on what arrives at its input called value.",
         .inputs = {},
         .outputs = {},
         .open = true},
        {.id = "frame",
         .label = "Frame",
         .category = Category::structure,
         .doc = "A comment on the canvas, without effect on the result.",
         .inputs = {textInput("text", "", "What the comment says.")},
         .outputs = {}},
        {.id = "group",
         .label = "Group",
         .category = Category::structure,
         .doc = "A graph of its own used as one node.",
         .inputs = {},
         .outputs = {},
         .open = true},
        {.id = "group_input",
         .label = "Group input",
         .category = Category::structure,
         .doc = "What a group receives: inside the group, one output for each of its inputs.",
         .inputs = {},
         .outputs = {},
         .open = true},
        {.id = "group_output",
         .label = "Group output",
         .category = Category::structure,
         .doc = "What a group gives: inside the group, one input for each of its outputs.",
         .inputs = {},
         .outputs = {},
         .open = true},
    };
}

}  // namespace fw
