#include "editor/document/remedies.h"

#include <algorithm>

#include "editor/document/paths.h"
#include "editor/document/wiring.h"
#include "graph/base/words.h"
#include "graph/check/check.h"
#include "graph/document/input_value.h"

namespace fw::editor {

namespace {

constexpr double kBehind = 260.0;  // canvas units from a node to the output that is added for it

bool sameFinding(const Error& a, const Error& b) {
    return a.node == b.node && a.input == b.input && a.message == b.message && a.severity == b.severity;
}

bool stands(const Graph& graph, const Error& finding) {
    return std::ranges::any_of(checkStructure(graph),
                               [&](const Error& each) { return sameFinding(each, finding); });
}

/// What is done to the node of this id in the scope.
template <class Change>
std::function<Graph(const Graph&)> changing(std::string scope, std::string id, Change change) {
    return [scope = std::move(scope), id = std::move(id), change](const Graph& graph) {
        Graph next = graph;
        std::vector<Node>& nodes = nodesOf(next, scope);
        const auto node = std::ranges::find(nodes, id, &Node::id);
        if (node != nodes.end()) change(*node);
        return next;
    };
}

void takeOff(Node& node, const std::string& input) {
    std::erase_if(node.inputs, [&](const auto& each) { return each.first == input; });
}

/// The nearest value that the input takes; of numbers that must be above 0 its default.
InputValue fitting(const InputSpec& spec, InputValue value) {
    const auto fit = [&](double& number) {
        if (!rangeProblem(spec, number)) return;
        const double usual = spec.value.numbers.empty() ? 1.0 : spec.value.numbers.front();
        number = spec.positive && !(number > 0.0) ? usual : std::clamp(number, spec.min, spec.max);
        if (spec.type == Type::integer) number = std::clamp(std::round(number), spec.min, spec.max);
    };
    if (double* number = std::get_if<double>(&value.value)) fit(*number);
    if (auto* several = std::get_if<std::vector<double>>(&value.value))
        for (double& number : *several) fit(number);
    return value;
}

std::string wordsOf(const InputValue& value) {
    std::string words;
    if (const double* number = std::get_if<double>(&value.value)) return shortNumber(*number);
    if (const auto* several = std::get_if<std::vector<double>>(&value.value))
        for (const double number : *several) words += (words.empty() ? "" : ", ") + shortNumber(number);
    return words;
}

/// The node that makes a surface which nothing uses, the one farthest to the right; none if there is none.
const Node* lastSurface(const Graph& graph, std::string_view scope) {
    const Wiring wiring(graph, scope);
    std::set<std::string_view> used;
    const std::vector<Node>& nodes = nodesOf(graph, scope);
    for (const Node& node : nodes)
        for (const auto& [name, value] : node.inputs)
            if (const Link* link = std::get_if<Link>(&value.value)) used.insert(link->node);
    const Node* last = nullptr;
    const auto right = [](const Node& node) { return node.at ? (*node.at)[0] : 0.0; };
    for (const Node& node : nodes) {
        const auto socket = wiring.output({node.id, ""});
        if (socket && socket->type == Type::surface && !used.contains(node.id) &&
            (!last || right(node) > right(*last)))
            last = &node;
    }
    return last;
}

Graph withEnd(const Graph& graph, const std::string& scope, NodeRole role) {
    const Node* shown = lastSurface(graph, scope);
    Position at = shown && shown->at ? *shown->at : Position{};
    at[0] += kBehind;
    Edited added = addNode(graph, scope, idOf(role), at);
    if (added.nodes.empty() || !shown) return std::move(added.graph);
    const auto input = fittingInput(added.graph, scope, {shown->id, ""}, added.nodes[0]);
    return input ? connect(added.graph, scope, {shown->id, ""}, *input) : std::move(added.graph);
}

void ofInput(const Graph& graph, const std::string& scope, const Node& node, const Error& finding,
             std::vector<Remedy>& remedies) {
    const std::string& name = finding.input;
    const InputValue* value = node.input(name);
    if (!value) return;
    const Wiring wiring(graph, scope);
    const auto index = wiring.find(node.id);
    if (!index || !hasKnownSockets(wiring.scope(), *index)) return;
    const std::optional<Socket> socket = inputSocket(wiring.scope(), *index, name);
    const bool isLink = std::holds_alternative<Link>(value->value);
    if (!socket) {
        std::vector<std::string> names = inputNames(wiring.scope(), *index);
        std::erase_if(names, [&](const std::string& each) { return node.input(each) != nullptr; });
        if (const std::string near = nearestName(name, names); !near.empty())
            remedies.push_back({"Call it " + near, changing(scope, node.id, [name, near](Node& of) {
                                    for (auto& input : of.inputs)
                                        if (input.first == name) input.first = near;
                                })});
    } else if (socket->spec && !isLink) {
        const InputValue fits = fitting(*socket->spec, *value);
        if (!(fits == *value))
            remedies.push_back({"Make it " + wordsOf(fits),
                                changing(scope, node.id, [name, fits](Node& of) { of.set(name, fits); })});
        else if (const auto* word = std::get_if<std::string>(&value->value)) {
            const std::string near = nearestName(*word, socket->spec->options);
            if (!near.empty() && near != *word)
                remedies.push_back({"Make it " + near, changing(scope, node.id, [name, near](Node& of) {
                                        of.set(name, InputValue{near});
                                    })});
        }
    }
    remedies.push_back({isLink    ? "Take off the wire"
                        : !socket ? "Take it off"
                                  : "Back to its default",
                        changing(scope, node.id, [name](Node& of) { takeOff(of, name); })});
}

void ofNode(const std::string& scope, const Node& node, std::vector<Remedy>& remedies) {
    if (!findNodeType(node.type)) {
        if (const std::string near = nearestNodeType(node.type); !near.empty())
            remedies.push_back({"Make it a " + findNodeType(near)->label,
                                changing(scope, node.id, [near](Node& of) { of.type = near; })});
    } else {
        if (roleOf(node.type) != NodeRole::expression && !node.code.empty())
            remedies.push_back(
                {"Take off the code", changing(scope, node.id, [](Node& of) { of.code.clear(); })});
        if (roleOf(node.type) != NodeRole::group && !node.group.empty())
            remedies.push_back(
                {"Take off the group", changing(scope, node.id, [](Node& of) { of.group.clear(); })});
    }
    remedies.push_back({"Remove the node", [scope, id = node.id](const Graph& graph) {
                            return removeNodes(graph, scope, std::span<const std::string>(&id, 1), true);
                        }});
}

}  // namespace

std::vector<Remedy> remediesOf(const Graph& graph, const Error& finding) {
    std::vector<Remedy> remedies;
    if (!stands(graph, finding)) return remedies;
    const bool unfinished = finding.code == Error::Code::unfinished;
    const auto [scope, id] = placeOf(graph, finding.node);
    const Node* node = findNode(nodesOf(graph, scope), id);
    if (finding.node.empty() && unfinished) {
        remedies.push_back(
            {"Add an output", [](const Graph& of) { return withEnd(of, "", NodeRole::output); }});
    } else if (!node && unfinished && graph.group(finding.node)) {
        remedies.push_back({"Add the group's output", [group = finding.node](const Graph& of) {
                                return withEnd(of, group, NodeRole::groupOutput);
                            }});
    } else if (node && !finding.input.empty()) {
        ofInput(graph, scope, *node, finding, remedies);
    } else if (node && finding.severity == Error::Severity::error) {
        ofNode(scope, *node, remedies);
    } else if (node) {
        ofNode(scope, *node, remedies);
        remedies.pop_back();  // what only is to be known is no reason to remove a node
    }
    std::erase_if(remedies, [&](const Remedy& remedy) { return stands(remedy.mend(graph), finding); });
    return remedies;
}

}  // namespace fw::editor
