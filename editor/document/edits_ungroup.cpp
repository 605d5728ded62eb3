// The nodes of a group in place of one of its instances.
//
// What came through the group's ends comes directly. Where the type declared there made a difference, such as
// a surface of which the group took the distance, a node that converts stays in between; and where an input
// cannot hold what the instance gave, or several hold what a parameter or a track sets, a node with the
// value.
#include <algorithm>
#include <cmath>
#include <map>

#include "editor/document/frames.h"
#include "editor/document/layout.h"
#include "editor/document/references.h"
#include "editor/document/soundness.h"
#include "editor/document/wiring.h"
#include "graph/compile/compile.h"
#include "graph/document/input_value.h"
#include "graph/document/named_parameters.h"
#include "graph/document/timeline.h"

namespace fw::editor {

namespace {

/// What an input gets: a link, a value, or nothing; and the input of the instance that it came from.
struct Source {
    std::optional<InputValue> value = {};
    std::optional<Type> type = {};
    std::string input = {};
};

bool isLink(const Source& source) {
    return source.value && std::holds_alternative<Link>(source.value->value);
}

std::vector<double> numbersOf(const InputValue& value) {
    if (const double* number = std::get_if<double>(&value.value)) return {*number};
    if (const bool* flag = std::get_if<bool>(&value.value)) return {*flag ? 1.0 : 0.0};
    const auto* numbers = std::get_if<std::vector<double>>(&value.value);
    return numbers && value.entry == 0 ? *numbers : std::vector<double>{};
}

InputValue valueOf(const std::vector<double>& numbers) {
    return numbers.size() == 1 ? InputValue{numbers[0]} : InputValue{numbers};
}

class Ungrouping {
  public:
    /// With `valueNodes` what parameters and tracks set always becomes a node.
    Ungrouping(const Graph& graph_, std::string_view scope_, std::string_view node, bool valueNodes_)
        : graph(graph_),
          scope(scope_),
          wiring(graph, scope_),
          instance(wiring.scope().nodes[*wiring.find(node)]),
          group(*graph.group(instance.group)),
          inside(graph, group.id),
          valueNodes(valueNodes_),
          ids(wiring.scope().nodes),
          result(graph_) {}

    Edited make() {
        Position middle = middleOfGroup(), at = instance.at.value_or(middle);
        shift = {at[0] - middle[0], at[1] - middle[1]};
        for (const Node& node : group.nodes)
            if (roleOf(node.type) != NodeRole::groupInput && roleOf(node.type) != NodeRole::groupOutput)
                renamed.emplace(node.id, ids.next(node.id));
        countTargets();
        for (const Node& node : group.nodes)
            if (renamed.contains(node.id)) addInner(node);
        std::vector<Node> outer;
        for (const Node& node : wiring.scope().nodes)
            if (node.id != instance.id) outer.push_back(rewired(node));
        finish(std::move(outer));
        return {std::move(result), std::move(made)};
    }

  private:
    Position middleOfGroup() const {
        Position low{}, high{};
        bool first = true;
        for (const Node& node : group.nodes) {
            if (!node.at || roleOf(node.type) == NodeRole::groupInput ||
                roleOf(node.type) == NodeRole::groupOutput)
                continue;
            for (int axis = 0; axis < 2; ++axis) {
                low[axis] = first ? (*node.at)[axis] : std::min(low[axis], (*node.at)[axis]);
                high[axis] = first ? (*node.at)[axis] : std::max(high[axis], (*node.at)[axis]);
            }
            first = false;
        }
        return {std::round(0.5 * (low[0] + high[0])), std::round(0.5 * (low[1] + high[1]))};
    }

    std::optional<Type> typeOf(const Wiring& of, std::string_view scopeId, const Link& link) {
        const std::optional<Socket> socket = of.output({link.node, link.output});
        if (!socket || socket->type) return socket ? socket->type : std::nullopt;
        if (!sound) sound = !newError(Graph{}, graph);
        return *sound ? compiledType(graph, scopeId, link) : std::nullopt;
    }

