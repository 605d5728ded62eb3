// The files that exportMesh writes: accepted by the tools of their formats, and holding the mesh exactly.
#include "runtime/export/export.h"

#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <glm/geometric.hpp>
#include <limits>
#include <set>
#include <sstream>

#include "graph/assets/image.h"
#include "runtime/measure/mesh_report.h"
#include "runtime/measure/read_back.h"
#include "runtime/mesh/creases.h"
#include "tests/support/gltf_validator.h"
#include "tests/support/graph/temp_dir.h"
#include "tests/support/meshes.h"

namespace fw::export_test {

using test::expectValidGltf;
using test::TempDir;

void mustExport(const Mesh& mesh, const std::string& path, const ExportOptions& options = {}) {
    const Result<ExportedFiles> written = exportMesh(mesh, path, options);
    ASSERT_TRUE(written) << format(written.error());
    uint64_t bytes = 0;
    for (const std::string& file : written->paths) bytes += std::filesystem::file_size(file);
    EXPECT_EQ(bytes, written->bytes);
    EXPECT_EQ(written->paths[0], path);
}

Mesh painted(Mesh mesh) {
    test::paint(mesh);
    return mesh;
}

tinygltf::Model loadModel(const std::string& path) {
    tinygltf::Model model;
    std::string error, warning;
    tinygltf::TinyGLTF loader;
    const bool loaded = path.ends_with(".glb") ? loader.LoadBinaryFromFile(&model, &error, &warning, path)
                                               : loader.LoadASCIIFromFile(&model, &error, &warning, path);
    EXPECT_TRUE(loaded) << error;
    EXPECT_EQ(warning, "");
    return model;
}

const unsigned char* viewOf(const tinygltf::Model& model, int view) {
    return model.buffers[0].data.data() + model.bufferViews.at(static_cast<std::size_t>(view)).byteOffset;
}

const unsigned char* dataOf(const tinygltf::Model& model, int accessor) {
    return viewOf(model, model.accessors[static_cast<std::size_t>(accessor)].bufferView);
}

/// So many indices of 16 or 32 bits.
std::vector<uint32_t> indicesAt(const unsigned char* data, int componentType, std::size_t count) {
    std::vector<uint32_t> indices(count);
    for (std::size_t i = 0; i < count; ++i) {
        if (componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) {
            uint16_t index = 0;
            std::memcpy(&index, data + i * 2, 2);
            indices[i] = index;
        } else {
            std::memcpy(&indices[i], data + i * 4, 4);
        }
    }
    return indices;
}

TEST(Export, GltfHasNothingForTheValidatorToSay) {
    const TempDir folder;
    Mesh plain = test::cube();
    Mesh full = painted(test::torus(40, 17));
    full.material.roughness = 0.25f;
    full.material.metallic = 1.0f;
    full.material.emission = {0.5f, 0.0f, 0.25f};
    Mesh glowing = test::torus(9, 5);
    glowing.material.emission = {12.0f, 3.0f, 0.0f};
    glowing.baseColor = {0.1f, 0.2f, 0.9f};
    Mesh wide = painted(test::torus(300, 250));  // 75,000 vertices: 32-bit indices
    Mesh odd = test::tetrahedron();              // 12 indices of 16 bits ...
    odd.indices.resize(9);                       // ... and 9, which end off a multiple of four

    std::vector<std::string> files;
    for (const char* extension : {".glb", ".gltf"}) {
        for (const auto& [name, mesh] : {std::pair<const char*, const Mesh*>{"plain", &plain},
                                         {"full", &full},
                                         {"glowing", &glowing},
                                         {"wide", &wide},
                                         {"odd", &odd},
                                         {"Größe 100% #1", &plain}}) {
            files.push_back(folder.path(std::string(name) + extension));
            mustExport(*mesh, files.back());
        }
    }
    expectValidGltf(files);
}

TEST(Export, GltfHoldsTheMeshExactly) {
    const TempDir folder;
    Mesh mesh = painted(test::torus(300, 250, 1.0 / 3.0, 0.1));
    mesh.material.roughness = 0.3f;
    mesh.material.metallic = 0.6f;
    mesh.material.emission = {2.0f, 1.0f, 0.0f};
    for (const char* name : {"mesh.glb", "mesh.gltf"}) {
        mustExport(mesh, folder.path(name));
        const tinygltf::Model model = loadModel(folder.path(name));
        EXPECT_EQ(model.asset.generator, "Fieldwright " FIELDWRIGHT_VERSION);
        ASSERT_EQ(model.meshes.size(), 1u);
        const tinygltf::Primitive& part = model.meshes[0].primitives.at(0);
        const int positions = part.attributes.at("POSITION"), normals = part.attributes.at("NORMAL");
        const int colors = part.attributes.at("COLOR_0");
        ASSERT_EQ(model.accessors[static_cast<std::size_t>(positions)].count, mesh.positions.size());
        ASSERT_EQ(model.accessors[static_cast<std::size_t>(part.indices)].count, mesh.indices.size());
        EXPECT_EQ(0,
                  std::memcmp(dataOf(model, positions), mesh.positions.data(), mesh.positions.size() * 12));
        EXPECT_EQ(0, std::memcmp(dataOf(model, normals), mesh.normals.data(), mesh.normals.size() * 12));
        EXPECT_EQ(0, std::memcmp(dataOf(model, part.indices), mesh.indices.data(), mesh.indices.size() * 4));
        for (std::size_t i = 0; i < mesh.colors.size(); i += 97) {
            std::array<uint16_t, 4> rgba{};
            std::memcpy(rgba.data(), dataOf(model, colors) + i * 8, 8);
            for (int k = 0; k < 3; ++k)
                EXPECT_NEAR(rgba[static_cast<std::size_t>(k)] / 65535.0, mesh.colors[i][k],
                            0.5 / 65535 + 1e-7);
            EXPECT_EQ(rgba[3], 65535);
        }
        const tinygltf::Material& material = model.materials.at(0);
        EXPECT_EQ(material.pbrMetallicRoughness.roughnessFactor, double{0.3f});
        EXPECT_EQ(material.pbrMetallicRoughness.metallicFactor, double{0.6f});
        EXPECT_EQ(material.pbrMetallicRoughness.baseColorFactor, (std::vector<double>{1, 1, 1, 1}));
        EXPECT_EQ(material.emissiveFactor, (std::vector<double>{1, 0.5, 0}));
        EXPECT_EQ(material.extensions.at("KHR_materials_emissive_strength")
                      .Get("emissiveStrength")
                      .GetNumberAsDouble(),
                  2.0);
    }
}

/// In three parts, the second of glass.
Mesh withParts(Mesh mesh) {
    const std::size_t third = mesh.triangleCount() / 3;
    mesh.parts = {{{.roughness = 0.125f, .metallic = 1.0f}, third},
                  {{.roughness = 0.0f, .transmission = 1.0f, .ior = 1.25f, .absorption = {0, 1, 2}}, 7},
                  {{.roughness = 0.75f, .emission = {4, 2, 0}}, mesh.triangleCount() - third - 7}};
    return mesh;
}
Mesh inParts(int around, int across) { return withParts(painted(test::torus(around, across))); }

/// The triangles of EXT_mesh_manifold's primitive, as its specification says to read them.
std::vector<uint32_t> solidOf(const tinygltf::Model& model) {
    const tinygltf::Mesh& object = model.meshes.at(0);
    const tinygltf::Value& extension = object.extensions.at("EXT_mesh_manifold");
    const tinygltf::Value& primitive = extension.Get("manifoldPrimitive");
    EXPECT_EQ(primitive.Get("attributes").Keys(), std::vector<std::string>{"POSITION"});
    EXPECT_EQ(primitive.Get("attributes").Get("POSITION").GetNumberAsInt(),
              object.primitives.at(0).attributes.at("POSITION"));
    EXPECT_FALSE(primitive.Has("material"));
    const int number = primitive.Get("indices").GetNumberAsInt();
    const auto& accessor = model.accessors.at(static_cast<std::size_t>(number));
    const auto& shown = model.accessors.at(static_cast<std::size_t>(object.primitives[0].indices));
    EXPECT_EQ(accessor.bufferView, shown.bufferView);
    EXPECT_EQ(accessor.byteOffset, 0u);
    std::vector<uint32_t> indices =
        indicesAt(viewOf(model, accessor.bufferView), accessor.componentType, accessor.count);
    EXPECT_EQ(extension.Has("mergeIndices"), accessor.sparse.isSparse);
    if (!accessor.sparse.isSparse) {
        EXPECT_EQ(number == object.primitives[0].indices, object.primitives.size() == 1);
        return indices;
    }
    const auto& sparse = accessor.sparse;
    const auto count = static_cast<std::size_t>(sparse.count);
    const auto& entries =
        model.accessors.at(static_cast<std::size_t>(extension.Get("mergeIndices").GetNumberAsInt()));
    const auto& values =
        model.accessors.at(static_cast<std::size_t>(extension.Get("mergeValues").GetNumberAsInt()));
    EXPECT_EQ(entries.bufferView, sparse.indices.bufferView);
    EXPECT_EQ(entries.componentType, sparse.indices.componentType);
    EXPECT_EQ(entries.count, count);
    EXPECT_EQ(values.bufferView, sparse.values.bufferView);
    EXPECT_EQ(values.componentType, accessor.componentType);
    EXPECT_EQ(values.count, count);
    const auto at = indicesAt(viewOf(model, entries.bufferView), entries.componentType, count);
    const auto vertices = indicesAt(viewOf(model, values.bufferView), values.componentType, count);
    for (std::size_t i = 0; i < count; ++i) indices.at(at[i]) = vertices[i];
    return indices;
}

TEST(Export, GltfSaysThatAMeshIsASolid) {
    const TempDir folder;
    std::vector<std::string> files;
    const auto expectSolid = [&](const std::string& name, const Mesh& mesh, bool doubled) {
        SCOPED_TRACE(name);
        files.push_back(folder.path(name));
        mustExport(mesh, files.back(), {.manifold = true});
        const tinygltf::Model model = loadModel(files.back());
        EXPECT_NE(std::ranges::find(model.extensionsUsed, "EXT_mesh_manifold"), model.extensionsUsed.end());
        EXPECT_TRUE(model.extensionsRequired.empty());
        const std::vector<uint32_t> solid = solidOf(model);
        ASSERT_EQ(solid.size(), mesh.indices.size());
        EXPECT_EQ(solid != mesh.indices, doubled);
        std::set<std::pair<uint32_t, uint32_t>> edges;
        for (std::size_t i = 0; i < solid.size(); ++i) {
            ASSERT_EQ(mesh.positions[solid[i]], mesh.positions[mesh.indices[i]]);
            EXPECT_TRUE(edges.emplace(solid[i], solid[i % 3 == 2 ? i - 2 : i + 1]).second);
        }
        for (const auto& [from, to] : edges) EXPECT_TRUE(edges.contains({to, from}));
        // What is shown is as it would be without.
        mustExport(mesh, folder.path("plain.glb"));
        EXPECT_EQ(writeReport(*reportOnFile(files.back())),
                  writeReport(*reportOnFile(folder.path("plain.glb"))));
    };
    Mesh creased = test::cube();
    creased.normals.assign(creased.positions.size(), glm::vec3(0, 1, 0));
    splitCreases(creased);
    ASSERT_EQ(creased.positions.size(), 24u);
    expectSolid("smooth.glb", painted(test::torus(40, 17)), false);
    expectSolid("Würfel mit Kanten.glb", painted(creased), true);
    expectSolid("cube.gltf", creased, true);
    expectSolid("tetrahedron.glb", test::unshared(test::tetrahedron()), true);
    expectSolid("wide.glb", test::unshared(test::torus(160, 80)), true);  // 76,800 vertices: 32-bit indices
    expectSolid("parts.glb", inParts(40, 18), false);
    expectSolid("doubled parts.gltf", withParts(test::unshared(test::torus(40, 18))), true);
    expectValidGltf(files, false);
}

double numberIn(const tinygltf::Material& material, const char* extension, const char* key) {
    return material.extensions.at(extension).Get(key).GetNumberAsDouble();
}

/// What is left of each colour's light after `length` metres, as KHR_materials_volume says it.
glm::dvec3 leftAfter(double length, const tinygltf::Material& material) {
    const tinygltf::Value& volume = material.extensions.at("KHR_materials_volume");
    EXPECT_EQ(volume.Has("attenuationDistance"), volume.Has("attenuationColor"));
    if (!volume.Has("attenuationDistance")) return glm::dvec3(1.0);
    const double distance = volume.Get("attenuationDistance").GetNumberAsDouble();
    EXPECT_GT(distance, 0.0);
    glm::dvec3 left;
    for (int i = 0; i < 3; ++i) {
        const double color = volume.Get("attenuationColor").Get(i).GetNumberAsDouble();
        EXPECT_GE(color, 0.0);
        EXPECT_LE(color, 1.0);
        left[i] = std::pow(color, length / distance);
    }
    return left;
}

TEST(Export, GltfSaysWhatLightPassesThrough) {
    const TempDir folder;
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN(),
                    kEndless = std::numeric_limits<float>::infinity();
    struct Case {
        Material material;
        double ior;
        glm::dvec3 absorption;
    };
    const std::vector<Case> cases = {
        {{.transmission = 1.0f}, 1.5, {0, 0, 0}},
        {{.transmission = 0.25f, .ior = 1.33f, .absorption = {0.5f, 0, 2}}, double{1.33f}, {0.5, 0, 2}},
        {{.transmission = 1.0f, .ior = 1.0f, .absorption = {1e9f, 1e9f, 1}}, 1.0, {1e9, 1e9, 1}},
        {{.transmission = 1.0f, .ior = 0.5f, .absorption = {1e-9f, 0, 0}}, 1.0, {1e-9, 0, 0}},
        {{.transmission = 1.0f, .ior = kNone, .absorption = {kNone, -1, 3}}, 1.0, {0, 0, 3}},
        {{.transmission = kEndless, .ior = 2.4f, .absorption = {0, kEndless, 0}}, double{2.4f}, {0, 3e38, 0}},
        {{.roughness = kNone, .metallic = kNone, .emission = {kNone, kEndless, 0}, .transmission = 1.0f},
         1.5,
         {0, 0, 0}},
    };
    std::vector<std::string> files;
    for (const Case& wanted : cases) {
        Mesh mesh = test::moved(test::cube(), {5, 6, 7});
        mesh.material = wanted.material;
        files.push_back(folder.path(std::to_string(files.size()) + ".glb"));
        SCOPED_TRACE(files.back());
        mustExport(mesh, files.back());
        const tinygltf::Model model = loadModel(files.back());
        ASSERT_EQ(model.materials.size(), 1u);
        const tinygltf::Material& material = model.materials[0];
        EXPECT_EQ(numberIn(material, "KHR_materials_transmission", "transmissionFactor"),
                  std::min(1.0, double{wanted.material.transmission}));
        EXPECT_EQ(numberIn(material, "KHR_materials_ior", "ior"), wanted.ior);
        EXPECT_NEAR(numberIn(material, "KHR_materials_volume", "thicknessFactor"), 4.0 * 8 / 24, 1e-6);
        for (const double length : {1e-9, 0.3, 2.0})
            for (int i = 0; i < 3; ++i)
                EXPECT_NEAR(leftAfter(length, material)[i], std::exp(-wanted.absorption[i] * length), 1e-6);
    }
    expectValidGltf(files);
}

TEST(Export, WhatNoLightPassesThroughNeedsNoWordOfIt) {
    const TempDir folder;
    Mesh mesh = painted(test::torus(20, 10));
    mustExport(mesh, folder.path("plain.gltf"), {.name = "part"});
    mustExport(mesh, folder.path("plain.obj"), {.name = "part"});
    mesh.material.ior = 2.4f;
    mesh.material.absorption = {1, 2, 3};
    mustExport(mesh, folder.path("other.gltf"), {.name = "part"});
    mustExport(mesh, folder.path("other.obj"), {.name = "part"});
    const std::string text = test::readText(folder.path("plain.gltf"));
    EXPECT_EQ(text.find("KHR_"), std::string::npos);
    EXPECT_EQ(test::readText(folder.path("other.gltf")),
              std::string(text).replace(text.find("plain.bin"), 9, "other.bin"));
    EXPECT_EQ(test::readText(folder.path("other.mtl")), test::readText(folder.path("plain.mtl")));
}

TEST(Export, GltfHasAPrimitiveForEachPart) {
    const TempDir folder;
    std::vector<std::string> files;
    for (const auto& [name, around] : {std::pair("short.glb", 40), {"long.glb", 700}, {"text.gltf", 41}}) {
        SCOPED_TRACE(name);
        const Mesh mesh = inParts(around, 100);
        files.push_back(folder.path(name));
        mustExport(mesh, files.back());
        const tinygltf::Model model = loadModel(files.back());
        const std::string stem = std::string(name).substr(0, std::string(name).find('.'));
        ASSERT_EQ(model.materials.size(), 3u);
        ASSERT_EQ(model.meshes.at(0).primitives.size(), 3u);
        std::vector<uint32_t> all;
        for (std::size_t i = 0; i < 3; ++i) {
            const tinygltf::Primitive& primitive = model.meshes[0].primitives[i];
            EXPECT_EQ(primitive.material, int(i));
            EXPECT_EQ(primitive.attributes, model.meshes[0].primitives[0].attributes);
            const auto& accessor = model.accessors.at(static_cast<std::size_t>(primitive.indices));
            const auto indices = indicesAt(viewOf(model, accessor.bufferView) + accessor.byteOffset,
                                           accessor.componentType, accessor.count);
            EXPECT_EQ(indices.size(), 3 * mesh.parts[i].triangles);
            all.insert(all.end(), indices.begin(), indices.end());
            const tinygltf::Material& material = model.materials[i];
            EXPECT_EQ(material.name, stem + "_" + std::to_string(i + 1));
            EXPECT_EQ(material.pbrMetallicRoughness.roughnessFactor,
                      double{mesh.parts[i].material.roughness});
            EXPECT_EQ(material.pbrMetallicRoughness.metallicFactor, double{mesh.parts[i].material.metallic});
            EXPECT_EQ(material.extensions.contains("KHR_materials_transmission"), i == 1);
            EXPECT_EQ(material.extensions.contains("KHR_materials_emissive_strength"), i == 2);
        }
        EXPECT_EQ(all, mesh.indices);
        EXPECT_EQ(model.extensionsUsed.size(), 4u);
        // What is read back of it is the whole mesh, without parts.
        Mesh whole = mesh;
        whole.parts.clear();
        mustExport(whole, folder.path("whole.glb"));
        EXPECT_EQ(writeReport(*reportOnFile(files.back())),
                  writeReport(*reportOnFile(folder.path("whole.glb"))));
    }
    expectValidGltf(files);
}

TEST(Export, ObjNamesTheMaterialOfEachPart) {
    const TempDir folder;
    const Mesh mesh = inParts(20, 10);
    mustExport(mesh, folder.path("part.obj"));
    std::istringstream lines(test::readText(folder.path("part.obj")));
    std::vector<std::pair<std::string, std::size_t>> faces;
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("usemtl ")) faces.emplace_back(line.substr(7), 0);
        if (line.starts_with("f ")) ++faces.back().second;
    }
    ASSERT_EQ(faces.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_EQ(faces[i], std::pair("part_" + std::to_string(i + 1), mesh.parts[i].triangles));
    const std::string library = test::readText(folder.path("part.mtl"));
    const std::string glass =
        "newmtl part_2\nKd 1.000 1.000 1.000\nPr 0.000000\nPm 0.000000\nTf 1.000 1.000 1.000\nNi 1.250000\n"
        "illum 7\nnewmtl part_3\n";
    EXPECT_NE(library.find(glass), std::string::npos) << library;
    mustExport(mesh, folder.path("part.glb"));
    EXPECT_EQ(reportOnFile(folder.path("part.obj"))->triangles,
              reportOnFile(folder.path("part.glb"))->triangles);
}

