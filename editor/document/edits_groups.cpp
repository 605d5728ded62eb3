// Nodes into a group of their own.
//
// Each wire that comes from outside becomes an input of the group, each source once, under the name of the
// first input that it feeds; each output that feeds the outside becomes an output. Types are those of the
// sources, so that the group gives what its nodes gave. What parameters and tracks set becomes an input too.
#include <algorithm>
#include <map>
#include <tuple>

#include "editor/document/frames.h"
#include "editor/document/layout.h"
#include "editor/document/references.h"
#include "editor/document/soundness.h"
#include "editor/document/wiring.h"
#include "graph/compile/compile.h"
#include "graph/document/named_parameters.h"
#include "graph/document/timeline.h"

namespace fw::editor {

namespace {

constexpr double kColumn = 260.0;  ///< from a group's ends to its nodes
constexpr const char* kGroupId = "group";

/// A name that no entry of the list has.
template <class Entries>
std::string freshName(const Entries& entries, const std::string& base) {
    std::string name = base;
    const auto taken = [&] {
        return std::ranges::any_of(entries, [&](const auto& entry) { return entry.name == name; });
    };
    for (int i = 2; taken(); ++i) name = base + "_" + std::to_string(i);
    return name;
}

class Grouping {
  public:
    Grouping(const Graph& graph_, std::string_view scope_, std::span<const std::string> nodes)
        : graph(graph_), scope(scope_), wiring(graph, scope_), result(graph_) {
        for (const std::string& id : nodes)
            if (wiring.find(id)) chosen.insert(id);
    }

    Result<Edited> make() {
        if (auto error = refusalOf()) return *error;
        group.id = FreshIds(graph.groups).next(kGroupId);
        const Scope& its = wiring.scope();
        FreshIds outer(its.nodes);
        instance.id = outer.next(kGroupId);
        instance.type = "group", instance.group = group.id;
        for (const Node& node : its.nodes) (chosen.contains(node.id) ? group.nodes : outside).push_back(node);
        FreshIds inner(group.nodes);
        in.type = "group_input", in.id = inner.next(in.type);
        out.type = "group_output", out.id = inner.next(out.type);
        if (!wireInside() || !wireOutside()) return failure;
        if (scope.empty()) exposeReferences();
        if (group.inputs.size() > kMaxSockets || group.outputs.size() > kMaxSockets)
            return Error{.message = "the group would have more than " + std::to_string(kMaxSockets) +
                                    " inputs or outputs: choose other nodes"};
        place();
        finish();
        if (auto error = newError(graph, result)) return *error;
        return Edited{std::move(result), {instance.id}};
    }

  private:
    std::optional<Error> refusalOf() const {
        if (chosen.empty()) return Error{.message = "no node is chosen: choose those that are to be grouped"};
        const NodeIds ids(chosen.begin(), chosen.end());
        for (const std::string& id : ids) {
            const std::string& type = wiring.scope().nodes[*wiring.find(id)].type;
            const NodeRole role = roleOf(type);
            if (role == NodeRole::output || role == NodeRole::groupOutput || role == NodeRole::groupInput)
                return Error{.message = "a node of type '" + type + "' stands for itself: leave it out",
                             .node = id};
        }
        const std::set<std::string> before = upstream(wiring.scope().nodes, ids),
                                    behind = downstream(wiring.scope().nodes, ids);
        for (const std::string& id : before)
            if (behind.contains(id) && !chosen.contains(id))
                return Error{.message = "a way leads out of the group to " + inQuotes(id) +
                                        " and back into it: choose that node too",
                             .node = id};
        return {};
    }

    /// The output with its name.
    Plug named(const Link& link) const {
        const auto node = wiring.find(link.node);
        if (!link.output.empty() || !node || !hasKnownSockets(wiring.scope(), *node))
            return {link.node, link.output};
        const std::vector<std::string> names = outputNames(wiring.scope(), *node);
        return {link.node, names.empty() ? "" : names.front()};
    }

    /// The type of what the link gives; none, with a failure, if that cannot be known.
    std::optional<Type> typeOf(const Link& link) {
        const std::optional<Socket> socket = wiring.output({link.node, link.output});
        if (socket && socket->type) return socket->type;
        if (!sound) sound = !newError(Graph{}, graph);
        std::optional<Type> type;
        if (socket && *sound) type = compiledType(graph, scope, link);
        if (!type)
            failure = {.message = "what node " + inQuotes(link.node) +
                                  " gives is not known while it has errors: correct them first",
                       .node = link.node};
        return type;
    }

