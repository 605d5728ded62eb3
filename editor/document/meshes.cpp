#include "editor/document/meshes.h"

#include "editor/document/layout.h"
#include "editor/document/wiring.h"

namespace fw::editor {

namespace {

constexpr double kBetween = 60.0, kBelow = 40.0;  // canvas units: the nodes of a pair, one pair and the next

/// The graph with the surface at its output, if that has neither a surface nor a mesh yet.
Graph shownAtFreeOutput(const Graph& graph, const Plug& surface) {
    const Wiring wiring(graph, "");
    for (const Node& node : graph.nodes) {
        const Plug input{node.id, "surface"};
        if (roleOf(node.type) == NodeRole::output && !wiring.source(input) &&
            !wiring.source({node.id, "mesh"}) && wiring.refusal(surface, input).empty())
            return connect(graph, "", surface, input);
    }
    return graph;
}

}  // namespace

Position sizeOfMeshPairs(std::size_t count) {
    const std::size_t rows = findNodeType("mesh_to_field")->inputs.size() + 1;  // of the higher node
    const double high = kTitleHeight + double(rows) * kRowHeight + kFoot;
    return {2 * kNodeWidth + kBetween, double(count) * (high + kBelow) - kBelow};
}

Edited addMeshes(const Graph& graph, std::string_view scope, std::span<const std::string> paths,
                 Position at) {
    Edited all{graph, {}};
    for (const std::string& path : paths) {
        const Edited file = addNode(all.graph, scope, "mesh_file", at);
        const Edited both =
            addNode(file.graph, scope, "mesh_to_field", {at[0] + kNodeWidth + kBetween, at[1]});
        if (file.nodes.empty() || both.nodes.empty()) break;
        const std::string &from = file.nodes[0], &to = both.nodes[0];
        all.graph = connect(setInput(both.graph, scope, {from, "path"}, InputValue{.value = path}), scope,
                            {from, "mesh"}, {to, "mesh"});
        if (scope.empty() && all.nodes.empty()) all.graph = shownAtFreeOutput(all.graph, {to, "surface"});
        all.nodes.insert(all.nodes.end(), {from, to});
        at[1] += sizeOfMeshPairs(2)[1] - sizeOfMeshPairs(1)[1];
    }
    return all;
}

}  // namespace fw::editor
