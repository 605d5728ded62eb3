// Decimation: fewer triangles, closed and manifold, no farther from the field than was asked for.
#include "runtime/stages/decimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "graph/document/json.h"
#include "graph/evaluate/evaluate.h"
#include "runtime/measure/field_measure.h"
#include "runtime/play/session.h"
#include "tests/support/command.h"
#include "tests/support/graph/temp_dir.h"
#include "tests/support/meshes.h"

namespace fw::decimate_test {

const bool kLong = std::getenv("FIELDWRIGHT_LONG") != nullptr;

struct Solid {
    const char* name;
    const char* shape;
    MeshMethod method;
    double error;
};

struct EachSolid : testing::TestWithParam<Solid> {};
INSTANTIATE_TEST_SUITE_P(
    Decimate, EachSolid,
    testing::Values(Solid{"SphereCoarse", R"("type": "sphere")", MeshMethod::marchingCubes, 0.02},
                    Solid{"SphereFine", R"("type": "sphere")", MeshMethod::marchingCubes, 0.003},
                    Solid{"SphereDual", R"("type": "sphere")", MeshMethod::dualContouring, 0.01},
                    Solid{"Box", R"("type": "box", "inputs": {"half_extents": [0.7, 0.5, 0.6]})",
                          MeshMethod::marchingCubes, 0.03},
                    Solid{"BoxDual", R"("type": "box", "inputs": {"half_extents": [0.7, 0.5, 0.6]})",
                          MeshMethod::dualContouring, 0.001}),
    [](const auto& row) { return row.param.name; });

Program programOf(const std::string& shape) {
    const std::string text = R"({"fieldwright": 1, "nodes": [{"id": "s", )" + shape +
                             R"(}, {"id": "m", "type": "material", "inputs": {"surface": {"from": "s"},
        "base_color": {"from": "p"}}}, {"id": "p", "type": "position"},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "m"}}}]})";
    const Result<Graph> graph = parseGraph(text, "test.field.json", nullptr);
    if (!graph) throw SystemError(format(graph.error()));
    Result<Program> program = compile(*graph);
    if (!program) throw SystemError(format(program.error()));
    return std::move(*program);
}

TEST_P(EachSolid, StaysWithinTheError) {
    const Solid& solid = GetParam();
    Result<Device> device = createDevice({.validation = true});
    ASSERT_TRUE(device);
    Session session(std::move(*device));
    const Box region{{-1.1, -1.2, -1.15}, {1.2, 1.1, 1.15}};
    const MeshRequest request{region, 40, solid.method};
    Program program = programOf(solid.shape);
    session.setProgram(program);
    const Result<MesherResult> whole = session.polygonise(request);
    ASSERT_TRUE(whole) << format(whole.error());

    program.stages = {{.kind = MeshStage::Kind::decimate, .error = solid.error}};
    session.setProgram(program);
    Mesh meshes[2];
    for (Mesh& mesh : meshes) {
        const Result<MesherResult> fewer = session.polygonise(request);
        ASSERT_TRUE(fewer) << format(fewer.error());
        EXPECT_FALSE(fewer->undecimated);
        mesh = session.download(*fewer);
    }
    EXPECT_EQ(meshes[0].positions, meshes[1].positions);
    EXPECT_EQ(meshes[0].indices, meshes[1].indices);

    const Mesh& mesh = meshes[0];
    const Report report = reportOnMesh(mesh.positions, mesh.indices, measureOf(program, region));
    EXPECT_TRUE(report.closedManifold());
    EXPECT_EQ(report.eulerCharacteristic, 2);
    EXPECT_LE(*report.maxError, solid.error);
    EXPECT_LE(report.meshToSurface->max, solid.error);
    EXPECT_LE(report.surfaceToMesh->max, solid.error);
    EXPECT_LT(report.triangles, whole->triangles * 6 / 10);
    EXPECT_GE(report.triangles, 12u);
    std::printf("%s: %u triangles, %llu left, %.4g m away\n", solid.name, whole->triangles,
                static_cast<unsigned long long>(report.triangles), farthest(report));
    ASSERT_EQ(mesh.colors.size(), mesh.positions.size());
    for (std::size_t v = 0; v < mesh.colors.size(); ++v)
        ASSERT_LT(glm::distance(mesh.colors[v], glm::clamp(mesh.positions[v], 0.0f, 1.0f)), 1e-4f);
    for (const glm::vec3& normal : mesh.normals) EXPECT_NEAR(glm::length(normal), 1.0f, 1e-3f);
    EXPECT_EQ(session.device().validationMessages(), std::vector<std::string>());
}

