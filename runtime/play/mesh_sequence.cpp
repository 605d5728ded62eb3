#include "runtime/play/mesh_sequence.h"

#include <utility>

#include "runtime/export/whole.h"

namespace fw {

FrameFiles meshFrames(const std::string& folder, const std::string& ending, const FrameRange& frames,
                      bool overwrite) {
    return {.folder = folder,
            .ending = ending,
            .frames = frames,
            .overwrite = overwrite,
            .whole = isWholeMesh,
            .together = exportedPaths};
}

Done WrittenBehind::begin(Write write) {
    const Done before = end();
    if (before) running = std::async(std::launch::async, std::move(write));
    return before;
}

Done WrittenBehind::end() { return running.valid() ? running.get() : done(); }

}  // namespace fw