    /// What the instance gives for an input of the group, of the type that is declared there once it has
    /// passed the group's end on its way to an input of type `next`.
    Source given(const std::string& name, std::optional<Type> next) {
        const auto declared = std::ranges::find(group.inputs, name, &GroupInput::name);
        if (declared == group.inputs.end()) return {};
        const std::optional<Type> type = typeNamed(declared->type);
        const InputValue* value = instance.input(name);
        if (!value && declared->value) value = &*declared->value;
        if (const Link* link = value ? std::get_if<Link>(&value->value) : nullptr) {
            if (link->node == instance.id) return {};
            return passed({*value, typeOf(wiring, scope, *link), ""}, type, next);
        }
        if (value) return {*value, type, name};
        const int count = type == Type::surface ? 0 : type ? componentCount(*type) : 0;
        if (count == 0) return {};
        return {valueOf(std::vector<double>(static_cast<std::size_t>(count), 0.0)), type, name};
    }

    /// What a link inside of the group carries.
    Source inner(const Link& link, std::optional<Type> next) {
        const Node* node = findNode(group.nodes, link.node);
        if (!node) return {};
        if (roleOf(node->type) == NodeRole::groupInput)
            return given(link.output.empty() && !group.inputs.empty() ? group.inputs[0].name : link.output,
                         next);
        const auto id = renamed.find(link.node);
        if (id == renamed.end()) return {};
        return {InputValue{Link{id->second, link.output}}, typeOf(inside, group.id, link), ""};
    }

    /// What an output of the group gives.
    Source output(std::string name, std::optional<Type> next) {
        if (name.empty() && !group.outputs.empty()) name = group.outputs[0].name;
        const auto declared = std::ranges::find(group.outputs, name, &GroupOutput::name);
        const auto end = std::ranges::find(group.nodes, "group_output", &Node::type);
        if (declared == group.outputs.end() || end == group.nodes.end()) return {};
        const std::optional<Type> type = typeNamed(declared->type);
        const InputValue* value = end->input(name);
        if (!value) return {};
        if (const Link* link = std::get_if<Link>(&value->value))
            return passed(inner(*link, type), type, next);
        return {*value, type, ""};
    }

    /// The source after it was converted to `type`, with a node in between where the next input would not
    /// convert it the same way.
    Source passed(Source source, std::optional<Type> type, std::optional<Type> next) {
        if (!isLink(source)) return source.value ? Source{source.value, source.type, source.input} : source;
        if (!type || !source.type || source.type == type || next == type) return source;
        const Link link = std::get<Link>(source.value->value);
        const char* converter = *type == Type::vec3            ? "combine_xyz"
                                : *type == Type::surface       ? "from_distance"
                                : source.type == Type::surface ? "distance"
                                                               : "value";
        if (*type != Type::vec3 && *type != Type::surface && *type != Type::scalar) return source;
        std::string& id = converters[{link.node, link.output, converter}];
        if (id.empty()) {
            Node node = newNode(converter);
            for (const InputSpec& spec : findNodeType(converter)->inputs) node.set(spec.name, {link});
            id = node.id;
            added.push_back(std::move(node));
        }
        return {InputValue{Link{id, ""}}, type, ""};
    }

    Node newNode(const char* type) {
        Node node;
        node.type = type;
        node.id = ids.next(type);
        node.at = {instance.at.value_or(Position{})[0] - 220.0,
                   instance.at.value_or(Position{})[1] + 90.0 * static_cast<double>(added.size())};
        return node;
    }

    /// A node that gives this value: a number or three. Its id, empty if there is none such.
    std::string constant(const Source& source) {
        const std::vector<double> numbers = numbersOf(*source.value);
        if (numbers.size() != 1 && numbers.size() != 3) return {};
        if (!source.input.empty())
            if (const auto known = constants.find(source.input); known != constants.end())
                return known->second;
        Node node = newNode(numbers.size() == 1 ? "value" : "vector");
        node.set("value", valueOf(numbers));
        const std::string id = node.id;
        added.push_back(std::move(node));
        if (!source.input.empty()) constants.emplace(source.input, id);
        return id;
    }

