// Formats whose numbers have their high byte first.
#include <cstring>

#include "runtime/export/big_endian.h"
#include "runtime/export/blocks.h"
#include "runtime/export/formats.h"
#include "runtime/export/point_formats.h"

namespace fw {

namespace {

/// Writes words(out, i), so many for each point.
template <class Words>
void writeWords(std::size_t points, std::size_t wordsOfOne, OutputFile& file, const Words& words) {
    const auto format = [&](char* out, std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) out = words(out, i);
        return out;
    };
    writeBlocks(points, 4 * wordsOfOne, format, file);
}

}  // namespace

void writeVtkPoints(const ParticlePoints& points, OutputFile& file) {
    constexpr uint32_t kVertex = 1;  // a cell of one point
    const std::size_t count = points.places.size();
    const std::string number = std::to_string(count);
    file.write("# vtk DataFile Version 3.0\n" + generatorName() +
               ", metres, +Y up\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS " + number + " float\n");
    writeWords(count, 3, file, [&](char* out, std::size_t i) { return putBig(out, points.places[i]); });
    file.write("\nCELLS " + number + " " + std::to_string(2 * count) + "\n");
    writeWords(count, 2, file,
               [&](char* out, std::size_t i) { return putBig(putBig(out, 1u), uint32_t(i)); });
    file.write("\nCELL_TYPES " + number + "\n");
    writeWords(count, 1, file, [&](char* out, std::size_t) { return putBig(out, kVertex); });
    file.write("\nPOINT_DATA " + number + "\nVECTORS velocity float\n");
    writeWords(count, 3, file, [&](char* out, std::size_t i) { return putBig(out, points.velocities[i]); });
    file.write("\nSCALARS id unsigned_int 1\nLOOKUP_TABLE default\n");
    writeWords(count, 1, file, [&](char* out, std::size_t i) { return putBig(out, points.ids[i]); });
    file.write("\n");
}

void writeBgeoPoints(const ParticlePoints& points, OutputFile& file) {
    constexpr uint32_t kVersion = 5, kInteger = 1, kVector = 5;  // the last two: types of attributes
    const auto count = uint32_t(points.places.size());
    file.write(std::string("BgeoV") + big({kVersion, count, 0, 0, 0}) +  // no primitives, no groups
               big({2, 0, 0, 0}));                                       // attributes of points alone
    const auto attribute = [&](std::string_view name, char size, uint32_t type) {
        file.write(std::string{'\0', char(name.size())} + std::string(name) + std::string{'\0', size} +
                   big({type}) + std::string(4 * std::size_t(size), '\0'));  // and what they are by default
    };
    attribute("v", 3, kVector);
    attribute("id", 1, kInteger);
    writeWords(count, 8, file, [&](char* out, std::size_t i) {
        out = putBig(putBig(out, points.places[i]), 1.0f);
        return putBig(putBig(out, points.velocities[i]), points.ids[i]);
    });
    file.write(std::string{'\0', char(0xff)});  // nothing more
}

}  // namespace fw
