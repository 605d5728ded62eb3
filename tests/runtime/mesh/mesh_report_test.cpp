// The report's counts against meshes whose topology and size are known.
#include "runtime/measure/mesh_report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>

#include "runtime/export/export.h"
#include "runtime/measure/read_back.h"
#include "tests/support/graph/temp_dir.h"
#include "tests/support/meshes.h"

namespace fw::mesh_report_test {

using test::TempDir;

Report reportOf(const Mesh& mesh, const FieldError& error = {}) {
    return reportOnMesh(mesh.positions, mesh.indices, {.error = error});
}

struct Topology {
    uint64_t boundary = 0, nonManifold = 0, flipped = 0, nonManifoldVertices = 0, degenerate = 0, shells = 1;
    int64_t euler = 2;
};

void expectTopology(const Report& report, const Topology& wanted) {
    EXPECT_EQ(report.boundaryEdges, wanted.boundary);
    EXPECT_EQ(report.nonManifoldEdges, wanted.nonManifold);
    EXPECT_EQ(report.flippedEdges, wanted.flipped);
    EXPECT_EQ(report.nonManifoldVertices, wanted.nonManifoldVertices);
    EXPECT_EQ(report.degenerateTriangles, wanted.degenerate);
    EXPECT_EQ(report.shells, wanted.shells);
    EXPECT_EQ(report.eulerCharacteristic, wanted.euler);
}

TEST(MeshReport, Tetrahedron) {
    const Report report = reportOf(test::tetrahedron());
    expectTopology(report, {});
    EXPECT_TRUE(report.closedManifold());
    EXPECT_EQ(report.vertices, 4u);
    EXPECT_EQ(report.triangles, 4u);
    EXPECT_NEAR(report.volume, 1.0 / 6.0, 1e-15);
    EXPECT_NEAR(report.area, 1.5 + std::sqrt(3.0) / 2.0, 1e-14);
    EXPECT_EQ(report.boundsMin, (std::array<double, 3>{0, 0, 0}));
    EXPECT_EQ(report.boundsMax, (std::array<double, 3>{1, 1, 1}));
}

TEST(MeshReport, CubeSharedOrNotIsTheSame) {
    for (const Mesh& mesh : {test::cube(), test::unshared(test::cube())}) {
        const Report report = reportOf(mesh);
        expectTopology(report, {});
        EXPECT_EQ(report.vertices, 8u);
        EXPECT_DOUBLE_EQ(report.volume, 8.0);
        EXPECT_DOUBLE_EQ(report.area, 24.0);
    }
}

TEST(MeshReport, TorusFarAway) {
    const Mesh mesh = test::torus(400, 200);
    const Report report = reportOf(mesh);
    expectTopology(report, {.euler = 0});
    EXPECT_NEAR(report.volume, 2 * std::pow(std::numbers::pi * 0.25, 2), 1e-3);
    // A power of two keeps the coordinates of a cube exact, so its volume must not suffer from the distance.
    EXPECT_DOUBLE_EQ(reportOf(test::moved(test::cube(), glm::vec3(1048576.0f))).volume, 8.0);
}

TEST(MeshReport, InsideOut) {
    Mesh mesh = test::cube();
    for (std::size_t t = 0; t < 12; ++t) test::flip(mesh, t);
    const Report report = reportOf(mesh);
    expectTopology(report, {});
    EXPECT_DOUBLE_EQ(report.volume, -8.0);
}

TEST(MeshReport, TwoShells) {
    const Report report = reportOf(test::join(test::cube(), test::moved(test::torus(20, 10), {4, 0, 0})));
    expectTopology(report, {.shells = 2, .euler = 2});
}

TEST(MeshReport, FlippedTriangle) {
    Mesh mesh = test::cube();
    test::flip(mesh, 5);
    expectTopology(reportOf(mesh), {.flipped = 3});
}

TEST(MeshReport, OpenCube) {
    Mesh mesh = test::cube();
    mesh.indices.resize(30);  // without its last side
    expectTopology(reportOf(mesh), {.boundary = 4, .euler = 1});
}

TEST(MeshReport, BowTieVertex) {
    // Two tetrahedra that touch in the corner at the origin only.
    Mesh other = test::tetrahedron();
    for (glm::vec3& p : other.positions) p = -p;
    for (std::size_t t = 0; t < 4; ++t) test::flip(other, t);
    const Report report = reportOf(test::join(test::tetrahedron(), other));
    expectTopology(report, {.nonManifoldVertices = 1, .shells = 2, .euler = 3});
    EXPECT_EQ(report.vertices, 7u);
}

TEST(MeshReport, PinchedOpenFan) {
    // Two triangles that share one vertex: two fans, each open.
    const Report report =
        reportOnMesh(std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}},
                     std::vector<uint32_t>{0, 1, 2, 0, 3, 4});
    expectTopology(report, {.boundary = 6, .nonManifoldVertices = 1, .shells = 2, .euler = 1});
}