TEST(Export, GltfStatesTheBaseColourOfAMeshWithoutVertexColours) {
    const TempDir folder;
    Mesh mesh = test::cube();
    mesh.baseColor = {0.25f, 0.5f, 0.75f};
    mustExport(mesh, folder.path("mesh.glb"));
    const tinygltf::Model model = loadModel(folder.path("mesh.glb"));
    EXPECT_EQ(model.materials.at(0).pbrMetallicRoughness.baseColorFactor,
              (std::vector<double>{0.25, 0.5, 0.75, 1}));
    EXPECT_EQ(model.meshes.at(0).primitives.at(0).attributes.size(), 1u);
}

TEST(Export, GltfIndicesAreAsShortAsTheVerticesAllow) {
    // The greatest 16-bit number restarts a strip in glTF and may not stand for a vertex.
    const TempDir folder;
    for (const std::size_t vertices : {65535u, 65536u}) {
        Mesh mesh = test::cube();
        mesh.positions.resize(vertices, glm::vec3(2.0f));
        mesh.indices.insert(mesh.indices.end(), {0, 1, static_cast<uint32_t>(vertices - 1)});
        mustExport(mesh, folder.path("mesh.glb"));
        const tinygltf::Model model = loadModel(folder.path("mesh.glb"));
        const int indices = model.meshes.at(0).primitives.at(0).indices;
        EXPECT_EQ(model.accessors[static_cast<std::size_t>(indices)].componentType,
                  vertices == 65535 ? TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT
                                    : TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT);
        expectValidGltf({folder.path("mesh.glb")});
    }
}

