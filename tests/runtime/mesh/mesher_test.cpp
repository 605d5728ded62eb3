// The mesher: closed, oriented and manifold for any signs; the same bytes on every run; accurate; capped;
// grown.
#include "runtime/mesher/mesher.h"

#include <gtest/gtest.h>

#include <cstring>
#include <glm/geometric.hpp>
#include <random>

#include "runtime/measure/mesh_report.h"
#include "runtime/mesh/octahedral.h"
#include "runtime/mesher/marching_cubes_table.h"
#include "tests/support/gpu.h"

namespace fw::mesher_test {

/// All parts of a field from an expression for the value in p, its gradient by central differences.
/// `interval` is an expression for (least, greatest) over lo and hi.
std::string fieldText(const std::string& value, const std::string& interval, const std::string& before = "") {
    return before + R"(
struct FieldMaterial { vec3 baseColor; float roughness; float metallic; vec3 emission; float transmission; float ior; vec3 absorption; };
void fieldBegin() {}
bool fieldChoose(uint place) { return true; }
float fieldValueOf(vec3 p) { return )" +
           value + R"(; }
#ifdef FIELD_VALUE
float fieldValue(vec3 p) { return fieldValueOf(p); }
#endif
#ifdef FIELD_GRADIENT
vec4 fieldGradient(vec3 p) {
    const float e = 1.0 / 1024.0;
    vec3 g;
    for (int i = 0; i < 3; ++i) {
        vec3 d = vec3(0);
        d[i] = e;
        g[i] = (fieldValueOf(p + d) - fieldValueOf(p - d)) / (2.0 * e);
    }
    return vec4(g, fieldValueOf(p));
}
#endif
#ifdef FIELD_INTERVAL
vec2 fieldInterval(vec3 lo, vec3 hi) { return )" +
           interval + R"(; }
#endif
#ifdef FIELD_ROWS
struct FieldPlane { float a; };
struct FieldRow { float a, b; };
FieldPlane fieldPlane(float at) { return FieldPlane(at); }
FieldRow fieldRow(FieldPlane plane, float at) { return FieldRow(plane.a, at); }
#ifndef FIELD_ALONG
float fieldAt(FieldRow row, float at) { return fieldValueOf(vec3(row.b, at, row.a)); }
#elif FIELD_ALONG == 0
float fieldAt(FieldRow row, float at) { return fieldValueOf(vec3(at, row.b, row.a)); }
#else
float fieldAt(FieldRow row, float at) { return fieldValueOf(vec3(row.a, row.b, at)); }
#endif
#endif
#ifdef FIELD_MATERIAL
FieldMaterial fieldMaterial(vec3 p) { return FieldMaterial(p * 0.25 + 0.5, 0.5, 0.0, vec3(0), 0.0, 1.5, vec3(0)); }
#endif
)";
}

/// A 1-Lipschitz field: the interval over a box is the value at its centre and half its diagonal.
std::string lipschitzField(const std::string& value, const std::string& slope = "1.0") {
    return fieldText(value, "vec2(fieldValueOf(0.5 * (lo + hi))) + " + slope +
                                " * 0.5001 * length(hi - lo) * vec2(-1, 1)");
}

struct Meshed {
    Mesh mesh;
    MesherResult result;
};

