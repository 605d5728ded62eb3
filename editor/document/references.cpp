#include "editor/document/references.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "editor/document/wiring.h"
#include "graph/document/named_parameters.h"
#include "graph/document/timeline.h"

namespace fw::editor {

namespace {

/// The timeline's tracks, if it has a list of them.
Json* tracksOf(Graph& graph) {
    if (!graph.timeline->is_object()) return nullptr;
    const auto tracks = graph.timeline->find("tracks");
    return tracks != graph.timeline->end() && tracks->is_array() ? &*tracks : nullptr;
}

/// The text under this key of a track, const or not; nullptr if there is none.
template <class Track>
auto textOf(Track& track, const char* key) {
    using Text = std::conditional_t<std::is_const_v<Track>, const std::string, std::string>;
    if (!track.is_object()) return static_cast<Text*>(nullptr);
    const auto found = track.find(key);
    return found == track.end() ? nullptr : found->template get_ptr<Text*>();
}

/// Whether the input can be set; of a track also whether it has numbers to move.
bool isTarget(const Graph& graph, const Scope& top, const Plug& plug, bool ofTrack) {
    const auto node = top.byId.find(plug.node);
    if (node == top.byId.end() || !hasKnownSockets(top, node->second)) return false;
    const std::string name = ofTrack ? splitTrackInput(plug.name).first : plug.name;
    if (!settableSocket(top, node->second, name)) return false;
    const InputValue* value = graph.nodes[node->second].input(name);
    return !ofTrack || (value && std::holds_alternative<Link>(value->value)) ||
           !inputNumbers(graph.nodes[node->second], name).empty();
}

/// Whether what the track moves is there; true for tracks of the scene.
bool leadsSomewhere(const Graph& graph, const Scope& top, const Json& track) {
    const std::string *node = textOf(track, "node"), *input = textOf(track, "input"),
                      *parameter = textOf(track, "parameter");
    if (node && input) return isTarget(graph, top, {*node, *input}, true);
    if (!parameter) return true;
    Track wanted;
    wanted.target = Track::Target::parameter, wanted.name = *parameter;
    const auto found = animatedInput(graph, wanted);
    return found && isTarget(graph, top, {found->node, found->input}, true);
}

}  // namespace

std::pair<std::string, std::string> splitTrackInput(const std::string& name) {
    const std::size_t dot = name.rfind('.');
    const std::string end = dot == std::string::npos ? "" : name.substr(dot);
    return end == ".x" || end == ".y" || end == ".z" ? std::pair(name.substr(0, dot), end)
                                                     : std::pair(name, std::string());
}

void redirect(Graph& graph, const Redirect& to) {
    for (ExposedParameter& parameter : graph.parameters)
        if (const auto plug = to({parameter.node, parameter.input}))
            parameter.node = plug->node, parameter.input = plug->name;
    Json* tracks = tracksOf(graph);
    if (!tracks) return;
    for (Json& track : *tracks) {
        std::string *node = textOf(track, "node"), *input = textOf(track, "input");
        if (!node || !input) continue;
        const auto [name, component] = splitTrackInput(*input);
        if (const auto plug = to({*node, name})) *node = plug->node, *input = plug->name + component;
    }
}

void renameParameterTracks(Graph& graph, const std::string& from, const std::string& to) {
    Json* tracks = tracksOf(graph);
    if (!tracks) return;
    for (Json& track : *tracks)
        if (std::string* name = textOf(track, "parameter")) {
            const auto [plain, component] = splitTrackInput(*name);
            if (*name == from)
                *name = to;
            else if (plain == from)
                *name = to + component;
        }
}

void dropLost(Graph& graph, const Graph& before) {
    if (graph.parameters.empty() && !tracksOf(graph)) return;
    const Groups groups(graph), formerGroups(before);
    const Scope top(groups, graph.nodes, nullptr), formerTop(formerGroups, before.nodes, nullptr);
    const auto isLost = [&](const Json& track) {
        return !leadsSomewhere(graph, top, track) && leadsSomewhere(before, formerTop, track);
    };
    Json* tracks = tracksOf(graph);
    std::vector<std::size_t> lost;  // found before the parameters go that they may lead to
    for (std::size_t i = 0; tracks && i < tracks->size(); ++i)
        if (isLost((*tracks)[i])) lost.push_back(i);
    std::erase_if(graph.parameters, [&](const ExposedParameter& parameter) {
        const Plug plug{parameter.node, parameter.input};
        return !isTarget(graph, top, plug, false) && isTarget(before, formerTop, plug, false);
    });
    for (std::size_t i = lost.size(); i-- > 0;)
        tracks->erase(tracks->begin() + static_cast<std::ptrdiff_t>(lost[i]));
    if (!lost.empty()) graph.timelinePlaces.list.clear();  // which are counted along the values
}

std::string targetRefusal(const Graph& graph, const Plug& input) {
    const Wiring wiring(graph, "");
    const std::optional<uint32_t> node = wiring.find(input.node);
    if (!node) return "it is possible only for nodes outside of groups";
    if (!hasKnownSockets(wiring.scope(), *node)) return "the node's inputs are unknown";
    const std::optional<Socket> socket = settableSocket(wiring.scope(), *node, input.name);
    if (!socket) return "the node has no such input";
    const InputValue* value = graph.nodes[*node].input(input.name);
    if (value && std::holds_alternative<Link>(value->value)) return "it is linked";
    const Type type = socket->type.value_or(Type::string);
    if (componentCount(type) == 0 || type == Type::surface) return "it is no number";
    return inputNumbers(graph.nodes[*node], input.name).empty() ? "it has no value yet" : "";
}

}  // namespace fw::editor