TEST(Decimate, WhereAMeshIsFartherAwayAlreadyItGetsNoFarther) {
    // A torus of flat quads whose surface is said to be farther away on one side.
    Mesh mesh = test::torus(60, 40);
    const std::size_t before = mesh.triangleCount();
    MeasureOptions measure;
    measure.error = [](std::span<const glm::dvec3> points, std::span<double> errors) {
        for (std::size_t i = 0; i < points.size(); ++i)
            errors[i] =
                points[i].x > 0.5
                    ? 0.2
                    : std::abs(std::hypot(std::hypot(points[i].x, points[i].z) - 1.0, points[i].y) - 0.25);
    };
    ASSERT_TRUE(decimate(mesh, {.error = 0.02}, measure));
    EXPECT_LT(mesh.triangleCount(), before / 3);
    const Report report = reportOnMesh(mesh.positions, mesh.indices, measure);
    EXPECT_TRUE(report.closedManifold());
    EXPECT_LE(*report.maxError, 0.2);
    std::vector<glm::dvec3> places;
    for (const uint32_t index : mesh.indices) places.emplace_back(mesh.positions[index]);
    std::vector<double> errors(places.size());
    measure.error(places, errors);
    for (std::size_t i = 0; i < places.size(); ++i) ASSERT_LE(errors[i], places[i].x > 0.5 ? 0.2 : 0.02);
}

TEST(Decimate, ASolidStaysASolidWhateverTheError) {
    for (const double error : {0.5, 2.0, 10.0, 1000.0}) {
        Mesh mesh = test::torus(30, 20);
        ASSERT_TRUE(decimate(mesh, {.error = error}, {})) << error;
        const Report report = reportOnMesh(mesh.positions, mesh.indices);
        EXPECT_TRUE(report.closedManifold());
        EXPECT_GE(report.triangles, 4u);
        EXPECT_EQ(report.eulerCharacteristic, 0) << "a torus stays one";
        EXPECT_GT(report.volume, 0.0);
    }
}

TEST(Decimate, AnEmptyMeshStaysEmpty) {
    Mesh mesh;
    EXPECT_FALSE(decimate(mesh, {.error = 1.0}, {}));
    EXPECT_FALSE(decimate(mesh, {.triangles = 10}, {}));
    EXPECT_TRUE(mesh.indices.empty());
}

TEST(Decimate, WithoutAWishNothingGoes) {
    Mesh mesh = test::torus(30, 20);
    EXPECT_FALSE(decimate(mesh, {}, {}));
    EXPECT_EQ(mesh.triangleCount(), 1200u);
}