/// By default also as a graphics card does it, with kernels where the host takes their place here, and with
/// memory that it does not see: the same to the bit.
Meshed polygonise(const std::string& field, const MesherConfig& config, bool alsoByKernels = true) {
    MesherPipelines pipelines = createMesherPipelines(test::device(), field, config.colors);
    const auto run = [&](const MesherConfig& with) -> Meshed {
        MesherBuffers buffers;
        Result<MesherResult> result = runMesher(test::device(), pipelines, buffers, with);
        if (!result) throw SystemError(format(result.error()));
        return {downloadMesh(test::device(), buffers, *result), *result};
    };
    const Meshed meshed = run(config);
    if (!alsoByKernels) return meshed;
    MesherConfig other = config;
    other.connectOnHost = !config.connectOnHost;
    const test::HiddenMemory hidden;
    const Meshed byKernels = run(other);
    EXPECT_EQ(byKernels.mesh.positions, meshed.mesh.positions);
    EXPECT_EQ(byKernels.mesh.normals, meshed.mesh.normals);
    EXPECT_EQ(byKernels.mesh.indices, meshed.mesh.indices);
    EXPECT_EQ(byKernels.mesh.colors, meshed.mesh.colors);
    EXPECT_EQ(byKernels.result.capped, meshed.result.capped);
    EXPECT_EQ(byKernels.result.runs, meshed.result.runs);
    return meshed;
}

MesherConfig cube(float low, float high, int cells, MeshMethod method = MeshMethod::marchingCubes) {
    return {.origin = glm::vec3(low),
            .cellSize = glm::vec3((high - low) / float(cells)),
            .cells = glm::ivec3(cells),
            .method = method};
}

Report expectClosed(const Mesh& mesh) {
    for (uint32_t index : mesh.indices) {
        if (index < mesh.positions.size()) continue;
        ADD_FAILURE() << "index out of range";
        return {};
    }
    Report report = reportOnMesh(mesh.positions, mesh.indices);
    EXPECT_EQ(report.boundaryEdges, 0u);
    EXPECT_EQ(report.nonManifoldEdges, 0u);
    EXPECT_EQ(report.nonManifoldVertices, 0u);
    EXPECT_EQ(report.flippedEdges, 0u);
    EXPECT_EQ(report.degenerateTriangles, 0u);
    EXPECT_EQ(report.vertices, mesh.positions.size()) << "vertices coincide or are not used";
    return report;
}

/// A field whose signs at the grid points are given bit by bit, in a buffer.
struct SignField {
    explicit SignField(int side) : n(side), inside(std::size_t(side) * side * side) {}
    int n;  ///< samples a side; the region has n - 1 cells of size 1
    std::vector<uint32_t> inside;

    uint32_t& at(int x, int y, int z) { return inside[(std::size_t(z) * n + y) * n + x]; }

    Meshed polygonise(MeshMethod method) const {
        std::string text = fieldText("signAt(p)", "vec2(-1, 1)",
                                     "layout(binding = 15, scalar) readonly buffer Signs { uint signs[]; };\n"
                                     "float signAt(vec3 p) {\n"
                                     "    ivec3 i = clamp(ivec3(floor(p + 0.5)), ivec3(0), ivec3(N - 1));\n"
                                     "    return signs[(i.z * N + i.y) * N + i.x] != 0 ? -1.0 : 1.0;\n"
                                     "}\n");
        text = "#define N " + std::to_string(n) + "\n" + text;
        Buffer buffer = createBuffer(test::device(), inside.size() * 4);
        upload(test::device(), buffer, inside);
        MesherConfig config{.origin = glm::vec3(0),
                            .cellSize = glm::vec3(1),
                            .cells = glm::ivec3(n - 1),
                            .field = {.parameters = &buffer},
                            .method = method};
        return mesher_test::polygonise(text, config);
    }

    /// That there are as many vertices and triangles as the table gives, the outside layer included.
    void expectCounts(const MesherResult& result, MeshMethod method) const {
        auto sign = [&](int x, int y, int z) {
            return x >= 0 && y >= 0 && z >= 0 && x < n && y < n && z < n &&
                   inside[(std::size_t(z) * n + y) * n + x];
        };
        uint32_t triangles = 0, patches = 0, edges = 0;
        for (int z = -1; z < n; ++z)
            for (int y = -1; y < n; ++y)
                for (int x = -1; x < n; ++x) {
                    int pattern = 0;
                    for (int c = 0; c < 8; ++c)
                        pattern |= int(sign(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2))) << c;
                    for (int c : {1, 2, 4}) edges += (pattern & 1) != (pattern >> c & 1);
                    for (const CellPolygon& polygon : cellPolygons(pattern))
                        triangles += uint32_t(polygon.size()) - 2, ++patches;
                }
        const bool dual = method == MeshMethod::dualContouring;
        EXPECT_EQ(result.vertices, dual ? patches + result.pinches : edges);
        EXPECT_EQ(result.triangles, dual ? 2 * (edges + result.pinches) : triangles);
    }
};

