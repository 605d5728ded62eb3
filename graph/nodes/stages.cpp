// Stages that turn a field into triangles, and the nodes that give a graph its structure.
#include "graph/compile/compile.h"
#include "graph/compile/graph_lowering.h"
#include "graph/nodes/inputs.h"

namespace fw {

std::vector<NodeType> stageNodes() {
    const InputSpec resolution =
        integer("resolution", 128, 1, 4096, "Number of cells along the longest side of the region.");
    const InputSpec method =
        choice("method", {std::begin(kMeshMethodNames), std::end(kMeshMethodNames)},
               "How the surface is turned into triangles. Dual contouring keeps edges and corners sharp.");
    const InputSpec mesh = {.name = "mesh", .type = Type::mesh, .value = {}, .doc = "The mesh to change."};
    return {
        {.id = "polygonize",
         .label = "Polygonize",
         .category = Category::mesh,
         .doc = "Turns a surface into triangles.",
         .inputs = {surfaceInput("surface", "The surface to turn into triangles."),
                    grippedCorner(
                        {.name = "region_min",
                         .type = Type::vec3,
                         .value = {},
                         .unit = "m",
                         .doc = "Lowest corner of the region; found from the surface if not given."},
                        "region_max"),
                    grippedCorner(
                        {.name = "region_max",
                         .type = Type::vec3,
                         .value = {},
                         .unit = "m",
                         .doc = "Highest corner of the region; found from the surface if not given."},
                        "region_min"),
                    resolution, method},
         .outputs = {{"mesh", Type::mesh}},
         .lower = lowerPolygonize},
        {.id = "smooth",
         .label = "Smooth",
         .category = Category::mesh,
         .doc = "Evens out a mesh: each vertex moves toward the mean of its neighbours. Edges get round, and "
                "thin parts thinner.",
         .inputs = {mesh, integer("iterations", 1, 0, 100, "How often; more is smoother."),
                    length(
                        "spare", 0,
                        "What is as round as a ball of this radius, or rounder, stays as it is: half as much "
                        "again as a drop's radius keeps drops that have left a fluid. 0: nothing stays."),
                    length("within", 0, "The farthest that a vertex may get from where it was; 0: any way.")},
         .outputs = {{"mesh", Type::mesh}},
         .lower = lowerSmooth},
        {.id = "subdivide",
         .label = "Subdivide",
         .category = Category::mesh,
         .doc = "Makes four triangles of each, with a new vertex on every edge. Put it ahead of smooth: new "
                "vertices go to the field, and not to the old ones if these have left it.",
         .inputs = {mesh, integer("levels", 1, 0, 6, "How often; each level has four times the triangles."),
                    toggle("project", true,
                           "Move new vertices onto the field's surface, by no more than a quarter of their "
                           "edge; else they stay in its middle.")},
         .outputs = {{"mesh", Type::mesh}},
         .lower = lowerSubdivide},
        {.id = "decimate",
         .label = "Decimate",
         .category = Category::mesh,
         .doc =
             "Leaves out triangles while the mesh stays near the field, or down to a number of them. "
             "Creases stay, and borders between colours and materials are moved no farther than the error. "
             "Where the mesh is farther away from the field already it gets no farther.",
         .inputs = {mesh,
                    length(
                        "error", 0.01,
                        "The farthest that mesh and surface may be apart, as measured; 0: any, for a number "
                        "of triangles alone."),
                    integer(
                        "triangles", 0, 0, 1 << 24,
                        "End at so many triangles, unless the error ends it before; 0: leave as few as the "
                        "error allows.")},
         .outputs = {{"mesh", Type::mesh}},
         .lower = lowerDecimate},
        {.id = "drop_crumbs",
         .label = "Drop crumbs",
         .category = Category::mesh,
         .doc =
             "Leaves out small parts that hang together with nothing, as those that a curved solid cuts off "
             "the ends of a lattice.",
         .inputs = {mesh,
                    share("least", 0.05,
                          "Parts stay whose volume is at least so large a share of the largest one's; 1: "
                          "that alone.")},
         .outputs = {{"mesh", Type::mesh}},
         .lower = lowerDropCrumbs,
         .aliases = {"islands", "largest_part"}},
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
         .outputs = {},
         .lower = lowerOutput,
         .role = NodeRole::output},
        {.id = "reroute",
         .label = "Reroute",
         .category = Category::structure,
         .doc = "A bend in a wire: passes on what arrives at its input called value.",
         .inputs = {},
         .outputs = {},
         .lower = lowerReroute,
         .open = true,
         .role = NodeRole::reroute},
        {.id = "frame",
         .label = "Frame",
         .category = Category::structure,
         .doc = "A comment on the canvas, without effect on the result.",
         .inputs = {textInput("text", "", "What the comment says.")},
         .outputs = {},
         .lower = lowerNothing,
         .role = NodeRole::frame},
        {.id = "group",
         .label = "Group",
         .category = Category::structure,
         .doc = "A graph of its own used as one node.",
         .inputs = {},
         .outputs = {},
         .lower = lowerGroup,
         .open = true,
         .role = NodeRole::group},
        {.id = "group_input",
         .label = "Group input",
         .category = Category::structure,
         .doc = "What a group receives: inside the group, one output for each of its inputs.",
         .inputs = {},
         .outputs = {},
         .lower = lowerGroupInput,
         .open = true,
         .role = NodeRole::groupInput},
        {.id = "group_output",
         .label = "Group output",
         .category = Category::structure,
         .doc = "What a group gives: inside the group, one input for each of its outputs.",
         .inputs = {},
         .outputs = {},
         .lower = lowerGroupOutput,
         .open = true,
         .role = NodeRole::groupOutput},
    };
}

}  // namespace fw
