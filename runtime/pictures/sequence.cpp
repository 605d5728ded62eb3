#include "runtime/pictures/sequence.h"

#include <cmath>
#include <numbers>

namespace fw {

FrameFiles filesOf(const SequenceWish& wish) {
    const std::string ending = (wish.turntable ? "_of_" + std::to_string(wish.frames.count()) : "") + "." +
                               nameOf(wish.picture.format);
    const auto whole = [picture = wish.picture](const std::string& path) {
        return sizeOfPicture(path, picture.format) == std::pair(picture.width, picture.height);
    };
    return {.folder = wish.folder,
            .ending = ending,
            .frames = wish.frames,
            .overwrite = wish.overwrite,
            .whole = whole};
}

Done checkFrames(const SequenceWish& wish, const Graph& graph) {
    const FrameFiles files = filesOf(wish);
    if (const Done free = checkFrames(files, graph); !free || wish.overwrite) return free;
    for (long frame = wish.frames.first; frame < wish.frames.last; ++frame) {
        const std::string path = files.path(frame);
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
