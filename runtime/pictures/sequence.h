// The frames of a timeline as numbered pictures, and of a camera that goes once around what rests.
//
// They are numbered as frames are (play/frames.h); a picture that is there belongs to the sequence if it has
// its size, and is the same bytes in whatever order the frames are made. On a turntable frame n of N is seen
// from n / N of the way around, at one moment of the timeline; its name tells N, so that frames of another
// turntable, or of the timeline, are never taken for its own.
#pragma once

#include <string>

#include "runtime/pictures/wish.h"
#include "runtime/play/frames.h"

namespace fw {

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
FrameFiles filesOf(const SequenceWish& wish);

/// As checkFrames() of its files; also refuses a picture of another size that is to stay.
Done checkFrames(const SequenceWish& wish, const Graph& graph);

/// The picture of one frame: the player seeks it. `render` are the renderOptions() of the sequence.
Result<Picture> drawFrame(Player& player, const SequenceWish& wish, long frame, RenderOptions render);

/// The camera, `part` of a whole turn further around the vertical through its target, counter-clockwise seen
/// from above.
Camera turned(Camera camera, double part);

}  // namespace fw
