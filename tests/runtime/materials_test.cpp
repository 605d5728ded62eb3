// Which triangles of a mesh have which material, and how thick a solid is: against closed forms.
#include "runtime/mesh/materials.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "graph/document/json.h"
#include "runtime/play/tiled_mesh.h"
#include "tests/support/gpu.h"
#include "tests/support/graph/temp_dir.h"
#include "tests/support/meshes.h"

namespace fw::materials_test {

using test::TempDir;

Program programOf(const std::string& nodes) {
    const Result<Graph> graph =
        parseGraph(R"({"fieldwright": 1, "nodes": [)" + nodes + "]}", "m.field.json", nullptr);
    if (!graph) throw SystemError(format(graph.error()));
    Result<Program> program = compile(*graph);
    if (!program) throw SystemError(format(program.error()));
    return std::move(*program);
}

Session sessionOf(const std::string& nodes) {
    Result<Device> device = createDevice({});
    if (!device) throw SystemError(format(device.error()));
    Session session(std::move(*device));
    session.setProgram(programOf(nodes));
    return session;
}

Mesh meshOf(Session& session, int resolution, bool parts) {
    const Result<MesherResult> result = session.polygonise({std::nullopt, resolution});
    if (!result) throw SystemError(format(result.error()));
    return session.download(*result, parts);
}

glm::vec3 middleOf(const Mesh& mesh, std::size_t triangle) {
    const uint32_t* corner = &mesh.indices[3 * triangle];
    return (mesh.positions[corner[0]] + mesh.positions[corner[1]] + mesh.positions[corner[2]]) / 3.0f;
}

/// Corners of all triangles, sorted: what does not depend on their order.
std::vector<std::array<uint32_t, 3>> sortedTriangles(const Mesh& mesh) {
    std::vector<std::array<uint32_t, 3>> triangles(mesh.triangleCount());
    for (std::size_t t = 0; t < triangles.size(); ++t)
        std::copy_n(&mesh.indices[3 * t], 3, triangles[t].begin());
    std::ranges::sort(triangles);
    return triangles;
}

TEST(Materials, TheMeanChordIsFourVolumesOverTheArea) {
    const float cube = sizeOf(test::cube()).meanChord();
    EXPECT_NEAR(cube, 4.0 * 8 / 24, 1e-6);
    EXPECT_NEAR(sizeOf(test::moved(test::cube(), {100, -20, 3})).meanChord(), cube, 1e-4);
    // Of a torus twice the tube's radius (Pappus).
    EXPECT_NEAR(sizeOf(test::torus(400, 200, 2.0, 0.25)).meanChord(), 0.5, 1e-3);
    Mesh inverted = test::cube();
    std::ranges::reverse(inverted.indices);
    EXPECT_EQ(sizeOf(inverted).meanChord(), 0.0f);
    EXPECT_EQ(sizeOf(Mesh()).meanChord(), 0.0f);
}

TEST(Materials, EqualOnesAreAPartAndKeepTheirNumbers) {
    const Mesh whole = test::torus(30, 20);
    const Material glass{.roughness = 0.1f, .transmission = 1.0f, .ior = 1.33f, .absorption = {0.1f, 7, 0}},
        brass{.roughness = 0.3f, .metallic = 1.0f}, lamp{.emission = {64, 0.1f, 0}};
    const Material cycle[] = {brass, glass, brass, lamp};
    std::vector<Material> ofTriangles;
    for (std::size_t t = 0; t < whole.triangleCount(); ++t) ofTriangles.push_back(cycle[t % 4]);
    Mesh mesh = whole;
    partByMaterial(mesh, ofTriangles);
    ASSERT_EQ(mesh.parts.size(), 3u);
    const Material expected[] = {brass, glass, lamp};
    std::vector<uint32_t> indices;
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(mesh.parts[i].material, expected[i]);
        std::size_t count = 0;
        for (std::size_t t = 0; t < whole.triangleCount(); ++t) {
            if (cycle[t % 4] != expected[i]) continue;
            indices.insert(indices.end(), &whole.indices[3 * t], &whole.indices[3 * t] + 3);
            ++count;
        }
        EXPECT_EQ(mesh.parts[i].triangles, count);
    }
    EXPECT_EQ(mesh.indices, indices);

    mesh = whole;
    partByMaterial(mesh, std::vector<Material>(whole.triangleCount(), glass));
    EXPECT_TRUE(mesh.parts.empty());
    EXPECT_EQ(mesh.material, glass);
    EXPECT_EQ(mesh.indices, whole.indices);
}

