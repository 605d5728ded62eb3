// The `timeline` of a document: tracks of keys, which move numbers of the graph and of its scene over time.
//
//     "timeline": {
//       "length": 4, "loop": "repeat", "fps": 30,
//       "tracks": [
//         {"node": "blend", "input": "t", "interpolation": "cubic", "keys": [
//           {"time": 0, "value": 0}, {"time": 2, "value": 1, "ease": "in-out"}, {"time": 4, "value": 0}]},
//         {"parameter": "hole", "keys": [{"time": 0, "value": 0.1}, {"time": 4, "value": 0.5}]},
//         {"scene": "camera.position", "interpolation": "cubic", "keys": [
//           {"time": 0, "value": [4, 2, 4], "out": [0, 1, 0]}, {"time": 4, "value": [4, 3, 4], "tangents":
//           "flat"}]}
//       ],
//       "markers": [{"time": 1.5, "name": "it opens"}],
//       "range": [1, 3]
//     }
//
// A track moves an input of a node, a named parameter, or a value of the scene by its dotted path; behind a
// vector `.x`, `.y` or `.z` names one component, and a number an entry of a list ("lights.0.color").
// Between two keys the interpolation and the easing of the former hold; a track may give both for all of its
// keys. Before the first key and after the last the track rests.
//
// Cubic segments are Hermite curves, so one may pass beyond its keys. Their slopes, in units of the value per
// second, are "in" where the curve arrives at a key and "out" where it leaves: a number for each component,
// or one for all. A side that is not given is as "tangents" has it, of the key or of its track: "auto" is the
// slope of the parabola through the key and its neighbours (Catmull-Rom for uneven times), "flat" is 0, and
// "linear" leads straight to the neighbour. "broken" is "auto", and says that the two sides are to be moved
// apart even where they are equal. An ease bends the time of a segment, and its slopes with it.
//
// What drives an input is then kept in the input's range, and in the parameter's. A track of a repeating
// timeline that ends on the value it began with, at both ends of the timeline, is smooth across the seam:
// there the first key and the last are one, and a side that one of them does not give is the other's.
//
// Markers are times with a name. The range is what the editor plays over and over; what is rendered does not
// know it unless asked (`render --range`).
//
// A Timeline is a value, read from a Graph and independent of it. The graph keeps the JSON.
#pragma once

#include <limits>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "graph/base/interval.h"
#include "graph/base/result.h"
#include "graph/document/graph.h"

