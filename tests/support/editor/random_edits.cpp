#include "tests/support/editor/random_edits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "editor/document/clipboard.h"
#include "editor/document/wiring.h"
#include "graph/library/node_type.h"
#include "tests/support/graph/random_graph.h"

namespace fw::editor::test {

std::string RandomEdits::scopeOf(const Graph& graph) {
    return graph.groups.empty() || chance(0.6) ? "" : graph.groups[below(graph.groups.size())].id;
}

const Node* RandomEdits::nodeOf(const Graph& graph, const std::string& scope) {
    const std::vector<Node>& nodes = nodesOf(graph, scope);
    return nodes.empty() ? nullptr : &nodes[below(nodes.size())];
}

NodeIds RandomEdits::someOf(const Graph& graph, const std::string& scope) {
    NodeIds ids;
    for (std::size_t i = 1 + below(4); i-- > 0;)
        if (const Node* node = nodeOf(graph, scope); node && std::ranges::find(ids, node->id) == ids.end())
            ids.push_back(node->id);
    return ids;
}

Plug RandomEdits::inputOf(const Graph& graph, const std::string& scope, const Node& node) {
    const Wiring wiring(graph, scope);
    const auto at = wiring.find(node.id);
    if (!hasKnownSockets(wiring.scope(), *at)) return {node.id, "x"};
    const auto names = inputNames(wiring.scope(), *at);
    return {node.id, names.empty() ? "x" : names[below(names.size())]};
}

Plug RandomEdits::outputOf(const Graph& graph, const std::string& scope, const Node& node) {
    const Wiring wiring(graph, scope);
    const auto at = wiring.find(node.id);
    if (!hasKnownSockets(wiring.scope(), *at)) return {node.id, ""};
    const auto names = outputNames(wiring.scope(), *at);
    return {node.id, names.empty() || chance(0.5) ? "" : names[below(names.size())]};
}

Graph RandomEdits::wire(const Graph& graph, const std::string& scope) {
    const Node *from = nodeOf(graph, scope), *to = nodeOf(graph, scope);
    if (!from || !to) return graph;
    const Plug output = outputOf(graph, scope, *from), input = inputOf(graph, scope, *to);
    if (refusal(graph, scope, output, input).empty()) return connect(graph, scope, output, input);
    const auto fitting = fittingInput(graph, scope, output, to->id);
    return fitting ? connect(graph, scope, output, *fitting) : graph;
}

Graph RandomEdits::value(const Graph& graph, const std::string& scope) {
    const Node* node = nodeOf(graph, scope);
    // What a parameter's range leaves out of a track is for the person to see, not an unsound graph.
    if (!node || node->type == "parameter") return graph;
    const Plug input = inputOf(graph, scope, *node);
    if (node->type == "expression") return setInput(graph, scope, input, InputValue{number() / 100});
    switch (below(5)) {
        case 0: return setInput(graph, scope, input, std::nullopt);
        case 1: return setInput(graph, scope, input, InputValue{chance(0.5)});
        case 2: return setInput(graph, scope, input, InputValue{std::vector<double>{number(), 1.0, 2.0}});
        case 3: return setInput(graph, scope, input, InputValue{std::string("round")});
        default: return setInput(graph, scope, input, InputValue{number() / 100});
    }
}

Graph RandomEdits::paste(const Graph& graph, const std::string& scope, const NodeIds& some, Position at) {
    const std::string text = copyNodes(graph, scope, some);
    const Result<Edited> pasted = pasteNodes(graph, scopeOf(graph), text, at);
    return pasted ? pasted->graph : graph;
}

Graph RandomEdits::next(const Graph& graph, std::string& name) {
    const std::string scope = scopeOf(graph);
    const Node* node = nodeOf(graph, scope);
    const NodeIds some = someOf(graph, scope);
    const auto& types = nodeTypes();
    const Position at{number(), number()};
    if (!node) return name = "add", addNode(graph, scope, types[below(types.size())].id, at).graph;
    switch (below(22)) {
        case 0:
        case 1: {
            const std::string group = graph.groups.empty() ? "" : graph.groups[below(graph.groups.size())].id;
            return name = "add", addNode(graph, scope, types[below(types.size())].id, at, group).graph;
        }
        case 2: return name = "wire", wire(graph, scope);
        case 3: return name = "wire", wire(graph, scope);
        case 4: return name = "disconnect", disconnect(graph, scope, inputOf(graph, scope, *node));
        case 5: {
            const auto fitting = typesThatFit(graph, scope, outputOf(graph, scope, *node), true);
            const NodeType& type =
                fitting.empty() ? types[below(types.size())] : *fitting[below(fitting.size())];
            return name = "insert",
                   insertOnWire(graph, scope, inputOf(graph, scope, *node), type.id, at).graph;
        }
        case 6:
            return name = "drop",
                   dropOnWire(graph, scope, inputOf(graph, scope, *node), nodeOf(graph, scope)->id);
        case 7: return name = "remove", removeNodes(graph, scope, some, false);
        case 8: return name = "heal", removeNodes(graph, scope, some, true);
        case 9: return name = "duplicate", duplicate(graph, scope, some, chance(0.5)).graph;
        case 10: return name = "move", moveNodes(graph, scope, some, at);
        case 11: return name = "mute", toggleMuted(graph, scope, some);
        case 12: return name = "collapse", toggleCollapsed(graph, scope, some);
        case 13:
            return name = "label", setLabel(graph, scope, node->id, "Label " + std::to_string(below(100)));
        case 14: {
            const auto renamed =
                renameNode(graph, scope, node->id, freshId(nodesOf(graph, scope), "renamed"));
            EXPECT_TRUE(renamed) << format(renamed.error());
            return name = "rename", *renamed;
        }
        case 15: return name = "swap", swapInputs(graph, scope, node->id);
        case 16: return name = "reroute", addReroute(graph, scope, inputOf(graph, scope, *node), at).graph;
        case 17: {
            const Result<Edited> made = groupNodes(graph, scope, some);
            return name = "group", made ? made->graph : graph;
        }
        case 18: {
            for (const Node& each : nodesOf(graph, scope))
                if (each.type == "group" && chance(0.5))
                    return name = "ungroup", ungroup(graph, scope, each.id).graph;
            return name = "paste", paste(graph, scope, some, at);
        }
        default: return name = "value", value(graph, scope);
    }
}

std::vector<std::string> structuralErrors(const Graph& graph) {
    std::vector<std::string> errors;
    for (const Error& finding : checkStructure(graph)) {
        // A path that is typed may name whatever file.
        if (finding.severity == Error::Severity::error && finding.code != Error::Code::unfinished &&
            finding.code != Error::Code::wrongFile)
            errors.push_back(format(finding));
    }
    return errors;
}

std::vector<Graph> graphsToEdit(int randomOnes) {
    std::vector<std::string> paths;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::string(FIELDWRIGHT_SOURCE_DIR) + "/samples"))
        if (entry.path().string().ends_with(".field.json")) paths.push_back(entry.path());
    std::ranges::sort(paths);
    EXPECT_GT(paths.size(), 10u);
    std::vector<Graph> graphs;
    for (const std::string& path : paths) {
        const Result<Graph> graph = readGraph(path, nullptr);
        EXPECT_TRUE(graph) << format(graph.error());
        if (graph) graphs.push_back(*graph);
    }
    for (int i = 0; i < randomOnes; ++i)
        graphs.push_back(fw::test::randomGraph(static_cast<uint32_t>(i), 5 + 10 * (i % 4)));
    return graphs;
}

}  // namespace fw::editor::test
