// The frames of a timeline, one after the other: as numbered pictures for `render` (runtime/pictures), as
// numbered meshes for `export` (play/mesh_sequence.h), or only made for `play --headless`.
#pragma once

#include "runtime/cli/commands.h"
#include "runtime/export/export.h"
#include "runtime/pictures/sequence.h"
#include "runtime/system/clock.h"

namespace fw::cli {

/// How far a sequence is, on one line of a terminal: frames, rate, time left. Nothing in a pipe.
class SequenceProgress {
  public:
    /// `one` is what there are so many of.
    SequenceProgress(const char* one, long count);
    ~SequenceProgress();
    /// One more frame is done; `made` if it took work.
    void next(bool made);

    long done = 0, made = 0;
    double seconds() const;

  private:
    const char* one;
    long count;
    bool shown;
    Clock::time_point begin = Clock::now();
};

/// What a sequence is made of, for makeFrames().
struct FrameWork {
    const char* command;        ///< "render"
    const char* one = "frame";  ///< what there are many of
    const MeshOptions& mesh;
    PlayerOptions player;
    bool rests = false;  ///< it shows one moment
    /// Says which files there are to be of the graph. Errors: bad usage.
    std::function<Result<FrameFiles>(const Graph&)> files;
    /// Makes the frame into the file, for which `kept` is called once it is there: now, or before end()
    /// returns, or while what was thrown here ends the command. The exit status; what is wrong was said.
    std::function<int(Player& player, long frame, const std::string& path, std::function<void()> kept)> make;
    std::function<int()> end = [] { return kDone; };
};

/// Makes the frames that are not there yet into the folder; the exit status.
int makeFrames(const FrameWork& work, const std::string& folder);

/// Says of a picture that is a draft for lack of a quick compiler why it is one; of one of widths what its
/// colours are.
void notePicture(Player& player, const PictureWish& wish, const std::string& output);

/// `render` with --from, --to, --fps, --range or --turntable: `wish` is what each of its pictures is to be.
int renderSequence(const RenderCommandOptions& options, const PictureWish& wish);

/// The frames that are asked for of the graph's timeline.
Result<FrameRange> framesAsked(const Graph& graph, const ExportOptions& options);

/// Says of a command that a job is to share out what there is many of; kDone.
int noteWork(JobWork& work, const char* one, const FrameRange& frames);

/// `export` with --from, --to, --fps or --range; the same into one file, with --animated; with --sweep.
int exportSequence(const ExportOptions& options);
int exportAnimated(const ExportOptions& options);
int exportSweep(const ExportOptions& options);
/// `export --instances`: copies share a mesh.
int exportInstances(const ExportOptions& options);
/// `export --implicit`: functions in place of a mesh.
int exportImplicit(const ExportOptions& options);
/// `export --particles`: a file of points, or one for every frame.
int exportParticles(const ExportOptions& options);

}  // namespace fw::cli