TEST(Export, NormalsThatTheFieldCouldNotGiveComeFromTheTriangles) {
    const TempDir folder;
    Mesh mesh = test::torus(24, 12);
    const std::vector<glm::vec3> right = mesh.normals;
    mesh.normals[5] = glm::vec3(0.0f);
    mesh.normals[6] = glm::vec3(std::numeric_limits<float>::quiet_NaN());
    mesh.normals[7] *= 3.0f;
    mustExport(mesh, folder.path("mesh.glb"));
    expectValidGltf({folder.path("mesh.glb")});
    const tinygltf::Model model = loadModel(folder.path("mesh.glb"));
    std::vector<glm::vec3> written(mesh.normals.size());
    std::memcpy(written.data(), dataOf(model, model.meshes[0].primitives[0].attributes.at("NORMAL")),
                written.size() * 12);
    for (std::size_t i = 0; i < written.size(); ++i) EXPECT_GT(glm::dot(written[i], right[i]), 0.9f) << i;
}

TEST(Export, AdmeshFindsNothingToRepairInTheStl) {
    const TempDir folder;
    for (const Mesh& mesh : {test::cube(), test::torus(200, 60),
                             test::join(test::cube(), test::moved(test::cube(), {3, 0, 0}))}) {
        mustExport(mesh, folder.path("mesh.stl"));
        const auto result = test::runProgram("admesh '" + folder.path("mesh.stl") + "'");
        ASSERT_EQ(result.status, 0) << result.output;
        EXPECT_NE(result.output.find("Number of facets                 : "), std::string::npos)
            << result.output;
        for (const char* line :
             {"Total disconnected facets        :     0                   0", "Degenerate facets     :     0",
              "Edges fixed           :     0", "Facets removed        :     0",
              "Facets added          :     0", "Facets reversed       :     0",
              "Backwards edges       :     0", "Normals fixed         :     0"})
            EXPECT_NE(result.output.find(line), std::string::npos) << line << "\n" << result.output;
    }
}

