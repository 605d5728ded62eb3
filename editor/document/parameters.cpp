#include "editor/document/parameters.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "editor/document/references.h"
#include "graph/document/named_parameters.h"

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

Graph withRange(const Graph& graph, std::size_t index, std::optional<double> min, std::optional<double> max) {
    Graph result = graph;
    result.parameters[index].min = min, result.parameters[index].max = max;
    return result;
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
    if (std::string refusal = targetRefusal(graph, input); !refusal.empty()) return refusal;
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
    if (isTaken(result, parameter.name) || !result.timeline->is_object()) return result;
    const auto tracks = result.timeline->find("tracks");
    if (tracks == result.timeline->end() || !tracks->is_array()) return result;
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
    const std::optional<double> max = graph.parameters[index].max;
    return withRange(graph, index, min, min && max ? std::max(*min, *max) : max);
}

Graph setParameterMax(const Graph& graph, std::size_t index, std::optional<double> max) {
    if (index >= graph.parameters.size()) return graph;
    const std::optional<double> min = graph.parameters[index].min;
    return withRange(graph, index, min && max ? std::min(*min, *max) : min, max);
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
