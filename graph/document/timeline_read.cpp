// The reading half of timeline.h.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "graph/base/words.h"
#include "graph/document/placed_json.h"
#include "graph/document/timeline.h"
#include "graph/library/node_type.h"

namespace fw {

namespace {

std::string_view kindOf(const Json& json) {
    if (json.is_null()) return "null";
    if (json.is_boolean()) return "a boolean";
    if (json.is_number()) return "a number";
    if (json.is_string()) return "a string";
    return json.is_array() ? "an array" : "an object";
}

/// Every function returns false after it has stored the one error.
class TimelineReader {
  public:
    TimelineReader(const Graph& graph_, std::vector<Error>* findings) : graph(graph_), warnings(findings) {}

    bool read() {
        bool hasLength = false;
        const PlacedJson root(graph.timeline, graph.timelinePlaces);
        if (!root.value().is_object())
            return fail(root, "\"timeline\" must be an object, not " + std::string(kindOf(root.value())));
        const bool sound = root.forMembers([&](const std::string& key, const PlacedJson& value) {
            if (key == "length") return hasLength = true, number(value, key, timeline.length);
            if (key == "fps") return number(value, key, timeline.framesPerSecond);
            if (key == "loop") return choice(value, key, loopNames(), timeline.loop);
            if (key == "tracks") return tracks(value);
            if (key == "markers") return markers(value);
            if (key == "range") return range(value);
            return unknown(value, key, {"length", "fps", "loop", "tracks", "markers", "range"});
        });
        if (!sound) return false;
        if (!hasLength) {
            double last = 0.0;
            for (const Track& track : timeline.tracks)
                for (const Key& key : track.keys)
                    if (std::isfinite(key.time)) last = std::max(last, key.time);
            if (last > 0.0) timeline.length = last;
        }
        for (Track& track : timeline.tracks) {
            const Key &first = track.keys.front(), &last = track.keys.back();
            track.closed = timeline.loop == Loop::repeat && first.time == 0.0 &&
                           last.time == timeline.length && first.value == last.value;
        }
        return true;
    }

    Timeline timeline;
    Error error;

  private:
    bool fail(const PlacedJson& where, std::string message) {
        error = {.message = std::move(message),
                 .file = graph.path,
                 .line = where.at().line,
                 .column = where.at().column};
        return false;
    }

    bool failKind(const PlacedJson& value, const std::string& key, const std::string& wanted) {
        return fail(value,
                    "\"" + key + "\" must be " + wanted + ", not " + std::string(kindOf(value.value())));
    }

    bool unknown(const PlacedJson& value, const std::string& key, const std::vector<std::string>& known) {
        if (!warnings) return true;
        const std::string near = nearestName(key.substr(0, 64), known);
        warnings->push_back({.message = "unknown key " + inQuotes(key) +
                                        " of the timeline is kept but has no effect" +
                                        (near.empty() ? "" : "; did you mean '" + near + "'?"),
                             .file = graph.path,
                             .line = value.at().line,
                             .column = value.at().column,
                             .severity = Error::Severity::warning});
        return true;
    }

    bool number(const PlacedJson& value, const std::string& key, double& to) {
        if (!value.value().is_number()) return failKind(value, key, "a number");
        to = value.value().get<double>();
        return true;
    }

    bool text(const PlacedJson& value, const std::string& key, std::string& to) {
        if (!value.value().is_string()) return failKind(value, key, "a string");
        to = value.value().get<std::string>();
        return true;
    }

    template <class Choice>
    bool choice(const PlacedJson& value, const std::string& key, const std::vector<std::string>& names,
                Choice& to) {
        std::string list;
        for (const std::string& name : names) list += (list.empty() ? "\"" : ", \"") + name + "\"";
        if (!value.value().is_string()) return failKind(value, key, "one of " + list);
        const std::string name = value.value().get<std::string>();
        const auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end())
            return fail(value, "\"" + key + "\" must be one of " + list + ", not " + inQuotes(name));
        to = static_cast<Choice>(found - names.begin());
        return true;
    }

    bool markers(const PlacedJson& value) {
        if (!value.value().is_array()) return failKind(value, "markers", "an array of markers");
        return value.forEntries(
            [&](const PlacedJson& entry) { return marker(entry, timeline.markers.emplace_back()); });
    }

    bool marker(const PlacedJson& value, Marker& to) {
        if (!value.value().is_object())
            return fail(value, "a marker is an object such as {\"time\": 1, \"name\": \"start\"}, not " +
                                   std::string(kindOf(value.value())));
        to.place = value.at();
        bool hasTime = false;
        const bool sound = value.forMembers([&](const std::string& key, const PlacedJson& member) {
            if (key == "time") return hasTime = true, number(member, key, to.time);
            if (key == "name") return text(member, key, to.name);
            return unknown(member, key, {"time", "name"});
        });
        if (!sound) return false;
        return hasTime || fail(value, "the marker has no \"time\"");
    }

    bool range(const PlacedJson& value) {
        const Json& json = value.value();
        if (!json.is_array() || json.size() != 2 || !json[0].is_number() || !json[1].is_number())
            return failKind(value, "range", "an array of two times, [from, to]");
        timeline.range = {json[0].get<double>(), json[1].get<double>()};
        return true;
    }

