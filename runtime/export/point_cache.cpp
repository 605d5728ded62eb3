#include "runtime/export/point_cache.h"

#include <array>
#include <cstring>
#include <filesystem>
#include <utility>

#include "runtime/export/big_endian.h"
#include "runtime/export/blocks.h"
#include "runtime/export/formats.h"

namespace fw {

namespace {

bool isPc2(const std::string& path) { return lowerExtension(path) == ".pc2"; }

std::string meshBeside(const std::string& path) {
    return std::filesystem::path(path).replace_extension(".obj").string();
}

}  // namespace

bool isPointCache(const std::string& path) { return isPc2(path) || lowerExtension(path) == ".mdd"; }

std::vector<std::string> pointCachePaths(const std::string& path) {
    std::vector<std::string> paths = exportedPaths(meshBeside(path));
    paths.insert(paths.begin(), path);
    return paths;
}

Done checkPointCache(const std::string& path, const ExportOptions& options) {
    return checkExportPath(meshBeside(path), options);
}

PointCache::PointCache(std::string path_, std::vector<double> seconds_, ExportOptions options_,
                       OutputFile file_)
    : path(std::move(path_)),
      seconds(std::move(seconds_)),
      options(std::move(options_)),
      file(std::move(file_)) {}

Result<PointCache> PointCache::open(const std::string& path, std::vector<double> seconds,
                                    const ExportOptions& options) {
    if (const Done fine = checkPointCache(path, options); !fine) return fine.error();
    Result<OutputFile> file = OutputFile::open(path, options.cancel);
    if (!file) return file.error();
    return PointCache(path, std::move(seconds), options, std::move(*file));
}

void PointCache::begin() {
    const auto points = uint32_t(first->positions.size()), samples = uint32_t(seconds.size());
    if (isPc2(path)) {
        constexpr float kFirstFrame = 0.0f, kFramesOfASample = 1.0f;
        file.write(std::string_view("POINTCACHE2\0", 12));
        file.write(std::span<const uint32_t>(std::array{1u, points}));
        file.write(std::span<const float>(std::array{kFirstFrame, kFramesOfASample}));
        file.write(std::span(&samples, 1));
        return;
    }
    file.write(big({samples, points}));
    for (const double second : seconds) file.write(big({std::bit_cast<uint32_t>(float(second))}));
}

Done PointCache::add(const Mesh& mesh) {
    const auto refuse = [&](const char* message) { return Error{.message = message, .file = path}; };
    if (mesh.indices.empty())
        return refuse(
            "the solid is empty, of which a point cache can say nothing: write a .glb, or leave "
            "that time out");
    if (!first) {
        first = mesh;
        begin();
    } else if (mesh.indices != first->indices || mesh.positions.size() != first->positions.size()) {
        return refuse(
            "the mesh has other triangles than before, and a point cache moves the points of one mesh: "
            "write a .glb, or a mesh for every frame");
    }
    if (isPc2(path)) {
        file.write(std::span(mesh.positions));
    } else {
        const auto format = [&](char* out, std::size_t from, std::size_t to) {
            for (std::size_t i = from; i < to; ++i) out = putBig(out, mesh.positions[i]);
            return out;
        };
        writeBlocks(mesh.positions.size(), 12, format, file);
    }
    return file.good() ? done() : file.finish();
}

Result<ExportedFiles> PointCache::end() {
    if (const Done whole = file.finish(); !whole) return whole.error();
    ExportOptions ofMesh = options;
    ofMesh.kept = {};
    Result<ExportedFiles> files = exportMesh(*first, meshBeside(path), ofMesh);
    if (!files) return files;
    const uint64_t bytes = file.size();
    if (const Done kept = file.commit(options.kept); !kept) return kept.error();
    files->paths.insert(files->paths.begin(), path);
    files->bytes += bytes;
    return files;
}

}  // namespace fw
