#include "graph/compile/endless.h"

#include <algorithm>
#include <map>

#include "graph/base/words.h"
#include "graph/compile/compile.h"
#include "graph/evaluate/region.h"
#include "graph/library/node_type.h"

namespace fw {

namespace {

constexpr int kMostLooks = 24;

/// The graph, with the instances that were stepped into replaced by what is in them, and what those nodes are
/// called.
struct Search {
    Graph graph;
    std::map<std::string, std::string> names;  ///< of nodes from groups
    int looks = 0;

    std::string nameOf(const std::string& id) const {
        const auto found = names.find(id);
        return found == names.end() ? id : found->second;
    }
};

Node* outputOf(Graph& graph) {
    const auto found = std::ranges::find_if(
        graph.nodes, [](const Node& node) { return roleOf(node.type) == NodeRole::output; });
    return found == graph.nodes.end() ? nullptr : &*found;
}

bool isEndless(Search& search, const Link& link) {
    if (++search.looks > kMostLooks) return false;
    Graph shown = search.graph;
    outputOf(shown)->set("surface", {link});
    CompileOptions options;
    options.bake = boxInPlace;
    options.finest = kLeastFieldResolution;
    const Result<Program> program = compile(shown, options);
    return program && findRegion(*program).extent == Extent::unbounded;
}

bool takesSurface(const Graph& graph, const Node& node, const std::string& input, const Link& link) {
    const NodeType* type = findNodeType(node.type);
    const int index = type ? inputIndex(*type, input) : -1;
    if (index >= 0) {
        const Type taken = type->inputs[std::size_t(index)].type;
        return taken == Type::surface || taken == Type::mesh;
    }
    return compiledType(graph, "", link) == Type::surface;
}

/// Puts the nodes of the group in the place of its instance. Returns what the instance's output was inside;
/// none if that is no node's.
std::optional<Link> stepInside(Search& search, const Link& at) {
    const Node instance = *search.graph.node(at.node);
    const Group* group = search.graph.group(instance.group);
    if (!group) return std::nullopt;
    std::map<std::string, std::string> ids;
    std::string entrance, exit;
    for (const Node& node : group->nodes) {
        if (roleOf(node.type) == NodeRole::groupInput) entrance = node.id;
        if (roleOf(node.type) == NodeRole::groupOutput) exit = node.id;
        std::string id;
        for (int number = 0; id.empty() || search.graph.node(id) || search.names.contains(id); ++number)
            id = "inner_" + std::to_string(search.names.size() + std::size_t(number));
        ids[node.id] = id;
        search.names[id] = search.nameOf(instance.id) + "/" + node.id;
    }
    /// As seen from outside: a link to the entrance becomes what the instance is given.
    const auto outside = [&](const InputValue& value) -> std::optional<InputValue> {
        const Link* link = std::get_if<Link>(&value.value);
        if (!link) return value;
        if (link->node != entrance) return InputValue{Link{ids[link->node], link->output}};
        for (const GroupInput& input : group->inputs)
            if (link->output.empty() || link->output == input.name) {
                const InputValue* given = instance.input(input.name);
                return given ? std::optional(*given) : input.value;
            }
        return std::nullopt;
    };
    std::vector<Node> inner;
    std::optional<InputValue> result;
    for (const Node& node : group->nodes) {
        if (node.id == entrance) continue;
        Node copy = node;
        copy.id = ids[node.id];
        copy.inputs.clear();
        for (const auto& [name, value] : node.inputs)
            if (const std::optional<InputValue> taken = outside(value))
                copy.inputs.emplace_back(name, *taken);
        if (node.id != exit) {
            inner.push_back(std::move(copy));
        } else if (const InputValue* value = copy.input(
                       at.output.empty() && !group->outputs.empty() ? group->outputs[0].name : at.output)) {
            result = *value;
        }
    }
    const Link* link = result ? std::get_if<Link>(&result->value) : nullptr;
    if (!link) return std::nullopt;
    search.graph.nodes.insert(search.graph.nodes.end(), inner.begin(), inner.end());
    return *link;
}

/// A surface that the node takes and that has no bounds.
std::optional<Link> endlessInput(Search& search, const Node& node) {
    for (const auto& [name, value] : node.inputs)
        if (const Link* link = std::get_if<Link>(&value.value))
            if (takesSurface(search.graph, node, name, *link) && isEndless(search, *link)) return *link;
    return std::nullopt;
}

}  // namespace

std::string endlessNode(const Graph& graph) {
    Search search{graph, {}, 0};
    const Node* output = outputOf(search.graph);
    if (!output) return {};
    // What the output shows is known to be endless: of its one input no look is needed.
    std::vector<Link> shown;
    for (const auto& [name, value] : output->inputs)
        if (const Link* link = std::get_if<Link>(&value.value)) shown.push_back(*link);
    std::optional<Link> at = shown.size() == 1 ? std::optional(shown[0]) : endlessInput(search, *output);
    if (!at) return {};
    while (true) {
        const Node node = *search.graph.node(at->node);
        std::optional<Link> next =
            node.group.empty() || node.muted ? endlessInput(search, node) : stepInside(search, *at);
        if (!next) {
            const NodeType* type = findNodeType(node.type);
            return inQuotes(search.nameOf(node.id)) + (type ? " (" + type->label + ")" : std::string());
        }
        at = std::move(next);
    }
}

}  // namespace fw
