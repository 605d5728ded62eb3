// Wavefront OBJ and its material file.
//
// Numbers are the shortest text that reads back as the same float, so the file loses nothing. Vertex colours
// follow the position ("v x y z r g b"), the extension that MeshLab, Blender and ZBrush share, sRGB-encoded.
// The material file carries the factors: Kd, and Pr, Pm, Ke of the PBR extension that Blender and others
// read; of what light passes through also its filter Tf, its index of refraction Ni, and illum 7, which says
// that both count. Nothing in it says how much is absorbed within.
#include <array>
#include <charconv>
#include <cstring>

#include "runtime/export/blocks.h"
#include "runtime/export/formats.h"

namespace fw {
namespace {

constexpr std::size_t kLongestLine =
    128;  // "v" and six floats of at most 15 characters; "f" and six indices of 10

char* put(char* out, float value) { return std::to_chars(out, out + 24, value).ptr; }
char* put(char* out, uint32_t value) { return std::to_chars(out, out + 12, value).ptr; }

char* putVector(char* out, const char* key, glm::vec3 v) {
    while (*key) *out++ = *key++;
    for (int k = 0; k < 3; ++k) {
        *out++ = ' ';
        out = put(out, v[k]);
    }
    return out;
}

/// Colour codes are 8 bit: three digits say all of them.
char* putColor(char* out, glm::vec3 color) {
    for (int k = 0; k < 3; ++k) {
        const unsigned code = (encodeSrgb(color[k]) * 1000u + 127u) / 255u;
        *out++ = ' ';
        *out++ = static_cast<char>('0' + code / 1000);
        *out++ = '.';
        *out++ = static_cast<char>('0' + code / 100 % 10);
        *out++ = static_cast<char>('0' + code / 10 % 10);
        *out++ = static_cast<char>('0' + code % 10);
    }
    return out;
}

std::string materialName(const Mesh& mesh, const std::string& name, std::size_t part) {
    return printable(partName(mesh, name, part));
}

void writeLibrary(const Mesh& mesh, bool colors, const std::string& name,
                  const std::vector<TextureImage>& images, OutputFile& library) {
    const auto linear = [](glm::vec3 v) {
        std::array<char, kLongestLine> text{};
        return std::string(text.data(), putVector(text.data(), "", v));
    };
    const auto encoded = [](glm::vec3 v) {
        std::array<char, kLongestLine> text{};
        return std::string(text.data(), putColor(text.data(), v));
    };
    const glm::vec3 base = colors ? glm::vec3(1.0f) : mesh.baseColor;
    library.write("# " + generatorName() + "\n");
    const auto write = [&](const Material& material, const std::string& called) {
        library.write("newmtl " + called + "\n");
        if (mesh.textures) {
            library.write(textureLines(*mesh.textures, images));
        } else {
            library.write("Kd" + encoded(base) + "\nPr " + std::to_string(material.roughness) + "\nPm " +
                          std::to_string(material.metallic) + "\n");
            if (material.emission != glm::vec3(0.0f)) library.write("Ke" + linear(material.emission) + "\n");
        }
        if (material.transmission > 0.0f)
            library.write("Tf" + encoded(base * material.transmission) + "\nNi " +
                          std::to_string(material.ior) + "\nillum 7\n");
    };
    if (mesh.parts.empty()) write(mesh.material, materialName(mesh, name, 0));
    for (std::size_t i = 0; i < mesh.parts.size(); ++i)
        write(mesh.parts[i].material, materialName(mesh, name, i));
}

}  // namespace

void writeObjHead(const Mesh& material, bool colors, const std::string& name, const std::string& libraryName,
                  const Placement& placement, OutputFile& file, OutputFile& library,
                  const std::vector<TextureImage>& images) {
    writeLibrary(material, colors, name, images, library);
    file.write("# " + generatorName() + ", " + placement.words() + "\nmtllib " + libraryName + "\no " + name +
               "\n");
}

void writeObjMaterial(const std::string& name, OutputFile& file) { file.write("usemtl " + name + "\n"); }

void writeObjVertices(const Mesh& mesh, OutputFile& file) {
    writeBlocks(
        mesh.positions.size(), kLongestLine,
        [&](char* out, std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) {
                out = putVector(out, "v", mesh.positions[i]);
                if (!mesh.colors.empty()) out = putColor(out, mesh.colors[i]);
                *out++ = '\n';
            }
            return out;
        },
        file);
    writeBlocks(
        mesh.uvs.size(), kLongestLine,
        [&](char* out, std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) {
                *out++ = 'v';
                *out++ = 't';
                *out++ = ' ';
                out = put(out, mesh.uvs[i].x);
                *out++ = ' ';
                out = put(out, 1.0f - mesh.uvs[i].y);  // upwards
                *out++ = '\n';
            }
            return out;
        },
        file);
    writeBlocks(
        mesh.normals.size(), kLongestLine,
        [&](char* out, std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) {
                out = putVector(out, "vn", mesh.normals[i]);
                *out++ = '\n';
            }
            return out;
        },
        file);
}

void writeObjFaces(const Mesh& mesh, std::size_t firstTriangle, std::size_t count, OutputFile& file) {
    const bool normals = !mesh.normals.empty(), uvs = !mesh.uvs.empty();
    writeBlocks(
        count, kLongestLine,
        [&](char* out, std::size_t first, std::size_t last) {
            for (std::size_t i = (firstTriangle + first) * 3; i < (firstTriangle + last) * 3; ++i) {
                if (i % 3 == 0) *out++ = 'f';
                *out++ = ' ';
                const char* index = out;
                out = put(out, mesh.indices[i] + 1);
                const auto digits = static_cast<std::size_t>(out - index);
                const auto again = [&] {
                    std::memcpy(out, index, digits);
                    out += digits;
                };
                if (normals || uvs) *out++ = '/';  // "7//7", "7/7/7", "7/7"
                if (uvs) again();
                if (normals) *out++ = '/', again();
                if (i % 3 == 2) *out++ = '\n';
            }
            return out;
        },
        file);
}

void writeObj(const Mesh& mesh, const std::string& name, const std::string& libraryName,
              const Placement& placement, const std::vector<TextureImage>& images, OutputFile& file,
              OutputFile& library) {
    writeObjHead(mesh, !mesh.colors.empty(), name, libraryName, placement, file, library, images);
    writeObjVertices(mesh, file);
    if (mesh.parts.empty()) {
        writeObjMaterial(materialName(mesh, name, 0), file);
        writeObjFaces(mesh, 0, mesh.triangleCount(), file);
    }
    std::size_t first = 0;
    for (std::size_t i = 0; i < mesh.parts.size(); ++i) {
        writeObjMaterial(materialName(mesh, name, i), file);
        writeObjFaces(mesh, first, mesh.parts[i].triangles, file);
        first += mesh.parts[i].triangles;
    }
}

}  // namespace fw
