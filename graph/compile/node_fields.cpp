#include "graph/compile/node_fields.h"

#include <algorithm>

#include "graph/compile/graph_lowering.h"
#include "graph/compile/mesh_recipe.h"
#include "graph/rules/structure.h"

namespace fw {

const std::vector<Node>* nodesInScope(const Graph& graph, std::string_view prefix) {
    const std::vector<Node>* nodes = &graph.nodes;
    for (std::size_t slash = prefix.find('/'); slash != std::string_view::npos; slash = prefix.find('/')) {
        const Node* instance = findNode(*nodes, std::string(prefix.substr(0, slash)));
        const Group* group = instance ? graph.group(instance->group) : nullptr;
        if (!group) return nullptr;
        nodes = &group->nodes;
        prefix.remove_prefix(slash + 1);
    }
    return nodes;
}

std::vector<NodeField> gatherNodeFields(const Graph& graph, const GraphLowering& lowering,
                                        const std::string& prefix, FieldSelection selection) {
    std::vector<NodeField> fields;
    const std::vector<Node>* nodes = nodesInScope(graph, prefix);
    const LoweredNodes* lowered = lowering.nodesIn(prefix);
    if (!nodes || !lowered) return fields;
    const bool all = selection == FieldSelection::all;
    for (const Node& node : *nodes) {
        const auto found = lowered->find(node.id);
        if (found == lowered->end() || found->second.failed || (node.muted && !all)) continue;
        for (const NodeOutput& output : found->second.outputs) {
            const int count = componentCount(output.value.type);
            if (count == 0) continue;
            if (const auto& mesh = output.value.mesh; mesh && (!all || mesh->read)) continue;
            NodeField& field =
                fields.emplace_back(NodeField{node.id, output.name, output.value.type, {}, output.exactness});
            std::copy_n(output.value.ids.begin(), count, field.roots.begin());
        }
    }
    return fields;
}

Result<NodeFields> compileNodeFields(const Graph& graph, const std::string& prefix,
                                     const std::string& besides, const CompileOptions& options) {
    for (const Error& error : checkStructure(graph))
        if (error.severity == Error::Severity::error) return error;
    std::vector<const Node*> targets;
    for (const Node& node : graph.nodes)
        if (roleOf(node.type) == NodeRole::output || node.id == besides) targets.push_back(&node);
    NodeFields result;
    if (targets.empty()) return result;
    GraphLowering lowering(graph, options);
    lowering.lowerAll(graph.nodes, "", nullptr, targets);
    result.fields = gatherNodeFields(graph, lowering, prefix, FieldSelection::ownFields);
    std::vector<IrId> roots;
    for (const NodeField& field : result.fields)
        roots.insert(roots.end(), field.roots.begin(), field.roots.begin() + componentCount(field.type));
    result.ir = lowering.state.ir.compact(roots);
    std::size_t next = 0;
    for (NodeField& field : result.fields)
        for (int i = 0; i < componentCount(field.type); ++i) field.roots[std::size_t(i)] = roots[next++];
    result.live = std::move(lowering.live);
    return result;
}

}  // namespace fw