namespace fw {

inline constexpr double kDefaultTimelineLength = 10.0;  ///< seconds, of a document without keys
inline constexpr double kMostTimelineLength = 86'400.0;
inline constexpr std::size_t kMaxTracks = 1'000;
inline constexpr double kMostFramesPerSecond = 1000.0;

enum class Interpolation : unsigned char { step, linear, cubic };
enum class Ease : unsigned char { none, in, out, inOut };
enum class Tangents : unsigned char { automatic, flat, linear, broken };

/// What follows the end of the timeline: it rests there, begins again, or runs back and forth.
enum class Loop : unsigned char { once, repeat, pingPong };

/// As files have them, in the order of the values.
const std::vector<std::string>& interpolationNames();
const std::vector<std::string>& easeNames();
const std::vector<std::string>& tangentsNames();
const std::vector<std::string>& loopNames();

struct Key {
    double time = 0.0;          ///< seconds
    std::vector<double> value;  ///< 1 to 4 numbers, as many as the track's other keys have
    Interpolation interpolation = Interpolation::linear;  ///< from here to the next key
    Ease ease = Ease::none;
    std::vector<double> in = {}, out = {};  ///< slopes, a second: one, or as many as values; empty: not given
    Tangents tangents = Tangents::automatic;
    TextPosition place = {};
    bool operator==(const Key&) const = default;
};

struct Track {
    enum class Target : unsigned char { input, parameter, scene };
    Target target = Target::input;
    std::string node;  ///< of an input
    std::string name;  ///< of the input or the parameter, or the path into the scene
    std::vector<Key> keys;
    bool closed = false;  ///< smooth from the last key to the first
    TextPosition place = {};
    bool operator==(const Track&) const = default;
};

struct Marker {
    double time = 0.0;  ///< seconds
    std::string name = {};
    TextPosition place = {};
    bool operator==(const Marker&) const = default;
};

/// Times between which it is played again and again.
struct TimeRange {
    double from = 0.0, to = 0.0;
    bool operator==(const TimeRange&) const = default;
};

struct Timeline {
    double length = kDefaultTimelineLength;  ///< seconds
    Loop loop = Loop::repeat;
    double framesPerSecond = 30.0;
    std::vector<Track> tracks = {};
    std::vector<Marker> markers = {};
    std::optional<TimeRange> range = {};
    bool endless = false;  ///< the document has none: time goes on
    bool operator==(const Timeline&) const = default;
};

/// The document's timeline; one without tracks if it has none. Errors: what is missing or of the wrong form,
/// with its place. Unknown keys are kept in the graph, and each adds a warning to `warnings`, which may be
/// null. Whether keys and targets make sense is for check().
Result<Timeline> readTimeline(const Graph& graph, std::vector<Error>* warnings = nullptr);

/// The time on the timeline, 0 to length, that `seconds` after its start show; of an endless one: `seconds`.
double timelineTime(const Timeline& timeline, double seconds);

/// Times on the timeline at which is looked at what has to last for all of it, as the bounds of a solid.
std::vector<double> momentsOf(const Timeline& timeline);

/// The track's value at a time on the timeline. The track has keys, in the order of their times.
std::vector<double> evaluate(const Track& track, double time);

/// An interval that contains component `c` of the track's value at all times from `from` to `to` on the
/// timeline. The track has keys, in the order of their times.
Interval rangeBetween(const Track& track, std::size_t c, double from, double to);

/// The slope of component `c`, in units per second, with which a cubic curve arrives at key `i` or leaves it.
/// There is more than one key.
enum class KeySide : unsigned char { in, out };
double slopeAt(const Track& track, std::size_t i, std::size_t c, KeySide side);

/// Whether two timelines move the same, whatever their markers and range are.
bool moveAlike(const Timeline& a, const Timeline& b);

/// 0 to 1 for 0 to 1.
double eased(Ease ease, double x);

/// An input that a track moves.
struct AnimatedInput {
    std::string node, input;
    int component = -1;          ///< of a vector; all if negative
    std::string_view unit = {};  ///< as unitOfInput()
    double min = -std::numeric_limits<double>::infinity(), max = std::numeric_limits<double>::infinity();
};

/// The input that the track moves, directly or through a parameter; none if it moves the scene or nothing.
std::optional<AnimatedInput> animatedInput(const Graph& graph, const Track& track);

/// "node.input" of every input that a track moves: what compile() is to keep live.
std::set<std::string> animatedInputs(const Graph& graph, const Timeline& timeline);

/// Sets the numbers of an animated input to what its track gives at a time on the timeline, within the range.
void applyTrack(const Track& track, const AnimatedInput& input, double time, std::vector<double>& numbers);

/// The same for intervals of numbers: what applyTrack() gives at all times from `from` to `to`.
void applyTrackRange(const Track& track, const AnimatedInput& input, double from, double to,
                     std::vector<Interval>& numbers);

/// The document with every animated input and value of the scene as they are at a time on the timeline.
Graph atTime(const Graph& graph, const Timeline& timeline, double time);

/// The document's `scene` alone at that time; null if it has none and no track moves it.
Json sceneAt(const Graph& graph, const Timeline& timeline, double time);

/// The value at the end of a dotted path into the scene, made (as objects) as far as it is missing; nullptr
/// if the path leads through a number or beyond the end of a list.
Json* sceneValue(Json& scene, std::string_view path);
/// A key's value as JSON: the number, or the list of several.
void setNumbers(Json& value, const std::vector<double>& numbers);

}  // namespace fw
