#include "runtime/export/export.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <filesystem>
#include <functional>
#include <future>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <optional>
#include <utility>

#include "graph/assets/image.h"
#include "graph/document/json_tokens.h"
#include "runtime/export/formats.h"
#include "runtime/export/gltf_scene.h"
#include "runtime/measure/mesh_requirements.h"
#include "runtime/mesh/corners.h"
#include "runtime/mesh/separate_parts.h"
#include "runtime/system/interruption.h"

namespace fw {
namespace {

enum class Format { glb, gltf, obj, stl, ply, threeMf, vdb };

/// In the order of Format.
constexpr ExportFormat kFormats[] = {
    {".glb", "glTF in one file, with colours: Blender, game engines, the web", true, true, true},
    {".gltf", "glTF as text and a .bin file beside it", true, true, true},
    {".obj", "OBJ with colours and a .mtl file beside it", false, true, true},
    {".stl", "STL: the shape alone, for printing"},
    {".ply", "PLY with colours: MeshLab and other tools for meshes"},
    {".3mf", "3MF in millimetres with colours, for printing"},
    {".vdb", "OpenVDB level set: distances instead of triangles, for Houdini and Blender", false, false},
};

std::optional<Format> formatOf(const std::string& path) {
    const ExportFormat* format = exportFormat(path);
    return format ? std::optional(Format(format - kFormats)) : std::nullopt;
}

/// The bounds, or nothing if some coordinate is NaN or infinite.
std::optional<Bounds> finiteBounds(const std::vector<glm::vec3>& positions) {
    Bounds bounds{positions[0], positions[0]};
    glm::vec3 poison(0.0f);  // x * 0 is 0 for finite x and NaN for the rest: one test for all
    for (const glm::vec3& p : positions) {
        bounds.min = glm::min(bounds.min, p);
        bounds.max = glm::max(bounds.max, p);
        poison += p * 0.0f;
    }
    if (poison != glm::vec3(0.0f)) return std::nullopt;
    return bounds;
}

bool unitLength(glm::vec3 n) {
    const float squared = glm::dot(n, n);
    return squared > 0.999f && squared < 1.001f;  // NaN fails
}

/// Where the field has no gradient the mesher has no normal. glTF demands one: the mean of the triangles
/// around.
std::vector<glm::vec3> repairedNormals(const Mesh& mesh) {
    std::vector<glm::vec3> normals = mesh.normals;
    for (glm::vec3& n : normals)
        if (!unitLength(n)) n = glm::vec3(0.0f);
    std::vector<glm::vec3> sums(normals.size(), glm::vec3(0.0f));
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const uint32_t* corner = &mesh.indices[i];
        const glm::vec3 a = mesh.positions[corner[0]];
        const glm::vec3 area = glm::cross(mesh.positions[corner[1]] - a, mesh.positions[corner[2]] - a);
        for (int k = 0; k < 3; ++k) sums[corner[k]] += area;
    }
    for (std::size_t i = 0; i < normals.size(); ++i) {
        if (normals[i] != glm::vec3(0.0f)) continue;
        const glm::vec3 n = glm::normalize(sums[i]);
        normals[i] = unitLength(n) ? n : glm::vec3(0.0f, 1.0f, 0.0f);
    }
    return normals;
}

/// What keeps the mesh from being a solid for the format; empty if nothing does. A level set needs an inside.
/// 3MF and EXT_mesh_manifold need two triangles at each edge, which run along it in opposite directions;
/// parts may touch at a vertex. Triangles that collapsed are left out of 3MF, but glTF has to show them.
std::string whyNoSolid(const WeldedMesh& solid, Format format) {
    Report report = reportOnMesh(solid.positions, solid.indices);
    report.nonManifoldVertices = 0;
    const auto needed = parseRequirements(format == Format::vdb ? "closed" : "closed,manifold");
    const std::vector<std::string> reasons = unmet(*needed, report);
    if (!reasons.empty()) return reasons.front();
    if (!exportFormats()[std::size_t(format)].manifold) return {};
    for (std::size_t i = 0; i < solid.indices.size(); i += 3)
        if (collapsed(&solid.indices[i])) return "a triangle of it has two corners at one place";
    return {};
}

Merges mergesOf(const Mesh& mesh, const WeldedMesh& solid) {
    constexpr uint32_t kNone = ~0u;
    std::vector<uint32_t> first(solid.positions.size(), kNone);  // vertex at each place
    Merges merges;
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        uint32_t& vertex = first[solid.indices[i]];
        if (vertex == kNone) vertex = mesh.indices[i];
        if (vertex == mesh.indices[i]) continue;
        merges.entries.push_back(static_cast<uint32_t>(i));
        merges.vertices.push_back(vertex);
    }
    return merges;
}