TEST(Materials, OnesThatVaryFinelyAreFewAndNear) {
    Mesh mesh = test::torus(200, 50);
    std::vector<Material> ofTriangles;
    std::map<std::array<uint32_t, 3>, float> roughness;
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
        ofTriangles.push_back({.roughness = middleOf(mesh, t).x / 2.5f + 0.5f});
        roughness[{mesh.indices[3 * t], mesh.indices[3 * t + 1], mesh.indices[3 * t + 2]}] =
            ofTriangles.back().roughness;
    }
    const auto before = sortedTriangles(mesh);
    partByMaterial(mesh, ofTriangles);
    EXPECT_EQ(sortedTriangles(mesh), before);
    EXPECT_GT(mesh.parts.size(), kMostMaterials / 4);
    EXPECT_LE(mesh.parts.size(), kMostMaterials);
    std::size_t t = 0;
    for (const MeshPart& part : mesh.parts)
        for (const std::size_t end = t + part.triangles; t < end; ++t) {
            const float own =
                roughness.at({mesh.indices[3 * t], mesh.indices[3 * t + 1], mesh.indices[3 * t + 2]});
            ASSERT_NEAR(part.material.roughness, own, 1.0 / 32);
        }
    EXPECT_EQ(t, mesh.triangleCount());

    // All numbers at once, so that hardly two triangles are alike.
    for (std::size_t i = 0; i < ofTriangles.size(); ++i) {
        const auto wave = [&](double f) { return float(0.5 + 0.5 * std::sin(f * double(i))); };
        ofTriangles[i] = {wave(1), wave(2),     {wave(3), wave(4), wave(5)},
                          wave(6), 1 + wave(7), {wave(8), 9 * wave(9), 99 * wave(10)}};
    }
    partByMaterial(mesh, ofTriangles);
    EXPECT_LE(mesh.parts.size(), kMostMaterials);
    EXPECT_EQ(sortedTriangles(mesh), before);
}

TEST(Materials, NumbersOutOfRangeAreLimited) {
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN(),
                    kEndless = std::numeric_limits<float>::infinity();
    Mesh mesh = test::tetrahedron();
    partByMaterial(mesh, {{.roughness = kNone, .metallic = -1, .emission = {kNone, -1, kEndless}},
                          {.roughness = 7, .transmission = kNone, .ior = kNone},
                          {.transmission = 1, .ior = kNone, .absorption = {kNone, 1e9f, kEndless}},
                          {.transmission = 1, .ior = kEndless}});
    ASSERT_EQ(mesh.parts.size(), 4u);
    constexpr float kMost = std::numeric_limits<float>::max();
    EXPECT_EQ(mesh.parts[0].material, (Material{.roughness = 0, .emission = {0, 0, kMost}}));
    EXPECT_EQ(mesh.parts[1].material, (Material{.roughness = 1}));
    EXPECT_EQ(mesh.parts[2].material,
              (Material{.transmission = 1, .ior = 0.1f, .absorption = {0, 1e9f, kMost}}));
    EXPECT_EQ(mesh.parts[3].material, (Material{.transmission = 1, .ior = 10}));
}

const std::string kTwoBalls = R"(
    {"id": "ball", "type": "sphere", "inputs": {"radius": 1}},
    {"id": "left", "type": "translate", "inputs": {"surface": {"from": "ball"}, "offset": [-1.5, 0, 0]}},
    {"id": "right", "type": "translate", "inputs": {"surface": {"from": "ball"}, "offset": [1.5, 0, 0]}},
    {"id": "glass", "type": "material", "inputs": {"surface": {"from": "left"}, "roughness": 0.05,
     "transmission": 1, "ior": 1.45, "absorption": [0.25, 0.5, 4]}},
    {"id": "brass", "type": "material", "inputs": {"surface": {"from": "right"}, "roughness": 0.3,
     "metallic": 1, "base_color": [0.9, 0.7, 0.3]}},
    {"id": "both", "type": "union", "inputs": {"a": {"from": "glass"}, "b": {"from": "brass"}}},
    {"id": "out", "type": "output", "inputs": {"surface": {"from": "both"}}})";

