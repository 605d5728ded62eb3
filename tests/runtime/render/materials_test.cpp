// Which triangles of a mesh have which material, and how thick a solid is: against closed forms.
#include "runtime/mesh/materials.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "graph/document/json.h"
#include "runtime/measure/mesh_report.h"
#include "runtime/measure/read_back.h"
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

Mesh meshOf(Session& session, int resolution, MaterialParts parts) {
    const Result<MesherResult> result = session.polygonise({std::nullopt, resolution});
    if (!result) throw SystemError(format(result.error()));
    return session.download(*result, parts);
}

/// All by one painter without a name.
void part(Mesh& mesh, const std::vector<Material>& ofTriangles) {
    std::vector<PaintedBy> triangles;
    for (const Material& material : ofTriangles) triangles.push_back({0, material});
    partByMaterial(mesh, triangles, {});
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
    part(mesh, ofTriangles);
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
    part(mesh, std::vector<Material>(whole.triangleCount(), glass));
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
    part(mesh, ofTriangles);
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
    part(mesh, ofTriangles);
    EXPECT_LE(mesh.parts.size(), kMostMaterials);
    EXPECT_EQ(sortedTriangles(mesh), before);
}

TEST(Materials, NumbersOutOfRangeAreLimited) {
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN(),
                    kEndless = std::numeric_limits<float>::infinity();
    Mesh mesh = test::tetrahedron();
    part(mesh, {{.roughness = kNone, .metallic = -1, .emission = {kNone, -1, kEndless}},
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
    const Mesh whole = meshOf(session, 64, MaterialParts::none),
               mesh = meshOf(session, 64, MaterialParts::whole);
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

std::vector<std::string> namesOf(const Mesh& mesh) {
    std::vector<std::string> names;
    for (const MeshPart& part : mesh.parts) names.push_back(part.name);
    std::ranges::sort(names);
    return names;
}

TEST(Materials, AreCalledAsTheirNodes) {
    Session session = sessionOf(kTwoBalls);
    EXPECT_EQ(namesOf(meshOf(session, 32, MaterialParts::whole)),
              (std::vector<std::string>{"brass", "glass"}));
    session = sessionOf(R"({"id": "ball", "type": "sphere"},
        {"id": "paint", "type": "material", "label": "Blue enamel", "inputs": {"surface": {"from": "ball"}}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "paint"}}})");
    EXPECT_EQ(meshOf(session, 32, MaterialParts::whole).materialName, "Blue enamel");
    session = sessionOf(R"({"id": "ball", "type": "sphere"},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "ball"}}})");
    EXPECT_EQ(meshOf(session, 32, MaterialParts::whole).materialName, "");
}

// Of two nodes with the same numbers each has a material; of one node in two instances of a group there is
// one, or as many as it has numbers; and no name is given twice.
TEST(Materials, AreAsManyAsTheGraphHas) {
    const auto names = [](const std::string& roughness, const std::string& more) {
        const Result<Graph> graph = parseGraph(
            R"({"fieldwright": 1, "groups": [{"id": "knob", "inputs": [{"name": "shine", "type": "float"}],
                "outputs": [{"name": "surface", "type": "surface"}], "nodes": [
                {"id": "in", "type": "group_input"}, {"id": "ball", "type": "sphere"},
                {"id": "tin", "type": "material", "inputs": {"surface": {"from": "ball"},
                 "roughness": {"from": "in", "output": "shine"}}},
                {"id": "end", "type": "group_output", "inputs": {"surface": {"from": "tin"}}}]}],
            "nodes": [{"id": "a", "type": "group", "group": "knob", "inputs": {"shine": 0.25}},
                {"id": "b", "type": "group", "group": "knob", "inputs": {"shine": )" +
                roughness + R"(}},
                {"id": "ball", "type": "sphere"},
                {"id": "plain", "type": "material", "label": "tin", "inputs": {"surface": {"from": "ball"}}},
                {"id": "a1", "type": "translate", "inputs": {"surface": {"from": "a"}, "offset": [3, 0, 0]}},
                {"id": "b1", "type": "translate", "inputs": {"surface": {"from": "b"}, "offset": [-3, 0, 0]}},
                {"id": "ab", "type": "union", "inputs": {"a": {"from": "a1"}, "b": {"from": "b1"}}},
                {"id": "abc", "type": "union", "inputs": {"a": {"from": "ab"}, "b": {"from": ")" +
                more + R"("}}},
                {"id": "out", "type": "output", "inputs": {"surface": {"from": "abc"}}}]})",
            "m.field.json", nullptr);
        if (!graph) throw SystemError(format(graph.error()));
        Result<Device> device = createDevice({});
        Session session(std::move(*device));
        session.setProgram(*compile(*graph));
        const Mesh mesh = meshOf(session, 48, MaterialParts::whole);
        return mesh.parts.empty() ? std::vector<std::string>{mesh.materialName} : namesOf(mesh);
    };
    EXPECT_EQ(names("0.25", "ab"), (std::vector<std::string>{"tin"}));
    EXPECT_EQ(names("0.75", "ab"), (std::vector<std::string>{"tin", "tin_2"}));
    EXPECT_EQ(names("0.5", "plain"), (std::vector<std::string>{"tin", "tin_2", "tin_3"}));
}