float voxelSize(const ExportOptions& options, const Bounds& bounds) {
    const glm::vec3 size = bounds.max - bounds.min;
    return options.cellSize > 0.0f ? options.cellSize * float(options.placement.scale)
                                   : std::max({size.x, size.y, size.z}) / 128.0f;
}

/// Hands that part of every piece to `write`, while the next is loaded.
Done forPieces(const MeshPieces& mesh, MeshPieces::Part part, const OutputFile& to,
               const std::function<void(const Mesh&)>& write) {
    const auto load = [&](std::size_t piece) {
        return std::async(std::launch::async, [&mesh, piece, part] { return mesh.load(piece, part); });
    };
    std::future<Result<Mesh>> next = load(0);
    for (std::size_t i = 0; i < mesh.count && to.good(); ++i) {
        const Result<Mesh> piece = next.get();
        if (!piece) return piece.error();
        if (i + 1 < mesh.count) next = load(i + 1);
        write(*piece);
    }
    return done();
}

/// One of the arrays of a file, to which pieces are added behind each other.
struct Section {
    uint64_t next, end;  ///< bytes of the file

    void add(OutputFile& file, const std::function<void()>& write) {
        file.goTo(next);
        write();
        next = file.position();
    }
};

/// What is written of the pieces is as much as was said.
Done checkFilled(std::initializer_list<Section> sections, OutputFile& file) {
    for (const Section& section : sections)
        if (file.good() && section.next != section.end)
            return Error{.message = "the mesh was another when it was made again; run the command again"};
    file.goTo(file.size());
    return done();
}

Done writeGltfPieces(const MeshPieces& mesh, const GltfLayout& layout, OutputFile& file) {
    const auto behind = [](uint64_t begin, uint64_t bytes) { return Section{begin, begin + bytes}; };
    Section positions = behind(file.position(), layout.vertices * 12),
            normals = behind(positions.end, layout.vertices * 12),
            colors = behind(normals.end, layout.colors ? layout.vertices * 8 : 0),
            indices = behind(colors.end, layout.indices * layout.indexSize());
    const Done written = forPieces(mesh, MeshPieces::numbered, file, [&](const Mesh& m) {
        positions.add(file, [&] { file.write(std::span(m.positions)); });
        normals.add(file, [&] { file.write(std::span(m.normals)); });
        if (layout.colors) colors.add(file, [&] { writeGltfColors(m, file); });
        indices.add(file, [&] { writeGltfIndices(m.indices, layout.shortIndices(), file); });
    });
    if (!written) return written;
    return checkFilled({positions, normals, colors, indices}, file);
}

Done writePlyPieces(const MeshPieces& mesh, OutputFile& file) {
    Section vertices{file.position(), file.position() + mesh.vertexCount * kPlyVertexBytes},
        faces{vertices.end, vertices.end + mesh.triangleCount * kPlyFaceBytes};
    const Done written = forPieces(mesh, MeshPieces::numbered, file, [&](const Mesh& m) {
        vertices.add(file, [&] { writePlyVertices(m, file); });
        faces.add(file, [&] { writePlyFaces(m, file); });
    });
    if (!written) return written;
    return checkFilled({vertices, faces}, file);
}

/// The pieces where they stand in the file.
MeshPieces placedPieces(const MeshPieces& given, const Placement& placement) {
    if (placement.isNone()) return given;
    MeshPieces pieces = given;
    pieces.material = placed(given.material, placement);
    const glm::vec3 a = placement.place(given.least), b = placement.place(given.greatest);
    pieces.least = glm::min(a, b), pieces.greatest = glm::max(a, b);
    pieces.size.volume *= std::pow(placement.scale, 3.0),
        pieces.size.area *= placement.scale * placement.scale;
    pieces.load = [&given, placement](std::size_t piece, MeshPieces::Part part) -> Result<Mesh> {
        Result<Mesh> mesh = given.load(piece, part);
        if (!mesh) return mesh;
        return placed(std::move(*mesh), placement);
    };
    return pieces;
}