struct EachMethod : testing::TestWithParam<MeshMethod> {};
INSTANTIATE_TEST_SUITE_P(Mesher, EachMethod,
                         testing::Values(MeshMethod::marchingCubes, MeshMethod::dualContouring),
                         [](const auto& row) {
                             return row.param == MeshMethod::marchingCubes ? "MarchingCubes"
                                                                           : "DualContouring";
                         });

TEST_P(EachMethod, WhiteNoiseIsClosedOrientedAndManifold) {
    for (unsigned seed : {1u, 2u, 3u}) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        SignField field(40);
        std::mt19937 random(seed);
        for (uint32_t& sign : field.inside) sign = random() >> 31;
        Meshed meshed = field.polygonise(GetParam());
        field.expectCounts(meshed.result, GetParam());
        EXPECT_TRUE(meshed.result.capped);
        EXPECT_GT(expectClosed(meshed.mesh).volume, 0.0);
        if (GetParam() == MeshMethod::marchingCubes) continue;
        EXPECT_GT(meshed.result.pinches, 100u);
        const Meshed again = field.polygonise(GetParam());  // the device lists pinches in any order
        EXPECT_EQ(again.mesh.indices, meshed.mesh.indices);
        EXPECT_EQ(again.mesh.positions, meshed.mesh.positions);
    }
}

TEST_P(EachMethod, EveryPatternAloneInItsCell) {
    // 256 cells of 2x2x2 samples each, two samples apart, none on the boundary.
    SignField field(4 * 8 + 2);
    for (int pattern = 0; pattern < 256; ++pattern)
        for (int c = 0; c < 8; ++c)
            field.at(2 + pattern % 8 * 4 + (c & 1), 2 + pattern / 8 % 8 * 4 + (c >> 1 & 1),
                     2 + pattern / 64 * 4 + (c >> 2)) = pattern >> c & 1;
    Meshed meshed = field.polygonise(GetParam());
    field.expectCounts(meshed.result, GetParam());
    EXPECT_FALSE(meshed.result.capped);
    expectClosed(meshed.mesh);
}

TEST_P(EachMethod, EveryPairOfPatternsAcrossAFace) {
    // 4096 sets of 3x2x2 samples, in each of the three directions.
    for (int axis = 0; axis < 3; ++axis) {
        SignField field(16 * 5 + 2);
        for (int signs = 0; signs < 4096; ++signs)
            for (int c = 0; c < 12; ++c) {
                glm::ivec3 p(1 + signs % 16 * 5, 1 + signs / 16 % 16 * 5, 1 + signs / 256 * 5);
                p[axis] += c >> 2;
                p[(axis + 1) % 3] += c & 1;
                p[(axis + 2) % 3] += c >> 1 & 1;
                field.at(p.x, p.y, p.z) = signs >> c & 1;
            }
        Meshed meshed = field.polygonise(GetParam());
        field.expectCounts(meshed.result, GetParam());
        expectClosed(meshed.mesh);
    }
}

TEST_P(EachMethod, EverythingInsideIsTheRegionItself) {
    SignField field(20);
    std::fill(field.inside.begin(), field.inside.end(), 1u);
    Meshed meshed = field.polygonise(GetParam());
    EXPECT_TRUE(meshed.result.capped);
    Report report = expectClosed(meshed.mesh);
    EXPECT_EQ(report.eulerCharacteristic, 2);
    EXPECT_NEAR(report.volume, 19.0 * 19 * 19, 0.1);
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(report.boundsMin[i], 0.0);  // on the boundary exactly
        EXPECT_EQ(report.boundsMax[i], 19.0);
    }
}

