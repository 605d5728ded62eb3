#include "runtime/export/points.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <charconv>
#include <cstring>

#include "graph/base/words.h"
#include "runtime/export/blocks.h"
#include "runtime/export/formats.h"

namespace fw {

namespace {

static_assert(std::endian::native == std::endian::little, "the writers copy memory into little-endian files");

constexpr const char* kColumns[] = {"x", "y", "z", "vx", "vy", "vz"};

void writePlyPoints(const ParticlePoints& points, OutputFile& file) {
    std::string header =
        "ply\nformat binary_little_endian 1.0\ncomment " + generatorName() + ", metres, +Y up\n";
    header += "element vertex " + std::to_string(points.places.size()) + "\n";
    for (const char* column : kColumns) header += std::string("property float ") + column + "\n";
    file.write(header + "end_header\n");
    const auto format = [&](char* out, std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i, out += 24) {
            std::memcpy(out, &points.places[i], 12);
            std::memcpy(out + 12, &points.velocities[i], 12);
        }
        return out;
    };
    writeBlocks(points.places.size(), 24, format, file);
}

void writeLines(const ParticlePoints& points, char between, OutputFile& file) {
    constexpr std::size_t kMostDigits = 16;  // of a float, so that it is read again as it was
    const auto format = [&](char* out, std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i)
            for (int k = 0; k < 6; ++k) {
                const float number = k < 3 ? points.places[i][k] : points.velocities[i][k - 3];
                out = std::to_chars(out, out + kMostDigits, number).ptr;
                *out++ = k < 5 ? between : '\n';
            }
        return out;
    };
    writeBlocks(points.places.size(), 6 * (kMostDigits + 1), format, file);
}

}  // namespace

Done checkPointsPath(const std::string& path) {
    const std::string ending = lowerExtension(path);
    if (std::ranges::find(kPointEndings, ending) != std::end(kPointEndings)) return done();
    return Error{.message = "particles are written as points, and " +
                            (ending.empty() ? "the file needs an ending that names its format"
                                            : "'" + ending + "' holds none") +
                            ": choose one of " + listed({std::begin(kPointEndings), std::end(kPointEndings)}),
                 .file = path};
}

Done exportPoints(const ParticlePoints& points, const std::string& path) {
    assert(points.places.size() == points.velocities.size());
    if (Done known = checkPointsPath(path); !known) return known;
    Result<OutputFile> file = OutputFile::open(path, nullptr);
    if (!file) return file.error();
    const std::string ending = lowerExtension(path);
    if (ending == ".ply") {
        writePlyPoints(points, *file);
    } else {
        const bool named = ending == ".csv";
        if (named) file->write("x,y,z,vx,vy,vz\n");
        writeLines(points, named ? ',' : ' ', *file);
    }
    return file->commit();
}

}  // namespace fw