TEST(Export, EveryFormatHoldsTheSameTriangles) {
    const TempDir folder;
    const Mesh mesh = painted(test::torus(500, 300, 1.0 / 3.0, 0.07));  // many blocks in every format
    const WeldedMesh wanted = weld(mesh.positions, mesh.indices);
    for (const char* name : {"mesh.glb", "mesh.gltf", "mesh.obj", "mesh.ply", "MESH.STL"}) {
        mustExport(mesh, folder.path(name));
        const Result<WeldedMesh> read = readWelded({folder.path(name), folder.path(name)});
        ASSERT_TRUE(read) << format(read.error());
        ASSERT_EQ(read->indices.size(), wanted.indices.size()) << name;
        for (std::size_t i = 0; i < wanted.indices.size(); ++i)
            ASSERT_EQ(read->positions[read->indices[i]], wanted.positions[wanted.indices[i]])
                << name << " corner " << i;
    }
}

TEST(Export, ObjNumbersReadBackAsTheSameFloats) {
    const TempDir folder;
    Mesh mesh = painted(test::torus(30, 20, 1.0 / 3.0, 0.07));
    mesh.positions[0] = {1e-30f, -3.4e38f, 16777217.0f};
    mustExport(mesh, folder.path("part.obj"));
    std::istringstream lines(test::readText(folder.path("part.obj")));
    std::size_t vertices = 0, normals = 0, faces = 0;
    bool library = false;
    for (std::string line; std::getline(lines, line);) {
        glm::vec3 p, c;
        if (std::sscanf(line.c_str(), "v %f %f %f %f %f %f", &p.x, &p.y, &p.z, &c.x, &c.y, &c.z) == 6) {
            ASSERT_EQ(p, mesh.positions.at(vertices));
            for (int k = 0; k < 3; ++k) { EXPECT_NEAR(decodeSrgb(c[k]), mesh.colors[vertices][k], 0.006); }
            ++vertices;
        } else if (std::sscanf(line.c_str(), "vn %f %f %f", &p.x, &p.y, &p.z) == 3) {
            ASSERT_EQ(p, mesh.normals.at(normals++));
        } else if (line.starts_with("f ")) {
            std::array<unsigned, 6> n{};
            ASSERT_EQ(
                std::sscanf(line.c_str(), "f %u//%u %u//%u %u//%u", &n[0], &n[1], &n[2], &n[3], &n[4], &n[5]),
                6)
                << line;
            for (std::size_t k = 0; k < 3; ++k) {
                ASSERT_EQ(n[2 * k], mesh.indices[faces * 3 + k] + 1);
                ASSERT_EQ(n[2 * k + 1], n[2 * k]);
            }
            ++faces;
        } else if (line == "mtllib part.mtl") {
            library = true;
        }
    }
    EXPECT_EQ(vertices, mesh.positions.size());
    EXPECT_EQ(normals, mesh.normals.size());
    EXPECT_EQ(faces, mesh.triangleCount());
    EXPECT_TRUE(library);
    EXPECT_NE(test::readText(folder.path("part.mtl")).find("newmtl part\nKd 1.000 1.000 1.000\n"),
              std::string::npos);
}