TEST_P(EachMethod, AnEmptyFieldGivesAnEmptyMesh) {
    Meshed meshed = polygonise(lipschitzField("length(p) + 1.0"), cube(-1, 1, 33, GetParam()));
    EXPECT_EQ(meshed.result.triangles, 0u);
    EXPECT_TRUE(meshed.mesh.positions.empty());
    EXPECT_FALSE(meshed.result.capped);
}

TEST(Mesher, SphereHasTheRightSizeAndItsVerticesLieOnIt) {
    for (int cells : {24, 64, 129}) {
        SCOPED_TRACE(cells);
        Meshed meshed = polygonise(lipschitzField("length(p) - 0.7"), cube(-1, 1, cells));
        Report report = expectClosed(meshed.mesh);
        EXPECT_EQ(report.eulerCharacteristic, 2);
        double h = 2.0 / cells;
        EXPECT_NEAR(report.volume, 1.436755040, 1.436755040 * 1.5 * 0.00118 * (h / 0.03125) * (h / 0.03125));
        for (std::size_t i = 0; i < meshed.mesh.positions.size(); ++i) {
            glm::vec3 p = meshed.mesh.positions[i];
            ASSERT_NEAR(glm::length(p), 0.7, 1.5e-4 * h + 2e-7);
            // The normal is the gradient at most a fiftieth of a cell from the vertex.
            ASSERT_LT(glm::distance(meshed.mesh.normals[i], glm::normalize(p)), 0.02 * h / 0.7 + 1e-4);
        }
    }
}

TEST_P(EachMethod, FacesOnGridPlanesAndCornersOnGridPointsStaySound) {
    struct Case {
        const char* name;
        std::string field;
        double volume, tolerance;
    };
    const Case cases[] = {
        {"box on grid planes", lipschitzField("max(abs(p.x), max(abs(p.y), abs(p.z))) - 0.5"), 1.0, 0.025},
        {"octahedron on the grid", lipschitzField("(abs(p.x) + abs(p.y) + abs(p.z) - 0.75) * 0.57735"),
         0.5625, 0.02},
        {"two boxes that touch along an edge",
         lipschitzField(
             "min(max(abs(p.x - 0.25), max(abs(p.y - 0.25), abs(p.z))), max(abs(p.x + 0.25), max(abs(p.y + "
             "0.25), abs(p.z)))) - 0.25"),
         0.25, 0.08},
        {"plane through grid points, capped", lipschitzField("(p.x + p.y + p.z) * 0.57735"), 4.0, 0.05},
    };
    for (const Case& one : cases) {
        for (int cells : {16, 32, 64}) {
            SCOPED_TRACE(std::string(one.name) + " at " + std::to_string(cells));
            Report report = expectClosed(polygonise(one.field, cube(-1, 1, cells, GetParam())).mesh);
            EXPECT_NEAR(report.volume, one.volume, one.volume * one.tolerance * 64 / cells);
        }
    }
}

TEST_P(EachMethod, TowerAtManyResolutions) {
    MesherPipelines pipelines = createMesherPipelines(test::device(), {});
    MesherBuffers buffers;
    for (int cells : {1, 2, 7, 8, 9, 31, 50, 64, 100, 130}) {
        SCOPED_TRACE(cells);
        Result<MesherResult> result =
            runMesher(test::device(), pipelines, buffers, cube(-2.5f, 2.5f, cells, GetParam()));
        ASSERT_TRUE(result);
        Mesh mesh = downloadMesh(test::device(), buffers, *result);
        if (result->triangles) expectClosed(mesh);
        EXPECT_FALSE(result->capped);
        if (cells == 64) {
            EXPECT_EQ(result->vertices, GetParam() == MeshMethod::marchingCubes ? 15534u : 14992u);
        }
    }
}