TEST(Materials, EachTriangleHasThatOfTheFieldAtIt) {
    Session session = sessionOf(kTwoBalls);
    const Mesh whole = meshOf(session, 64, false), mesh = meshOf(session, 64, true);
    EXPECT_TRUE(whole.parts.empty());
    EXPECT_EQ(sortedTriangles(mesh), sortedTriangles(whole));
    ASSERT_EQ(mesh.parts.size(), 2u);
    const Material glass{.roughness = 0.05f, .transmission = 1, .ior = 1.45f, .absorption = {0.25f, 0.5f, 4}},
        brass{.roughness = 0.3f, .metallic = 1};
    std::size_t t = 0;
    for (const MeshPart& part : mesh.parts)
        for (const std::size_t end = t + part.triangles; t < end; ++t)
            ASSERT_EQ(part.material, middleOf(mesh, t).x < 0 ? glass : brass);
    EXPECT_EQ(t, mesh.triangleCount());
    EXPECT_NEAR(double(mesh.parts[0].triangles), double(t) / 2, double(t) / 50);
}

TEST(Materials, WhereTheFieldHasNoNumberItIsTheLeast) {
    // Left of the middle the number is infinity less infinity.
    Session session = sessionOf(R"nodes({"id": "ball", "type": "sphere"},
        {"id": "root", "type": "expression", "code":
         "float a = max(-p.x, 0.0) * 1e30; float b = a * a; return sqrt(p.x) + (a * b - b);"},
        {"id": "paint", "type": "material", "inputs": {"surface": {"from": "ball"}, "roughness": {"from": "root"}}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "paint"}}})nodes");
    const Mesh mesh = meshOf(session, 64, true);
    EXPECT_GT(mesh.parts.size(), kMostMaterials / 4);
    EXPECT_LE(mesh.parts.size(), kMostMaterials);
    std::size_t t = 0;
    for (const MeshPart& part : mesh.parts)
        for (const std::size_t end = t + part.triangles; t < end; ++t)
            ASSERT_NEAR(part.material.roughness, std::sqrt(std::max(0.0f, middleOf(mesh, t).x)), 1.0 / 32);
    EXPECT_EQ(t, mesh.triangleCount());
}

TEST(Materials, TilesOfGlassAreAsThickAsTheWhole) {
    Session session = sessionOf(R"({"id": "ball", "type": "sphere"},
        {"id": "glass", "type": "material", "inputs": {"surface": {"from": "ball"}, "roughness": 0,
         "base_color": [1, 1, 1], "transmission": 0.75, "ior": 1.33, "absorption": [0, 1, 2]}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "glass"}}})");
    const TempDir folder;
    const Material glass{.roughness = 0, .transmission = 0.75f, .ior = 1.33f, .absorption = {0, 1, 2}};
    for (const MeshMethod method : {MeshMethod::marchingCubes, MeshMethod::dualContouring}) {
        const MeshRequest request{std::nullopt, 128, method};
        const TilePlan plan = planTiles(*cellGrid(*meshRegion(session.program(), request), 128), 64);
        ASSERT_GE(plan.tiles.size(), 8u);
        const Mesh whole = session.download(*session.polygonise(request));
        EXPECT_EQ(whole.material, glass);
        const float chord = sizeOf(whole).meanChord();
        EXPECT_NEAR(chord, 4.0 / 3, 1e-3);  // 4/3 of the radius

        std::vector<TileRecord> tiles;
        for (std::size_t i = 0; i < plan.tiles.size(); ++i)
            tiles.push_back(*meshTile(session, request, plan, tileKey(session, request, plan), i,
                                      folder.folder.string(), nullptr));
        const Result<MeshPieces> joined = joinTiles(std::move(tiles));
        const Result<CountedTiles> counted = countTiles(session, request, plan);
        ASSERT_TRUE(joined && counted);
        for (const MeshPieces& pieces : {*joined, counted->mesh}) {
            EXPECT_EQ(pieces.material.material, glass);
            EXPECT_NEAR(pieces.size.meanChord(), chord, 1e-5);
            ASSERT_TRUE(exportPieces(pieces, folder.path("tiles.gltf"), {.name = "ball"}));
            ASSERT_TRUE(exportMesh(whole, folder.path("whole.gltf"), {.name = "ball"}));
            const auto materials = [&](const char* file) {
                return nlohmann::json::parse(test::readText(folder.path(file)))["materials"];
            };
            nlohmann::json inTiles = materials("tiles.gltf"), atOnce = materials("whole.gltf");
            for (nlohmann::json* one : {&inTiles, &atOnce})
                (*one)[0]["extensions"]["KHR_materials_volume"].erase("thicknessFactor");
            EXPECT_EQ(inTiles, atOnce);
        }
    }
}

}  // namespace fw::materials_test
