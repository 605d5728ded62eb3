// The frames of a timeline as numbered pictures, and of a camera that goes once around what rests.
//
// Frame n shows the time n / fps, whatever the sequence that it belongs to, and is named after n: so
// sequences of one graph, size and rate can be extended, taken up again after a stop, and shared between
// machines. A picture is the same bytes in whatever order the frames are made. On a turntable frame n of N
// is seen from n / N of the way around, at one moment of the timeline; its name tells N, so that frames of
// another turntable, or of the timeline, are never taken for its own.
#pragma once

#include <string>

#include "runtime/pictures/wish.h"

namespace fw {

/// Frames first <= n < last.
struct FrameRange {
    long first = 0, last = 0;
    double framesPerSecond = 30.0;

    double time(long frame) const { return static_cast<double>(frame) / framesPerSecond; }
    long count() const { return last - first; }
};

inline constexpr long kMostFrames = 1'000'000;

/// The frames with from <= time < to. Errors: times below zero, no frame between them, more than kMostFrames.
Result<FrameRange> framesBetween(double from, double to, double framesPerSecond);

/// What there is to be of a sequence, in a folder.
struct SequenceWish {
    PictureWish picture = {};
    std::string folder = {};
    FrameRange frames = {};
    bool overwrite = false;                ///< frames that are there already; else they are passed over
    std::optional<double> turntable = {};  ///< the moment that a camera goes around, seconds on the timeline
    std::optional<Camera> camera = {};     ///< in place of the scene's
};

/// "000042.png", of a turntable "000042_of_120.png".
std::string frameName(const SequenceWish& wish, long frame);
std::string pathOf(const SequenceWish& wish, long frame);
/// Whether the frame's picture lies there and is to stay.
bool isThere(const SequenceWish& wish, long frame);

/// How many of its frames are there, whether they are to stay or not.
long framesThere(const SequenceWish& wish);

/// Whether the frames may be written: none is a file that the graph reads, another thing than a file, or a
/// picture of another size that is to stay. The Error names the frame.
Done checkFrames(const SequenceWish& wish, const Graph& graph);

/// The picture of one frame: the player seeks it. `render` are the renderOptions() of the sequence.
Result<Picture> drawFrame(Player& player, const SequenceWish& wish, long frame, RenderOptions render);

/// The camera, `part` of a whole turn further around the vertical through its target, counter-clockwise seen
/// from above.
Camera turned(Camera camera, double part);

}  // namespace fw
