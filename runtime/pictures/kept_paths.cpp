#include "runtime/pictures/kept_paths.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "graph/base/algorithm_version.h"
#include "graph/base/hash.h"
#include "graph/document/json.h"
#include "runtime/system/output_file.h"

namespace fw {

namespace {

struct Head {
    char name[8] = {'F', 'W', 'P', 'A', 'T', 'H', 'S', '3'};
    uint64_t algorithms = kAlgorithmVersion;
    uint64_t key = 0;
    int64_t paths = 0;
};

uint64_t keyOf(const Player& player, const RenderOptions& options) {
    uint64_t key = player.program().structureHash;
    const auto add = [&](double value) { key = mixed(key, std::bit_cast<uint64_t>(value)); };
    for (const float number : player.program().numbers()) add(number);
    for (const char letter : writeGraph(player.graph())) key = mixed(key, uint64_t(letter));
    add(player.time());
    const Box region = player.region();
    for (int axis = 0; axis < 3; ++axis) add(region.lo[axis]), add(region.hi[axis]);
    add(options.width), add(options.height), add(options.bounces), add(player.resolution());
    if (options.cutout) add(1);
    std::optional<Camera> camera = options.scene.camera;
    if (const Result<Scene> scene = player.scene(); !camera && scene) camera = scene->camera;
    if (camera) {
        for (int axis = 0; axis < 3; ++axis) add(camera->position[axis]), add(camera->target[axis]);
        for (const double number : {camera->fov, camera->aperture, camera->focus, camera->shutter})
            add(number);
    }
    // Which of the samples are of which moment depends on how many there are.
    if (camera && camera->shutter > 0.0) add(options.samples);
    if (player.environment())
        for (const Radiance& texel : player.environment()->texels)
            for (const float value : texel) add(value);
    return key;
}

}  // namespace

KeptPaths::KeptPaths(const std::string& output, const Player& player, const RenderOptions& options)
    : path(output + ".paths"),
      key(keyOf(player, options)),
      samples(options.samples),
      floats(4 * std::size_t(options.width) * std::size_t(options.height)) {}

int KeptPaths::goOn(RenderOptions& render, std::function<void(int paths)> kept) {
    sums = read();
    render.sums = &sums;
    render.keepSums = [this, kept = std::move(kept)] {
        if (write() && kept) kept(sums.paths);  // the picture does not depend on it
    };
    return sums.paths;
}

PathSums KeptPaths::read() const {
    std::ifstream file(path, std::ios::binary);
    Head head;
    const Head mine;
    PathSums there;
    if (!file.read(reinterpret_cast<char*>(&head), sizeof head) ||
        std::memcmp(head.name, mine.name, 8) != 0 || head.algorithms != mine.algorithms || head.key != key ||
        head.paths < 1 || head.paths > samples)
        return there;
    there.sums.resize(floats);
    if (!file.read(reinterpret_cast<char*>(there.sums.data()), std::streamsize(floats * sizeof(float))))
        return {};
    for (const float value : there.sums)
        if (!std::isfinite(value)) return {};
    there.paths = int(head.paths);
    return there;
}

Done KeptPaths::write() const {
    Result<OutputFile> file = OutputFile::open(path, nullptr);
    if (!file) return file.error();
    Head head;
    head.key = key;
    head.paths = sums.paths;
    file->write(&head, sizeof head);
    file->write(std::span<const float>(sums.sums));
    return file->commit();
}

void KeptPaths::remove() const {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
}

}  // namespace fw
