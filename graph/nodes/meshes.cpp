// Triangle meshes made elsewhere, and the fields that are made of them.
#include "graph/assets/mesh_field.h"
#include "graph/compile/graph_lowering.h"
#include "graph/nodes/inputs.h"

namespace fw {

std::vector<NodeType> meshNodes() {
    return {
        {.id = "mesh_file",
         .label = "Mesh file",
         .category = Category::mesh,
         .doc = "Reads a triangle mesh from a file in the folder of the graph's file or in one below it. A "
                "changed file is read again.",
         .inputs = {fileInput("path", kMeshFile)},
         .outputs = {{"mesh", Type::mesh}},
         .lower = lowerMeshFile,
         .aliases = {"import", "model"}},
        {.id = "mesh_to_field",
         .label = "Mesh to field",
         .category = Category::mesh,
         .doc = "Makes a solid of a triangle mesh, for booleans and everything else that works on surfaces. "
                "Distances to "
                "the mesh are measured on a grid, once. The mesh's colours, if it has some, become the "
                "material's.",
         .inputs =
             {positionInput(),
              {.name = "mesh", .type = Type::mesh, .value = {}, .doc = "The mesh: that of a mesh_file."},
              integer("resolution", 64, kLeastFieldResolution, kMostFieldResolution,
                      "Samples along the grid's longest side. What is thinner than two or three of its cells "
                      "gets "
                      "holes."),
              length("margin", 0.0,
                     "How far around the mesh distances are measured. Beyond, they are bounds: right at the "
                     "grid, and then rather too small."),
              choice("sampling", {"tricubic", "trilinear"},
                     "How values between samples are found. Tricubic is smooth."),
              choice(
                  "inside", {std::begin(kMeshInsideNames), std::end(kMeshInsideNames)},
                  "How the inside is found. Automatic goes by normals where the mesh is closed, and else by "
                  "the winding number, which also closes holes. With none there is only the distance to the "
                  "triangles: for sheets that an offset makes thick.")},
         .outputs = {{"surface", Type::surface}},
         .lower = lowerMeshToField,
         .aliases = {"voxelize", "bake"}},
    };
}

}  // namespace fw
