#include "runtime/play/frames.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "runtime/export/outputs.h"

namespace fw {

namespace fs = std::filesystem;

Result<FrameRange> framesBetween(double from, double to, double framesPerSecond) {
    Error error;
    // A time that is a frame's but for rounding is that frame's.
    const double first = std::ceil(from * framesPerSecond - 1e-6),
                 last = std::ceil(to * framesPerSecond - 1e-6);
    if (from < 0.0) {
        error.message = "a sequence begins at 0 s or later";
    } else if (!(first < last)) {
        error.message = "there is no frame from " + std::to_string(from) + " s up to " + std::to_string(to) +
                        " s (not included)";
    } else if (last > kMostFrames) {
        error.message = "frames are numbered up to " + std::to_string(kMostFrames) +
                        ": end sooner, or have fewer of them a second";
    } else {
        return FrameRange{static_cast<long>(first), static_cast<long>(last), framesPerSecond};
    }
    return error;
}

std::optional<FramePart> readFramePart(std::string_view text) {
    FramePart part;
    const char* end = text.data() + text.size();
    const auto first = std::from_chars(text.data(), end, part.first);
    if (first.ec != std::errc() || part.first < 0) return std::nullopt;
    part.last = part.first;
    if (first.ptr == end) return part;
    const auto last = std::from_chars(first.ptr + 1, end, part.last);
    const bool fine = *first.ptr == '-' && last.ec == std::errc() && last.ptr == end;
    return fine && part.first <= part.last ? std::optional(part) : std::nullopt;
}

Result<FrameRange> partOf(const FrameRange& all, const std::optional<FramePart>& part) {
    if (!part) return all;
    if (part->first < all.first || part->last >= all.last)
        return Error{.message = "--frames " + std::to_string(part->first) + "-" + std::to_string(part->last) +
                                " reaches beyond what there is: " + std::to_string(all.first) + " to " +
                                std::to_string(all.last - 1)};
    return FrameRange{part->first, part->last + 1, all.framesPerSecond};
}

Result<FrameRange> framesOf(const Timeline& timeline, const FrameTimes& times) {
    if (times.range && !timeline.range)
        return Error{.message = "the timeline has no range: give --from and --to"};
    const TimeRange within = times.range ? *timeline.range : TimeRange{0.0, timeline.length};
    return framesBetween(times.from.value_or(within.from), times.to.value_or(within.to),
                         times.framesPerSecond.value_or(timeline.framesPerSecond));
}

std::string FrameFiles::name(long frame) const {
    if (stem) return stem(frame) + ending;
    const std::string number = std::to_string(frame);
    return std::string(6 - std::min<std::size_t>(number.size(), 6), '0') + number + ending;
}

std::string FrameFiles::path(long frame) const { return (fs::path(folder) / name(frame)).string(); }

bool FrameFiles::isThere(long frame) const { return !overwrite && whole(path(frame)); }

long FrameFiles::countThere() const {
    long there = 0;
    std::error_code failure;
    fs::directory_iterator each(folder, failure);
    for (; !failure && each != fs::directory_iterator(); each.increment(failure)) {
        const std::string file = each->path().filename().string();
        long frame = -1;
        std::from_chars(file.data(), file.data() + file.size(), frame);
        there += frame >= frames.first && frame < frames.last && file == name(frame) && whole(path(frame));
    }
    return there;
}

Done checkFrames(const FrameFiles& files, const Graph& graph) {
    const std::vector<std::string> read = filesRead(graph);
    for (long frame = files.frames.first; frame < files.frames.last; ++frame) {
        const std::string path = files.path(frame);
        for (const std::string& written : files.together ? files.together(path) : std::vector{path}) {
            std::error_code failure;
            if (const Done kept = checkReplacesNone(read, {written}); !kept) return kept;
            if (fs::exists(written, failure) && !fs::is_regular_file(written, failure))
                return Error{.message = written + " is no ordinary file: give another folder"};
        }
    }
    return done();
}

}  // namespace fw
