#include "runtime/cli/sequence.h"

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>

#include "runtime/cli/mesh_graph.h"
#include "runtime/system/interruption.h"
#include "runtime/system/output_file.h"

namespace fw::cli {

namespace fs = std::filesystem;

namespace {

int badUsage(const std::string& message) {
    std::fprintf(stderr, "fieldwright render: %s\n", message.c_str());
    return kBadUsage;
}

}  // namespace

SequenceProgress::SequenceProgress(long count_) : count(count_), shown(isatty(STDERR_FILENO)) {}

SequenceProgress::~SequenceProgress() {
    if (shown) std::fprintf(stderr, "\r\033[K");
}

double SequenceProgress::seconds() const { return secondsSince(begin); }

void SequenceProgress::next(bool work) {
    ++done;
    made += work;
    if (!shown) return;
    const double rate = static_cast<double>(made) / std::max(seconds(), 1e-6);
    const long left = rate > 0.0 ? std::lround(static_cast<double>(count - done) / rate) : 0;
    std::fprintf(stderr, "\r\033[K%3ld %%  frame %ld of %ld, %.2f a second, %ld:%02ld left",
                 100 * done / count, done, count, rate, left / 60, left % 60);
    std::fflush(stderr);
}

namespace {

/// The frames of the graph that are asked for. Errors: none there.
Result<FrameRange> framesOf(const Graph& graph, const RenderCommandOptions& options) {
    const Timeline timeline = *readTimeline(graph);
    const double rate = options.framesPerSecond.value_or(timeline.framesPerSecond);
    if (options.turntable) return framesBetween(0.0, *options.turntable, rate);
    if (options.range && !timeline.range)
        return Error{.message = "the timeline has no range: give --from and --to"};
    const TimeRange within = options.range ? *timeline.range : TimeRange{0.0, timeline.length};
    return framesBetween(options.from.value_or(within.from), options.to.value_or(within.to), rate);
}

}  // namespace

int runSequence(const RenderCommandOptions& options, const PictureWish& picture) {
    SequenceWish wish{.picture = picture, .folder = options.output, .overwrite = options.overwrite};
    if (options.turntable) wish.turntable = options.mesh.graph.time;
    if (const std::string ending = lowerExtension(options.output); ending == ".png" || ending == ".exr")
        return badUsage(options.output +
                        ": a sequence goes into a folder, a file for each frame: give its name" +
                        (ending == ".exr" ? ", and --format exr" : ""));
    std::error_code failure;
    if (fs::exists(options.output, failure) && !fs::is_directory(options.output, failure))
        return badUsage(options.output + ": this is a file: a sequence goes into a folder");

    const auto accept = [&](const Graph& graph) {
        const Result<FrameRange> frames = framesOf(graph, options);
        if (!frames) return badUsage(frames.error().message + " (--from, --to, --fps, --turntable)");
        wish.frames = *frames;
        const Done free = checkFrames(wish, graph);
        return free ? kDone : badUsage(free.error().message + " (--size, -o, --overwrite)");
    };
    std::optional<Player> player;
    {
        Progress progress;
        int status = kDone;
        player = openPlayer(options.mesh, progress, {.liveParameters = false, .fieldBy = renderedBy(picture)},
                            status, accept);
        if (!player) return status;
    }
    const FrameRange& range = wish.frames;
    if (!player->moves() && !wish.turntable)
        std::fprintf(stderr, "%s: note: nothing moves in this graph: all frames are the same\n",
                     options.mesh.graph.path.c_str());

    const bool fresh = !fs::exists(options.output, failure);
    const auto goesOn = [&](long done) {
        return WhenEnded{.said = "; " + std::to_string(done) + " of " + std::to_string(range.count()) +
                                 " frames were made: the same command goes on",
                         .folder = fresh ? options.output : ""};
    };
    whenEnded(goesOn(0));
    fs::create_directories(options.output, failure);
    if (!fs::is_directory(options.output)) {
        std::fprintf(stderr, "%s: error: cannot make the folder: %s\n", options.output.c_str(),
                     failure.message().c_str());
        return kSystemFailure;
    }

    bool capped = false;
    long made = 0;
    {
        SequenceProgress progress(range.count());
        RenderOptions render = renderOptions(picture, *player);
        render.framesPerSecond = range.framesPerSecond;
        LightPicture light;
        if (picture.format == PictureFormat::exr) render.light = &light;
        for (long frame = range.first; frame < range.last; ++frame) {
            const bool there = isThere(wish, frame);
            if (!there) {
                const auto make = [&] {
                    Result<Picture> drawn = drawFrame(*player, wish, frame, render);
                    if (drawn) capped = capped || player->capped();
                    return drawn;
                };
                const Result<Picture> drawn = onceMoreIfLost(
                    make, [&] { renewDevice(*player, "going on at frame " + std::to_string(frame)); });
                if (!drawn) return badInput(options.mesh, drawn.error());
                if (progress.made == 0) noteDraft(*player, picture, options.output);
                if (const Done written = save(*drawn, light, picture.format, pathOf(wish, frame)); !written)
                    return print(written.error()), kSystemFailure;
            }
            progress.next(!there);
            whenEnded(goesOn(progress.made));
        }
        made = progress.made;
    }
    if (made < range.count())
        std::fprintf(stderr, "%s: note: %ld of %ld frames were there already (--overwrite makes them anew)\n",
                     options.output.c_str(), range.count() - made, range.count());
    if (const std::optional<Error> coarser = player->coarser()) print(*coarser);
    if (capped)
        std::fprintf(stderr, "%s: note: the surface leaves the region and was closed at its boundary\n",
                     options.output.c_str());
    return kDone;
}

}  // namespace fw::cli
