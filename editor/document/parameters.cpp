#include "editor/document/parameters.h"

#include <algorithm>
#include <cmath>

#include "editor/document/references.h"
#include "graph/compile.h"

namespace fw::editor {

namespace {

std::optional<double> finite(double bound) {
    return std::isfinite(bound) ? std::optional(bound) : std::nullopt;
}

bool isTaken(const Graph& graph, const std::string& name) {
    return std::ranges::any_of(namedParameters(graph),
                               [&](const NamedParameter& each) { return each.name == name; });
}

std::string freshName(const Graph& graph, const Plug& input) {
    if (!isTaken(graph, input.name)) return input.name;
    const std::string base = input.node + "_" + input.name;
    std::string name = base;
    for (int i = 2; isTaken(graph, name); ++i) name = base + "_" + std::to_string(i);
    return name;
}

/// The track with "parameter" replaced by the node and the input that it drove.
Json directTrack(const Json& track, const ExposedParameter& parameter, const std::string& component) {
    Json direct = Json::object();
    for (const auto& [key, value] : track.items())
        if (key == "parameter")
            direct["node"] = parameter.node, direct["input"] = parameter.input + component;
        else
            direct[key] = value;
    return direct;
}

}  // namespace

std::string exposureRefusal(const Graph& graph, const Plug& input) {
    const Groups groups(graph);
    const Scope top(groups, graph.nodes, nullptr);
    const auto node = top.byId.find(input.node);
    if (node == top.byId.end()) return "only nodes outside of groups can have parameters";
    if (!hasKnownSockets(top, node->second)) return "the node's inputs are unknown";
    const std::optional<Socket> socket = settableSocket(top, node->second, input.name);
    if (!socket) return "the node has no such input";
    const InputValue* value = graph.nodes[node->second].input(input.name);
    if (value && std::holds_alternative<Link>(value->value)) return "it is linked";
    const Type type = socket->type.value_or(Type::string);
    if (componentCount(type) == 0 || type == Type::surface) return "it is no number";
    if (inputNumbers(graph.nodes[node->second], input.name).empty()) return "it has no value yet";
    if (parameterOf(graph, input)) return "it is a parameter already";
    return graph.parameters.size() >= kMaxEntries ? "there are too many parameters" : "";
}

std::optional<std::size_t> parameterOf(const Graph& graph, const Plug& input) {
    for (std::size_t i = 0; i < graph.parameters.size(); ++i)
        if (graph.parameters[i].node == input.node && graph.parameters[i].input == input.name) return i;
    return std::nullopt;
}

Graph exposeInput(const Graph& graph, const Plug& input) {
    if (!exposureRefusal(graph, input).empty()) return graph;
    ExposedParameter parameter;
    parameter.name = freshName(graph, input);
    parameter.node = input.node, parameter.input = input.name;
    const NodeType* type = findNodeType(graph.node(input.node)->type);
    if (const int index = type ? inputIndex(*type, input.name) : -1; index >= 0) {
        const InputSpec& spec = type->inputs[std::size_t(index)];
        parameter.min = finite(spec.min), parameter.max = finite(spec.max);
    }
    Graph result = graph;
    result.parameters.push_back(std::move(parameter));
    return result;
}

Graph removeParameter(const Graph& graph, std::size_t index) {
    if (index >= graph.parameters.size()) return graph;
    Graph result = graph;
    const ExposedParameter parameter = graph.parameters[index];
    result.parameters.erase(result.parameters.begin() + std::ptrdiff_t(index));
    // Another of its name takes its tracks over.
    if (isTaken(result, parameter.name) || !result.timeline.is_object()) return result;
    const auto tracks = result.timeline.find("tracks");
    if (tracks == result.timeline.end() || !tracks->is_array()) return result;
    for (Json& track : *tracks) {
        if (!track.is_object() || !track.contains("parameter") || !track["parameter"].is_string()) continue;
        const std::string name = track["parameter"];
        const auto [plain, component] = splitTrackInput(name);
        if (name == parameter.name)
            track = directTrack(track, parameter, "");
        else if (plain == parameter.name)
            track = directTrack(track, parameter, component);
        else
            continue;
        result.timelinePlaces.list.clear();  // which are counted along the values
    }
    return result;
}

Result<Graph> renameParameter(const Graph& graph, std::size_t index, std::string name) {
    if (index >= graph.parameters.size() || graph.parameters[index].name == name) return graph;
    if (name.empty() || name.find('=') != std::string::npos)
        return Error{.message = "a parameter's name is not empty and has no '='"};
    if (isTaken(graph, name))
        return Error{.message = "another parameter is named " + inQuotes(name) + ": choose another name"};
    Graph result = graph;
    renameParameterTracks(result, graph.parameters[index].name, name);
    result.parameters[index].name = std::move(name);
    return result;
}

Graph setParameterMin(const Graph& graph, std::size_t index, std::optional<double> min) {
    if (index >= graph.parameters.size()) return graph;
    Graph result = graph;
    ExposedParameter& parameter = result.parameters[index];
    parameter.min = min;
    if (min && parameter.max) parameter.max = std::max(*min, *parameter.max);
    return result;
}

Graph setParameterMax(const Graph& graph, std::size_t index, std::optional<double> max) {
    if (index >= graph.parameters.size()) return graph;
    Graph result = graph;
    ExposedParameter& parameter = result.parameters[index];
    parameter.max = max;
    if (max && parameter.min) parameter.min = std::min(*max, *parameter.min);
    return result;
}

Graph moveParameter(const Graph& graph, std::size_t index, std::size_t to) {
    if (index >= graph.parameters.size() || to >= graph.parameters.size()) return graph;
    Graph result = graph;
    ExposedParameter parameter = std::move(result.parameters[index]);
    result.parameters.erase(result.parameters.begin() + std::ptrdiff_t(index));
    result.parameters.insert(result.parameters.begin() + std::ptrdiff_t(to), std::move(parameter));
    return result;
}

}  // namespace fw::editor