    /// The value as an input of this type holds it, if it can.
    static std::optional<InputValue> literal(const Source& source, const Socket& socket) {
        if (!socket.type) {  // of an expression
            const std::vector<double> numbers = numbersOf(*source.value);
            if (numbers.empty()) return {};
            return std::holds_alternative<bool>(source.value->value) ? valueOf(numbers) : *source.value;
        }
        InputValue value = *source.value;
        const std::vector<double> numbers = numbersOf(value);
        if (source.type != socket.type && numbers.size() == 1) {
            if (socket.type == Type::vec3) value = InputValue{std::vector<double>(3, numbers[0])};
            if (socket.type == Type::scalar) value = InputValue{numbers[0]};
        }
        if (valueProblem(*socket.type, socket.spec, value)) return {};
        return value;
    }

    /// Gives the source to an input of a node that is `of` in its former scope and `node` in the new one.
    void give(const Wiring& of, const std::string& former, Node& node, const std::string& name, Source source,
              std::optional<Type> wasFed) {
        const std::optional<Socket> socket = of.input({former, name});
        if (!source.value || !socket) return unlink(node, name, wasFed);
        if (isLink(source)) return node.set(name, *source.value);
        const int sites = source.input.empty() ? 0 : targets[source.input];
        const bool movable = source.type == Type::scalar || source.type == Type::vec3;
        const bool asNode = movable && (sites > 1 || (sites == 1 && valueNodes));
        // A reroute and a muted node pass on what is wired to them, no values.
        if (!asNode && !node.muted && roleOf(node.type) != NodeRole::reroute)
            if (const auto value = literal(source, *socket)) {
                node.set(name, *value);
                if (sites == 1) redirected[source.input] = {node.id, name};
                return;
            }
        const std::optional<Type> type = numbersOf(*source.value).size() == 3 ? Type::vec3 : Type::scalar;
        const bool takes = !socket->type || converts(*type, *socket->type);
        const std::string id = takes ? constant(source) : "";
        if (id.empty()) return unlink(node, name, wasFed);
        if (sites > 0) redirected[source.input] = {id, "value"};
        node.set(name, {Link{id, ""}});
    }

    /// How many inputs each input of the instance leads to that a parameter or a track sets.
    void countTargets() {
        if (!scope.empty()) return;
        std::set<std::string> names;
        const auto note = [&](const Plug& plug) {
            if (plug.node == instance.id) names.insert(plug.name);
            return std::optional<Plug>();
        };
        Graph asked;  // of which redirect() only asks
        asked.parameters = graph.parameters, asked.timeline = graph.timeline;
        redirect(asked, note);
        const auto end = std::ranges::find(group.nodes, "group_input", &Node::type);
        for (const std::string& name : names) {
            int& count = targets[name];
            for (const Node& node : group.nodes)
                for (const auto& [input, value] : node.inputs) {
                    const Link* link = std::get_if<Link>(&value.value);
                    if (!link || end == group.nodes.end()) continue;
                    const Node* from = findNode(group.nodes, link->node);
                    if (!from || roleOf(from->type) != NodeRole::groupInput) continue;
                    const std::string& output =
                        link->output.empty() && !group.inputs.empty() ? group.inputs[0].name : link->output;
                    if (output != name) continue;
                    count += roleOf(node.type) == NodeRole::groupOutput ? fedBy(input) : 1;
                }
        }
    }

    /// How many inputs outside this output of the instance feeds.
    int fedBy(const std::string& name) const {
        int count = 0;
        for (const Node& node : wiring.scope().nodes)
            for (const auto& [input, value] : node.inputs)
                if (const Link* link = std::get_if<Link>(&value.value))
                    count +=
                        link->node == instance.id &&
                        (link->output == name || (link->output.empty() && group.outputs[0].name == name));
        return count;
    }

    void addInner(const Node& original) {
        Node node = original;
        node.id = renamed.at(original.id);
        node.muted = node.muted || instance.muted;
        if (node.at) node.at = {(*node.at)[0] + shift[0], (*node.at)[1] + shift[1]};
        for (const auto& [name, value] : original.inputs) {
            const Link* link = std::get_if<Link>(&value.value);
            if (!link) continue;
            const std::optional<Socket> fed = inside.output({link->node, link->output});
            give(inside, original.id, node, name, inner(*link, typeAt(inside, original.id, name)),
                 fed ? fed->type : std::nullopt);
        }
        made.push_back(node.id);
        added.push_back(std::move(node));
    }