TEST(Export, PlyColoursAreTheNearestSrgbCodes) {
    const TempDir folder;
    Mesh mesh;
    for (int i = 0; i <= 255; ++i) {
        const double code = i / 255.0;
        const double linear = decodeSrgb(code);
        mesh.positions.emplace_back(i, 0, i * i);
        mesh.colors.emplace_back(linear, i % 2 ? -1.0 : 7.0, 0.0);
    }
    mesh.indices = {0, 1, 255};
    mustExport(mesh, folder.path("mesh.ply"));
    const std::string text = test::readText(folder.path("mesh.ply"));
    const std::size_t body = text.find("end_header\n") + 11;
    ASSERT_EQ(text.size(), body + 256 * 15 + 13);
    for (std::size_t i = 0; i <= 255; ++i) {
        EXPECT_EQ(static_cast<unsigned char>(text[body + i * 15 + 12]), i);
        EXPECT_EQ(static_cast<unsigned char>(text[body + i * 15 + 13]), i % 2 ? 0 : 255);
    }
}

TEST(Export, TheDocumentsListEveryFormat) {
    for (const char* page : {"/README.md", "/docs/tutorial.md"}) {
        const std::string text = test::readText(std::string(FIELDWRIGHT_SOURCE_DIR) + page);
        for (const ExportFormat& known : exportFormats())
            EXPECT_NE(text.find("`" + std::string(known.ending) + "`"), std::string::npos)
                << page << " lacks " << known.ending;
    }
}

TEST(Export, LargeMeshIsNotHeldTwice) {
    const TempDir folder;
    const Mesh mesh = painted(test::torus(2000, 500));  // 2 million triangles: an STL of 100 MB
    const uint64_t before = peakMemoryBytes();
    for (const char* name : {"mesh.glb", "mesh.stl", "mesh.obj"}) mustExport(mesh, folder.path(name));
    EXPECT_LT(peakMemoryBytes(), before + (24u << 20));
}

}  // namespace fw::export_test