/// The file beside the one asked for, and its name; no file where the format has none.
struct Beside {
    std::optional<OutputFile> file = {};
    std::string name = {};

    OutputFile* orNone() { return file ? &*file : nullptr; }
};

Result<Beside> openBeside(const std::string& path, const ExportOptions& options) {
    const std::string besidePath = exportedPaths(path).back();
    if (besidePath == path) return Beside{};
    Result<OutputFile> opened = OutputFile::open(besidePath, options.cancel);
    if (!opened) return opened.error();
    return Beside{std::move(*opened), std::filesystem::path(besidePath).filename().string()};
}

/// A file of the format without a triangle.
Result<ExportedFiles> exportEmpty(const std::string& path, Format format, const ExportOptions& options) {
    const std::string name = objectName(path, options);
    Result<OutputFile> file = OutputFile::open(path, options.cancel);
    if (!file) return file.error();
    Result<Beside> beside = openBeside(path, options);
    if (!beside) return beside.error();
    std::string failure;
    switch (format) {
        case Format::glb: writeEmptyGltf(name, true, *file); break;
        case Format::gltf: writeEmptyGltf(name, false, *file); break;
        case Format::obj:
            writeObjHead({}, false, name, beside->name, options.placement, *file, *beside->file);
            break;
        case Format::stl: writeStlHeader(0, options.placement, *file); break;
        case Format::ply: writePlyHeader(0, 0, true, *file); break;
        case Format::threeMf: failure = write3mf({}, {}, name, options.cancel, *file); break;
        case Format::vdb:
            failure =
                writeVdb({}, options.cellSize > 0.0f ? options.cellSize : 1.0f, name, options.cancel, *file);
            break;
    }
    if (!failure.empty()) return Error{.message = "cannot write: " + failure, .file = path};
    return commitAll(path, options, *file, beside->orNone());
}

}  // namespace

Result<Bounds> checkMesh(const Mesh& mesh, const std::string& path) {
    const auto refuse = [&](std::string message) {
        return Error{.message = std::move(message), .file = path};
    };
    if (mesh.positions.size() > 0x7fffffffu || mesh.triangleCount() > 0xffffffffu)
        return refuse("the mesh is too large for this format; lower the resolution");
    const bool small = mesh.positions.size() < 10'000;  // not worth a thread
    std::future<uint32_t> greatest = std::async(small ? std::launch::deferred : std::launch::async, [&] {
        return *std::max_element(mesh.indices.begin(), mesh.indices.end());
    });
    const std::optional<Bounds> bounds = finiteBounds(mesh.positions);
    if (greatest.get() >= mesh.positions.size())
        return refuse("the mesh refers to a vertex that it does not have");
    if (!bounds)
        return refuse("the mesh has a vertex that is not finite; the field is infinite or undefined there");
    return *bounds;
}

std::optional<Mesh> withUnitNormals(const Mesh& mesh) {
    if (std::ranges::all_of(mesh.normals, unitLength)) return std::nullopt;
    Mesh repaired = mesh;
    repaired.normals = repairedNormals(mesh);
    return repaired;
}

std::string printable(std::string name) {
    for (std::size_t bad; (bad = firstBadByte(name)) != std::string::npos;) name[bad] = '_';
    for (char& c : name)
        if ((c > 0 && c <= ' ') || c == 127) c = '_';
    return name.empty() ? "mesh" : name;
}

std::string objectName(const std::string& path, const ExportOptions& options) {
    return printable(options.name.empty() ? std::filesystem::path(path).stem().string() : options.name);
}

std::string percentEncoded(const std::string& name) {
    constexpr char kHex[] = "0123456789ABCDEF";
    std::string uri;
    for (const char c : name) {
        const auto byte = static_cast<unsigned char>(c);
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                           std::string_view("-._~").find(c) != std::string_view::npos;
        if (plain) {
            uri += c;
        } else {
            uri += '%';
            uri += kHex[byte >> 4];
            uri += kHex[byte & 15];
        }
    }
    return uri;
}