TEST(MeshReport, CubesThatShareAnEdge) {
    const Report report = reportOf(test::join(test::cube(), test::moved(test::cube(), {2, 2, 0})));
    expectTopology(report, {.nonManifold = 1, .euler = 3});
    EXPECT_EQ(report.vertices, 14u);
}

TEST(MeshReport, ThreeLeavesOnOneEdge) {
    const Report report =
        reportOnMesh(std::vector<glm::vec3>{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}},
                     std::vector<uint32_t>{0, 1, 2, 0, 1, 3, 0, 1, 4});
    expectTopology(report, {.boundary = 6, .nonManifold = 1, .euler = 1});
}

TEST(MeshReport, DegenerateTriangles) {
    // A collapsed one is left out of the topology; one without area is not, it may be what closes the mesh.
    Mesh mesh = test::cube();
    mesh.indices.insert(mesh.indices.end(), {0, 0, 5});
    mesh.positions.push_back(mesh.positions[3]);
    mesh.indices.insert(mesh.indices.end(), {3, 8, 6});
    expectTopology(reportOf(mesh), {.degenerate = 2});
    EXPECT_EQ(reportOf(mesh).triangles, 14u);

    const Report needle =
        reportOnMesh(std::vector<glm::vec3>{{0, 0, 0}, {1, 1, 1}, {3, 3, 3}}, std::vector<uint32_t>{0, 1, 2});
    expectTopology(needle, {.boundary = 3, .degenerate = 1, .euler = 1});
    const Report point =
        reportOnMesh(std::vector<glm::vec3>(3, glm::vec3(1)), std::vector<uint32_t>{0, 1, 2});
    expectTopology(point, {.degenerate = 1, .shells = 0, .euler = 0});
    EXPECT_EQ(point.vertices, 0u);
}

TEST(MeshReport, SmallTrianglesAreNotDegenerate) {
    Mesh mesh = test::torus(50, 20);
    for (glm::vec3& p : mesh.positions) p *= 1e-12f;
    expectTopology(reportOf(mesh), {.euler = 0});
}

TEST(MeshReport, ZeroesOfBothSignsAreOnePlace) {
    Mesh mesh = test::unshared(test::tetrahedron());
    for (std::size_t i = 0; i < mesh.positions.size(); i += 2)
        for (int k = 0; k < 3; ++k)
            if (mesh.positions[i][k] == 0.0f) mesh.positions[i][k] = -0.0f;
    expectTopology(reportOf(mesh), {});
}

TEST(MeshReport, VertexOfHighDegree) {
    // A cone of 50,000 sides and its base: two vertices that every triangle meets.
    Mesh mesh;
    constexpr uint32_t kSides = 50000;
    mesh.positions = {{0, 1, 0}, {0, 0, 0}};
    for (uint32_t i = 0; i < kSides; ++i) {
        const double angle = 2 * std::numbers::pi * i / kSides;
        mesh.positions.emplace_back(std::cos(angle), 0.0, std::sin(angle));
        const uint32_t a = 2 + i, b = 2 + (i + 1) % kSides;
        mesh.indices.insert(mesh.indices.end(), {0, b, a, 1, a, b});
    }
    const Report report = reportOf(mesh);
    expectTopology(report, {});
    EXPECT_NEAR(report.volume, std::numbers::pi / 3.0, 1e-6);
}

