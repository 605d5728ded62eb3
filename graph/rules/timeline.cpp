// The part of check() about the timeline and the scene.
#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "graph/base/words.h"
#include "graph/document/named_parameters.h"
#include "graph/document/scene.h"
#include "graph/document/timeline.h"
#include "graph/rules/findings.h"

namespace fw {

namespace {

std::string seconds(double time) { return shortNumber(time) + " s"; }

/// What messages call it.
std::string nameOf(const Track& track) {
    switch (track.target) {
        case Track::Target::input: return "its track";  // the place of the finding names node and input
        case Track::Target::parameter: return "the track of parameter " + inQuotes(track.name);
        case Track::Target::scene: return "the track of scene " + inQuotes(track.name);
    }
    return {};
}

void checkKeys(const Timeline& timeline, const Track& track, Findings& findings) {
    const std::size_t count = track.keys.front().value.size();
    const double* before = nullptr;
    for (const Key& key : track.keys) {
        if (findings.full()) return;
        const Place place{key.place, track.node, track.target == Track::Target::input ? track.name : ""};
        if (!std::isfinite(key.time) || key.time < 0.0) {
            findings.error(place, nameOf(track) + ": a key's time must be a number from 0 on, not " +
                                      shortNumber(key.time));
            continue;
        }
        if (before && key.time < *before)
            findings.error(place, nameOf(track) + ": its keys are not in the order of their times: " +
                                      seconds(key.time) + " comes after " + seconds(*before));
        if (before && key.time == *before)
            findings.error(place, nameOf(track) + ": two keys at " + seconds(key.time) +
                                      ": move or remove one (for a jump, use \"interpolation\": \"step\")");
        if (key.time > timeline.length)
            findings.warning(place, nameOf(track) + ": the key at " + seconds(key.time) +
                                        " lies beyond the timeline's length of " + seconds(timeline.length));
        for (double number : key.value)
            if (!std::isfinite(number)) {
                findings.error(place, nameOf(track) + ": the value of the key at " + seconds(key.time) +
                                          " is not a number");
                break;
            }
        if (key.value.size() != count)
            findings.error(place, nameOf(track) + ": the key at " + seconds(key.time) + " has " +
                                      std::to_string(key.value.size()) + " numbers, the first one has " +
                                      std::to_string(count));
        for (const auto& [side, slopes] : {std::pair{"in", &key.in}, {"out", &key.out}}) {
            if (slopes->size() > 1 && slopes->size() != key.value.size())
                findings.error(place, nameOf(track) + ": the key at " + seconds(key.time) + " has " +
                                          std::to_string(slopes->size()) + " slopes \"" + side + "\" for " +
                                          std::to_string(key.value.size()) +
                                          (key.value.size() == 1 ? " number" : " numbers"));
            if (!std::all_of(slopes->begin(), slopes->end(), [](double x) { return std::isfinite(x); }))
                findings.error(place, nameOf(track) + ": a slope of the key at " + seconds(key.time) +
                                          " is not a number");
        }
        before = &key.time;
    }
}

void checkMarkers(const Timeline& timeline, const Place& start, Findings& findings) {
    for (const Marker& marker : timeline.markers) {
        if (findings.full()) return;
        const Place place{marker.place, {}, {}};
        if (!std::isfinite(marker.time) || marker.time < 0.0)
            findings.error(place,
                           "a marker's time must be a number from 0 on, not " + shortNumber(marker.time));
    }
    if (!timeline.range) return;
    const auto [from, to] = *timeline.range;
    if (!(from >= 0.0 && from < to && std::isfinite(to)))
        findings.error(start,
                       "the timeline's range must begin at 0 or later and end after that, not go from " +
                           seconds(from) + " to " + seconds(to));
    else if (from >= timeline.length)
        findings.warning(start, "the timeline's range begins at " + seconds(from) +
                                    ", beyond the timeline's length of " + seconds(timeline.length));
}

/// A track of an input or parameter: what it moves exists, can move, and takes the keys' values.
void checkInput(const Graph& graph, const Scope& top, const Track& track, Findings& findings) {
    Place place{track.place, track.node, track.target == Track::Target::input ? track.name : ""};
    const auto animated = animatedInput(graph, track);
    if (!animated && track.target == Track::Target::parameter) {
        std::vector<std::string> names;
        if (!findings.full())
            for (const NamedParameter& parameter : namedParameters(graph)) names.push_back(parameter.name);
        return findings.error(place,
                              nameOf(track) + ": the graph has no such parameter" +
                                  findings.hint(track.name, names, names.empty() ? ": it exposes none" : ""));
    }
    if (!animated)
        return findings.error(place, nameOf(track) + ": there is no node " + inQuotes(track.node) +
                                         (findings.full() ? "" : findings.hint(track.node, idsOf(top))));
    const auto found = top.byId.find(animated->node);
    if (found == top.byId.end() || !hasKnownSockets(top, found->second)) return;
    const uint32_t i = found->second;
    const std::optional<Socket> socket = settableSocket(top, i, animated->input);
    const InputValue* value = top.nodes[i].input(animated->input);
    if (!socket) {
        if (track.target == Track::Target::parameter) return;  // the parameter has its own finding
        const std::vector<std::string> names = inputNames(top, i);
        return findings.error(
            place, nameOf(track) + ": the node has no such input" +
                       findings.hint(animated->input, names,
                                     names.empty() ? "; it has none" : "; it has " + listed(names)));
    }
    if (value && std::holds_alternative<Link>(value->value))
        return findings.warning(place, nameOf(track) + " has no effect: the input is linked");
    const NodeType* type = top.types[i];
    const Type kind = socket->type.value_or(Type::string);
    // What has no default shapes a grid, which is known when the graph is compiled.
    const bool shapesGrid = socket->spec && socket->spec->value.kind == InputDefault::Kind::none;
    if ((kind != Type::scalar && kind != Type::vec2 && kind != Type::vec3) ||
        type->category == Category::mesh || shapesGrid)
        return findings.error(place, nameOf(track) +
                                         ": this input cannot move over time: a number or a vector "
                                         "can that shapes the field");
    if (inputNumbers(top.nodes[i], animated->input).empty())
        return findings.error(place,
                              nameOf(track) + ": the input needs a value of its own: it has no default");
    const int components = animated->component >= 0 ? 1 : componentCount(kind);
    if (animated->component >= componentCount(kind))
        return findings.error(place, nameOf(track) + ": the input has no such component");
    for (const Key& key : track.keys) {
        if (findings.full()) return;
        place.at = key.place;
        if (key.value.size() != 1 && key.value.size() != static_cast<std::size_t>(components))
            return findings.error(place, nameOf(track) + ": the key has " + std::to_string(key.value.size()) +
                                             " numbers, the input takes " + std::to_string(components));
        for (double number : key.value)
            if (number < animated->min || number > animated->max)
                findings.error(place, nameOf(track) + ": the value " + shortNumber(number) + " at " +
                                          seconds(key.time) + " is out of the input's range, " +
                                          shortNumber(animated->min) + " to " + shortNumber(animated->max));
    }
}

void checkSceneTrack(const Graph& graph, const Track& track, Findings& findings) {
    const Place place{track.place, {}, {}};
    const std::string_view path = track.name;
    if (path.empty() || path.front() == '.' || path.back() == '.' ||
        path.find("..") != std::string_view::npos)
        return findings.error(
            place, nameOf(track) + ": write the way to the value with dots, as \"camera.position\"");
    Json scene = graph.scene;
    Json* value = sceneValue(scene, path);
    if (!value)
        return findings.error(place, nameOf(track) + ": the scene has no value there that could move");
    if (!readScene(graph.scene)) return;  // which has a finding of its own
    *value = "not a number";              // every key that the scene knows refuses that
    if (readScene(scene))
        return findings.warning(place, nameOf(track) + " has no effect: the scene knows no such value");
    for (const Key& key : track.keys) {
        if (findings.full()) return;
        if (key.value.size() != track.keys.front().value.size()) continue;  // checkKeys() says so
        setNumbers(*value, key.value);
        const Result<Scene> read = readScene(scene);
        if (!read)
            findings.error({key.place, {}, {}},
                           nameOf(track) + ", the key at " + seconds(key.time) + ": " + read.error().message);
    }
}

/// Whether one of two paths moves what the other moves too.
bool overlaps(std::string_view a, std::string_view b) {
    if (a.size() > b.size()) std::swap(a, b);
    return b.starts_with(a) && (b.size() == a.size() || b[a.size()] == '.');
}

}  // namespace

void checkTimeline(const Graph& graph, const Scope& top, Findings& findings) {
    std::vector<Error> warnings;
    const Result<Timeline> timeline = readTimeline(graph, &warnings);
    for (const Error& warning : warnings)
        findings.warning({{warning.line, warning.column}, {}, {}}, warning.message);
    if (!timeline)
        return findings.error({{timeline.error().line, timeline.error().column}, {}, {}},
                              timeline.error().message);
    const Result<Scene> scene = readScene(graph.scene, graph.scenePlaces);
    if (!scene) findings.error({{scene.error().line, scene.error().column}, {}, {}}, scene.error().message);
    if (graph.timeline->is_null()) return;
    const Place start{
        graph.timelinePlaces.list.empty() ? TextPosition{} : graph.timelinePlaces.list[0], {}, {}};
    if (!(timeline->length > 0.0 && timeline->length <= kMostTimelineLength))
        findings.error(start, "the timeline's length must be above 0 and at most " +
                                  seconds(kMostTimelineLength) + ", not " + shortNumber(timeline->length));
    if (!(timeline->framesPerSecond > 0.0 && timeline->framesPerSecond <= kMostFramesPerSecond))
        findings.error(start, "the timeline's fps must be above 0 and at most " +
                                  shortNumber(kMostFramesPerSecond) + ", not " +
                                  shortNumber(timeline->framesPerSecond));
    checkMarkers(*timeline, start, findings);
    std::map<std::string, const Track*> taken;
    for (const Track& track : timeline->tracks) {
        checkKeys(*timeline, track, findings);
        if (track.target == Track::Target::scene)
            checkSceneTrack(graph, track, findings);
        else
            checkInput(graph, top, track, findings);

        const auto animated = animatedInput(graph, track);
        const std::string target =
            track.target == Track::Target::scene ? "scene." + track.name
            : animated                           ? "node." + animated->node + "." + animated->input +
                             (animated->component < 0 ? "" : "." + std::string(1, "xyz"[animated->component]))
                       : std::string();
        if (target.empty()) continue;
        // What begins like the target sorts right after it, what the target begins like stands before.
        const Track* other = nullptr;
        for (std::size_t end = target.find('.'); !other; end = target.find('.', end + 1)) {
            const auto same = taken.find(target.substr(0, end));
            if (same != taken.end()) other = same->second;
            if (end == std::string::npos) break;
        }
        const auto after = taken.lower_bound(target + ".");
        if (!other && after != taken.end() && overlaps(target, after->first)) other = after->second;
        if (other)
            findings.error({track.place, {}, {}}, nameOf(track) + " moves what another track moves" +
                                                      firstInLine(other->place) + ": remove one");
        taken.emplace(target, &track);
    }
}

}  // namespace fw
