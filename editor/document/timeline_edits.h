// Edits of the document's timeline (graph/document/timeline.h). It stays the JSON that it is in the file:
// keys that the program does not know are kept where they are.
//
// `track` and `key` are indices into what readTimeline() gives; a timeline that it cannot read is left as it
// is. Times are seconds.
#pragma once

#include <optional>
#include <span>

#include "editor/document/edits.h"
#include "graph/document/timeline.h"

namespace fw::editor {

/// Keys nearer than this to each other are one.
inline constexpr double kSameTime = 1e-4;

/// What a track moves: see Track.
struct Moved {
    Track::Target target = Track::Target::input;
    std::string node, name;
    bool operator==(const Moved&) const = default;
};
Moved movedBy(const Track& track);
/// "Hole", "Tower · Radius", "camera.position".
std::string nameOf(const Graph& graph, const Moved& moved);

std::optional<std::size_t> trackOf(const Timeline& timeline, const Moved& moved);
/// The track that moves the whole of a node's input, itself or through a parameter.
std::optional<std::size_t> trackOfInput(const Graph& graph, const Timeline& timeline, const Plug& input);
/// The key at this time.
std::optional<std::size_t> keyAt(const Track& track, double time);

/// Why no track can move this input: "it is linked". Empty if one can.
std::string motionRefusal(const Graph& graph, const Plug& input);

Graph setTimelineLength(const Graph& graph, double seconds);
Graph setFramesPerSecond(const Graph& graph, double frames);
Graph setLoop(const Graph& graph, Loop loop);

/// A key of this value at the time: the one that is there changed, or another; a track if there is none.
Graph setKey(const Graph& graph, const Moved& moved, double time, std::span<const double> value);
/// The key at another time; it takes the place of one that is there.
Graph moveKey(const Graph& graph, std::size_t track, std::size_t key, double time);
Graph setInterpolation(const Graph& graph, std::size_t track, std::size_t key, Interpolation interpolation);
Graph setEase(const Graph& graph, std::size_t track, std::size_t key, Ease ease);
/// Without the key; without the track if it was its last.
Graph removeKey(const Graph& graph, std::size_t track, std::size_t key);
Graph removeTrack(const Graph& graph, std::size_t track);

}  // namespace fw::editor
