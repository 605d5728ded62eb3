#include "editor/document/key_edits.h"

#include <algorithm>
#include <cmath>

#include "editor/document/timeline_json.h"
#include "graph/document/input_value.h"

namespace fw::editor {

namespace {

/// Calls change(json track, track, indices of its selected keys) for every track that has some, as it is in
/// the file and as it was read.
template <class Change>
Graph editedKeys(const Graph& graph, const KeySelection& selection, Change change) {
    return editedTimeline(graph, [&](Json& json, const Timeline& timeline) {
        if (selection.empty()) return;
        member(json, "length", timeline.length);
        for (const SelectedKeys& selected : selection.tracks) {
            const auto index = trackOf(timeline, selected.moved);
            if (!index) continue;
            const Track& track = timeline.tracks[*index];
            std::vector<std::size_t> keys;
            for (std::size_t i = 0; i < track.keys.size(); ++i)
                if (isAmong(selected.times, track.keys[i].time)) keys.push_back(i);
            if (!keys.empty()) change(json["tracks"][*index], track, keys);
        }
    });
}

bool earlier(const Json& a, const Json& b) { return timeOf(a) < timeOf(b); }

/// The keys that stay and those that come, in order. What comes wins over what is there, the later of two
/// that come over the earlier.
Json mergedKeys(std::vector<Json> staying, std::vector<Json> coming) {
    std::stable_sort(coming.begin(), coming.end(), earlier);
    std::vector<Json> kept;
    for (Json& key : coming) {
        if (!kept.empty() && timeOf(key) - timeOf(kept.back()) <= kSameTime) kept.pop_back();
        kept.push_back(std::move(key));
    }
    std::vector<double> times;
    for (const Json& key : kept) times.push_back(timeOf(key));
    std::erase_if(staying, [&](const Json& key) { return isAmong(times, timeOf(key)); });
    Json all = Json::array();
    std::size_t at = 0;
    for (Json& key : staying) {
        while (at < kept.size() && earlier(kept[at], key)) all.push_back(std::move(kept[at++]));
        all.push_back(std::move(key));
    }
    while (at < kept.size()) all.push_back(std::move(kept[at++]));
    return all;
}

void divide(Json& key, const char* name, double by) {
    const auto slopes = key.find(name);
    if (slopes == key.end() || by == 1.0) return;
    if (slopes->is_number()) *slopes = slopes->get<double>() / by;
    if (slopes->is_array())
        for (Json& slope : *slopes) slope = slope.get<double>() / by;
}

/// Adds the keys to the track, which has `staying` besides, and their times to the selection.
void give(Json& track, std::vector<Json> staying, std::vector<Json> coming, const Moved& moved,
          KeySelection& selection) {
    for (const Json& key : coming) selection.add(moved, timeOf(key));
    track["keys"] = mergedKeys(std::move(staying), std::move(coming));
}

/// What the keys of a track say about themselves only because the track does.
void sayAll(const Json& track, Json& key) {
    for (const char* name : {"interpolation", "ease", "tangents"})
        if (track.contains(name) && !key.contains(name)) key[name] = track[name];
}

std::vector<double> slopesOf(const Track& track, std::size_t i, KeySide side) {
    const Key& key = track.keys[i];
    std::vector<double> slopes(key.value.size(), 0.0);
    if (track.keys.size() > 1)
        for (std::size_t c = 0; c < slopes.size(); ++c) slopes[c] = slopeAt(track, i, c, side);
    return slopes;
}

/// Gives the key slopes of its own.
void giveSlopes(Json& json, Json& key, std::span<const double> in, std::span<const double> out, bool broken) {
    key["in"] = numbersJson(in);
    key["out"] = numbersJson(out);
    chooseForKey(json, key, "tangents", tangentsNames(),
                 std::size_t(broken ? Tangents::broken : Tangents::automatic));
}

}  // namespace

double Retiming::operator()(double time) const {
    double to = pivot + (time - pivot) * factor + shift;
    if (framesPerSecond > 0.0) to = std::round(to * framesPerSecond) / framesPerSecond;
    return std::clamp(to, 0.0, kMostTimelineLength);
}

KeysEdited retimed(const Graph& graph, const KeySelection& selection, Retiming to) {
    KeysEdited result{graph, {}};
    if (selection.empty()) return result;
    const double first = to.pivot + (selection.span().first - to.pivot) * to.factor;
    to.shift = std::max(to.shift, -std::max(first, 0.0));
    result.graph = editedKeys(graph, selection, [&](Json& json, const Track& track, const auto& indices) {
        std::vector<Json> staying, coming;
        std::size_t next = 0;
        for (std::size_t i = 0; i < track.keys.size(); ++i) {
            Json& key = json["keys"][i];
            if (next >= indices.size() || indices[next] != i) {
                staying.push_back(std::move(key));
                continue;
            }
            ++next;
            if (const double time = to(track.keys[i].time); time != track.keys[i].time) key["time"] = time;
            divide(key, "in", to.factor);
            divide(key, "out", to.factor);
            coming.push_back(std::move(key));
        }
        give(json, std::move(staying), std::move(coming), movedBy(track), result.selection);
    });
    return result;
}

Graph raised(const Graph& graph, const KeySelection& selection, std::size_t component, double by) {
    return editedKeys(graph, selection, [&](Json& json, const Track& track, const auto& indices) {
        const std::optional<AnimatedInput> input = animatedInput(graph, track);
        for (std::size_t i : indices) {
            std::vector<double> value = track.keys[i].value;
            if (component >= value.size()) continue;
            double& number = value[component];
            number += by;
            if (input) number = std::min(std::max(number, input->min), input->max);
            json["keys"][i]["value"] = numbersJson(value);
        }
    });
}

Graph withoutKeys(const Graph& graph, const KeySelection& selection) {
    Graph result = editedKeys(graph, selection, [&](Json& json, const Track& track, const auto& indices) {
        Json left = Json::array();
        std::size_t next = 0;
        for (std::size_t i = 0; i < track.keys.size(); ++i)
            if (next < indices.size() && indices[next] == i)
                ++next;
            else
                left.push_back(std::move(json["keys"][i]));
        json["keys"] = std::move(left);
    });
    if (!result.timeline->is_object() || !result.timeline->contains("tracks")) return result;
    Json& tracks = (*result.timeline)["tracks"];
    for (std::size_t i = tracks.size(); tracks.is_array() && i-- > 0;)
        if (tracks[i].is_object() && tracks[i].contains("keys") && tracks[i]["keys"].empty())
            tracks.erase(tracks.begin() + std::ptrdiff_t(i));
    return result;
}

KeysEdited duplicatedKeys(const Graph& graph, const KeySelection& selection, double later) {
    KeysEdited result{graph, {}};
    result.graph = editedKeys(graph, selection, [&](Json& json, const Track& track, const auto& indices) {
        std::vector<Json> staying, coming;
        for (std::size_t i : indices) {
            Json& key = coming.emplace_back(json["keys"][i]);
            key["time"] = std::clamp(timeOf(key) + later, 0.0, kMostTimelineLength);
        }
        for (Json& key : json["keys"]) staying.push_back(std::move(key));
        give(json, std::move(staying), std::move(coming), movedBy(track), result.selection);
    });
    return result;
}

std::string copyKeys(const Graph& graph, const KeySelection& selection) {
    Json all = {{"keys_of", Json::array()}};
    if (selection.empty()) return all.dump();
    const double first = selection.span().first;
    (void)editedKeys(graph, selection, [&](const Json& json, const Track& track, const auto& indices) {
        Json copied = Json::object();
        for (const char* name : {"node", "input", "parameter", "scene"})
            if (json.contains(name)) copied[name] = json[name];
        copied["keys"] = Json::array();
        for (std::size_t i : indices) {
            Json key = json["keys"][i];
            key["time"] = track.keys[i].time - first;
            sayAll(json, key);
            copied["keys"].push_back(std::move(key));
        }
        all["keys_of"].push_back(std::move(copied));
    });
    return all.dump(2);
}

namespace {

/// What a track of the clipboard moves and how many numbers its values have; no keys, no track.
struct Copied {
    Moved moved;
    std::vector<Json> keys;
    std::size_t width = 0;
};

/// The tracks of the clipboard's text as a timeline has them, which readTimeline() reads; empty if it is
/// something else.
std::vector<Copied> copiedOf(std::string_view text) {
    Json json = Json::parse(text, nullptr, false);
    if (!json.is_object() || !json.contains("keys_of")) return {};
    Graph graph;
    graph.timeline = Json{{"tracks", json["keys_of"]}};
    const Result<Timeline> timeline = readTimeline(graph);
    if (!timeline) return {};
    std::vector<Copied> all;
    for (std::size_t i = 0; i < timeline->tracks.size(); ++i) {
        const Track& track = timeline->tracks[i];
        Copied& copied = all.emplace_back();
        copied.moved = movedBy(track);
        copied.width = track.keys[0].value.size();
        for (std::size_t k = 0; k < track.keys.size(); ++k) {
            const Key& key = track.keys[k];
            if (!(key.time >= 0.0) || key.value.size() != copied.width) return {};
            copied.keys.push_back(json["keys_of"][i]["keys"][k]);
        }
    }
    return all;
}

/// Whether a track for it can be made.
bool canMove(const Graph& graph, const Moved& moved, std::size_t width) {
    if (moved.target == Track::Target::scene) return true;
    Track track;
    track.target = moved.target, track.node = moved.node, track.name = moved.name;
    const std::optional<AnimatedInput> input = animatedInput(graph, track);
    if (!input || !motionRefusal(graph, {input->node, input->input}).empty()) return false;
    const std::size_t count =
        input->component >= 0 ? 1 : inputNumbers(*graph.node(input->node), input->input).size();
    return width == 1 || width == count;
}

}  // namespace

Result<KeysEdited> pasteKeys(const Graph& graph, std::string_view text, double time, const Moved* onto,
                             std::size_t* left) {
    std::vector<Copied> all = copiedOf(text);
    if (all.empty()) return Error{.message = "the clipboard holds no keys"};
    const Result<Timeline> read = readTimeline(graph);
    if (!read) return read.error();
    if (onto && all.size() == 1)
        if (const auto index = trackOf(*read, *onto)) {
            const std::size_t width = read->tracks[*index].keys[0].value.size();
            if (width != all[0].width)
                return Error{.message = "the keys have " + std::to_string(all[0].width) +
                                        (all[0].width == 1 ? " number" : " numbers") + ", those of " +
                                        nameOf(graph, *onto) + " have " + std::to_string(width)};
            all[0].moved = *onto;
        }
    KeysEdited result{graph, {}};
    std::size_t lost = 0;
    for (Copied& copied : all) {
        const Result<Timeline> now = readTimeline(result.graph);
        std::optional<std::size_t> index = trackOf(*now, copied.moved);
        if (index ? now->tracks[*index].keys[0].value.size() != copied.width
                  : !canMove(graph, copied.moved, copied.width)) {
            lost += copied.keys.size();
            continue;
        }
        for (Json& key : copied.keys) key["time"] = std::min(timeOf(key) + time, kMostTimelineLength);
        if (!index) {
            std::vector<double> value(copied.width, 0.0);
            result.graph = setKey(result.graph, copied.moved, timeOf(copied.keys[0]), value);
            const Result<Timeline> made = readTimeline(result.graph);
            index = trackOf(*made, copied.moved);
            if (!index) continue;
        }
        result.graph = editedTimeline(result.graph, [&](Json& json, const Timeline& timeline) {
            member(json, "length", timeline.length);
            Json& track = json["tracks"][*index];
            std::vector<Json> staying;
            for (Json& key : track["keys"]) staying.push_back(std::move(key));
            give(track, std::move(staying), std::move(copied.keys), copied.moved, result.selection);
        });
    }
    if (left) *left = lost;
    if (result.selection.empty())
        return Error{.message = "nothing here moves what the keys of the clipboard moved"};
    return result;
}

Graph setInterpolations(const Graph& graph, const KeySelection& selection, Interpolation interpolation) {
    return editedKeys(graph, selection, [&](Json& json, const Track&, const auto& indices) {
        for (std::size_t i : indices)
            chooseForKey(json, json["keys"][i], "interpolation", interpolationNames(),
                         std::size_t(interpolation));
    });
}

Graph setEases(const Graph& graph, const KeySelection& selection, Ease ease) {
    return editedKeys(graph, selection, [&](Json& json, const Track&, const auto& indices) {
        for (std::size_t i : indices)
            chooseForKey(json, json["keys"][i], "ease", easeNames(), std::size_t(ease));
    });
}

TangentChoice tangentsOf(const Key& key) {
    if (key.tangents == Tangents::broken) return TangentChoice::broken;
    if (!key.in.empty() || !key.out.empty())
        return key.in == key.out ? TangentChoice::unified : TangentChoice::broken;
    return key.tangents == Tangents::flat     ? TangentChoice::flat
           : key.tangents == Tangents::linear ? TangentChoice::linear
                                              : TangentChoice::automatic;
}

Graph setTangents(const Graph& graph, const KeySelection& selection, TangentChoice choice) {
    return editedKeys(graph, selection, [&](Json& json, const Track& track, const auto& indices) {
        for (std::size_t i : indices) {
            Json& key = json["keys"][i];
            if (choice == TangentChoice::unified || choice == TangentChoice::broken) {
                std::vector<double> in = slopesOf(track, i, KeySide::in),
                                    out = slopesOf(track, i, KeySide::out);
                if (choice == TangentChoice::unified)
                    for (std::size_t c = 0; c < in.size(); ++c) in[c] = out[c] = 0.5 * (in[c] + out[c]);
                giveSlopes(json, key, in, out, choice == TangentChoice::broken);
                continue;
            }
            key.erase("in");
            key.erase("out");
            chooseForKey(json, key, "tangents", tangentsNames(),
                         std::size_t(choice == TangentChoice::flat     ? Tangents::flat
                                     : choice == TangentChoice::linear ? Tangents::linear
                                                                       : Tangents::automatic));
        }
    });
}

Graph setSlope(const Graph& graph, const Moved& moved, double time, std::size_t component, KeySide side,
               double slope, bool breaks) {
    KeySelection one;
    one.add(moved, time);
    return editedKeys(graph, one, [&](Json& json, const Track& track, const auto& indices) {
        const std::size_t i = indices[0];
        const Key& key = track.keys[i];
        if (component >= key.value.size() || !std::isfinite(slope)) return;
        std::vector<double> in = slopesOf(track, i, KeySide::in), out = slopesOf(track, i, KeySide::out);
        const TangentChoice now = tangentsOf(key);
        const bool both = !breaks && now != TangentChoice::broken && now != TangentChoice::linear;
        if (both || side == KeySide::in) in[component] = slope;
        if (both || side == KeySide::out) out[component] = slope;
        if (both)  // at an end, or where they were found, the others' sides may differ
            for (std::size_t c = 0; c < in.size(); ++c)
                if (c != component) in[c] = out[c] = side == KeySide::in ? in[c] : out[c];
        giveSlopes(json, json["keys"][i], in, out, !both);
    });
}

namespace {

/// Calls each(track, animated) for the tracks that move the input.
template <class Each>
void eachOf(const Graph& graph, const Timeline& timeline, const Plug& input, Each each) {
    for (const Track& track : timeline.tracks)
        if (const auto animated = animatedInput(graph, track))
            if (animated->node == input.node && animated->input == input.name) each(track, *animated);
}

/// The numbers that the input has at the time.
std::vector<double> numbersAt(const Graph& graph, const Timeline& timeline, const Plug& input, double time) {
    const Node* node = graph.node(input.node);
    if (!node) return {};
    std::vector<double> numbers = inputNumbers(*node, input.name);
    eachOf(graph, timeline, input, [&](const Track& track, const AnimatedInput& animated) {
        applyTrack(track, animated, time, numbers);
    });
    return numbers;
}

}  // namespace

Graph setMovedInput(const Graph& graph, const Plug& input, double time, const std::vector<double>& numbers) {
    const Result<Timeline> timeline = readTimeline(graph);
    if (!timeline) return graph;
    const std::vector<double> before = numbersAt(graph, *timeline, input, time);
    if (before.size() != numbers.size()) return graph;
    Graph result = graph;
    std::vector<bool> moved(numbers.size(), false);
    const auto differs = [&](std::size_t c) { return numbers[c] != before[c]; };
    eachOf(graph, *timeline, input, [&](const Track& track, const AnimatedInput& animated) {
        const bool one = animated.component < 0 && track.keys[0].value.size() == 1 && numbers.size() > 1;
        std::optional<std::size_t> changed;
        for (std::size_t c = 0; c < numbers.size(); ++c) {
            if (animated.component >= 0 && c != std::size_t(animated.component)) continue;
            moved[c] = true;
            if (differs(c) && !changed) changed = c;
        }
        if (!changed) return;
        const std::vector<double> value =
            one || animated.component >= 0 ? std::vector{numbers[*changed]} : numbers;
        result = setKey(result, movedBy(track), time, value);
    });
    std::vector<double> own = inputNumbers(*graph.node(input.node), input.name);
    bool any = false;
    for (std::size_t c = 0; c < own.size(); ++c)
        if (!moved[c] && differs(c)) own[c] = numbers[c], any = true;
    return any ? setInput(result, "", input, numbersValue(own)) : result;
}

Graph removeMotion(const Graph& graph, const Plug& input, double time) {
    const Result<Timeline> timeline = readTimeline(graph);
    if (!timeline) return graph;
    std::vector<double> numbers = numbersAt(graph, *timeline, input, time);
    KeySelection all;
    eachOf(graph, *timeline, input, [&](const Track& track, const AnimatedInput&) {
        for (const Key& key : track.keys) all.add(movedBy(track), key.time);
    });
    if (all.empty()) return graph;
    return setInput(withoutKeys(graph, all), "", input, numbersValue(numbers));
}

Graph insertKeyOf(const Graph& graph, const Plug& input, double time) {
    const Result<Timeline> timeline = readTimeline(graph);
    if (!timeline) return graph;
    Graph result = graph;
    bool any = false;
    eachOf(graph, *timeline, input, [&](const Track& track, const AnimatedInput&) {
        any = true;
        result = setKey(result, movedBy(track), time, evaluate(track, time));
    });
    if (any || !motionRefusal(graph, input).empty()) return result;
    return setKey(graph, {Track::Target::input, input.node, input.name}, time,
                  numbersAt(graph, *timeline, input, time));
}

Graph removeKeyOf(const Graph& graph, const Plug& input, double time) {
    const Result<Timeline> timeline = readTimeline(graph);
    if (!timeline) return graph;
    KeySelection here;
    eachOf(graph, *timeline, input, [&](const Track& track, const AnimatedInput&) {
        if (const auto key = keyAt(track, time)) here.add(movedBy(track), track.keys[*key].time);
    });
    return withoutKeys(graph, here);
}

void copyTracks(Graph& graph, const std::string& from, const std::string& to) {
    const Result<Timeline> timeline = readTimeline(graph);
    if (!timeline) return;
    std::vector<Json> copies;
    for (std::size_t i = 0; i < timeline->tracks.size(); ++i) {
        const auto input = animatedInput(graph, timeline->tracks[i]);
        if (!input || input->node != from) continue;
        const InputValue* value = graph.node(from)->input(input->input);
        if (value && std::holds_alternative<Link>(value->value)) continue;  // it moves nothing
        Json& copy = copies.emplace_back((*graph.timeline)["tracks"][i]);
        copy.erase("parameter");
        copy["node"] = to;
        copy["input"] = input->input;
        if (input->component >= 0) copy["input"] = input->input + "." + "xyz"[input->component];
    }
    if (copies.empty()) return;
    Json& tracks = (*graph.timeline)["tracks"];
    for (Json& copy : copies)
        if (tracks.size() < kMaxTracks) tracks.push_back(std::move(copy));
    graph.timelinePlaces.list.clear();  // which are counted along the values
}

}  // namespace fw::editor
