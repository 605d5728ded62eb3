// Binary little-endian PLY: a text header, then vertices (position, normal, colour), then faces.
//
// Colours are 8-bit sRGB, as every reader of "red green blue" takes them; a mesh without vertex colours
// states its base colour so that it does not look different from the glTF.
#include <bit>
#include <cstring>
#include <string>

#include "runtime/export/blocks.h"
#include "runtime/export/formats.h"

namespace fw {
namespace {

static_assert(std::endian::native == std::endian::little, "the writers copy memory into little-endian files");

struct Rgb {
    unsigned char r, g, b;
};

Rgb encode(glm::vec3 color) { return {encodeSrgb(color.x), encodeSrgb(color.y), encodeSrgb(color.z)}; }

}  // namespace

void writePlyHeader(uint64_t vertices, uint64_t triangles, bool normals, OutputFile& file) {
    std::string header =
        "ply\nformat binary_little_endian 1.0\ncomment " + generatorName() + ", metres, +Y up\n";
    header += "element vertex " + std::to_string(vertices) + "\n";
    header += "property float x\nproperty float y\nproperty float z\n";
    if (normals) header += "property float nx\nproperty float ny\nproperty float nz\n";
    header += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    header += "element face " + std::to_string(triangles) + "\n";
    header += "property list uchar int vertex_indices\nend_header\n";
    file.write(header);
}

void writePlyVertices(const Mesh& mesh, OutputFile& file) {
    const bool normals = !mesh.normals.empty();
    const std::size_t stride = normals ? kPlyVertexBytes : 15;
    const auto formatVertices = [&](char* out, std::size_t first, std::size_t last) {
        glm::vec3 lastColor = mesh.baseColor;  // neighbours mostly share a colour: encode it once
        Rgb lastCode = encode(lastColor);
        for (std::size_t i = first; i < last; ++i, out += stride) {
            std::memcpy(out, &mesh.positions[i], 12);
            if (normals) std::memcpy(out + 12, &mesh.normals[i], 12);
            if (!mesh.colors.empty() && mesh.colors[i] != lastColor)
                lastCode = encode(lastColor = mesh.colors[i]);
            std::memcpy(out + stride - 3, &lastCode, 3);
        }
        return out;
    };
    writeBlocks(mesh.positions.size(), stride, formatVertices, file);
}

void writePlyFaces(const Mesh& mesh, OutputFile& file) {
    const auto formatFaces = [&](char* out, std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i, out += kPlyFaceBytes) {
            out[0] = 3;
            std::memcpy(out + 1, &mesh.indices[i * 3], 12);
        }
        return out;
    };
    writeBlocks(mesh.triangleCount(), kPlyFaceBytes, formatFaces, file);
}

void writePly(const Mesh& mesh, OutputFile& file) {
    writePlyHeader(mesh.positions.size(), mesh.triangleCount(), !mesh.normals.empty(), file);
    writePlyVertices(mesh, file);
    writePlyFaces(mesh, file);
}

}  // namespace fw
