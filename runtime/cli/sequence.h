// The frames of a timeline, one after the other: as numbered pictures for `render`, or only made for `play
// --headless`.
//
// Frame n shows the time n / fps, whatever the sequence that it belongs to, and is named after n: so
// sequences of one graph, size and rate can be extended, taken up again after a stop, and shared between
// machines. A picture is the same bytes in whatever order the frames are made.
#pragma once

#include <string>
#include <utility>

#include "runtime/cli/commands.h"
#include "runtime/play/player.h"
#include "runtime/render/renderer.h"
#include "runtime/system/clock.h"

namespace fw::cli {

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

/// "000042.png"
std::string frameName(long frame, PictureFormat format);

/// How far a sequence is, on one line of a terminal: frames, rate, time left. Nothing in a pipe.
class SequenceProgress {
  public:
    explicit SequenceProgress(long count);
    ~SequenceProgress();
    /// One more frame is done; `made` if it took work.
    void next(bool made);

    long done = 0, made = 0;
    double seconds() const;

  private:
    long count;
    bool shown;
    Clock::time_point begin = Clock::now();
};

/// "png" or "exr".
std::string nameOf(PictureFormat format);
/// What the command writes for every picture.
PictureFormat formatOf(const RenderCommandOptions& options);
/// Writes the picture, of which an EXR file has the light; `kept` as in OutputFile::commit().
Done save(const Picture& picture, const LightPicture& light, PictureFormat format, const std::string& path,
          const std::function<void()>& kept = {});

/// What --view takes.
const std::vector<std::string>& renderViews();
/// The options that all pictures of the command share.
RenderOptions renderOptions(const RenderCommandOptions& options, std::pair<int, int> size,
                            const Player& player);
/// Who evaluates the field for them: kernels if a view traces it.
FieldBy renderedBy(const RenderCommandOptions& options);
/// Says of a picture that is a draft for lack of a quick compiler why it is one.
void noteDraft(Player& player, const RenderCommandOptions& options);

/// `render` with --from, --to or --fps.
int runSequence(const RenderCommandOptions& options, std::pair<int, int> size);

}  // namespace fw::cli