TEST_P(EachMethod, TwoLevelsOfCullingGiveTheSameMeshAsOne) {
    // A slab of few cells across, long enough for blocks to be culled, against its short halves.
    std::string field = lipschitzField("length(p.yz) - 0.05 - 0.02 * sin(p.x * 9.0)", "1.1");
    MesherConfig longGrid{.origin = {-1, -0.1f, -0.1f},
                          .cellSize = glm::vec3(2.0f / 640),
                          .cells = {640, 64, 70},
                          .method = GetParam()};
    Meshed meshed = polygonise(field, longGrid);
    Report report = expectClosed(meshed.mesh);
    EXPECT_EQ(report.eulerCharacteristic, 2);
    EXPECT_TRUE(meshed.result.capped);
    EXPECT_EQ(report.boundsMin[0], -1.0);
    double volume = 0;
    for (float start : {-1.0f, 0.0f}) {
        MesherConfig half = longGrid;
        half.origin.x = start;
        half.cells.x = 320;
        volume += expectClosed(polygonise(field, half).mesh).volume;
    }
    EXPECT_NEAR(report.volume, volume, 1e-5);
}

TEST_P(EachMethod, SameBytesAlongEveryAxis) {
    const std::string field =
        lipschitzField("max(length(p - vec3(0.1, 0.2, 0.3)) - 0.9, 0.2 - length(p.xy + 0.3 * p.z))", "1.2");
    MesherConfig config = cube(-1.3f, 1.3f, 41, GetParam());
    config.cells = glm::ivec3(41, 38, 45);
    const Mesh usual = polygonise(field, config).mesh;
    ASSERT_GT(expectClosed(usual).triangles, 1000u);
    for (const char* along : {"#define FIELD_ALONG 0\n", "#define FIELD_ALONG 2\n"}) {
        SCOPED_TRACE(along);
        const Mesh mesh = polygonise(along + field, config).mesh;
        EXPECT_EQ(mesh.indices, usual.indices);
        ASSERT_EQ(mesh.positions.size(), usual.positions.size());
        EXPECT_EQ(0, std::memcmp(mesh.positions.data(), usual.positions.data(), mesh.positions.size() * 12));
    }
}

TEST_P(EachMethod, SameBytesOnEveryRun) {
    MesherPipelines pipelines = createMesherPipelines(test::device(), {}, true);
    MesherConfig config = cube(-2.5f, 2.5f, 90, GetParam());
    config.colors = true;
    Mesh first;
    for (int run = 0; run < 4; ++run) {
        MesherBuffers buffers;
        Result<MesherResult> result = runMesher(test::device(), pipelines, buffers, config);
        ASSERT_TRUE(result);
        Mesh mesh = downloadMesh(test::device(), buffers, *result);
        if (run == 0) first = mesh;
        ASSERT_EQ(mesh.indices, first.indices);
        ASSERT_EQ(0, std::memcmp(mesh.positions.data(), first.positions.data(), mesh.positions.size() * 12));
        ASSERT_EQ(0, std::memcmp(mesh.normals.data(), first.normals.data(), mesh.normals.size() * 12));
        ASSERT_EQ(0, std::memcmp(mesh.colors.data(), first.colors.data(), mesh.colors.size() * 12));
    }
}

TEST_P(EachMethod, ColorsComeFromTheMaterial) {
    MesherConfig config = cube(-1, 1, 20, GetParam());
    config.colors = true;
    Meshed meshed = polygonise(lipschitzField("length(p) - 0.7"), config);
    ASSERT_EQ(meshed.mesh.colors.size(), meshed.mesh.positions.size());
    for (std::size_t i = 0; i < meshed.mesh.colors.size(); ++i)
        EXPECT_LT(glm::distance(meshed.mesh.colors[i], meshed.mesh.positions[i] * 0.25f + 0.5f), 1e-6f);
}