TEST(MeshReport, FieldErrorIsTakenAtVerticesAndCentroids) {
    const auto sphere = [](std::span<const glm::dvec3> points, std::span<double> errors) {
        for (std::size_t i = 0; i < points.size(); ++i)
            errors[i] = std::abs(
                std::sqrt(points[i].x * points[i].x + points[i].y * points[i].y + points[i].z * points[i].z) -
                1.0);
    };
    Mesh mesh = test::cube();
    mesh.positions.emplace_back(100.0f);  // no triangle uses it
    const Report report = reportOf(mesh, sphere);
    ASSERT_TRUE(report.maxError && report.meanError);
    // 8 corners at sqrt(3); 12 centroids at (1/3, 1/3, 1), each sqrt(11)/3 from the middle.
    const double corner = std::sqrt(3.0) - 1.0, centroid = std::sqrt(11.0) / 3.0 - 1.0;
    EXPECT_DOUBLE_EQ(*report.maxError, corner);
    EXPECT_NEAR(*report.meanError, (8 * corner + 12 * centroid) / 20.0, 1e-14);
    EXPECT_FALSE(reportOf(mesh).maxError);
}

TEST(MeshReport, SameNumbersOnEveryRun) {
    const Mesh mesh = test::torus(700, 300);
    const std::string first = writeReport(reportOf(mesh));
    for (int i = 0; i < 5; ++i) EXPECT_EQ(writeReport(reportOf(mesh)), first);
}

TEST(MeshReport, JsonHasTheDocumentedKeysInOrder) {
    Report report = reportOf(test::cube());
    report.capped = true;
    report.stages = {{"compile", 1.5}, {"mesh", 2.25}};
    report.totalMs = 4.0;
    report.peakMemoryBytes = 123;
    report.device = "llvmpipe \"quoted\" \xff";
    const auto json = nlohmann::ordered_json::parse(writeReport(report));
    std::vector<std::string> keys;
    for (const auto& [key, value] : json.items()) keys.push_back(key);
    EXPECT_EQ(keys, (std::vector<std::string>{"vertices",
                                              "triangles",
                                              "shells",
                                              "bodies",
                                              "cavities",
                                              "boundaryEdges",
                                              "nonManifoldEdges",
                                              "nonManifoldVertices",
                                              "flippedEdges",
                                              "degenerateTriangles",
                                              "eulerCharacteristic",
                                              "unit",
                                              "volume",
                                              "area",
                                              "boundsMin",
                                              "boundsMax",
                                              "size",
                                              "centreOfMass",
                                              "density",
                                              "mass",
                                              "leastWall",
                                              "leastGap",
                                              "units",
                                              "maxError",
                                              "meanError",
                                              "selfIntersections",
                                              "smallestAngle",
                                              "largestAngle",
                                              "meshToSurfaceMax",
                                              "meshToSurfaceMean",
                                              "meshToSurfaceSamples",
                                              "surfaceToMeshMax",
                                              "surfaceToMeshMean",
                                              "surfaceToMeshSamples",
                                              "capped",
                                              "complete",
                                              "completeness",
                                              "solidOutside",
                                              "stages",
                                              "totalMs",
                                              "peakMemoryBytes",
                                              "device"}));
    EXPECT_EQ(json["vertices"], 8);
    EXPECT_EQ(json["volume"], 8.0);
    EXPECT_EQ(json["boundsMin"], (nlohmann::ordered_json{-1.0, -1.0, -1.0}));
    EXPECT_TRUE(json["maxError"].is_null());
    EXPECT_EQ(json["capped"], true);
    EXPECT_EQ(json["stages"]["mesh"], 2.25);
    EXPECT_EQ(json["peakMemoryBytes"], 123);
}

