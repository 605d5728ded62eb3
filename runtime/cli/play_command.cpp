// `fieldwright play`: the timeline of a graph, in a window or without one.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "runtime/cli/mesh_graph.h"
#include "runtime/cli/play_window.h"
#include "runtime/cli/sequence.h"

namespace fw::cli {

namespace {

/// Makes every frame and shows none: how fast, and whether, a graph plays.
int playHeadless(const PlayOptions& options, std::pair<int, int> size) {
    std::optional<Player> player;
    {
        Progress progress;
        int status = kDone;
        player = openPlayer(options.mesh, progress, {.fieldBy = options.quality}, status);
        if (!player) return status;
    }
    const Timeline& timeline = player->timeline();
    const FrameRange range{
        0, options.frames.value_or(static_cast<int>(std::lround(timeline.length * timeline.framesPerSecond))),
        timeline.framesPerSecond};
    const double start = options.mesh.graph.time;
    const RenderOptions render{.width = size.first, .height = size.second, .primary = Primary::measured};
    Picture picture;
    const auto device = [&]() -> const DeviceRecord& { return *player->device().record; };
    uint64_t built = 0, submitted = 0, awaited = 0;  // by the first frame
    double seconds = 0.0;
    long made = 0;
    {
        SequenceProgress progress("frame", range.count());
        for (long frame = 0; frame < range.last; ++frame) {
            const auto make = [&] {
                player->seek(start + range.time(frame));
                return player->show(render, picture);
            };
            const Result<bool> shown = onceMoreIfLost(make, [&] {
                renewDevice(*player, "going on at frame " + std::to_string(frame));
                built = submitted = awaited = 0;
            });
            if (!shown) return badInput(options.mesh, shown.error());
            progress.next(true);
            if (frame == 0)
                built = player->pipelinesBuilt(), submitted = device().submissions, awaited = device().waits;
        }
        seconds = progress.seconds();
        made = progress.made;
    }
    if (const std::optional<Error> coarser = player->coarser()) print(*coarser);
    const double later = static_cast<double>(std::max(made - 1, 1L));
    std::printf(
        "%ld frames in %.2f s, %.2f a second; %llu pipelines built after the first frame, %.1f submissions a "
        "frame, %.1f of them awaited\n",
        made, seconds, static_cast<double>(made) / seconds,
        static_cast<unsigned long long>(player->pipelinesBuilt() - built),
        static_cast<double>(device().submissions - submitted) / later,
        static_cast<double>(device().waits - awaited) / later);
    return kDone;
}

}  // namespace

int runPlay(const PlayOptions& options) {
    const auto size = pictureSize("play", options.size);
    if (!size) return kBadUsage;
    return options.headless ? playHeadless(options, *size) : playInWindow(options, *size);
}

}  // namespace fw::cli