TEST(Decimate, EndsAtTheNumberUnlessTheErrorEndsItBefore) {
    const Mesh torus = test::torus(60, 40);
    for (const std::size_t wanted : {4799u, 4000u, 1001u, 200u, 60u}) {
        Mesh mesh = torus;
        ASSERT_TRUE(decimate(mesh, {.triangles = wanted}, {})) << wanted;
        EXPECT_LE(mesh.triangleCount(), wanted);
        EXPECT_GE(mesh.triangleCount() + 1, wanted) << "two triangles go at a time";
        EXPECT_EQ(reportOnMesh(mesh.positions, mesh.indices).eulerCharacteristic, 0);
    }
    Mesh mesh = torus;
    EXPECT_FALSE(decimate(mesh, {.triangles = 4800}, {})) << "as many as there are";
    EXPECT_FALSE(decimate(mesh, {.triangles = 100'000}, {}));
    ASSERT_TRUE(decimate(mesh, {.triangles = 4}, {})) << "as few as a torus can have";
    EXPECT_GE(mesh.triangleCount(), 14u);
    EXPECT_TRUE(reportOnMesh(mesh.positions, mesh.indices).closedManifold());

    Mesh within = torus, both = torus;
    ASSERT_TRUE(decimate(within, {.error = 0.01}, {}));
    ASSERT_TRUE(decimate(both, {.error = 0.01, .triangles = 4}, {}));
    EXPECT_GT(within.triangleCount(), 100u);
    EXPECT_GT(both.triangleCount(), 100u);
    ASSERT_TRUE(decimate(both = torus, {.error = 0.5, .triangles = 1000}, {}));
    EXPECT_EQ(both.triangleCount(), 1000u);
}

/// A graph of these nodes, of which `solid` is meshed and decimated.
Graph decimated(const std::string& nodes, const std::string& solid, int resolution, double error,
                int triangles) {
    const std::string text =
        R"({"fieldwright": 1, "nodes": [)" + nodes +
        R"({"id": "mesh", "type": "polygonize", "inputs": {"surface": {"from": ")" + solid +
        R"("}, "method": "dual-contouring", "resolution": )" + std::to_string(resolution) +
        R"(}}, {"id": "few", "type": "decimate", "inputs": {"mesh": {"from": "mesh"}, "error": )" +
        std::to_string(error) + R"(, "triangles": )" + std::to_string(triangles) +
        R"(}}, {"id": "out", "type": "output", "inputs": {"mesh": {"from": "few"}}}]})";
    Result<Graph> graph = parseGraph(text, "decimated.field.json", nullptr);
    if (!graph) throw SystemError(format(graph.error()));
    return std::move(*graph);
}

constexpr char kNotched[] = R"(
    {"id": "block", "type": "box", "inputs": {"half_extents": [1, 0.5, 0.7]}},
    {"id": "tool", "type": "box", "inputs": {"half_extents": [0.2, 0.3, 1]}},
    {"id": "left", "type": "translate", "inputs": {"surface": {"from": "tool"}, "offset": [-0.4, 0.5, 0]}},
    {"id": "right", "type": "translate", "inputs": {"surface": {"from": "tool"}, "offset": [0.45, 0.55, 0]}},
    {"id": "one", "type": "subtract", "inputs": {"a": {"from": "block"}, "b": {"from": "left"}}},
    {"id": "two", "type": "subtract", "inputs": {"a": {"from": "one"}, "b": {"from": "right"}}},)";