    bool tracks(const PlacedJson& value) {
        if (!value.value().is_array()) return failKind(value, "tracks", "an array of tracks");
        if (value.value().size() > kMaxTracks)
            return fail(value,
                        "the timeline has more than " + std::to_string(kMaxTracks) + " tracks: remove some");
        return value.forEntries(
            [&](const PlacedJson& entry) { return track(entry, timeline.tracks.emplace_back()); });
    }

    bool track(const PlacedJson& value, Track& to) {
        if (!value.value().is_object())
            return fail(value,
                        "a track is an object such as {\"node\": \"ball\", \"input\": \"radius\", "
                        "\"keys\": [{\"time\": 0, \"value\": 1}]}, not " +
                            std::string(kindOf(value.value())));
        to.place = value.at();
        bool hasNode = false, hasInput = false, hasParameter = false, hasScene = false, hasKeys = false;
        Key usual;  // what keys have that do not say otherwise
        bool sound = value.forMembers([&](const std::string& key, const PlacedJson& member) {
            if (key == "node") return hasNode = true, text(member, key, to.node);
            if (key == "input") return hasInput = true, text(member, key, to.name);
            if (key == "parameter") return hasParameter = true, text(member, key, to.name);
            if (key == "scene") return hasScene = true, text(member, key, to.name);
            if (key == "interpolation") return choice(member, key, interpolationNames(), usual.interpolation);
            if (key == "ease") return choice(member, key, easeNames(), usual.ease);
            if (key == "tangents") return choice(member, key, tangentsNames(), usual.tangents);
            if (key == "keys") return hasKeys = true;
            return unknown(
                member, key,
                {"node", "input", "parameter", "scene", "interpolation", "ease", "tangents", "keys"});
        });
        if (!sound) return false;
        if (hasNode != hasInput || hasInput + hasParameter + hasScene != 1)
            return fail(value,
                        "a track moves one thing: give \"node\" and \"input\", or \"parameter\", or "
                        "\"scene\"");
        to.target = hasParameter ? Track::Target::parameter
                    : hasScene   ? Track::Target::scene
                                 : Track::Target::input;
        sound = value.forMembers([&](const std::string& key, const PlacedJson& member) {
            return key != "keys" || keys(member, usual, to);
        });
        if (!sound) return false;
        if (!hasKeys || to.keys.empty())
            return fail(value, "the track has no keys: add \"keys\": [{\"time\": 0, \"value\": 1}]");
        return true;
    }

    bool keys(const PlacedJson& value, const Key& usual, Track& to) {
        if (!value.value().is_array()) return failKind(value, "keys", "an array of keys");
        return value.forEntries([&](const PlacedJson& entry) {
            to.keys.push_back(usual);
            return key(entry, to.keys.back());
        });
    }

    bool key(const PlacedJson& value, Key& to) {
        if (!value.value().is_object())
            return fail(value, "a key is an object such as {\"time\": 0, \"value\": 1}, not " +
                                   std::string(kindOf(value.value())));
        to.place = value.at();
        bool hasTime = false, hasValue = false;
        const bool sound = value.forMembers([&](const std::string& name, const PlacedJson& member) {
            if (name == "time") return hasTime = true, number(member, name, to.time);
            if (name == "value") return hasValue = true, numbers(member, name, to.value);
            if (name == "interpolation") return choice(member, name, interpolationNames(), to.interpolation);
            if (name == "ease") return choice(member, name, easeNames(), to.ease);
            if (name == "in") return numbers(member, name, to.in);
            if (name == "out") return numbers(member, name, to.out);
            if (name == "tangents") return choice(member, name, tangentsNames(), to.tangents);
            return unknown(member, name, {"time", "value", "interpolation", "ease", "in", "out", "tangents"});
        });
        if (!sound) return false;
        if (!hasTime || !hasValue)
            return fail(value, std::string("the key has no \"") + (hasTime ? "value" : "time") +
                                   "\": a key is an object such as {\"time\": 0, \"value\": 1}");
        return true;
    }

    bool numbers(const PlacedJson& value, const std::string& name, std::vector<double>& to) {
        const Json& json = value.value();
        if (json.is_number()) return to = {json.get<double>()}, true;
        const bool fits = json.is_array() && !json.empty() && json.size() <= 4 &&
                          std::all_of(json.begin(), json.end(), [](const Json& n) { return n.is_number(); });
        if (!fits) return failKind(value, name, "a number or an array of 1 to 4 numbers");
        to.clear();
        for (const Json& n : json) to.push_back(n.get<double>());
        return true;
    }

    const Graph& graph;
    std::vector<Error>* warnings;
};

}  // namespace

const std::vector<std::string>& interpolationNames() {
    static const std::vector<std::string> names = {"step", "linear", "cubic"};
    return names;
}

const std::vector<std::string>& easeNames() {
    static const std::vector<std::string> names = {"none", "in", "out", "in-out"};
    return names;
}

const std::vector<std::string>& tangentsNames() {
    static const std::vector<std::string> names = {"auto", "flat", "linear", "broken"};
    return names;
}

const std::vector<std::string>& loopNames() {
    static const std::vector<std::string> names = {"once", "repeat", "ping-pong"};
    return names;
}

Result<Timeline> readTimeline(const Graph& graph, std::vector<Error>* warnings) {
    if (graph.timeline->is_null()) return Timeline{.endless = true};
    TimelineReader reader(graph, warnings);
    if (!reader.read()) return std::move(reader.error);
    return std::move(reader.timeline);
}

}  // namespace fw