Result<std::vector<OutputFile>> openImages(const std::string& path, const std::vector<TextureImage>& images,
                                           const ExportOptions& options) {
    std::vector<OutputFile> files;
    if (lowerExtension(path) == ".glb") return files;
    for (const TextureImage& image : images) {
        const std::filesystem::path file = std::filesystem::path(path).parent_path() / image.file;
        Result<OutputFile> opened = OutputFile::open(file.string(), options.cancel);
        if (!opened) return opened.error();
        opened->write(image.png);
        files.push_back(std::move(*opened));
    }
    return files;
}

Result<ExportedFiles> commitAll(const std::string& path, const ExportOptions& options, OutputFile& file,
                                OutputFile* beside, std::span<OutputFile> images) {
    ExportedFiles files{exportedPaths(path), file.size() + (beside ? beside->size() : 0)};
    for (OutputFile& image : images) {
        files.bytes += image.size();
        if (Done finished = image.finish(); !finished) return finished.error();
    }
    if (Done finished = file.finish(); !finished) return finished.error();
    if (Done finished = beside ? beside->finish() : done(); !finished) return finished.error();
    if (options.examine)
        if (Done fine = options.examine({path, file.place(), beside ? beside->place() : ""}); !fine)
            return fine.error();
    // The file asked for goes last: when it is there, all of the export is.
    const Uninterrupted now;
    for (OutputFile& image : images)
        if (Done committed = image.commit(); !committed) return committed.error();
    if (Done committed = beside ? beside->commit() : done(); !committed) return committed.error();
    if (Done committed = file.commit(options.kept); !committed) return committed.error();
    return files;
}

std::span<const ExportFormat> exportFormats() { return kFormats; }

const ExportFormat* exportFormat(const std::string& path) {
    const auto* format = std::ranges::find(kFormats, lowerExtension(path), &ExportFormat::ending);
    return format == std::end(kFormats) ? nullptr : format;
}

Done checkExportPath(const std::string& path, const ExportOptions& options, bool measured) {
    if (const ExportFormat* format = exportFormat(path)) {
        const std::string ending = format->ending;
        if (options.manifold && !format->manifold)
            return Error{
                .message =
                    "a mesh is marked as a solid in .glb and .gltf alone: leave that out for " + ending,
                .file = path};
        for (const auto& [asked, what] :
             {std::pair(options.compress, "compressed"), {options.parts, "parted"}})
            if (asked && !isGltf(path))
                return Error{.message = std::string("a mesh is ") + what +
                                        " in .glb and .gltf alone: leave that out for " + ending,
                             .file = path};
        if (options.manifold && (options.compress || options.parts))
            return Error{
                .message = "a mesh that is marked as a solid is neither compressed nor parted: choose one",
                .file = path};
        if (options.splitMaterials && !format->parts)
            return Error{.message =
                             "faces are cut where materials meet in .glb, .gltf and .obj alone: leave "
                             "--split-materials out for " +
                             ending,
                         .file = path};
        if (measured && !format->measurable)
            return Error{.message = ending +
                                    " holds distances and no triangles that a report could measure: "
                                    "ask for the report of a .ply of the same graph",
                         .file = path};
        return done();
    }
    const std::string extension = lowerExtension(path);
    std::string message = extension.empty() ? "the file needs an extension that names its format: "
                                            : "unknown format '" + extension + "'; known are ";
    for (std::size_t i = 0; i < std::size(kFormats); ++i) {
        if (i > 0) message += i + 1 < std::size(kFormats) ? ", " : " and ";
        message += kFormats[i].ending;
    }
    return Error{.message = message, .file = path};
}

bool isGltf(const std::string& path) {
    return formatOf(path) == Format::glb || formatOf(path) == Format::gltf;
}

std::vector<std::string> exportedPaths(const std::string& path) {
    const std::optional<Format> format = formatOf(path);
    if (format != Format::gltf && format != Format::obj) return {path};
    const char* ending = format == Format::gltf ? ".bin" : ".mtl";
    return {path, std::filesystem::path(path).replace_extension(ending).string()};
}

