#include "editor/document/scene_edits.h"

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

namespace fw::editor {

namespace {

Json jsonOf(const Triple& triple) { return Json(std::vector<double>(triple.begin(), triple.end())); }

/// The first part of a dotted path, and the rest.
std::pair<std::string_view, std::string_view> split(std::string_view path) {
    const std::size_t dot = path.find('.');
    if (dot == std::string_view::npos) return {path, {}};
    return {path.substr(0, dot), path.substr(dot + 1)};
}

std::optional<std::size_t> indexOf(std::string_view text) {
    std::size_t index = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), index);
    if (failure != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return index;
}

/// The value at the path, made as far as it is missing; nullptr if the path leads beyond a list.
Json* reach(Json& at, std::string_view path) {
    if (path.empty()) return &at;
    const auto [step, rest] = split(path);
    if (at.is_array()) {
        const auto index = indexOf(step);
        return index && *index < at.size() ? reach(at[*index], rest) : nullptr;
    }
    if (at.is_null() && indexOf(step)) return nullptr;  // an entry of a list that is not there
    if (!at.is_object()) at = Json::object();
    return reach(at[std::string(step)], rest);
}

void forget(Json& at, std::string_view path) {
    const auto [step, rest] = split(path);
    if (at.is_array()) {
        const auto index = indexOf(step);
        if (index && *index < at.size() && !rest.empty()) forget(at[*index], rest);
        return;
    }
    const auto found = at.is_object() ? at.find(std::string(step)) : at.end();
    if (!at.is_object() || found == at.end()) return;
    if (rest.empty())
        at.erase(found);
    else
        forget(*found, rest);
}

/// A copy whose scene may be changed: the places of its values are counted along them.
Graph withScene(const Graph& graph) {
    Graph result = graph;
    result.scenePlaces.list.clear();
    return result;
}

constexpr std::string_view kLights = "lights.";

/// Leads tracks of lamps behind the one removed to where these stand now; drops those of that one.
void followLamps(Graph& graph, std::size_t removed) {
    if (!graph.timeline->is_object() || !graph.timeline->contains("tracks")) return;
    Json& tracks = (*graph.timeline)["tracks"];
    if (!tracks.is_array()) return;
    for (std::size_t i = tracks.size(); i-- > 0;) {
        Json& track = tracks[i];
        if (!track.is_object() || !track.contains("scene") || !track["scene"].is_string()) continue;
        const std::string path = track["scene"];
        if (!path.starts_with(kLights)) continue;
        const auto [entry, rest] = split(std::string_view(path).substr(kLights.size()));
        const auto index = indexOf(entry);
        if (!index || *index < removed) continue;
        if (*index == removed)
            tracks.erase(tracks.begin() + std::ptrdiff_t(i));
        else
            track["scene"] = std::string(kLights) + std::to_string(*index - 1) + "." + std::string(rest);
        graph.timelinePlaces.list.clear();
    }
}

}  // namespace

Graph setSceneValue(const Graph& graph, std::string_view path, Json value) {
    Graph result = withScene(graph);
    Json* at = reach(*result.scene, path);
    if (!at) return graph;
    *at = std::move(value);
    return result;
}

Graph clearSceneValue(const Graph& graph, std::string_view path) {
    Graph result = withScene(graph);
    forget(*result.scene, path);
    return result;
}

Graph switchScene(const Graph& graph, std::string_view part, bool on) {
    const bool isOn = graph.scene->is_object() && graph.scene->contains(std::string(part)) &&
                      (*graph.scene)[std::string(part)].is_object();
    if (on && isOn) return graph;
    return setSceneValue(graph, part, on ? Json::object() : Json(false));
}

Graph setSceneCamera(const Graph& graph, const std::optional<Camera>& camera) {
    if (!camera) return clearSceneValue(graph, "camera");
    Graph result = setSceneValue(graph, "camera.position", jsonOf(camera->position));
    result = setSceneValue(result, "camera.target", jsonOf(camera->target));
    return setSceneValue(result, "camera.fov", camera->fov);
}

const std::vector<std::string>& lampTypes() {
    static const std::vector<std::string> names = {"point", "spot", "directional"};
    return names;
}

Graph addLamp(const Graph& graph, const Lamp& lamp) {
    Graph result = withScene(graph);
    if (!result.scene->is_object()) result.scene = Json::object();
    Json& lights = (*result.scene)["lights"];
    if (!lights.is_array()) lights = Json::array();
    if (lights.size() >= kMostLights) return graph;
    Json json = {{"type", lampTypes()[std::size_t(lamp.type)]}, {"position", jsonOf(lamp.position)}};
    if (lamp.type != Lamp::Type::point) json["target"] = jsonOf(lamp.target);
    json["color"] = jsonOf(lamp.color);
    json["strength"] = lamp.strength;
    lights.push_back(std::move(json));
    return result;
}

Graph removeLamp(const Graph& graph, std::size_t index) {
    if (!graph.scene->is_object() || !graph.scene->contains("lights")) return graph;
    const Json& before = (*graph.scene)["lights"];
    if (!before.is_array() || index >= before.size()) return graph;
    Graph result = withScene(graph);
    Json& lights = (*result.scene)["lights"];
    lights.erase(lights.begin() + std::ptrdiff_t(index));
    if (lights.empty()) result.scene->erase("lights");
    followLamps(result, index);
    return result;
}

}  // namespace fw::editor
