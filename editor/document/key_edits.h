// Edits of many keys of the timeline at once. Keys that the program does not know stay with theirs.
//
// Each is a function from a graph to a graph, and gives the selection where the keys are afterwards. A key
// that comes to lie on one that is not selected takes its place. A timeline that cannot be read is left as it
// is.
#pragma once

#include <string>
#include <string_view>

#include "editor/document/key_selection.h"

namespace fw::editor {

struct KeysEdited {
    Graph graph;
    KeySelection selection;
};

/// Where times go: first away from `pivot` by `factor`, which is above 0, then on by `shift`, then, if there
/// is a frame rate, onto the nearest frame.
struct Retiming {
    double pivot = 0.0, factor = 1.0, shift = 0.0;
    double framesPerSecond = 0.0;
    double operator()(double time) const;
};

/// The keys at other times. A selection that would begin before 0 begins there; slopes become so much
/// steeper as the curves become shorter.
KeysEdited retimed(const Graph& graph, const KeySelection& selection, Retiming to);
/// The value's component higher by so much, of every selected key that has it, within the input's range.
Graph raised(const Graph& graph, const KeySelection& selection, std::size_t component, double by);
/// Without the keys; a track without keys goes too.
Graph withoutKeys(const Graph& graph, const KeySelection& selection);
/// The keys once more, so much later.
KeysEdited duplicatedKeys(const Graph& graph, const KeySelection& selection, double later);

/// The keys as text for the clipboard; times count from the first of them.
std::string copyKeys(const Graph& graph, const KeySelection& selection);
/// The keys of the text from `time` on, in the tracks that they came from; keys of one track in the track
/// `onto` instead, if that is given and its values have as many numbers. Tracks that are missing are made
/// where something can move; keys of others are left out, and `left` counts them. Error: why none was pasted.
Result<KeysEdited> pasteKeys(const Graph& graph, std::string_view text, double time, const Moved* onto,
                             std::size_t* left = nullptr);

Graph setInterpolations(const Graph& graph, const KeySelection& selection, Interpolation interpolation);
Graph setEases(const Graph& graph, const KeySelection& selection, Ease ease);

/// How the two sides of a key go together.
enum class TangentChoice : unsigned char {
    automatic,
    flat,
    linear,
    unified,  ///< slopes of its own, the mean of what they are, the same on both sides
    broken,   ///< slopes of its own, as they are, each by itself
};
TangentChoice tangentsOf(const Key& key);
Graph setTangents(const Graph& graph, const KeySelection& selection, TangentChoice choice);
/// The slope of one component of a key that exists, on one side, or on both if the key's are unified. The
/// other slopes become its own as they are; the key's segment becomes cubic on that side.
Graph setSlope(const Graph& graph, const Moved& moved, double time, std::size_t component, KeySide side,
               double slope, bool breaks);

/// Markers and the range. `marker` is an index into Timeline::markers.
Graph addMarker(const Graph& graph, double time, const std::string& name);
Graph moveMarker(const Graph& graph, std::size_t marker, double time);
Graph renameMarker(const Graph& graph, std::size_t marker, const std::string& name);
Graph removeMarker(const Graph& graph, std::size_t marker);
/// "Marker 3": none has it.
std::string freshMarkerName(const Timeline& timeline);
Graph setRange(const Graph& graph, std::optional<TimeRange> range);

/// What moves an input has these numbers at the time: a key there for each track whose own are others. A
/// component that nothing moves is set in the input itself.
Graph setMovedInput(const Graph& graph, const Plug& input, double time, const std::vector<double>& numbers);
/// Without what moves the input, which keeps the numbers that it has at the time.
Graph removeMotion(const Graph& graph, const Plug& input, double time);
/// A key at the time for every track of the input, of the numbers that it has there; a track if there is
/// none.
Graph insertKeyOf(const Graph& graph, const Plug& input, double time);
/// Without the keys that its tracks have at the time.
Graph removeKeyOf(const Graph& graph, const Plug& input, double time);

/// The tracks of the inputs of a node once more, for another node of its type.
void copyTracks(Graph& graph, const std::string& from, const std::string& to);

}  // namespace fw::editor