TEST_P(EachMethod, BuffersGrowUntilTheSurfaceFits) {
    // Far more surface than the first guess: thin shells, 32 to the metre.
    Meshed meshed =
        polygonise(lipschitzField("abs(mod(p.x, 0.03125) - 0.015625) - 0.006"), cube(-1, 1, 180, GetParam()));
    EXPECT_GT(meshed.result.runs, 1);
    EXPECT_EQ(expectClosed(meshed.mesh).shells, 64u);
}

TEST_P(EachMethod, AdversarialFieldsStaySound) {
    const std::string anyInterval = "vec2(-1, 1)";
    const std::pair<const char*, std::string> fields[] = {
        {"a sheet thinner than a cell, aslant", "abs(dot(p, vec3(0.6, 0.64, 0.48))) - 0.004"},
        {"two sheets a tenth of a cell apart", "abs(abs(p.y - 0.013) - 0.04) - 0.037"},
        {"cones that touch at a grid point", "(length(p.xz) - abs(p.y)) * 0.7"},
        {"cones that touch between grid points", "(length(p.xz - 0.0123) - abs(p.y - 0.0217)) * 0.7"},
        {"eight cones", "length(p) < 1e-6 ? 1.0 : 0.8 - max(abs(p.x), max(abs(p.y), abs(p.z))) / length(p)"},
        {"a saddle at the scale of the grid", "p.y - 60.0 * p.x * p.z"},
        {"ripples at the scale of the grid", "p.y - 0.05 * sin(p.x * 97.0) * cos(p.z * 89.0)"},
        {"zero in a whole half", "max(p.y, 0.0)"},
        {"zero on grid planes only", "abs(fract(p.x * 16.0) - 0.5) - 0.5"},
        {"less than nothing on one face", "p.y > 0.0 ? 1.0 : p.y < 0.0 ? 0.0 : -1.0"},
        {"a slope of zero", "pow(length(p) - 0.7, 3.0)"},
        {"a slope without end", "sign(length(p) - 0.7) * sqrt(abs(length(p) - 0.7))"},
        {"a step", "length(p) < 0.7 ? -1.0 : 1.0"},
        {"huge", "(length(p) - 0.7) * 1e30"},
        {"tiny", "(length(p) - 0.7) * 1e-30"},
        {"infinite", "length(p) < 0.7 ? -1.0 / 0.0 : 1.0 / 0.0"}};
    for (const auto& [name, value] : fields)
        for (int cells : {16, 31}) {
            SCOPED_TRACE(std::string(name) + " at " + std::to_string(cells));
            const Meshed meshed = polygonise(fieldText(value, anyInterval), cube(-1, 1, cells, GetParam()));
            if (meshed.result.triangles == 0) continue;
            expectClosed(meshed.mesh);
            for (const glm::vec3& normal : meshed.mesh.normals) ASSERT_NEAR(glm::length(normal), 1.0f, 1e-3f);
        }
}

