#include "graph/document/timeline.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <tuple>

#include "graph/document/input_value.h"
#include "graph/document/named_parameters.h"
#include "graph/library/node_type.h"

namespace fw {

namespace {

/// 0, 1, 2 for the names of a vector's components; -1 for any other text.
int componentNamed(std::string_view text) { return text == "x" ? 0 : text == "y" ? 1 : text == "z" ? 2 : -1; }

/// How much the component rises in a second from this key to the next.
double rateOf(const Track& track, std::size_t from, std::size_t c) {
    const Key &a = track.keys[from], &b = track.keys[from + 1];
    return (b.value[c] - a.value[c]) / (b.time - a.time);
}

/// That of the parabola through the key and its neighbours, of the segment at an end.
double automaticSlope(const Track& track, std::size_t i, std::size_t c) {
    const std::vector<Key>& keys = track.keys;
    const std::size_t last = keys.size() - 1;
    const bool seam = track.closed && (i == 0 || i == last) && keys.size() > 2;
    const auto rate = [&](std::size_t from) { return rateOf(track, from, c); };
    const auto width = [&](std::size_t from) { return keys[from + 1].time - keys[from].time; };
    if (!seam && i == 0) return rate(0);
    if (!seam && i == last) return rate(last - 1);
    const std::size_t before = seam ? last - 1 : i - 1, after = seam ? 0 : i;
    const double h0 = width(before), h1 = width(after);
    return (rate(before) * h1 + rate(after) * h0) / (h0 + h1);
}

/// The side's slope as the key itself says; none if it is to be found.
std::optional<double> slopeSaid(const Key& key, std::size_t c, KeySide side) {
    const std::vector<double>& given = side == KeySide::in ? key.in : key.out;
    if (!given.empty()) return given[std::min(c, given.size() - 1)];
    return key.tangents == Tangents::flat ? std::optional(0.0) : std::nullopt;
}

double hermite(double a, double b, double slopeA, double slopeB, double u) {
    const double u2 = u * u, u3 = u2 * u;
    return a * (2 * u3 - 3 * u2 + 1) + b * (3 * u2 - 2 * u3) + slopeA * (u3 - 2 * u2 + u) +
           slopeB * (u3 - u2);
}

/// Its derivative by u.
double hermiteSlope(double a, double b, double slopeA, double slopeB, double u) {
    const double u2 = u * u;
    return (b - a) * (6 * u - 6 * u2) + slopeA * (3 * u2 - 4 * u + 1) + slopeB * (3 * u2 - 2 * u);
}

/// The input's name without the component that may follow it.
std::pair<std::string, int> splitComponent(const std::string& name) {
    const std::size_t dot = name.rfind('.');
    const int component = dot == std::string::npos ? -1 : componentNamed(name.substr(dot + 1));
    return component < 0 ? std::pair(name, -1) : std::pair(name.substr(0, dot), component);
}

/// Index of a list's entry from the text of a path; none if the text is no number or the list is shorter.
std::optional<std::size_t> entryOf(const Json& list, std::string_view text) {
    std::size_t index = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), index);
    if (const int component = componentNamed(text); component >= 0)
        index = static_cast<std::size_t>(component);
    else if (failure != std::errc() || end != text.data() + text.size())
        return std::nullopt;
    return index < list.size() ? std::optional(index) : std::nullopt;
}

}  // namespace

double eased(Ease ease, double x) {
    switch (ease) {
        case Ease::none: return x;
        case Ease::in: return x * x;
        case Ease::out: return x * (2.0 - x);
        case Ease::inOut: return x * x * (3.0 - 2.0 * x);
    }
    return x;
}

double slopeAt(const Track& track, std::size_t i, std::size_t c, KeySide side) {
    const std::size_t last = track.keys.size() - 1;
    if (const auto said = slopeSaid(track.keys[i], c, side)) return *said;
    const bool linear = track.keys[i].tangents == Tangents::linear;
    if (linear && side == KeySide::out && i < last) return rateOf(track, i, c);
    if (linear && side == KeySide::in && i > 0) return rateOf(track, i - 1, c);
    if (track.closed && (i == 0 || i == last))
        if (const auto said = slopeSaid(track.keys[last - i], c, side)) return *said;
    return automaticSlope(track, i, c);
}