/// Sand walls with battlements and towers, a blue keep with windows, red roofs, on green.
constexpr char kCastle[] = R"(
    {"id": "outer", "type": "box", "inputs": {"half_extents": [1.5, 0.35, 1.5]}},
    {"id": "inner", "type": "box", "inputs": {"half_extents": [1.38, 0.6, 1.38]}},
    {"id": "ring", "type": "subtract", "inputs": {"a": {"from": "outer"}, "b": {"from": "inner"}}},
    {"id": "gap", "type": "box", "inputs": {"half_extents": [0.05, 0.07, 3]}},
    {"id": "gaps", "type": "repeat", "inputs": {"surface": {"from": "gap"}, "period": [0.2, 0, 0], "count": [15, 1, 1]}},
    {"id": "above", "type": "translate", "inputs": {"surface": {"from": "gaps"}, "offset": [0, 0.35, 0]}},
    {"id": "front", "type": "subtract", "inputs": {"a": {"from": "ring"}, "b": {"from": "above"}}},
    {"id": "turned", "type": "rotate", "inputs": {"surface": {"from": "above"}, "angles": [0, 90, 0]}},
    {"id": "sides", "type": "subtract", "inputs": {"a": {"from": "front"}, "b": {"from": "turned"}}},
    {"id": "gate", "type": "box", "inputs": {"half_extents": [0.25, 0.25, 0.4], "p": {"from": "at_gate"}}},
    {"id": "here", "type": "position"},
    {"id": "at_gate", "type": "vector_math", "inputs": {"op": "subtract", "a": {"from": "here"}, "b": [0, -0.2, 1.45]}},
    {"id": "open", "type": "subtract", "inputs": {"a": {"from": "sides"}, "b": {"from": "gate"}}},
    {"id": "lifted", "type": "translate", "inputs": {"surface": {"from": "open"}, "offset": [0, 0.35, 0]}},
    {"id": "walls", "type": "material", "inputs": {"surface": {"from": "lifted"}, "base_color": [0.76, 0.6, 0.35], "roughness": 0.8}},
    {"id": "shaft", "type": "cylinder", "inputs": {"radius": 0.32, "half_height": 0.6}},
    {"id": "corner", "type": "translate", "inputs": {"surface": {"from": "shaft"}, "offset": [1.45, 0.6, 1.45]}},
    {"id": "tower", "type": "material", "inputs": {"surface": {"from": "corner"}, "base_color": [0.76, 0.6, 0.35], "roughness": 0.8}},
    {"id": "cap", "type": "cone", "inputs": {"height": 0.6, "radius": 0.42}},
    {"id": "top", "type": "translate", "inputs": {"surface": {"from": "cap"}, "offset": [1.45, 1.75, 1.45]}},
    {"id": "roof", "type": "material", "inputs": {"surface": {"from": "top"}, "base_color": [0.6, 0.05, 0.03], "roughness": 0.4}},
    {"id": "roofed", "type": "union", "inputs": {"a": {"from": "tower"}, "b": {"from": "roof"}}},
    {"id": "towers", "type": "polar_repeat", "inputs": {"surface": {"from": "roofed"}, "count": 4}},
    {"id": "block", "type": "box", "inputs": {"half_extents": [0.5, 0.8, 0.5]}},
    {"id": "window", "type": "box", "inputs": {"half_extents": [0.06, 0.12, 1]}},
    {"id": "windows", "type": "repeat", "inputs": {"surface": {"from": "window"}, "period": [0.3, 0.45, 0], "count": [3, 3, 1]}},
    {"id": "holed", "type": "subtract", "inputs": {"a": {"from": "block"}, "b": {"from": "windows"}}},
    {"id": "raised", "type": "translate", "inputs": {"surface": {"from": "holed"}, "offset": [0, 0.8, 0]}},
    {"id": "keep", "type": "material", "inputs": {"surface": {"from": "raised"}, "base_color": [0.05, 0.12, 0.5], "roughness": 0.8}},
    {"id": "hat", "type": "cone", "inputs": {"height": 0.7, "radius": 0.75}},
    {"id": "high", "type": "translate", "inputs": {"surface": {"from": "hat"}, "offset": [0, 2.28, 0]}},
    {"id": "red", "type": "material", "inputs": {"surface": {"from": "high"}, "base_color": [0.6, 0.05, 0.03], "roughness": 0.4}},
    {"id": "hill", "type": "cylinder", "inputs": {"radius": 2.3, "half_height": 0.1}},
    {"id": "green", "type": "material", "inputs": {"surface": {"from": "hill"}, "base_color": [0.1, 0.3, 0.08], "roughness": 0.9}},
    {"id": "one", "type": "union", "inputs": {"a": {"from": "walls"}, "b": {"from": "towers"}}},
    {"id": "two", "type": "union", "inputs": {"a": {"from": "one"}, "b": {"from": "keep"}}},
    {"id": "three", "type": "union", "inputs": {"a": {"from": "two"}, "b": {"from": "red"}}},
    {"id": "castle", "type": "union", "inputs": {"a": {"from": "three"}, "b": {"from": "green"}}},)";