    /// Whether the link carries anything: a reroute that nothing feeds does not.
    bool carries(const Link& link) const {
        const auto node = wiring.find(link.node);
        if (!node || !wiring.scope().is(*node, NodeRole::reroute)) return true;
        std::set<uint32_t> seen;
        for (auto at = node; at && wiring.scope().is(*at, NodeRole::reroute) && seen.insert(*at).second;) {
            const Link* source = wiring.source({wiring.scope().nodes[*at].id, "value"});
            if (!source) return false;
            at = wiring.find(source->node);
        }
        return true;
    }

    std::string addInput(const std::string& base, Type type, std::optional<InputValue> value) {
        GroupInput input;
        input.name = freshName(group.inputs, base);
        input.type = typeName(type);
        input.value = std::move(value);
        group.inputs.push_back(std::move(input));
        return group.inputs.back().name;
    }

    bool wireInside() {
        std::map<std::pair<std::string, std::string>, std::string> inputs;  // of the sources
        for (Node& node : group.nodes) {
            const auto before = node.inputs;
            for (const auto& [name, value] : before) {
                const Link* link = std::get_if<Link>(&value.value);
                if (!link || chosen.contains(link->node) || !wiring.find(link->node)) continue;
                if (!carries(*link)) {
                    unlink(node, name, std::nullopt);
                    continue;
                }
                const Plug source = named(*link);
                std::string& input = inputs[{source.node, source.name}];
                if (input.empty()) {
                    const std::optional<Type> type = typeOf(*link);
                    if (!type) return false;
                    input = addInput(name, *type, std::nullopt);
                    instance.set(input, {*link});
                }
                node.set(name, {Link{in.id, input}});
            }
        }
        return true;
    }

    bool wireOutside() {
        std::map<std::pair<std::string, std::string>, std::string> outputs;
        std::vector<std::tuple<Node*, std::string, std::string>> wires;
        for (Node& node : outside) {
            const auto before = node.inputs;
            for (const auto& [name, value] : before) {
                const Link* link = std::get_if<Link>(&value.value);
                if (!link || !chosen.contains(link->node)) continue;
                if (!carries(*link)) {
                    unlink(node, name, std::nullopt);
                    continue;
                }
                const Plug source = named(*link);
                std::string& output = outputs[{source.node, source.name}];
                if (output.empty()) {
                    const std::optional<Type> type = typeOf(*link);
                    if (!type) return false;
                    GroupOutput made;
                    made.name = freshName(group.outputs, source.name);
                    made.type = typeName(*type);
                    output = made.name;
                    group.outputs.push_back(std::move(made));
                    out.set(output, {*link});
                }
                wires.emplace_back(&node, name, output);
            }
        }
        for (const auto& [node, name, output] : wires)
            node->set(name, {Link{instance.id, group.outputs.size() == 1 ? "" : output}});
        return true;
    }

    Node* inner(const std::string& id) {
        const auto found = std::ranges::find(group.nodes, id, &Node::id);
        return found == group.nodes.end() ? nullptr : &*found;
    }

    /// The input of the instance that sets this input of a node inside.
    std::optional<Plug> expose(const Plug& target) {
        Node* node = inner(target.node);
        if (!node) return {};
        const auto done = exposed.find({target.node, target.name});
        if (done != exposed.end()) return Plug{instance.id, done->second};
        const uint32_t at = *wiring.find(target.node);
        const InputValue* given = wiring.scope().nodes[at].input(target.name);
        if (given && std::holds_alternative<Link>(given->value)) {
            // What a wire feeds has no effect, and goes on having none. A surface is nothing that can be set,
            // though it stands for a number where it is wired.
            const Link* link = std::get_if<Link>(&node->input(target.name)->value);
            if (!link || link->node != in.id) return {};
            const auto input = std::ranges::find(group.inputs, link->output, &GroupInput::name);
            if (input == group.inputs.end() || input->type == typeName(Type::surface)) return {};
            return Plug{instance.id, link->output};
        }
        if (!hasKnownSockets(wiring.scope(), at)) return {};
        const std::optional<Socket> socket = settableSocket(wiring.scope(), at, target.name);
        if (!socket || !socket->type || componentCount(*socket->type) == 0) return {};
        const std::vector<double> numbers = inputNumbers(*node, target.name);
        InputValue value;
        if (given)
            value = *given;
        else if (numbers.empty())
            return {};
        else if (*socket->type == Type::boolean)
            value.value = numbers[0] != 0.0;
        else if (numbers.size() == 1)
            value.value = numbers[0];
        else
            value.value = numbers;
        const std::string name = addInput(target.name, *socket->type, value);
        instance.set(name, value);
        node->set(target.name, {Link{in.id, name}});
        exposed.emplace(std::pair(target.node, target.name), name);
        return Plug{instance.id, name};
    }

