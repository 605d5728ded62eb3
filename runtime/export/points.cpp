#include "runtime/export/points.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <charconv>
#include <cstring>
#include <fstream>

#include "graph/base/words.h"
#include "runtime/export/blocks.h"
#include "runtime/export/formats.h"
#include "runtime/export/point_formats.h"

namespace fw {

namespace {

static_assert(std::endian::native == std::endian::little, "the writers copy memory into little-endian files");

constexpr const char* kColumns[] = {"x", "y", "z", "vx", "vy", "vz"};

void writePlyPoints(const ParticlePoints& points, OutputFile& file) {
    std::string header =
        "ply\nformat binary_little_endian 1.0\ncomment " + generatorName() + ", metres, +Y up\n";
    header += "element vertex " + std::to_string(points.places.size()) + "\n";
    for (const char* column : kColumns) header += std::string("property float ") + column + "\n";
    file.write(header + "property uint id\nend_header\n");
    const auto format = [&](char* out, std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i, out += 28) {
            std::memcpy(out, &points.places[i], 12);
            std::memcpy(out + 12, &points.velocities[i], 12);
            std::memcpy(out + 24, &points.ids[i], 4);
        }
        return out;
    };
    writeBlocks(points.places.size(), 28, format, file);
}

void writeLines(const ParticlePoints& points, char between, OutputFile& file) {
    constexpr std::size_t kMostDigits = 16;  // of a float, so that it is read again as it was
    const auto format = [&](char* out, std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            for (int k = 0; k < 6; ++k) {
                const float number = k < 3 ? points.places[i][k] : points.velocities[i][k - 3];
                out = std::to_chars(out, out + kMostDigits, number).ptr;
                *out++ = between;
            }
            out = std::to_chars(out, out + kMostDigits, points.ids[i]).ptr;
            *out++ = '\n';
        }
        return out;
    };
    writeBlocks(points.places.size(), 7 * (kMostDigits + 1), format, file);
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

bool isWholePoints(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::string start(16, '\0');
    file.read(start.data(), std::streamsize(start.size()));
    const auto read = std::size_t(file.gcount());
    const std::string ending = lowerExtension(path);
    const std::string_view first = ending == ".ply"    ? "ply\n"
                                   : ending == ".vtk"  ? "# vtk DataFile"
                                   : ending == ".bgeo" ? "BgeoV"
                                   : ending == ".csv"  ? "x,y,z"
                                                       : "";
    return std::string_view(start).substr(0, read).starts_with(first);
}

Done exportPoints(const ParticlePoints& points, const std::string& path, const std::function<void()>& kept) {
    assert(points.places.size() == points.velocities.size() && points.places.size() == points.ids.size());
    if (Done known = checkPointsPath(path); !known) return known;
    Result<OutputFile> file = OutputFile::open(path, nullptr);
    if (!file) return file.error();
    const std::string ending = lowerExtension(path);
    if (ending == ".ply") {
        writePlyPoints(points, *file);
    } else if (ending == ".vtk") {
        writeVtkPoints(points, *file);
    } else if (ending == ".bgeo") {
        writeBgeoPoints(points, *file);
    } else {
        const bool named = ending == ".csv";
        if (named) file->write("x,y,z,vx,vy,vz,id\n");
        writeLines(points, named ? ',' : ' ', *file);
    }
    return file->commit(kept);
}

}  // namespace fw