TEST_P(EachMethod, MoreThanOneChunkOfTriangles) {
    // More triangles than one binding holds. The sum over directed edges of a hash, opposite ones cancelling,
    // is zero only for a closed mesh; reportOnMesh would take its time over eleven million triangles.
    std::string field = lipschitzField("abs(mod(p.x, 0.03125) - 0.015625) - 0.006");
    MesherPipelines pipelines = createMesherPipelines(test::device(), field);
    MesherBuffers buffers;
    MesherConfig config = cube(-1, 1, GetParam() == MeshMethod::dualContouring ? 220 : 300, GetParam());
    uint64_t sums[2];
    for (bool onHost : {false, true}) {
        config.connectOnHost = onHost;
        Result<MesherResult> result = runMesher(test::device(), pipelines, buffers, config);
        ASSERT_TRUE(result) << format(result.error());
        EXPECT_GT(result->triangles, uint32_t(MESHER_TRIANGLE_CHUNK));
        std::vector<uint32_t> indices =
            download<uint32_t>(test::device(), buffers.triangles, std::size_t(result->triangles) * 3);
        auto hash = [](uint64_t from, uint64_t to) {
            uint64_t h = (from << 32 | to) * 0x9e3779b97f4a7c15ull;
            h = (h ^ h >> 29) * 0xbf58476d1ce4e5b9ull;
            return h ^ h >> 32;
        };
        uint64_t sum = 0, order = 0;
        uint32_t largest = 0;
        for (std::size_t t = 0; t < indices.size(); t += 3)
            for (int j = 0; j < 3; ++j) {
                uint32_t from = indices[t + j], to = indices[t + (j + 1) % 3];
                sum += hash(from, to) - hash(to, from);
                order = order * 0x9e3779b97f4a7c15ull + from;
                largest = std::max(largest, from);
            }
        EXPECT_EQ(sum, 0u);
        EXPECT_EQ(largest + 1, result->vertices);
        sums[onHost] = order;
    }
    EXPECT_EQ(sums[0], sums[1]) << "the host and the kernels disagree";
}

TEST_P(EachMethod, AnIntervalThatMissesSurfaceDoesNotTearAHole) {
    // The interval denies the surface in a slab across the sphere.
    std::string field =
        fieldText("length(p) - 0.7",
                  "lo.x > 0.1 && hi.x < 0.5 ? vec2(0.01, 9) : vec2(fieldValueOf(0.5 * (lo + hi))) + 0.5001 * "
                  "length(hi - lo) * vec2(-1, 1)");
    Meshed meshed = polygonise(field, cube(-1, 1, 64, GetParam()));
    EXPECT_GT(meshed.result.runs, 1);
    EXPECT_EQ(expectClosed(meshed.mesh).eulerCharacteristic, 2);
}

TEST_P(EachMethod, NotANumberIsOutside) {
    Meshed meshed =
        polygonise(fieldText("p.x > 0.03 ? log(-1.0 - p.x * p.x) : length(p) - 0.7", "vec2(-1, 1)"),
                   cube(-1, 1, 32, GetParam()));
    Report report = expectClosed(meshed.mesh);
    EXPECT_NEAR(report.volume, 1.436755 / 2, 0.1);
    for (glm::vec3 n : meshed.mesh.normals) EXPECT_NEAR(glm::length(n), 1.0f, 1e-3f);
}

TEST_P(EachMethod, PartsGiveTheSameBytes) {
    MesherConfig config = cube(-2.5f, 2.5f, 200, GetParam());
    const std::atomic<uint64_t>& submissions = test::device().record->submissions;
    const uint64_t begin = submissions;
    const Meshed whole = polygonise({}, config);
    const uint64_t ofWhole = submissions - begin;
    config.weight = 1e9;
    const Meshed parted = polygonise({}, config);
    EXPECT_GT(submissions - begin - ofWhole, ofWhole + 8);
    EXPECT_EQ(parted.mesh.positions, whole.mesh.positions);
    EXPECT_EQ(parted.mesh.normals, whole.mesh.normals);
    EXPECT_EQ(parted.mesh.indices, whole.mesh.indices);
}

TEST_P(EachMethod, TilesAreTheSameByHostAndKernels) {
    MesherConfig config = cube(-2.5f, 2.5f, 150, GetParam());
    uint32_t triangles = 0;
    for (int x = 0; x < 3; ++x)
        for (int y = 0; y < 3; ++y) {
            config.tile = {.begin = {x, y, 1}, .end = {x < 2 ? x + 1 : 0, y < 2 ? y + 1 : 0, 2}};
            triangles += polygonise({}, config).result.triangles;
        }
    EXPECT_GT(triangles, 0u);
}