namespace {

/// The mesh, or its parts, as a scene, where few bits a number can be had.
Result<ExportedFiles> exportScene(const Mesh& mesh, const std::string& path, const ExportOptions& options) {
    Result<GltfScene> scene = GltfScene::open(path, options);
    if (!scene) return scene.error();
    const std::string name = scene->name();
    if (!options.parts) {
        if (const Done added = scene->addShown(mesh, name); !added) return added.error();
        return scene->end();
    }
    const std::size_t whole = scene->addNode({{"name", name}});
    const std::vector<Mesh> parts = separateParts(mesh);
    for (std::size_t i = 0; i < parts.size(); ++i)
        if (const Done added = scene->addShown(parts[i], name + "_" + std::to_string(i + 1), whole); !added)
            return added.error();
    return scene->end();
}

/// Of a mesh that is where it stands in the file.
Result<ExportedFiles> exportPlaced(const Mesh& mesh, const std::string& path, const ExportOptions& options) {
    const auto refuse = [&](std::string message) {
        return Error{.message = std::move(message), .file = path};
    };
    const Format format = *formatOf(path);
    assert(mesh.indices.size() % 3 == 0);
    assert(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size());
    assert(mesh.colors.empty() || mesh.colors.size() == mesh.positions.size());

    if (mesh.indices.empty() && options.mayBeEmpty) return exportEmpty(path, format, options);
    if (mesh.indices.empty() || mesh.positions.empty())
        return refuse("nothing to export: the surface has no triangle inside the region");
    const Result<Bounds> bounds = checkMesh(mesh, path);
    if (!bounds) return bounds.error();
    if (const std::optional<Mesh> repaired = withUnitNormals(mesh))
        return exportPlaced(*repaired, path, options);
    if (options.compress || options.parts) return exportScene(mesh, path, options);
    assert(!mesh.textures || (hasTextures(path) && mesh.uvs.size() == mesh.positions.size() &&
                              mesh.tangents.size() == mesh.positions.size()));

    WeldedMesh solid;
    if (options.manifold || format == Format::threeMf || format == Format::vdb) {
        solid = weld(mesh.positions, mesh.indices);
        if (const std::string why = whyNoSolid(solid, format); !why.empty())
            return refuse("the mesh is no solid: " + why + "; change the resolution, or write " +
                          (options.manifold ? "glTF without saying that it is one" : "another format"));
    }
    const Merges merges = options.manifold ? mergesOf(mesh, solid) : Merges{};
    const Merges* const marked = options.manifold ? &merges : nullptr;

    const std::string name = objectName(path, options);
    Result<OutputFile> file = OutputFile::open(path, options.cancel);
    if (!file) return file.error();

    Result<Beside> beside = openBeside(path, options);
    if (!beside) return beside.error();
    const std::vector<TextureImage> images =
        mesh.textures ? textureImages(*mesh.textures, path) : std::vector<TextureImage>();
    Result<std::vector<OutputFile>> imageFiles = openImages(path, images, options);
    if (!imageFiles) return imageFiles.error();
    std::string failure;
    switch (format) {
        case Format::gltf:
            writeGltf(mesh, *bounds, name, marked, percentEncoded(beside->name), images, *file,
                      *beside->file);
            break;
        case Format::obj:
            writeObj(mesh, name, beside->name, options.placement, images, *file, *beside->file);
            break;
        case Format::glb:
            if (!writeGlb(mesh, *bounds, name, marked, images, *file))
                return refuse("the mesh exceeds the 4 GiB of a GLB; write .gltf or lower the resolution");
            break;
        case Format::stl: writeStl(mesh, options.placement, *file); break;
        case Format::ply: writePly(mesh, *file); break;
        case Format::threeMf: failure = write3mf(mesh, solid, name, options.cancel, *file); break;
        case Format::vdb:
            failure = writeVdb(solid, voxelSize(options, *bounds), name, options.cancel, *file);
            break;
    }
    if (!failure.empty()) return refuse("cannot write: " + failure);
    Result<ExportedFiles> files = commitAll(path, options, *file, beside->orNone(), *imageFiles);
    if (files && !imageFiles->empty())
        for (const TextureImage& image : images)
            files->paths.push_back((std::filesystem::path(path).parent_path() / image.file).string());
    return files;
}

}  // namespace

Result<ExportedFiles> exportMesh(const Mesh& mesh, const std::string& path, const ExportOptions& options) {
    if (Done known = checkExportPath(path, options); !known) return known.error();
    if (options.placement.isNone()) return exportPlaced(mesh, path, options);
    return exportPlaced(placed(mesh, options.placement), path, options);
}

