#include "runtime/serve/tools.h"

#include "graph/library/node_type.h"
#include "runtime/pictures/wish.h"
#include "runtime/serve/document.h"

namespace fw::serve {

namespace {

Json property(const char* type, std::string description) {
    return {{"type", type}, {"description", std::move(description)}};
}

Json pathProperty() {
    return property("string", "The graph file, from the root folder: \"lamp.field.json\"");
}

Json valuesProperty() {
    return property("object",
                    "Values of the graph's exposed parameters for this call alone, by their names: "
                    "{\"radius\": 0.5, \"size\": [1, 2, 1]}");
}

Json timeProperty() { return property("number", "Seconds at which the graph is evaluated; 0 by default"); }

Json resolutionProperty() {
    Json json = property("integer",
                         "Cells along the longest side; what is thinner than a cell is lost. By default the "
                         "output node's, else 128");
    json["minimum"] = 1, json["maximum"] = kMostServedResolution;
    return json;
}

Json tool(const char* name, const char* title, std::string description, Json properties,
          std::vector<std::string> required, bool readOnly) {
    Json schema = {{"type", "object"}, {"properties", std::move(properties)}};
    if (!required.empty()) schema["required"] = required;
    schema["additionalProperties"] = false;
    return {
        {"name", name},
        {"title", title},
        {"description", std::move(description)},
        {"inputSchema", std::move(schema)},
        {"annotations", {{"readOnlyHint", readOnly}, {"destructiveHint", false}, {"openWorldHint", false}}}};
}

}  // namespace

std::string assistantInstructions() {
    return R"(Fieldwright makes solids from graphs of signed distance fields: negative inside, positive outside. A graph is a JSON file whose name ends in .field.json:

{"fieldwright": 1, "unit": "mm",
 "nodes": [
  {"id": "body", "type": "box", "inputs": {"half_extents": [20, 10, 20], "rounding": 2}},
  {"id": "hole", "type": "cylinder", "inputs": {"radius": 6, "half_height": 30}},
  {"id": "part", "type": "subtract", "inputs": {"a": {"from": "body"}, "b": {"from": "hole"}}},
  {"id": "painted", "type": "material", "inputs": {"surface": {"from": "part"}, "base_color": [0.8, 0.2, 0.1]}},
  {"id": "out", "type": "output", "inputs": {"surface": {"from": "painted"}, "resolution": 128}}],
 "parameters": [{"name": "hole", "node": "hole", "input": "radius", "min": 1, "max": 9}]}

- Node ids are [a-z][a-z0-9_]*. An input is a number, true or false, a text, an array ([x, y, z]), or a link {"from": "node"}, with "output" where a node has several.
- There is one node of type output; what it shows is the solid. Inputs that are left out have their defaults.
- +Y is up. Lengths are in "unit" (m if it is left out), angles in degrees. Most shapes stand about the origin: move them by translate, turn them by rotate.
- Node types and names of inputs must be those of list_nodes and node_help: ask before you use one for the first time.
- An expression node computes its own field: {"type": "expression", "inputs": {"k": 2}, "code": "return length(p) - k;"}, with p the position.

Go about it so: list_nodes, then node_help for those you need; write_graph; mend what it finds; look, from several sides, and compare with what was wanted; measure; then export. Work in small steps, and look after each.)";
}

Json toolsJson() {
    Json tools = Json::array();
    Json category = property("string", "Only this category; all if it is left out");
    for (int i = 0; i < kCategories; ++i) category["enum"].push_back(categoryName(Category(i)));
    tools.push_back(tool("list_nodes", "List the node types",
                         "The types of nodes that a graph can have, by category, each with one sentence. Ask "
                         "node_help for the inputs of those you want.",
                         {{"category", category}}, {}, true));
    tools.push_back(
        tool("node_help", "Explain node types",
             "All about some node types: their inputs with type, default, unit and range, what they "
             "give, and how far their distance can be trusted.",
             {{"types",
               {{"type", "array"},
                {"items", {{"type", "string"}}},
                {"description", "Types as list_nodes has them: [\"box\", \"smooth_union\"]"}}}},
             {"types"}, true));
    tools.push_back(tool("write_graph", "Write a graph file",
                         "Writes a graph file, in place of one of that name, and says all that is wrong with "
                         "it, with node, input "
                         "and remedy. What is no JSON, or no graph, is not written. The user's editor shows "
                         "the file as it changes.",
                         {{"path", pathProperty()},
                          {"graph",
                           {{"type", Json::array({"object", "string"})},
                            {"description", "The graph: the JSON object, or its text"}}}},
                         {"path", "graph"}, false));
    tools.push_back(
        tool("check_graph", "Check a graph file",
             "All that is wrong with a graph file, or could be better: errors and warnings with node, input, "
             "line and remedy; and its exposed parameters.",
             {{"path", pathProperty()}}, {"path"}, true));
    Json look = {{"path", pathProperty()},
                 {"from",
                  {{"type", "string"},
                   {"enum", {"three_quarters", "front", "back", "left", "right", "top", "bottom"}},
                   {"description",
                    "Where it is seen from, all of it in the picture: front is from +z, right from +x, "
                    "top from +y. By default from three quarters, or by the scene's camera"}}},
                 {"camera", property("object",
                                     "In place of \"from\": {\"position\": [x, y, z], \"target\": [x, y, z], "
                                     "\"fov\": 30}")},
                 {"view",
                  {{"type", "string"},
                   {"enum", renderViews()},
                   {"description",
                    "picture, or a look inside: slice shows the field on a plane with lines of equal "
                    "distance, thickness how thin walls are, normals and cells the mesh"}}},
                 {"values", valuesProperty()},
                 {"time", timeProperty()},
                 {"width", property("integer", "Pixels, 640 by default, at most 1024")},
                 {"height", property("integer", "Pixels, 480 by default, at most 1024")},
                 {"resolution", resolutionProperty()}};
    tools.push_back(
        tool("look", "Look at a graph",
             "A picture of the solid. Look from several sides, and close, before you say that it is done.",
             std::move(look), {"path"}, true));
    tools.push_back(
        tool("measure", "Measure a graph's solid",
             "Size, volume, area, mass where there is a density, thinnest walls and gaps, number of "
             "separate parts and of holes through it, and whether the mesh is one closed solid that can "
             "be printed. Lengths are in the graph's unit.",
             {{"path", pathProperty()},
              {"values", valuesProperty()},
              {"time", timeProperty()},
              {"resolution", resolutionProperty()}},
             {"path"}, true));
    tools.push_back(
        tool("export", "Export a mesh",
             "Writes the solid as a mesh file below the root; the ending says the format: .glb .gltf .obj "
             ".stl .ply .3mf .vdb. For 3D printing .3mf or .stl with \"for\": \"print\".",
             {{"path", pathProperty()},
              {"output", property("string", "The mesh file: \"lamp.glb\"")},
              {"values", valuesProperty()},
              {"time", timeProperty()},
              {"resolution", resolutionProperty()},
              {"for", {{"type", "string"}, {"enum", {"print"}}, {"description", "Millimetres, +Z up"}}}},
             {"path", "output"}, false));
    return tools;
}

}  // namespace fw::serve