TEST(MeshReport, TellsSizeMassAndWhereTheMiddleIs) {
    // A cube of side 2 about (10, 0, 0) with one of side 1 about (10.5, 0, 0) taken out, in centimetres.
    Mesh hollow = test::cube();
    for (std::size_t i = 0; i < hollow.indices.size(); i += 3)
        std::swap(hollow.indices[i], hollow.indices[i + 1]);
    for (glm::vec3& p : hollow.positions) p = p * 0.5f + glm::vec3(0.25f, 0, 0);
    Report report = reportOf(test::moved(test::join(test::cube(), hollow), glm::vec3(10, 0, 0)));
    EXPECT_NEAR(report.volume, 7.0, 1e-12);
    EXPECT_NEAR(report.centre[0], 10 - 0.25 / 7.0, 1e-12);
    EXPECT_NEAR(report.centre[1], 0.0, 1e-12);
    EXPECT_EQ(report.extent(), (std::array<double, 3>{2, 2, 2}));
    EXPECT_FALSE(report.mass());
    report.density = 2.5;
    report.unit = "cm";
    EXPECT_NEAR(*report.mass(), 17.5, 1e-12);
    const auto json = nlohmann::json::parse(writeReport(report));
    EXPECT_NEAR(json["mass"].get<double>(), 17.5, 1e-12);
    EXPECT_EQ(json["units"]["volume"], "cm³");
    EXPECT_EQ(json["units"]["mass"], "g");
    const std::string words = reportWords(report);
    for (const char* line : {"Size: 2 × 2 × 2 cm\n", "Volume: 7 cm³\n", "Mass: 17.5 g at 2.5 g/cm³\n",
                             "Centre of mass: 9.96429, 0, 0 cm\n", "Closed: yes\n", "Cavities: 1\n"})
        EXPECT_NE(words.find(line), std::string::npos) << words;
    report.unit = "in";
    EXPECT_NEAR(*report.mass(), 17.5 * std::pow(2.54, 3), 1e-9);
    report.unit = "m";
    EXPECT_NE(reportWords(report).find("Mass: 17500 kg"), std::string::npos) << reportWords(report);
}