    static std::optional<Type> typeAt(const Wiring& of, const std::string& node, const std::string& input) {
        const std::optional<Socket> socket = of.input({node, input});
        return socket ? socket->type : std::nullopt;
    }

    Node rewired(const Node& original) {
        Node node = original;
        for (const auto& [name, value] : original.inputs) {
            const Link* link = std::get_if<Link>(&value.value);
            if (!link || link->node != instance.id) continue;
            const std::optional<Socket> fed = wiring.output({link->node, link->output});
            give(wiring, original.id, node, name, output(link->output, typeAt(wiring, original.id, name)),
                 fed ? fed->type : std::nullopt);
        }
        return node;
    }

    /// Whether the parameter led into the group, to a node of type parameter that says the same without it.
    bool namesItself(const ExposedParameter& parameter) const {
        const Node* node = findNode(result.nodes, parameter.node);
        if (!node || std::ranges::find(added, node->id, &Node::id) == added.end()) return false;
        Graph alone;
        alone.nodes = {*node};
        const std::optional<NamedParameter> own = findParameter(alone, parameter.name);
        return own && own->input == parameter.input && own->min == parameter.min.value_or(own->min) &&
               own->max == parameter.max.value_or(own->max);
    }

    void finish(std::vector<Node> outer) {
        std::size_t at = 0;
        while (wiring.scope().nodes[at].id != instance.id) ++at;
        const std::string groupId = group.id;
        outer.insert(outer.begin() + static_cast<std::ptrdiff_t>(at), added.begin(), added.end());
        nodesOf(result, scope) = std::move(outer);
        if (scope.empty())
            redirect(result, [&](const Plug& plug) -> std::optional<Plug> {
                const auto to = redirected.find(plug.name);
                if (plug.node != instance.id || to == redirected.end()) return {};
                return to->second;
            });
        std::erase_if(result.parameters, [&](const ExposedParameter& each) { return namesItself(each); });
        const auto shows = [&](const Node& node) { return node.group == groupId; };
        bool last = std::ranges::none_of(result.nodes, shows);
        for (const Group& each : result.groups) last = last && std::ranges::none_of(each.nodes, shows);
        std::vector<Frame> frames = framesOf(graph);
        for (std::size_t i = frames.size(); i-- > 0;) {
            Frame frame = frames[i];
            if (frame.scope != groupId) continue;
            frame.scope = scope;
            for (int axis = 0; axis < 2; ++axis) frame.at[axis] += shift[axis];
            result = setFrame(result, last ? i : framesOf(result).size(), frame);
        }
        if (last) std::erase_if(result.groups, [&](const Group& each) { return each.id == groupId; });
        dropLost(result, graph);
    }

    const Graph& graph;
    const std::string scope;
    const Wiring wiring;
    const Node& instance;
    const Group& group;
    const Wiring inside;
    const bool valueNodes;
    FreshIds ids;
    Graph result;
    Position shift{};
    std::unordered_map<std::string, std::string> renamed;  ///< ids of the group's nodes
    std::vector<Node> added;
    NodeIds made;
    std::map<std::tuple<std::string, std::string, std::string>, std::string> converters;
    std::map<std::string, std::string> constants;  ///< nodes, by the input of the instance
    std::map<std::string, int> targets;  ///< inputs of the instance that are set from outside of the nodes
    std::map<std::string, Plug> redirected;
    std::optional<bool> sound;
};

}  // namespace

Edited ungroup(const Graph& graph, std::string_view scope, std::string_view node) {
    const Node* instance = findNode(nodesOf(graph, scope), node);
    if (!instance || roleOf(instance->type) != NodeRole::group || !graph.group(instance->group) ||
        instance->group == scope)
        return {graph, {}};
    const std::size_t errors = errorCount(graph);
    Edited edited = Ungrouping(graph, scope, node, false).make();
    // An input may have a range that what sets it has not; a node with a value has none.
    if (errorCount(edited.graph) > errors) edited = Ungrouping(graph, scope, node, true).make();
    return errorCount(edited.graph) > errors ? Edited{graph, {}} : edited;
}

}  // namespace fw::editor
