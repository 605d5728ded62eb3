#include "editor/document/timeline_edits.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "editor/document/references.h"
#include "editor/document/timeline_json.h"
#include "editor/document/wiring.h"

namespace fw::editor {

namespace {

/// editedTimeline() for a track that exists. A length that follows from the last key is written down first,
/// so that keys can be moved without moving the end.
template <class Change>
Graph editedTrack(const Graph& graph, std::size_t track, Change change) {
    return editedTimeline(graph, [&](Json& json, const Timeline& timeline) {
        if (track >= timeline.tracks.size()) return;
        member(json, "length", timeline.length);
        change(json["tracks"], timeline.tracks[track]);
    });
}

/// The same for a key of it: change(keys, index).
template <class Change>
Graph editedKey(const Graph& graph, std::size_t track, std::size_t key, Change change) {
    return editedTrack(graph, track, [&](Json& tracks, const Track& read) {
        if (key < read.keys.size()) change(tracks[track]["keys"], key);
    });
}

/// Adds the key where its time belongs; what is there already at that time goes.
void insertKey(Json& keys, Json key) {
    const double time = timeOf(key);
    std::size_t at = 0;
    while (at < keys.size() && timeOf(keys[at]) < time - kSameTime) ++at;
    if (at < keys.size() && std::abs(timeOf(keys[at]) - time) <= kSameTime)
        keys[at] = std::move(key);
    else
        keys.insert(keys.begin() + std::ptrdiff_t(at), std::move(key));
}

}  // namespace

void chooseForKey(Json& track, Json& key, const char* name, const std::vector<std::string>& names,
                  std::size_t chosen) {
    const std::string usual = track.contains(name) ? track[name].get<std::string>() : std::string();
    const std::size_t unsaid =
        name == std::string_view("interpolation") ? std::size_t(Interpolation::linear) : 0;
    if (names[chosen] == (usual.empty() ? names[unsaid] : usual))
        key.erase(name);
    else
        key[name] = names[chosen];
}

Moved movedBy(const Track& track) { return {track.target, track.node, track.name}; }

std::string nameOf(const Graph& graph, const Moved& moved) {
    if (moved.target != Track::Target::input) return moved.name;
    const Node* node = graph.node(moved.node);
    const std::string& title = node && !node->label.empty() ? node->label : moved.node;
    return title + " · " + moved.name;
}

std::optional<std::size_t> trackOf(const Timeline& timeline, const Moved& moved) {
    for (std::size_t i = 0; i < timeline.tracks.size(); ++i)
        if (movedBy(timeline.tracks[i]) == moved) return i;
    return std::nullopt;
}

std::optional<std::size_t> trackOfInput(const Graph& graph, const Timeline& timeline, const Plug& input) {
    for (std::size_t i = 0; i < timeline.tracks.size(); ++i)
        if (const auto animated = animatedInput(graph, timeline.tracks[i]))
            if (animated->component < 0 && animated->node == input.node && animated->input == input.name)
                return i;
    return std::nullopt;
}

std::optional<std::size_t> keyAt(const Track& track, double time) {
    for (std::size_t i = 0; i < track.keys.size(); ++i)
        if (std::abs(track.keys[i].time - time) <= kSameTime) return i;
    return std::nullopt;
}

std::string motionRefusal(const Graph& graph, const Plug& input) {
    if (std::string refusal = targetRefusal(graph, input); !refusal.empty()) return refusal;
    const Wiring wiring(graph, "");
    const uint32_t node = *wiring.find(input.node);
    const std::optional<Type> type = settableSocket(wiring.scope(), node, input.name)->type;
    if (type != Type::scalar && type != Type::vec2 && type != Type::vec3)
        return "only numbers and vectors move over time";
    return wiring.scope().types[node]->category == Category::mesh ? "it does not shape the field" : "";
}

Graph setTimelineLength(const Graph& graph, double seconds) {
    if (!(seconds > 0.0)) return graph;
    return editedTimeline(
        graph, [&](Json& json, const Timeline&) { json["length"] = std::min(seconds, kMostTimelineLength); });
}

Graph setFramesPerSecond(const Graph& graph, double frames) {
    if (!(frames > 0.0)) return graph;
    return editedTimeline(
        graph, [&](Json& json, const Timeline&) { json["fps"] = std::min(frames, kMostFramesPerSecond); });
}

Graph setLoop(const Graph& graph, Loop loop) {
    return editedTimeline(
        graph, [&](Json& json, const Timeline&) { json["loop"] = loopNames()[std::size_t(loop)]; });
}

Graph setKey(const Graph& graph, const Moved& moved, double time, std::span<const double> value) {
    if (value.empty() || !(time >= 0.0)) return graph;
    return editedTimeline(graph, [&](Json& json, const Timeline& timeline) {
        member(json, "length", timeline.length);
        Json& tracks = member(json, "tracks", Json::array());
        std::optional<std::size_t> track = trackOf(timeline, moved);
        if (!track && tracks.size() >= kMaxTracks) return;
        if (!track) {
            Json added = Json::object();
            if (moved.target == Track::Target::input)
                added["node"] = moved.node, added["input"] = moved.name;
            else
                added[moved.target == Track::Target::parameter ? "parameter" : "scene"] = moved.name;
            added["keys"] = Json::array();
            tracks.push_back(std::move(added));
            track = tracks.size() - 1;
        } else if (const auto there = keyAt(timeline.tracks[*track], time)) {
            tracks[*track]["keys"][*there]["value"] = numbersJson(value);
            return;
        }
        insertKey(tracks[*track]["keys"], {{"time", time}, {"value", numbersJson(value)}});
    });
}

Graph moveKey(const Graph& graph, std::size_t track, std::size_t key, double time) {
    return editedKey(graph, track, key, [&](Json& keys, std::size_t at) {
        Json moved = keys[at];
        moved["time"] = std::max(time, 0.0);
        keys.erase(keys.begin() + std::ptrdiff_t(at));
        insertKey(keys, std::move(moved));
    });
}

Graph setInterpolation(const Graph& graph, std::size_t track, std::size_t key, Interpolation interpolation) {
    return editedTrack(graph, track, [&](Json& tracks, const Track& read) {
        if (key < read.keys.size())
            chooseForKey(tracks[track], tracks[track]["keys"][key], "interpolation", interpolationNames(),
                         std::size_t(interpolation));
    });
}

Graph setEase(const Graph& graph, std::size_t track, std::size_t key, Ease ease) {
    return editedTrack(graph, track, [&](Json& tracks, const Track& read) {
        if (key < read.keys.size())
            chooseForKey(tracks[track], tracks[track]["keys"][key], "ease", easeNames(), std::size_t(ease));
    });
}

Graph removeKey(const Graph& graph, std::size_t track, std::size_t key) {
    return editedTrack(graph, track, [&](Json& tracks, const Track& read) {
        if (key >= read.keys.size()) return;
        if (read.keys.size() == 1)
            tracks.erase(tracks.begin() + std::ptrdiff_t(track));
        else
            tracks[track]["keys"].erase(tracks[track]["keys"].begin() + std::ptrdiff_t(key));
    });
}

Graph removeTrack(const Graph& graph, std::size_t track) {
    return editedTrack(graph, track, [&](Json& tracks, const Track&) {
        tracks.erase(tracks.begin() + std::ptrdiff_t(track));
    });
}

}  // namespace fw::editor
