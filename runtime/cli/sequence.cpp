#include "runtime/cli/sequence.h"

#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "runtime/cli/mesh_graph.h"
#include "runtime/export/outputs.h"
#include "runtime/system/interruption.h"
#include "runtime/system/output_file.h"

namespace fw::cli {

namespace fs = std::filesystem;

namespace {

/// Width and height of the picture in a PNG file; none if it is no PNG, or not a whole one.
std::optional<std::pair<int, int>> sizeOfPng(const fs::path& path) {
    std::array<unsigned char, 24> head{};
    std::array<unsigned char, 8> tail{};  // name and checksum of the last chunk
    std::error_code failure;
    if (!fs::is_regular_file(path, failure)) return std::nullopt;  // a pipe would never answer
    std::ifstream file(path, std::ios::binary);
    const auto read = [&](auto& bytes) -> bool {
        return bool(file.read(reinterpret_cast<char*>(bytes.data()), bytes.size()));
    };
    if (!read(head) || std::memcmp(head.data() + 1, "PNG", 3) != 0 || !file.seekg(-8, std::ios::end) ||
        !read(tail) || std::memcmp(tail.data(), "IEND", 4) != 0)
        return std::nullopt;
    const auto number = [&](std::size_t at) {
        return head[at] << 24 | head[at + 1] << 16 | head[at + 2] << 8 | head[at + 3];
    };
    return std::pair(number(16), number(20));
}

/// Of a picture that is there already.
std::optional<std::pair<int, int>> sizeOfPicture(const fs::path& path, PictureFormat format) {
    std::error_code failure;
    if (format == PictureFormat::png) return sizeOfPng(path);
    return fs::is_regular_file(path, failure) ? sizeOfLight(path) : std::nullopt;
}

int badUsage(const std::string& message) {
    std::fprintf(stderr, "fieldwright render: %s\n", message.c_str());
    return kBadUsage;
}

}  // namespace

Result<FrameRange> framesBetween(double from, double to, double framesPerSecond) {
    Error error;
    // A time that is a frame's but for rounding is that frame's.
    const double first = std::ceil(from * framesPerSecond - 1e-6),
                 last = std::ceil(to * framesPerSecond - 1e-6);
    if (from < 0.0) {
        error.message = "--from must be 0 or later";
    } else if (!(first < last)) {
        error.message = "there is no frame from --from (" + std::to_string(from) + " s) up to --to (" +
                        std::to_string(to) + " s, not included)";
    } else if (last > kMostFrames) {
        error.message = "frames are numbered up to " + std::to_string(kMostFrames) + ": lower --to or --fps";
    } else {
        return FrameRange{static_cast<long>(first), static_cast<long>(last), framesPerSecond};
    }
    return error;
}

std::string frameName(long frame, PictureFormat format) {
    std::string number = std::to_string(frame);
    return std::string(6 - std::min<std::size_t>(number.size(), 6), '0') + number + "." + nameOf(format);
}

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

fs::path pathOf(const RenderCommandOptions& options, long frame) {
    return fs::path(options.output) / frameName(frame, formatOf(options));
}

/// Finds the frames of the graph that are asked for, and whether their files may be written; if not, says why
/// and returns a status other than kDone.
int acceptFrames(const Graph& graph, const RenderCommandOptions& options, std::pair<int, int> size,
                 std::optional<FrameRange>& range) {
    const Timeline timeline = *readTimeline(graph);
    if (options.range && !timeline.range) return badUsage("the timeline has no range: give --from and --to");
    const TimeRange within = options.range ? *timeline.range : TimeRange{0.0, timeline.length};
    const Result<FrameRange> wanted =
        framesBetween(options.from.value_or(within.from), options.to.value_or(within.to),
                      options.framesPerSecond.value_or(timeline.framesPerSecond));
    if (!wanted) return badUsage(wanted.error().message);
    range = *wanted;
    const std::vector<std::string> read = filesRead(graph);
    for (long frame = range->first; frame < range->last; ++frame) {
        const fs::path path = pathOf(options, frame);
        std::error_code failure;
        if (const Done kept = checkReplacesNone(read, {path.string()}); !kept)
            return print(kept.error()), kBadUsage;
        if (fs::exists(path, failure) && !fs::is_regular_file(path, failure))
            return badUsage(path.string() + " is no ordinary file: give another folder");
        if (options.overwrite) continue;
        const auto there = sizeOfPicture(path, formatOf(options));
        if (there && *there != size)
            return badUsage(path.string() + " is there already, with " + std::to_string(there->first) + "x" +
                            std::to_string(there->second) +
                            " pixels: give that --size, another folder, or --overwrite");
    }
    return kDone;
}

}  // namespace

int runSequence(const RenderCommandOptions& options, std::pair<int, int> size) {
    if (const std::string ending = lowerExtension(options.output); ending == ".png" || ending == ".exr")
        return badUsage(options.output + ": a sequence goes into a folder, in files " +
                        frameName(0, formatOf(options)) + " and so on: give its name" +
                        (ending == ".exr" ? ", and --format exr" : ""));
    std::error_code failure;
    if (fs::exists(options.output, failure) && !fs::is_directory(options.output, failure))
        return badUsage(options.output + ": this is a file: a sequence goes into a folder");

    std::optional<FrameRange> range;
    const auto accept = [&](const Graph& graph) { return acceptFrames(graph, options, size, range); };
    std::optional<Player> player;
    {
        Progress progress;
        int status = kDone;
        player = openPlayer(options.mesh, progress, {.liveParameters = false, .fieldBy = renderedBy(options)},
                            status, accept);
        if (!player) return status;
    }
    if (!player->moves())
        std::fprintf(stderr, "%s: note: nothing moves in this graph: all frames are the same\n",
                     options.mesh.graph.path.c_str());

    const bool fresh = !fs::exists(options.output, failure);
    const auto goesOn = [&](long done) {
        return WhenEnded{.said = "; " + std::to_string(done) + " of " + std::to_string(range->count()) +
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
        SequenceProgress progress(range->count());
        RenderOptions render = renderOptions(options, size, *player);
        render.framesPerSecond = range->framesPerSecond;
        LightPicture light;
        if (formatOf(options) == PictureFormat::exr) render.light = &light;
        for (long frame = range->first; frame < range->last; ++frame) {
            const std::string path = pathOf(options, frame).string();
            const bool there = !options.overwrite && sizeOfPicture(path, formatOf(options)) == size;
            if (!there) {
                const auto make = [&] {
                    player->seek(range->time(frame));
                    Result<Picture> drawn = player->frame(render);
                    if (drawn) capped = capped || player->capped();
                    return drawn;
                };
                const Result<Picture> picture = onceMoreIfLost(
                    make, [&] { renewDevice(*player, "going on at frame " + std::to_string(frame)); });
                if (!picture) return badInput(options.mesh, picture.error());
                if (progress.made == 0) noteDraft(*player, options);
                if (const Done written = save(*picture, light, formatOf(options), path); !written)
                    return print(written.error()), kSystemFailure;
            }
            progress.next(!there);
            whenEnded(goesOn(progress.made));
        }
        made = progress.made;
    }
    if (made < range->count())
        std::fprintf(stderr, "%s: note: %ld of %ld frames were there already (--overwrite makes them anew)\n",
                     options.output.c_str(), range->count() - made, range->count());
    if (const std::optional<Error> coarser = player->coarser()) print(*coarser);
    if (capped)
        std::fprintf(stderr, "%s: note: the surface leaves the region and was closed at its boundary\n",
                     options.output.c_str());
    return kDone;
}

}  // namespace fw::cli