bool moveAlike(const Timeline& a, const Timeline& b) {
    return a.length == b.length && a.loop == b.loop && a.framesPerSecond == b.framesPerSecond &&
           a.endless == b.endless && a.tracks == b.tracks;
}

std::vector<double> momentsOf(const Timeline& timeline) {
    constexpr int kSteps = 16;  // and the keys, up to as many again
    std::set<double> times;
    for (int i = 0; i <= kSteps; ++i) times.insert(timeline.length * i / kSteps);
    for (const Track& track : timeline.tracks)
        for (const Key& key : track.keys)
            if (times.size() < 2 * kSteps && key.time <= timeline.length) times.insert(key.time);
    return {times.begin(), times.end()};
}

double timelineTime(const Timeline& timeline, double seconds) {
    if (timeline.endless) return seconds;
    const double length = timeline.length;
    switch (timeline.loop) {
        case Loop::once: return std::clamp(seconds, 0.0, length);
        case Loop::repeat: return seconds - length * std::floor(seconds / length);
        case Loop::pingPong: {
            const double x = seconds - 2.0 * length * std::floor(seconds / (2.0 * length));
            return x <= length ? x : 2.0 * length - x;
        }
    }
    return seconds;
}

std::vector<double> evaluate(const Track& track, double time) {
    const std::vector<Key>& keys = track.keys;
    const auto next = std::upper_bound(keys.begin(), keys.end(), time,
                                       [](double t, const Key& key) { return t < key.time; });
    if (next == keys.begin()) return keys.front().value;
    const Key& from = *(next - 1);
    if (next == keys.end() || from.interpolation == Interpolation::step) return from.value;
    const double width = next->time - from.time;
    const double u = eased(from.ease, std::clamp((time - from.time) / width, 0.0, 1.0));
    std::vector<double> value = from.value;
    const auto i = static_cast<std::size_t>(next - keys.begin()) - 1;
    for (std::size_t c = 0; c < value.size(); ++c) {
        const double a = from.value[c], b = next->value[c];
        value[c] = from.interpolation == Interpolation::linear
                       ? (1.0 - u) * a + u * b
                       : hermite(a, b, width * slopeAt(track, i, c, KeySide::out),
                                 width * slopeAt(track, i + 1, c, KeySide::in), u);
    }
    return value;
}

Interval rangeBetween(const Track& track, std::size_t c, double from, double to) {
    Interval range{evaluate(track, from)[c], evaluate(track, from)[c]};
    const auto include = [&](double value) { range = hull(range, {value, value}); };
    include(evaluate(track, to)[c]);
    for (std::size_t i = 0; i < track.keys.size(); ++i) {
        const Key& key = track.keys[i];
        if (key.time >= from && key.time <= to) include(key.value[c]);
        if (i + 1 == track.keys.size() || key.interpolation != Interpolation::cubic) continue;
        const Key& next = track.keys[i + 1];
        if (next.time <= from || key.time >= to) continue;
        // The part of the segment as a Bézier curve, which lies between its control values.
        const double width = next.time - key.time;
        const auto at = [&](double time) {
            return eased(key.ease, std::clamp((time - key.time) / width, 0.0, 1.0));
        };
        const double first = at(from), last = at(to);
        const double out = width * slopeAt(track, i, c, KeySide::out),
                     in = width * slopeAt(track, i + 1, c, KeySide::in);
        for (const double end : {first, last}) {
            const double slope = hermiteSlope(key.value[c], next.value[c], out, in, end);
            include(hermite(key.value[c], next.value[c], out, in, end));
            include(hermite(key.value[c], next.value[c], out, in, end) +
                    slope * (end == first ? last - first : first - last) / 3.0);
        }
    }
    const double rounding = 1e-12 * absolute(range).hi;
    return {range.lo - rounding, range.hi + rounding};
}