struct Made {
    Mesh mesh;
    Report report;
    Program program;
    Box region;
};

/// Meshes the graph, which decimates, and measures what comes of it.
Made madeOf(const Graph& graph) {
    Result<Device> device = createDevice({.validation = true});
    if (!device) throw SystemError(format(device.error()));
    Session session(std::move(*device), FieldBy::tapes);
    Result<Program> program = compile(graph);
    if (!program) throw SystemError(format(program.error()));
    const Result<Box> region = meshRegion(*program, {});
    if (!region) throw SystemError(format(region.error()));
    session.setProgram(*program);
    const Result<MesherResult> result = session.polygonise({});
    if (!result) throw SystemError(format(result.error()));
    Made made{session.download(*result), {}, std::move(*program), *region};
    MeasureOptions measure = measureOf(made.program, made.region);
    measure.selfIntersections = true;
    made.report = reportOnMesh(made.mesh.positions, made.mesh.indices, measure);
    EXPECT_TRUE(made.report.closedManifold());
    EXPECT_EQ(made.report.selfIntersections, 0u);
    return made;
}

TEST(Decimate, ABoxWithTwoNotchesIsFortyFourTriangles) {
    const std::vector<int> resolutions = kLong ? std::vector{32, 48, 60, 72, 100, 128} : std::vector{32, 60};
    for (const int resolution : resolutions)
        for (const double error : {0.02, 0.01}) {
            const Made made = madeOf(decimated(kNotched, "two", resolution, error, 0));
            EXPECT_EQ(made.report.triangles, 44u) << resolution << ' ' << error;
            EXPECT_LT(farthest(made.report), 1e-5);
            EXPECT_NEAR(made.report.volume, 2.492, 1e-4);
        }
}

/// The largest difference between the mesh's colours and the field's, in places whose surroundings within
/// `reach` have one colour alone; and the share of the area where there is one of more than a tenth.
std::pair<double, double> colorsOff(const Made& made, double reach) {
    const auto colorAt = [&](const glm::vec3& p) {
        const std::span<const IrId> roots(&made.program.surface[baseColorComponent], 3);
        const std::vector<double> found =
            evaluate(made.program.ir, roots, made.program.parameters(), Point{p.x, p.y, p.z});
        return glm::vec3(found[0], found[1], found[2]);
    };
    const auto off = [](const glm::vec3& a, const glm::vec3& b) {
        const glm::vec3 d = glm::abs(a - b);
        return double(std::max({d.x, d.y, d.z}));
    };
    const Mesh& mesh = made.mesh;
    double most = 0.0, area = 0.0, wrong = 0.0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const uint32_t* at = &mesh.indices[i];
        const double size = 0.5 * glm::length(glm::cross(mesh.positions[at[1]] - mesh.positions[at[0]],
                                                         mesh.positions[at[2]] - mesh.positions[at[0]]));
        const int count = 1 + int(size / (0.5 * reach * reach));
        for (int k = 0; k < count; ++k) {
            float u = float(std::fmod(0.33 + 0.7548776662 * k, 1.0)),
                  v = float(std::fmod(0.33 + 0.5698402910 * k, 1.0));
            if (u + v > 1.0f) u = 1.0f - u, v = 1.0f - v;
            const auto mix = [&](const std::vector<glm::vec3>& values) {
                return (1.0f - u - v) * values[at[0]] + u * values[at[1]] + v * values[at[2]];
            };
            const glm::vec3 place = mix(mesh.positions), color = mix(mesh.colors), wanted = colorAt(place);
            area += size / count;
            if (off(color, wanted) <= 0.1) continue;
            wrong += size / count;
            bool alone = true;
            for (int n = 0; n < 27 && alone; ++n) {
                const glm::vec3 way(float(n % 3 - 1), float(n / 3 % 3 - 1), float(n / 9 - 1));
                for (const float part : {0.5f, 1.0f})
                    alone = alone && off(colorAt(place + part * float(reach) * way), wanted) < 0.01;
            }
            if (alone) most = std::max(most, off(color, wanted));
        }
    }
    return {most, wrong / area};
}