    /// Parameters and tracks lead to nodes of the document only, and so does a parameter's node by its name.
    void exposeReferences() {
        for (const NamedParameter& parameter : namedParameters(graph)) {
            const Node* node = inner(parameter.node);
            const bool byNode = node && roleOf(node->type) == NodeRole::parameter &&
                                parameter.input == "value" &&
                                std::ranges::none_of(graph.parameters, [&](const ExposedParameter& each) {
                                    return each.name == parameter.name;
                                });
            if (!byNode) continue;
            const auto plug = expose({parameter.node, parameter.input});
            if (!plug) continue;
            ExposedParameter made;
            made.name = parameter.name, made.node = plug->node, made.input = plug->name;
            made.min = parameter.min, made.max = parameter.max;
            const bool twice = std::ranges::any_of(
                result.parameters, [&](const ExposedParameter& each) { return each.name == made.name; });
            if (!twice) result.parameters.push_back(std::move(made));
        }
        redirect(result, [&](const Plug& plug) { return expose(plug); });
    }

    void place() {
        bool first = true;
        Position low{}, high{};
        for (const Node& node : group.nodes) {
            if (!node.at) continue;
            const Position size = aboutSize(wiring.scope(), *wiring.find(node.id));
            for (int axis = 0; axis < 2; ++axis) {
                const double begin = (*node.at)[axis], end = begin + size[axis];
                low[axis] = first ? begin : std::min(low[axis], begin);
                high[axis] = first ? end : std::max(high[axis], end);
            }
            first = false;
        }
        const double middle = std::round(0.5 * (low[1] + high[1]));
        instance.at = {std::round(0.5 * (low[0] + high[0])) - 90.0, middle};
        in.at = {low[0] - kColumn, middle};
        out.at = {high[0] + kColumn - 180.0, middle};
    }

    void finish() {
        if (!group.inputs.empty()) group.nodes.insert(group.nodes.begin(), std::move(in));
        if (!group.outputs.empty()) group.nodes.push_back(std::move(out));
        // The instance stands where the first of its nodes stood.
        std::vector<Node>& nodes = nodesOf(result, scope);
        const auto firstChosen =
            std::ranges::find_if(nodes, [&](const Node& node) { return chosen.contains(node.id); });
        const auto at = std::count_if(nodes.begin(), firstChosen,
                                      [&](const Node& node) { return !chosen.contains(node.id); });
        nodes = std::move(outside);
        nodes.insert(nodes.begin() + at, instance);
        const std::string id = group.id;
        result.groups.push_back(std::move(group));
        // Frames go along that held no other nodes.
        const std::vector<Frame> frames = framesOf(graph);
        for (std::size_t i = 0; i < frames.size(); ++i) {
            Frame frame = frames[i];
            if (frame.scope != scope) continue;
            bool any = false, all = true;
            for (const Node& node : wiring.scope().nodes)
                if (node.at && holds(frame, *node.at)) any = true, all = all && chosen.contains(node.id);
            frame.scope = id;
            if (any && all) result = setFrame(result, i, frame);
        }
        dropLost(result, graph);
    }

    static bool holds(const Frame& frame, Position at) {
        return at[0] >= frame.at[0] && at[1] >= frame.at[1] && at[0] < frame.at[0] + frame.size[0] &&
               at[1] < frame.at[1] + frame.size[1];
    }

    const Graph& graph;
    const std::string scope;
    const Wiring wiring;
    Graph result;
    std::set<std::string> chosen;
    Group group;
    Node instance, in, out;
    std::vector<Node> outside;
    std::map<std::pair<std::string, std::string>, std::string> exposed;  ///< inputs of nodes inside
    std::optional<bool> sound;
    Error failure;
};

}  // namespace

Result<Edited> groupNodes(const Graph& graph, std::string_view scope, std::span<const std::string> nodes) {
    return Grouping(graph, scope, nodes).make();
}

}  // namespace fw::editor