std::optional<AnimatedInput> animatedInput(const Graph& graph, const Track& track) {
    AnimatedInput found;
    if (track.target == Track::Target::scene) return std::nullopt;
    if (track.target == Track::Target::parameter) {
        std::optional<NamedParameter> parameter = findParameter(graph, track.name);
        if (!parameter) {
            const auto [name, component] = splitComponent(track.name);
            parameter = findParameter(graph, name);
            found.component = component;
        }
        if (!parameter) return std::nullopt;
        found.node = parameter->node, found.input = parameter->input;
        found.min = parameter->min, found.max = parameter->max;
    } else {
        found.node = track.node;
        std::tie(found.input, found.component) = splitComponent(track.name);
    }
    const Node* node = graph.node(found.node);
    if (!node) return std::nullopt;
    found.unit = unitOfInput(*node, found.input);
    const NodeType* type = findNodeType(node->type);
    if (const int index = type ? inputIndex(*type, found.input) : -1; index >= 0) {
        const InputSpec& spec = type->inputs[static_cast<std::size_t>(index)];
        found.min = std::max({found.min, spec.min, spec.positive ? kLeastPositive : spec.min});
        found.max = std::min(found.max, spec.max);
    }
    return found;
}

std::set<std::string> animatedInputs(const Graph& graph, const Timeline& timeline) {
    std::set<std::string> names;
    for (const Track& track : timeline.tracks)
        if (const auto input = animatedInput(graph, track)) names.insert(input->node + "." + input->input);
    return names;
}

void applyTrack(const Track& track, const AnimatedInput& input, double time, std::vector<double>& numbers) {
    const std::vector<double> value = evaluate(track, time);
    for (std::size_t c = 0; c < numbers.size(); ++c) {
        if (input.component >= 0 && c != static_cast<std::size_t>(input.component)) continue;
        const bool one = input.component >= 0 || value.size() == 1;
        if (!one && c >= value.size()) break;
        numbers[c] = std::min(std::max(value[one ? 0 : c], input.min), input.max);
    }
}

void applyTrackRange(const Track& track, const AnimatedInput& input, double from, double to,
                     std::vector<Interval>& numbers) {
    const std::size_t count = track.keys.front().value.size();
    for (std::size_t c = 0; c < numbers.size(); ++c) {
        if (input.component >= 0 && c != static_cast<std::size_t>(input.component)) continue;
        const bool one = input.component >= 0 || count == 1;
        if (!one && c >= count) break;
        const Interval range = rangeBetween(track, one ? 0 : c, from, to);
        numbers[c] = {std::min(std::max(range.lo, input.min), input.max),
                      std::min(std::max(range.hi, input.min), input.max)};
    }
}

Json* sceneValue(Json& scene, std::string_view path) {
    if (scene.is_null()) scene = Json::object();
    Json* at = &scene;
    while (!path.empty()) {
        const std::size_t dot = path.find('.');
        const std::string_view step = path.substr(0, dot);
        path = dot == std::string_view::npos ? std::string_view() : path.substr(dot + 1);
        if (at->is_null() && step.find_first_of("0123456789") == 0)
            return nullptr;  // an entry of a list that is not there
        if (at->is_null()) *at = Json::object();
        if (at->is_object()) {
            at = &(*at)[std::string(step)];
        } else if (at->is_array()) {
            const std::optional<std::size_t> entry = entryOf(*at, step);
            if (!entry) return nullptr;
            at = &(*at)[*entry];
        } else {
            return nullptr;
        }
    }
    return at;
}

void setNumbers(Json& value, const std::vector<double>& numbers) {
    if (numbers.size() == 1)
        value = numbers[0];
    else
        value = numbers;
}

Json sceneAt(const Graph& graph, const Timeline& timeline, double time) {
    Json scene = graph.scene;
    for (const Track& track : timeline.tracks) {
        if (track.target != Track::Target::scene) continue;
        Json* value = sceneValue(scene, track.name);
        if (!value) continue;
        setNumbers(*value, evaluate(track, time));
    }
    return scene;
}

Graph atTime(const Graph& graph, const Timeline& timeline, double time) {
    Graph result = graph;
    for (const Track& track : timeline.tracks) {
        const auto animated = animatedInput(graph, track);
        if (!animated) continue;
        Node* node = result.node(animated->node);
        const InputValue* given = node->input(animated->input);
        if (given && std::holds_alternative<Link>(given->value)) continue;
        std::vector<double> numbers = inputNumbers(*node, animated->input);
        applyTrack(track, *animated, time, numbers);
        InputValue value = given ? *given : InputValue{};
        value.value = numbersValue(numbers).value;
        node->set(animated->input, std::move(value));
    }
    result.scene = sceneAt(graph, timeline, time);
    return result;
}

}  // namespace fw