const std::string kThreeColors = R"(
    {"id": "ball", "type": "sphere", "inputs": {"radius": 1}},
    {"id": "l", "type": "translate", "inputs": {"surface": {"from": "ball"}, "offset": [-0.5, 0.1, 0]}},
    {"id": "r", "type": "translate", "inputs": {"surface": {"from": "ball"}, "offset": [0.5, 0, 0.1]}},
    {"id": "t", "type": "translate", "inputs": {"surface": {"from": "ball"}, "offset": [0.1, 0.8, 0]}},
    {"id": "red", "type": "material", "inputs": {"surface": {"from": "l"}, "base_color": [1, 0, 0]}},
    {"id": "green", "type": "material", "inputs": {"surface": {"from": "r"}, "base_color": [0, 1, 0]}},
    {"id": "blue", "type": "material", "inputs": {"surface": {"from": "t"}, "base_color": [0, 0, 1]}},
    {"id": "two", "type": "union", "inputs": {"a": {"from": "red"}, "b": {"from": "green"}}},
    {"id": "all", "type": "union", "inputs": {"a": {"from": "two"}, "b": {"from": "blue"}}},
    {"id": "out", "type": "output", "inputs": {"surface": {"from": "all"}}})";

TEST(Materials, FacesAreCutWhereTwoMeet) {
    Session session = sessionOf(kThreeColors);
    const std::map<std::string, glm::vec3> colors{
        {"red", {1, 0, 0}}, {"green", {0, 1, 0}}, {"blue", {0, 0, 1}}},
        middles{{"red", {-0.5, 0.1, 0}}, {"green", {0.5, 0, 0.1}}, {"blue", {0.1, 0.8, 0}}};
    for (const MeshMethod method : {MeshMethod::marchingCubes, MeshMethod::dualContouring}) {
        const Result<MesherResult> result = session.polygonise({std::nullopt, 40, method});
        ASSERT_TRUE(result);
        const Mesh whole = session.download(*result), mesh = session.download(*result, MaterialParts::cut);
        const WeldedMesh welded = weld(mesh.positions, mesh.indices);
        const Report report = reportOnMesh(welded.positions, welded.indices);
        EXPECT_EQ(report.boundaryEdges + report.nonManifoldEdges + report.nonManifoldVertices +
                      report.flippedEdges + report.degenerateTriangles,
                  0u);
        EXPECT_EQ(report.shells, 1u);
        EXPECT_NEAR(sizeOf(mesh).volume, sizeOf(whole).volume, 1e-5);
        EXPECT_NEAR(sizeOf(mesh).area, sizeOf(whole).area, 1e-4);
        EXPECT_EQ(namesOf(mesh), (std::vector<std::string>{"blue", "green", "red"}));
        std::size_t t = 0, crossed = 0;
        for (const MeshPart& part : mesh.parts)
            for (const std::size_t end = t + part.triangles; t < end; ++t)
                for (int k = 0; k < 3; ++k) {
                    const uint32_t v = mesh.indices[3 * t + std::size_t(k)];
                    ASSERT_EQ(mesh.colors[v], colors.at(part.name));
                    for (const auto& [name, middle] : middles) {
                        const float nearer = glm::distance(mesh.positions[v], middles.at(part.name)) -
                                             glm::distance(mesh.positions[v], middle);
                        crossed += nearer > 1e-3f;
                        EXPECT_LT(nearer, 0.03f);  // half a cell
                    }
                }
        EXPECT_EQ(t, mesh.triangleCount());
        EXPECT_LT(crossed, 30u);  // where three meet within a triangle
        EXPECT_GT(t, whole.triangleCount());
        EXPECT_LT(t, whole.triangleCount() + whole.triangleCount() / 3);
    }
}

TEST(Materials, WhereNothingMeetsNothingIsCut) {
    Session session = sessionOf(kTwoBalls);
    const Mesh whole = meshOf(session, 64, MaterialParts::whole),
               mesh = meshOf(session, 64, MaterialParts::cut);
    EXPECT_EQ(mesh.positions, whole.positions);
    EXPECT_EQ(mesh.indices, whole.indices);
}

TEST(Materials, WhereTheFieldHasNoNumberItIsTheLeast) {
    // Left of the middle the number is infinity less infinity.
    Session session = sessionOf(R"nodes({"id": "ball", "type": "sphere"},
        {"id": "root", "type": "expression", "code":
         "float a = max(-p.x, 0.0) * 1e30; float b = a * a; return sqrt(p.x) + (a * b - b);"},
        {"id": "paint", "type": "material", "inputs": {"surface": {"from": "ball"}, "roughness": {"from": "root"}}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "paint"}}})nodes");
    const Mesh mesh = meshOf(session, 64, MaterialParts::whole);
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
                (*one)[0]["extensions"]["KHR_materials_volume"].erase("thicknessFactor"),
                    (*one)[0].erase("name");
            EXPECT_EQ(inTiles, atOnce);
        }
    }
}

}  // namespace fw::materials_test
