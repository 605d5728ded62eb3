// The frames of a timeline, one after the other: as numbered pictures for `render` (runtime/pictures), or
// only made for `play --headless`.
#pragma once

#include "runtime/cli/commands.h"
#include "runtime/pictures/sequence.h"
#include "runtime/system/clock.h"

namespace fw::cli {

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

/// Says of a picture that is a draft for lack of a quick compiler why it is one.
void noteDraft(Player& player, const PictureWish& wish, const std::string& output);

/// `render` with --from, --to, --fps, --range or --turntable: `wish` is what each of its pictures is to be.
int runSequence(const RenderCommandOptions& options, const PictureWish& wish);

}  // namespace fw::cli
