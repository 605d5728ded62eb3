#include "runtime/pictures/sequence.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <numbers>

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

std::string frameName(const SequenceWish& wish, long frame) {
    const std::string number = std::to_string(frame);
    return std::string(6 - std::min<std::size_t>(number.size(), 6), '0') + number +
           (wish.turntable ? "_of_" + std::to_string(wish.frames.count()) : "") + "." +
           nameOf(wish.picture.format);
}

std::string pathOf(const SequenceWish& wish, long frame) {
    return (fs::path(wish.folder) / frameName(wish, frame)).string();
}

bool isThere(const SequenceWish& wish, long frame) {
    return !wish.overwrite && sizeOfPicture(pathOf(wish, frame), wish.picture.format) ==
                                  std::pair(wish.picture.width, wish.picture.height);
}

long framesThere(const SequenceWish& wish) {
    SequenceWish kept = wish;
    kept.overwrite = false;
    long there = 0;
    std::error_code failure;
    fs::directory_iterator each(wish.folder, failure);
    for (; !failure && each != fs::directory_iterator(); each.increment(failure)) {
        const std::string name = each->path().filename().string();
        long frame = -1;
        std::from_chars(name.data(), name.data() + name.size(), frame);
        there += frame >= wish.frames.first && frame < wish.frames.last && name == frameName(wish, frame) &&
                 isThere(kept, frame);
    }
    return there;
}

Done checkFrames(const SequenceWish& wish, const Graph& graph) {
    const std::vector<std::string> read = filesRead(graph);
    for (long frame = wish.frames.first; frame < wish.frames.last; ++frame) {
        const std::string path = pathOf(wish, frame);
        std::error_code failure;
        if (const Done kept = checkReplacesNone(read, {path}); !kept) return kept;
        if (fs::exists(path, failure) && !fs::is_regular_file(path, failure))
            return Error{.message = path + " is no ordinary file: give another folder"};
        if (wish.overwrite) continue;
        const auto there = sizeOfPicture(path, wish.picture.format);
        if (there && *there != std::pair(wish.picture.width, wish.picture.height))
            return Error{.message = path + " is there already, with " + std::to_string(there->first) + "x" +
                                    std::to_string(there->second) +
                                    " pixels: give that size, another folder, or have it made anew"};
    }
    return done();
}

Camera turned(Camera camera, double part) {
    const double angle = 2.0 * std::numbers::pi * part, c = std::cos(angle), s = std::sin(angle);
    const double x = camera.position[0] - camera.target[0], z = camera.position[2] - camera.target[2];
    camera.position[0] = camera.target[0] + c * x + s * z;
    camera.position[2] = camera.target[2] + c * z - s * x;
    return camera;
}

Result<Picture> drawFrame(Player& player, const SequenceWish& wish, long frame, RenderOptions render) {
    player.seek(wish.turntable.value_or(wish.frames.time(frame)));
    render.scene.camera = wish.camera;
    if (wish.turntable && !render.scene.camera) {
        const Result<std::optional<Camera>> camera =
            player.camera(float(render.width) / float(render.height));
        if (!camera) return camera.error();
        render.scene.camera = *camera;
    }
    if (wish.turntable && render.scene.camera) {  // without one frame() says what is wrong
        const double part = double(frame - wish.frames.first) / double(wish.frames.count());
        render.scene.camera = turned(*render.scene.camera, part);
        render.scene.camera->shutter = 0.0;  // the moment is one
    }
    return player.frame(render);
}

}  // namespace fw