TEST(Mesher, ImpossibleRegionsAreErrors) {
    MesherPipelines pipelines = createMesherPipelines(test::device(), {});
    MesherBuffers buffers;
    auto message = [&](const MesherConfig& config) {
        Result<MesherResult> result = runMesher(test::device(), pipelines, buffers, config);
        return result ? std::string() : result.error().message;
    };
    EXPECT_NE(message({.cells = {0, 4, 4}}).find("cells"), std::string::npos);
    EXPECT_NE(message({.cells = {4, 4, 100'000}}).find("100000"), std::string::npos);
    EXPECT_NE(message({.origin = glm::vec3(1e6f), .cellSize = glm::vec3(0.01f), .cells = {4, 4, 4}})
                  .find("single precision"),
              std::string::npos);
}

TEST(Mesher, StagesAreNamed) {
    MesherConfig config = cube(-2.5f, 2.5f, 40);
    config.timed = true;
    Meshed meshed = polygonise({}, config);
    std::vector<std::string> names;
    for (const StageTime& stage : meshed.result.stages) {
        names.push_back(stage.name);
        EXPECT_GT(stage.milliseconds, 0.0);
    }
    const std::vector<std::string> byHost = {"cull", "compact", "sample", "connect", "vertices"},
                                   byKernels = {"cull",     "compact",   "sample",
                                                "classify", "triangles", "vertices"};
    EXPECT_EQ(names, test::device().software ? byHost : byKernels);
}

TEST(Octahedral, RoundTripOnTheDevice) {
    Pipeline pipeline = test::computePipeline(R"(
#include "lib/octahedral.glsl"
layout(local_size_x = 64) in;
layout(binding = 0, scalar) buffer Vectors { vec3 v[]; };
layout(binding = 1, scalar) buffer Packed { uint packed[]; };
void main() {
    uint i = gl_GlobalInvocationID.x;
    packed[i] = packOctahedral(v[i]);
    v[i] = unpackOctahedral(packed[i]);
}
)");
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    std::vector<glm::vec3> vectors(1024);
    for (glm::vec3& v : vectors)
        v = glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
    vectors[0] = {0, 0, 1}, vectors[1] = {0, 0, -1}, vectors[2] = {-1, 0, 0}, vectors[3] = {0, -1, 0};
    Buffer a = createBuffer(test::device(), 1024 * 12), b = createBuffer(test::device(), 1024 * 4);
    upload(test::device(), a, vectors);
    Commands commands(test::device());
    Descriptor descriptors[] = {{0, a}, {1, b}};
    dispatch(commands, pipeline, {16, 1, 1}, nullptr, 0, descriptors);
    barrier(commands);
    submit(commands);
    std::vector<glm::vec3> onDevice = download<glm::vec3>(test::device(), a, 1024);
    std::vector<uint32_t> words = download<uint32_t>(test::device(), b, 1024);
    for (int i = 0; i < 1024; ++i) {
        EXPECT_LT(glm::distance(onDevice[i], vectors[i]), 1e-4f);
        EXPECT_LT(glm::distance(unpackOctahedral(words[i]), vectors[i]), 1e-4f);
    }
}

TEST(Octahedral, ManyAreWhatOneIs) {
    std::mt19937 random(6);
    std::vector<gpu::MeshVertex> vertices(1001);
    for (gpu::MeshVertex& vertex : vertices) vertex.normal = uint32_t(random());
    const uint32_t corners[] = {0, 0x8000, 0x80008000, 0x7fff7fff, 0x80017fff, 0x80000000, 0xffff};
    for (std::size_t i = 0; i < std::size(corners); ++i) vertices[i].normal = corners[i];
    std::vector<glm::vec3> normals(vertices.size());
    unpackNormals(vertices, normals);
    for (std::size_t i = 0; i < vertices.size(); ++i)
        EXPECT_EQ(normals[i], unpackOctahedral(vertices[i].normal));
}

}  // namespace fw::mesher_test