TEST(MeshReport, IsRefusedWhereThereIsNoMemoryForIt) {
    EXPECT_TRUE(checkMeasurable(10'000'000, 2'000'000'000));
    const Done refused = checkMeasurable(240'000'000, 8'000'000'000);
    ASSERT_FALSE(refused);
    for (const char* words : {"240000000 triangles", "25 GB", "8 GB are free", "--require"})
        EXPECT_NE(refused.error().message.find(words), std::string::npos) << refused.error().message;
    EXPECT_GT(freeMemoryBytes(), 1u << 20);
    EXPECT_LT(freeMemoryBytes(), uint64_t(1) << 50);  // known, on this system
}

TEST(MeshReport, MeasuresTheWrittenFile) {
    const TempDir folder;
    Mesh mesh = test::torus(60, 30);
    test::flip(mesh, 7);
    const std::string wanted = writeReport(reportOf(mesh));
    for (const char* name : {"mesh.glb", "mesh.gltf", "mesh.obj", "mesh.stl", "mesh.ply"}) {
        ASSERT_TRUE(exportMesh(mesh, folder.path(name)));
        const Result<Report> report = reportOnFile(folder.path(name));
        ASSERT_TRUE(report) << format(report.error());
        EXPECT_EQ(writeReport(*report), wanted) << name;
    }
    EXPECT_FALSE(reportOnFile(folder.path("missing.glb")));
    EXPECT_FALSE(reportOnFile(folder.folder.string()));
    EXPECT_FALSE(reportOnFile(folder.path("mesh.bin")));
}

TEST(ReadBack, DamagedFilesGiveAMeshOrAnErrorAndNeverMore) {
    const TempDir folder;
    Mesh mesh = test::cube();
    test::paint(mesh);
    std::mt19937 random(7);
    std::size_t refused = 0;
    for (const char* name : {"mesh.glb", "mesh.gltf", "mesh.obj", "mesh.stl", "mesh.ply", "mesh.3mf"}) {
        ASSERT_TRUE(exportMesh(mesh, folder.path(name)));
        const std::string whole = test::readText(folder.path(name));
        const std::string damaged =
            folder.path(std::string("damaged") + std::filesystem::path(name).extension().string());
        for (int round = 0; round < 400; ++round) {
            std::string text = whole;
            if (round % 4 == 0) text.resize(random() % text.size());
            for (unsigned i = 0; i < 1 + random() % 4 && !text.empty(); ++i) {
                // Values at the edge of their range find more than random ones.
                constexpr unsigned char kEdges[] = {0, 1, 0x7f, 0x80, 0xfe, 0xff, '9', '-', '"', '[', '\n'};
                text[random() % text.size()] =
                    static_cast<char>(random() % 2 ? kEdges[random() % std::size(kEdges)] : random());
            }
            test::writeText(damaged, text);
            const Result<Report> report = reportOnFile(damaged);
            if (!report) {
                ++refused;
                EXPECT_FALSE(report.error().message.empty());
            } else {
                EXPECT_LE(report->triangles, 100u);
            }
        }
    }
    EXPECT_GT(refused, 400u);
}

/// The folder of third-party meshes with known counts, or empty where this machine has none.
std::filesystem::path corpus() {
    if (const char* given = std::getenv("FIELDWRIGHT_CORPUS")) return given;
    const std::filesystem::path beside = std::filesystem::path(FIELDWRIGHT_SOURCE_DIR) / "../shared/corpus";
    return std::filesystem::exists(beside) ? beside : std::filesystem::path();
}

TEST(ReadBack, MeshesOfOtherPrograms) {
    struct Case {
        const char* file;
        uint64_t triangles;
        Topology topology;
        double volume, area;
    };
    const Case cases[] = {
        {"closed/cube.obj", 48, {}, 8, 24},
        {"closed/7_8ths_cube.stl", 24, {}, 56000, 9600},
        {"closed/fixed_top.ply", 4772, {.euler = -12}, 26449.3, 15317.7},
        {"closed/mengerSponge3.glb", 21598, {.euler = -2816}, 0.406442, 24.7572},
        {"closed/counter_unitsmm.STL", 83750, {.shells = 6, .euler = -38}, 888809, 169951},
        {"closed/Cray_left.obj", 576, {.shells = 2, .euler = 4}, 1.95686e12, 1.57026e10},
        {"broken/joined_tetrahedra.obj", 8, {.nonManifold = 3, .euler = 4}, 0.866025, 8.40755},
        {"broken/shared.STL", 24, {.nonManifold = 1, .euler = 3}, 2, 12},
        {"broken/not_convex.obj", 96, {.nonManifold = 12, .euler = 8}, 0.0308148, 3.51509},
        {"broken/featuretype.STL", 3476, {.boundary = 576, .euler = -16}, 11.6277, 53.8274},
        {"broken/octagonal_pocket.ply",
         3262,
         {.boundary = 54, .nonManifoldVertices = 3, .shells = 5, .euler = 0},
         0.000250353,
         0.0748225},
        {"broken/multiple_tetrahedrons.obj", 20, {.shells = 5, .euler = 10}, 0.000833333, 0.111237},
        {"derived/spot_soup.obj", 1654, {}, 0.679729, 5.52801},
        {"derived/spot_tiny_1e-6.obj", 1654, {}, 6.79729e-19, 5.52801e-12},
    };
    const std::filesystem::path folder = corpus() / "meshes";
    if (!std::filesystem::exists(folder))
        std::puts("no corpus here (FIELDWRIGHT_CORPUS); its meshes are not read");
    for (const Case& one : cases) {
        if (!std::filesystem::exists(folder / one.file)) continue;
        SCOPED_TRACE(one.file);
        const Result<Report> report = reportOnFile((folder / one.file).string());
        ASSERT_TRUE(report) << format(report.error());
        EXPECT_EQ(report->triangles, one.triangles);
        expectTopology(*report, one.topology);
        EXPECT_NEAR(report->volume, one.volume, 1e-5 * std::abs(one.volume));
        EXPECT_NEAR(report->area, one.area, 1e-5 * one.area);
    }
}

}  // namespace fw::mesh_report_test
