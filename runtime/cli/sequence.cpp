#include "runtime/cli/sequence.h"

#include <atomic>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <utility>

#include "graph/compile/cached_particles.h"
#include "runtime/cli/mesh_graph.h"
#include "runtime/cli/progress_lines.h"
#include "runtime/system/interruption.h"
#include "runtime/system/output_file.h"

namespace fw::cli {

namespace fs = std::filesystem;

SequenceProgress::SequenceProgress(const char* one_, long count_)
    : one(one_), count(count_), shown(progressIsShown()) {}

SequenceProgress::~SequenceProgress() {
    if (shown) hideProgress();
}

double SequenceProgress::seconds() const { return secondsSince(begin); }

void SequenceProgress::next(bool work) {
    ++done;
    made += work;
    if (!shown) return;
    const double rate = static_cast<double>(made) / std::max(seconds(), 1e-6);
    const long left = rate > 0.0 ? std::lround(static_cast<double>(count - done) / rate) : 0;
    char rest[64];
    std::snprintf(rest, sizeof rest, ", %.2f a second, %ld:%02ld left", rate, left / 60, left % 60);
    showProgress(100.0 * double(done) / double(count),
                 one + (" " + std::to_string(done) + " of " + std::to_string(count)), rest);
}

int noteWork(JobWork& work, const char* one, const FrameRange& frames) {
    work.one = one, work.first = frames.first, work.last = frames.last;
    return kDone;
}

int makeFrames(const FrameWork& work, const std::string& folder) {
    const auto badUsage = [&](const std::string& message) {
        std::fprintf(stderr, "fieldwright %s: %s\n", work.command, message.c_str());
        return kBadUsage;
    };
    std::error_code failure;
    if (fs::exists(folder, failure) && !fs::is_directory(folder, failure))
        return badUsage(folder + ": this is a file: a sequence goes into a folder");
    FrameFiles files;
    std::optional<Player> player;
    {
        Progress progress;
        int status = kDone;
        player = openPlayer(work.mesh, progress, work.player, status, [&](const Graph& graph) {
            Result<FrameFiles> wanted = work.files(graph);
            if (!wanted) return badUsage(wanted.error().message);
            files = std::move(*wanted);
            if (work.mesh.planned) {
                work.mesh.planned->simulates = !work.rests && simulatesAnew(graph);
                return noteWork(*work.mesh.planned, work.one, files.frames);
            }
            return kDone;
        });
        if (!player) return status;
    }
    const FrameRange& range = files.frames;
    if (!player->moves() && !work.rests)
        std::fprintf(stderr, "%s: note: nothing moves in this graph: all frames are the same\n",
                     work.mesh.graph.path.c_str());

    const bool fresh = !fs::exists(folder, failure);
    const auto goesOn = [fresh, folder, of = range.count(), one = work.one](long done) {
        return WhenEnded{.said = "; " + std::to_string(done) + " of " + std::to_string(of) + " " + one +
                                 "s were made: the same command goes on",
                         .folder = fresh ? folder : ""};
    };
    whenEnded(goesOn(0));
    fs::create_directories(folder, failure);
    if (!fs::is_directory(folder)) {
        std::fprintf(stderr, "%s: error: cannot make the folder: %s\n", folder.c_str(),
                     failure.message().c_str());
        return kSystemFailure;
    }

    bool capped = false;
    const auto kept =
        std::make_shared<std::atomic<long>>(0);  // a file that is written behind may outlive this
    int status = kDone;
    {
        SequenceProgress progress(work.one, range.count());
        for (long frame = range.first; frame < range.last && status == kDone; ++frame) {
            const bool there = files.isThere(frame);
            if (!there) {
                const auto make = [&] {
                    return work.make(*player, frame, files.path(frame),
                                     [goesOn, kept] { whenEnded(goesOn(++*kept)); });
                };
                status =
                    onceMoreIfLost(make, [&] { renewDevice(*player, "going on at " + files.name(frame)); });
                capped = capped || player->capped();
            }
            progress.next(!there);
        }
        const int ended = work.end();
        if (status == kDone) status = ended;
    }
    if (status != kDone) return status;
    if (*kept < range.count())
        std::fprintf(stderr, "%s: note: %ld of %ld %ss were there already (--overwrite makes them anew)\n",
                     folder.c_str(), range.count() - *kept, range.count(), work.one);
    if (const std::optional<Error> coarser = player->coarser()) print(*coarser);
    if (capped)
        std::fprintf(stderr, "%s: note: the surface leaves the region and was closed at its boundary\n",
                     folder.c_str());
    return kDone;
}

int renderSequence(const RenderCommandOptions& options, const PictureWish& picture) {
    SequenceWish wish{.picture = picture, .folder = options.output, .overwrite = options.sequence.overwrite};
    if (options.turntable) wish.turntable = options.mesh.graph.time;
    if (const std::string ending = lowerExtension(options.output); ending == ".png" || ending == ".exr") {
        std::fprintf(stderr,
                     "fieldwright render: %s: a sequence goes into a folder, a file for each frame: give its "
                     "name%s\n",
                     options.output.c_str(), ending == ".exr" ? ", and --format exr" : "");
        return kBadUsage;
    }
    const auto filesOfGraph = [&](const Graph& graph) -> Result<FrameFiles> {
        const Timeline timeline = *readTimeline(graph);
        const FrameTimes& times = options.sequence.frames;
        const Result<FrameRange> frames =
            options.turntable ? framesBetween(0.0, *options.turntable,
                                              times.framesPerSecond.value_or(timeline.framesPerSecond))
                              : framesOf(timeline, times);
        if (!frames) return Error{.message = frames.error().message + " (--from, --to, --fps, --turntable)"};
        wish.frames = *frames;
        if (const Done free = checkFrames(wish, graph); !free)
            return Error{.message = free.error().message + " (--size, -o, --overwrite)"};
        FrameFiles files = filesOf(wish);
        const Result<FrameRange> part = partOf(files.frames, times.part);
        if (!part) return part.error();
        files.frames = *part;
        return files;
    };
    LightPicture light;
    bool first = true;
    const auto make = [&](Player& player, long frame, const std::string& path, std::function<void()> kept) {
        RenderOptions render = renderOptions(picture, player);
        render.framesPerSecond = wish.frames.framesPerSecond;
        if (picture.format == PictureFormat::exr) render.light = &light;
        const Result<Picture> drawn = drawFrame(player, wish, frame, render);
        if (!drawn) return badInput(options.mesh, drawn.error());
        if (std::exchange(first, false)) notePicture(player, picture, options.output);
        if (const Done written = save(*drawn, light, picture.format, path, kept); !written)
            return print(written.error()), kSystemFailure;
        return kDone;
    };
    return makeFrames({.command = "render",
                       .mesh = options.mesh,
                       .player = {.liveParameters = false, .fieldBy = renderedBy(picture)},
                       .rests = wish.turntable.has_value(),
                       .files = filesOfGraph,
                       .make = make},
                      options.output);
}

}  // namespace fw::cli