TEST(Decimate, ACastleKeepsItsErrorAndItsColours) {
    const int resolution = kLong ? 200 : 90;
    const double cell = 4.6 / resolution;
    for (const double error : kLong ? std::vector{0.02, 0.05, 0.075, 0.1} : std::vector{0.05}) {
        const Made made = madeOf(decimated(kCastle, "castle", resolution, error, 0));
        const auto [most, share] = colorsOff(made, error + 1.5 * cell);
        std::printf("castle, error %g: %llu triangles, %.4f m, %.2g of the area off its colour\n", error,
                    static_cast<unsigned long long>(made.report.triangles), farthest(made.report), share);
        EXPECT_LE(farthest(made.report), error);
        EXPECT_LT(made.report.triangles, 3000u);
        EXPECT_LE(most, 0.1) << "away from any border";
    }
    if (!kLong) return;
    const Made made = madeOf(decimated(kCastle, "castle", resolution, 0.0, 10'000));
    EXPECT_LE(made.report.triangles, 10'000u);
    EXPECT_GE(made.report.triangles, 9'999u);
    const Made whole = madeOf(decimated(kCastle, "castle", resolution, 0.0, 1 << 24));
    EXPECT_LE(farthest(made.report), 1.1 * farthest(whole.report));
    const auto [most, share] = colorsOff(made, 2.0 * cell);
    EXPECT_LE(most, 0.1);
    EXPECT_LT(share, 1.2 * colorsOff(whole, 2.0 * cell).second) << "as much as the cells blend";
}

TEST(Decimate, TheCommandTakesANumberForAnyGraph) {
    test::TempDir folder;
    const std::string graph = folder.path("ball.field.json"), mesh = folder.path("ball.glb"),
                      report = folder.path("ball.json");
    test::writeText(graph, R"({"fieldwright": 1, "nodes": [{"id": "ball", "type": "sphere"},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "ball"}, "resolution": 48}}]})");
    const auto exported = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {"export", graph, "-o", mesh});
        return test::runCommand(more);
    };
    const test::CommandResult fewer =
        exported({"--triangles", "500", "--report", report, "--require", "closed,manifold,uncut"});
    ASSERT_EQ(fewer.status, 0) << fewer.errors;
    EXPECT_EQ(fewer.errors, "");
    EXPECT_EQ(nlohmann::json::parse(test::readText(report))["triangles"], 500);
    const test::CommandResult least = exported({"--triangles", "1"});
    ASSERT_EQ(least.status, 0);
    EXPECT_NE(least.errors.find("note: decimate ended at 4 triangles"), std::string::npos) << least.errors;
    for (const char* tiled : {"--tiles", "--tile"})
        test::expectRefusal(exported({"--triangles", "500", tiled, "2"}), 2, {"--triangles", tiled});
    for (const char* bad : {"0", "-4", "nan", "1e3", "99999999999"})
        test::expectRefusal(exported({"--triangles", bad}), 2, {"--triangles"});

    // Of a sequence each mesh.
    const test::CommandResult many =
        test::runCommand({"export", graph, "-o", folder.path("frames"), "--to", "0.1", "--fps", "20",
                          "--triangles", "300", "--report", report});
    ASSERT_EQ(many.status, 0) << many.errors;
    const nlohmann::json frames = nlohmann::json::parse(test::readText(report))["frames"];
    ASSERT_EQ(frames.size(), 2u);
    for (const nlohmann::json& frame : frames) EXPECT_EQ(frame["triangles"], 300);
}

}  // namespace fw::decimate_test
