// The edits of nodes and of their values.
#include <algorithm>
#include <cassert>

#include "editor/document/edits.h"
#include "editor/document/key_edits.h"
#include "editor/document/references.h"
#include "editor/document/soundness.h"
#include "editor/document/wiring.h"
#include "graph/document/input_value.h"
#include "graph/document/named_parameters.h"

namespace fw::editor {

namespace {

constexpr std::string_view kFirstCode = "return length(p) - 1.0;";
constexpr Position kBeside{32.0, 32.0};  ///< from a node to its duplicate

using Names = std::unordered_set<std::string_view>;

Node* findNode(std::vector<Node>& nodes, std::string_view id) {
    const auto found = std::ranges::find(nodes, id, &Node::id);
    return found == nodes.end() ? nullptr : &*found;
}

/// The graph after `change` of each of the nodes.
template <class Change>
Graph changed(const Graph& graph, std::string_view scope, std::span<const std::string> ids, Change change) {
    Graph result = graph;
    const Names names(ids.begin(), ids.end());
    for (Node& node : nodesOf(result, scope))
        if (names.contains(node.id)) change(node);
    return result;
}

/// Sets a flag of all nodes, or clears it if all have it.
Graph toggled(const Graph& graph, std::string_view scope, std::span<const std::string> ids,
              bool Node::*flag) {
    const Names names(ids.begin(), ids.end());
    const bool all = std::ranges::all_of(
        nodesOf(graph, scope), [&](const Node& node) { return node.*flag || !names.contains(node.id); });
    return changed(graph, scope, ids, [&](Node& node) { node.*flag = !all; });
}

/// Only a parameter with a name is offered to players, and they tell it from others by it.
void nameParameter(const Graph& graph, Node& node) {
    const std::string first = findNodeType("parameter")->inputs[0].value.text;
    std::string name = first;
    for (int i = 2; findParameter(graph, name); ++i) name = first + " " + std::to_string(i);
    node.set("name", {name});
}

/// The first source of a removed node that may feed the input, through any number of removed nodes.
std::optional<Link> healed(const Wiring& wiring, const Names& removed, const Link& link, const Plug& input,
                           std::set<uint32_t>& seen) {
    const auto at = wiring.find(link.node);
    if (!at || !seen.insert(*at).second) return {};
    for (const auto& [name, value] : wiring.scope().nodes[*at].inputs) {
        const Link* before = std::get_if<Link>(&value.value);
        if (!before) continue;
        const std::optional<Link> source = removed.contains(before->node)
                                               ? healed(wiring, removed, *before, input, seen)
                                               : std::optional(*before);
        if (source && wiring.refusal({source->node, source->output}, input).empty()) return source;
    }
    return {};
}

std::optional<Type> typeFrom(const Wiring& wiring, const Link& link) {
    const std::optional<Socket> socket = wiring.output({link.node, link.output});
    return socket ? socket->type : std::nullopt;
}

/// Whether the input may hold the value.
bool takes(const Wiring& wiring, const Plug& input, const InputValue& value) {
    const std::optional<Socket> socket = wiring.input(input);
    if (!socket) return false;
    if (const Link* link = std::get_if<Link>(&value.value))
        return wiring.refusal({link->node, link->output}, input).empty();
    if (socket->type) return !valueProblem(*socket->type, socket->spec, value);
    const std::optional<Type> type = typeOfValue(value);  // of an expression or a reroute
    return type && !valueProblem(*type, nullptr, value) && wiring.typeRefusal(type, input).empty();
}

}  // namespace

const std::vector<Node>& nodesOf(const Graph& graph, std::string_view scope) {
    if (scope.empty()) return graph.nodes;
    static const std::vector<Node> none;
    const Group* group = graph.group(scope);
    return group ? group->nodes : none;
}

std::vector<Node>& nodesOf(Graph& graph, std::string_view scope) {
    if (scope.empty()) return graph.nodes;
    const auto group = std::ranges::find(graph.groups, scope, &Group::id);
    if (group != graph.groups.end()) return group->nodes;
    static thread_local std::vector<Node> none;
    none.clear();
    return none;
}

FreshIds::FreshIds(const std::vector<Node>& nodes) {
    for (const Node& node : nodes) taken.insert(node.id);
}

FreshIds::FreshIds(const std::vector<Group>& groups) {
    for (const Group& group : groups) taken.insert(group.id);
}

std::string FreshIds::next(std::string_view wanted) {
    std::string base;
    for (const char c : wanted) {
        const char lower = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
        const bool fits = (lower >= 'a' && lower <= 'z') || (lower >= '0' && lower <= '9');
        if (fits || (!base.empty() && base.back() != '_')) base += fits ? lower : '_';
    }
    while (base.ends_with('_')) base.pop_back();
    if (base.empty() || !isId(base)) base = base.empty() ? "node" : "n" + base;
    if (taken.insert(base).second) return base;
    const std::size_t stem = base.find_last_not_of("0123456789");
    if (stem != std::string::npos && stem > 0 && base[stem] == '_') base.resize(stem);
    int& number = numbers.try_emplace(base, 1).first->second;
    while (true)
        if (std::string id = base + "_" + std::to_string(++number); taken.insert(id).second) return id;
}

std::string freshId(const std::vector<Node>& nodes, std::string_view base) {
    return FreshIds(nodes).next(base);
}

Edited addNode(const Graph& graph, std::string_view scope, std::string_view type, Position at,
               std::string_view group) {
    const NodeType* known = findNodeType(type);
    if (!known || !canAdd(graph, scope, *known) || (known->role == NodeRole::group && !graph.group(group)))
        return {graph, {}};
    Node node;
    node.id =
        freshId(nodesOf(graph, scope), known->role == NodeRole::group ? group : std::string_view(known->id));
    node.type = known->id;
    node.at = at;
    if (known->role == NodeRole::group) node.group = group;
    if (known->role == NodeRole::expression) node.code = kFirstCode;
    if (known->role == NodeRole::parameter) nameParameter(graph, node);
    Edited result{graph, {node.id}};
    nodesOf(result.graph, scope).push_back(std::move(node));
    return outgrows(graph, result.graph) ? Edited{graph, {}} : result;
}

Graph removeNodes(const Graph& graph, std::string_view scope, std::span<const std::string> nodes, bool heal) {
    Graph result = graph;
    const Wiring wiring(graph, scope);
    const Names removed(nodes.begin(), nodes.end());
    std::vector<Node>& left = nodesOf(result, scope);
    std::erase_if(left, [&](const Node& node) { return removed.contains(node.id); });
    for (Node& node : left) {
        const auto inputs = node.inputs;
        for (const auto& [name, value] : inputs) {
            const Link* link = std::get_if<Link>(&value.value);
            if (!link || !removed.contains(link->node)) continue;
            std::set<uint32_t> seen;
            if (const auto source =
                    heal ? healed(wiring, removed, *link, {node.id, name}, seen) : std::nullopt)
                node.set(name, {*source});
            else
                unlink(node, name, typeFrom(wiring, *link));
        }
    }
    dropLost(result, graph);
    return result;
}

Edited duplicate(const Graph& graph, std::string_view scope, std::span<const std::string> nodes,
                 bool keepInputs) {
    Edited result{graph, {}};
    const Wiring wiring(graph, scope);
    const Names chosen(nodes.begin(), nodes.end());
    std::vector<Node>& all = nodesOf(result.graph, scope);
    FreshIds ids(all);
    std::map<std::string, std::string> copies;  // in one order, for the tracks
    const std::size_t count = all.size();
    for (std::size_t i = 0; i < count; ++i) {
        if (!chosen.contains(all[i].id) || roleOf(all[i].type) == NodeRole::output ||
            roleOf(all[i].type) == NodeRole::groupOutput)
            continue;
        Node copy = all[i];
        copy.id = ids.next(copy.id);
        if (copy.at) copy.at = {(*copy.at)[0] + kBeside[0], (*copy.at)[1] + kBeside[1]};
        copies.emplace(all[i].id, copy.id);
        result.nodes.push_back(copy.id);
        all.push_back(std::move(copy));
    }
    for (std::size_t i = count; i < all.size(); ++i) {
        const auto inputs = all[i].inputs;
        for (const auto& [name, value] : inputs) {
            const Link* link = std::get_if<Link>(&value.value);
            if (!link) continue;
            const auto copy = copies.find(link->node);
            if (copy != copies.end())
                all[i].set(name, {Link{copy->second, link->output}});
            else if (!keepInputs)
                unlink(all[i], name, typeFrom(wiring, *link));
        }
    }
    if (scope.empty())
        for (const auto& [from, to] : copies) copyTracks(result.graph, from, to);
    return outgrows(graph, result.graph) ? Edited{graph, {}} : result;
}

Graph moveNodes(const Graph& graph, std::string_view scope, std::span<const std::string> nodes, Position by) {
    return changed(graph, scope, nodes, [&](Node& node) {
        const Position at = node.at.value_or(Position{});
        node.at = {at[0] + by[0], at[1] + by[1]};
    });
}

Graph toggleMuted(const Graph& graph, std::string_view scope, std::span<const std::string> nodes) {
    return toggled(graph, scope, nodes, &Node::muted);
}

Graph toggleCollapsed(const Graph& graph, std::string_view scope, std::span<const std::string> nodes) {
    return toggled(graph, scope, nodes, &Node::collapsed);
}

Graph setInput(const Graph& graph, std::string_view scope, const Plug& input,
               std::optional<InputValue> value) {
    const Wiring wiring(graph, scope);
    const auto at = wiring.find(input.node);
    if (!at || (value && !takes(wiring, input, *value))) return graph;
    Graph result = graph;
    Node& node = nodesOf(result, scope)[*at];
    if (!value) {  // that an input is unknown is no reason to keep what the document gives for it
        std::erase_if(node.inputs, [&](const auto& entry) { return entry.first == input.name; });
        dropLost(result, graph);
        return result;
    }
    const InputValue* former = node.input(input.name);
    const auto* oldName =
        roleOf(node.type) == NodeRole::parameter && input.name == "name" && scope.empty() && former
            ? std::get_if<std::string>(&former->value)
            : nullptr;
    const auto* newName = std::get_if<std::string>(&value->value);
    if (oldName && newName && !newName->empty())
        renameParameterTracks(result, std::string(*oldName), *newName);
    node.set(input.name, std::move(*value));
    return result;
}

Graph setNumber(const Graph& graph, std::string_view scope, const Plug& input, int component, double number) {
    const Wiring wiring(graph, scope);
    const auto at = wiring.find(input.node);
    if (!at) return graph;
    const std::optional<Socket> socket = wiring.input(input);
    std::vector<double> numbers = inputNumbers(nodesOf(graph, scope)[*at], input.name);
    const std::size_t count =
        socket && socket->type ? std::size_t(componentCount(*socket->type)) : numbers.size();
    if (component < 0 || std::size_t(component) >= count) return graph;
    // One number stands for a vector of it.
    numbers.resize(count, numbers.size() == 1 ? numbers[0] : 0.0);
    numbers[std::size_t(component)] = number;
    return setInput(graph, scope, input, numbersValue(numbers));
}

Graph setLabel(const Graph& graph, std::string_view scope, std::string_view node, std::string label) {
    Graph result = graph;
    if (Node* found = findNode(nodesOf(result, scope), node)) found->label = std::move(label);
    return result;
}

Graph setCode(const Graph& graph, std::string_view scope, std::string_view node, std::string code) {
    Graph result = graph;
    Node* found = findNode(nodesOf(result, scope), node);
    if (found && roleOf(found->type) == NodeRole::expression) found->code = std::move(code);
    return result;
}

Result<Graph> renameNode(const Graph& graph, std::string_view scope, std::string_view node,
                         std::string_view id) {
    const std::string from(node), to(id);
    if (!isId(id))
        return Error{
            .message = inQuotes(id) + " is no id for a node: use a-z, 0-9 and '_', beginning with a letter",
            .node = from};
    if (from == to) return graph;
    Graph result = graph;
    std::vector<Node>& nodes = nodesOf(result, scope);
    if (findNode(nodes, to))
        return Error{.message = "another node has the id " + inQuotes(id) + ": choose another", .node = from};
    Node* found = findNode(nodes, from);
    if (!found) return Error{.message = "there is no node " + inQuotes(node), .node = from};
    found->id = to;
    for (Node& each : nodes)
        for (auto& [name, value] : each.inputs)
            if (Link* link = std::get_if<Link>(&value.value); link && link->node == from) link->node = to;
    if (scope.empty())
        redirect(result, [&](const Plug& plug) {
            return plug.node == from ? std::optional(Plug{to, plug.name}) : std::nullopt;
        });
    return result;
}

std::set<std::string> upstream(const std::vector<Node>& nodes, std::span<const std::string> of) {
    std::unordered_map<std::string_view, const Node*> byId;
    for (const Node& node : nodes) byId.try_emplace(node.id, &node);
    std::set<std::string> found(of.begin(), of.end());
    std::vector<std::string> open(of.begin(), of.end());
    while (!open.empty()) {
        const auto node = byId.find(open.back());
        open.pop_back();
        if (node == byId.end()) continue;
        for (const auto& [name, value] : node->second->inputs)
            if (const Link* link = std::get_if<Link>(&value.value); link && byId.contains(link->node))
                if (found.insert(link->node).second) open.push_back(link->node);
    }
    return found;
}

std::set<std::string> downstream(const std::vector<Node>& nodes, std::span<const std::string> of) {
    std::unordered_map<std::string_view, std::vector<const Node*>> fed;
    for (const Node& node : nodes)
        for (const auto& [name, value] : node.inputs)
            if (const Link* link = std::get_if<Link>(&value.value)) fed[link->node].push_back(&node);
    std::set<std::string> found(of.begin(), of.end());
    std::vector<std::string> open(of.begin(), of.end());
    while (!open.empty()) {
        const auto to = fed.find(open.back());
        open.pop_back();
        if (to == fed.end()) continue;
        for (const Node* node : to->second)
            if (found.insert(node->id).second) open.push_back(node->id);
    }
    return found;
}

}  // namespace fw::editor