Done checkPiecesPath(const std::string& path) {
    if (Done known = checkExportPath(path); !known) return known;
    const std::optional<Format> format = formatOf(path);
    if (format != Format::threeMf && format != Format::vdb) return done();
    return Error{.message = lowerExtension(path) +
                            " cannot be written from tiles: choose .ply, .stl, .obj, .glb or .gltf",
                 .file = path};
}

Result<ExportedFiles> exportPieces(const MeshPieces& given, const std::string& path,
                                   const ExportOptions& options) {
    const MeshPieces mesh = placedPieces(given, options.placement);
    const auto refuse = [&](std::string message) {
        return Error{.message = std::move(message), .file = path};
    };
    if (Done known = checkPiecesPath(path); !known) return known.error();
    const Format format = *formatOf(path);
    if (mesh.triangleCount == 0)
        return refuse("nothing to export: the surface has no triangle inside the region");
    if (mesh.vertexCount > 0x7fffffffu || mesh.triangleCount > 0xffffffffu)
        return refuse(
            "the mesh has more vertices or triangles than the format can number; lower the resolution");

    const std::string name = objectName(path, options);
    Result<OutputFile> file = OutputFile::open(path, options.cancel);
    if (!file) return file.error();
    const GltfLayout layout{.vertices = mesh.vertexCount,
                            .indices = 3 * mesh.triangleCount,
                            .normals = true,
                            .colors = mesh.colors,
                            .thickness = mesh.size.meanChord()};
    const Bounds bounds{mesh.least, mesh.greatest};
    Done written = done();
    Result<Beside> beside = openBeside(path, options);
    if (!beside) return beside.error();
    if (format == Format::gltf) {
        file->write(gltfJson(mesh.material, layout, bounds, name, percentEncoded(beside->name)));
        written = writeGltfPieces(mesh, layout, *beside->file);
    } else if (format == Format::obj) {
        writeObjHead(mesh.material, mesh.colors, name, beside->name, options.placement, *file, *beside->file);
        writeObjMaterial(name, *file);
        written = forPieces(mesh, MeshPieces::numbered, *file, [&](const Mesh& m) {
            writeObjVertices(m, *file);
            writeObjFaces(m, 0, m.triangleCount(), *file);
        });
    } else if (format == Format::glb) {
        if (!writeGlbHead(gltfJson(mesh.material, layout, bounds, name, {}), layout.bytes(), *file))
            return refuse(
                "the mesh exceeds the 4 GiB of a GLB; write .gltf or .ply, or lower the resolution");
        written = writeGltfPieces(mesh, layout, *file);
        writeGlbEnd(layout.bytes(), *file);
    } else if (format == Format::stl) {
        writeStlHeader(mesh.triangleCount, options.placement, *file);
        written =
            forPieces(mesh, MeshPieces::corners, *file, [&](const Mesh& m) { writeStlFacets(m, *file); });
    } else {
        writePlyHeader(mesh.vertexCount, mesh.triangleCount, true, *file);
        written = writePlyPieces(mesh, *file);
    }
    if (!written) return written.error();
    return commitAll(path, options, *file, beside->orNone());
}

std::string partName(const Mesh& mesh, const std::string& name, std::size_t part) {
    const std::string& own = mesh.parts.empty() ? mesh.materialName : mesh.parts[part].name;
    if (!own.empty()) return own;
    return mesh.parts.empty() ? name : name + "_" + std::to_string(part + 1);
}

std::string generatorName() { return "Fieldwright " FIELDWRIGHT_VERSION; }

unsigned char encodeSrgb(float linear) {
    // thresholds[i] is the linear value halfway between the codes i and i + 1: nearest rounding without a
    // power a call.
    static const std::array<float, 255> thresholds = [] {
        std::array<float, 255> limits{};
        for (int i = 0; i < 255; ++i)
            limits[static_cast<std::size_t>(i)] = static_cast<float>(decodeSrgb((i + 0.5) / 255.0));
        return limits;
    }();
    return static_cast<unsigned char>(std::upper_bound(thresholds.begin(), thresholds.end(), linear) -
                                      thresholds.begin());
}

}  // namespace fw
