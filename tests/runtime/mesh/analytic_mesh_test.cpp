// Exported meshes against exact volumes, areas, bounds and topology (the rows of analytic solids that have
// closed forms), measured from the written file.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "graph/check/check.h"
#include "runtime/export/export.h"
#include "runtime/measure/mesh_report.h"
#include "runtime/play/session.h"
#include "tests/support/gpu.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::analytic_mesh_test {

constexpr double kPi = std::numbers::pi;

struct Inputs {
    std::vector<std::pair<std::string, InputValue>> list;
    Inputs& set(std::string name, InputValue value) {
        return list.emplace_back(std::move(name), std::move(value)), *this;
    }
};
InputValue from(const char* node) { return {Link{node, ""}}; }
InputValue vec(double x, double y, double z) { return {std::vector<double>{x, y, z}}; }

struct Nodes {
    Graph graph;
    Nodes& add(std::string id, std::string type, Inputs inputs) {
        Node node;
        node.id = std::move(id), node.type = std::move(type), node.inputs = std::move(inputs.list);
        graph.nodes.push_back(std::move(node));
        return *this;
    }
    Graph done() {
        const std::string last = graph.nodes.back().id;
        add("out", "output", Inputs().set("surface", {Link{last, ""}}));
        return graph;
    }
};
Graph single(std::string type, Inputs inputs) {
    return Nodes().add("solid", std::move(type), std::move(inputs)).done();
}
Graph coded(std::string code) {
    Nodes nodes;
    nodes.add("solid", "expression", {});
    nodes.graph.nodes[0].code = std::move(code);
    return nodes.done();
}

struct Row {
    const char* name;
    Graph graph;
    double volume, area;
    Point halfExtents;  ///< of the bounds; 0: not stated
    int euler, shells;
    double edgeLength;  ///< of sharp edges: marching cubes bevels each by up to a cell; 0 for a smooth solid
    bool pointed = false;  ///< the bounds are reached at tips or corners only
};

std::vector<Row> rows() {
    const double twelve = 12 * kPi;
    const auto box = [](double a, double b, double c) { return Inputs().set("half_extents", vec(a, b, c)); };
    const auto ball = [](double r) { return Inputs().set("radius", {r}); };
    const auto ab = [] { return Inputs().set("a", from("a")).set("b", from("b")); };
    return {
        {"sphere", single("sphere", ball(0.7)), 1.436755040, 6.157521601, {0.7, 0.7, 0.7}, 2, 1, 0},
        {"box", single("box", box(0.5, 0.4, 0.7)), 1.12, 6.64, {0.5, 0.4, 0.7}, 2, 1, 4 * (1.0 + 0.8 + 1.4)},
        {"round_box",
         single("box", box(0.5, 0.4, 0.7).set("rounding", {0.1})),
         1.093870199,
         6.079291886,
         {0.5, 0.4, 0.7},
         2,
         1,
         0},
        {"cylinder",
         single("cylinder", ball(0.4).set("half_height", {0.6})),
         0.603185789,
         4.021238597,
         {0.4, 0.6, 0.4},
         2,
         1,
         4 * kPi * 0.4},
        {"rounded_cylinder",
         single("cylinder", ball(0.5).set("half_height", {0.6}).set("rounding", {0.1})),
         0.929596336,
         5.062134361,
         {0.5, 0.6, 0.5},
         2,
         1,
         0},
        {"torus",
         single("torus", Inputs().set("major_radius", {0.6}).set("minor_radius", {0.2})),
         0.473741011,
         4.737410113,
         {0.8, 0.2, 0.8},
         0,
         1,
         0},
        {"capsule",
         single("capsule", ball(0.3).set("a", vec(0, -0.4, 0)).set("b", vec(0, 0.4, 0))),
         0.339292007,
         2.638937829,
         {0.3, 0.7, 0.3},
         2,
         1,
         0},
        {"cone",
         single("cone", ball(0.5).set("height", {0.9})),
         0.235619449,
         2.402631964,
         {0, 0, 0},
         2,
         1,
         kPi,
         true},
        {"frustum",
         single("capped_cone",
                Inputs().set("half_height", {0.5}).set("radius_bottom", {0.6}).set("radius_top", {0.25})),
         0.599520598,
         4.156511977,
         {0.6, 0.5, 0.6},
         2,
         1,
         2 * kPi * 0.85,
         true},
        {"ellipsoid",
         single("ellipsoid", Inputs().set("radii", vec(0.8, 0.6, 0.4))),
         0.804247719,
         4.461830796,
         {0.8, 0.6, 0.4},
         2,
         1,
         0},
        {"octahedron",
         single("octahedron", Inputs().set("size", {0.8})),
         0.682666667,
         4.434050067,
         {0.8, 0.8, 0.8},
         2,
         1,
         twelve * 0.8 * std::numbers::sqrt2 / kPi,
         true},
        {"pyramid",
         single("pyramid", Inputs().set("half_side", {0.5}).set("height", {0.8})),
         0.266666667,
         2.886796226,
         {0, 0, 0},
         2,
         1,
         4 + 4 * 1.07,
         true},
        {"hexagonal_prism",
         single("prism", Inputs().set("sides", {6.0}).set("apothem", {0.5}).set("half_height", {0.4})),
         0.692820323,
         4.503332100,
         {0, 0, 0},
         2,
         1,
         12 * 0.577 + 6 * 0.8,
         true},
        {"cut_sphere",
         single("cut_sphere", ball(0.7).set("height", {-0.2})),
         1.017876020,
         5.372123438,
         {0.7, 0, 0.7},
         2,
         1,
         2 * kPi * 0.67},
        {"sphere_shell",
         Nodes()
             .add("a", "sphere", ball(0.6))
             .add("b", "shell", Inputs().set("surface", from("a")).set("thickness", {0.05}))
             .done(),
         0.453436540,
         9.110618695,
         {0.65, 0.65, 0.65},
         4,
         2,
         0},
        {"box_with_cavity",
         Nodes()
             .add("a", "box", box(0.6, 0.6, 0.6))
             .add("b", "sphere", ball(0.4))
             .add("c", "subtract", ab())
             .done(),
         1.459917427,
         10.650619298,
         {0.6, 0.6, 0.6},
         4,
         2,
         24 * 0.6},
        {"box_and_sphere",
         Nodes()
             .add("a", "box", box(0.6, 0.6, 0.6))
             .add("b", "sphere", ball(0.75))
             .add("c", "intersect", ab())
             .done(),
         1.470265362,
         6.644468462,
         {0.6, 0.6, 0.6},
         2,
         1,
         6 * 2 * kPi * 0.45},
        {"lens",
         Nodes()
             .add("s", "sphere", ball(0.5))
             .add("a", "translate", Inputs().set("surface", from("s")).set("offset", vec(-0.25, 0, 0)))
             .add("b", "translate", Inputs().set("surface", from("s")).set("offset", vec(0.25, 0, 0)))
             .add("c", "intersect", ab())
             .done(),
         0.163624617,
         1.570796327,
         {0.25, 0.4330127, 0.4330127},
         2,
         1,
         2 * kPi * 0.433,
         true},
        {"two_cylinders",
         coded("return max(length(p.xz), length(p.yz)) - 0.5;"),
         2.0 / 3.0,
         4.0,
         {0.5, 0.5, 0.5},
         2,
         1,
         8.0,
         true},
        {"three_cylinders",
         coded("return max(length(p.xz), length(p.yz), length(p.xy)) - 0.5;"),
         0.585786438,
         3.514718626,
         {0.5, 0.5, 0.5},
         2,
         1,
         12.0,
         true},
        {"periodic_spheres",
         Nodes()
             .add("a", "sphere", ball(0.3))
             .add("b", "repeat",
                  Inputs().set("surface", from("a")).set("period", vec(1, 1, 1)).set("count", vec(4, 4, 4)))
             .done(),
         7.238229474,
         72.382294739,
         {1.8, 1.8, 1.8},
         128,
         64,
         0},
        {"twisted_box",
         Nodes()
             .add("a", "box", box(0.5, 0.4, 0.7))
             .add("b", "twist", Inputs().set("surface", from("a")).set("rate", {90.0}))
             .done(),
         1.12,
         0,
         {0, 0.4, 0},
         2,
         1,
         4 * 3.4,
         true},
    };
}

Report measure(const Graph& graph, int resolution, double* cell = nullptr,
               MeshMethod method = MeshMethod::marchingCubes) {
    for (const Error& error : check(graph))
        EXPECT_NE(error.severity, Error::Severity::error) << format(error);
    Result<Program> program = compile(graph);
    EXPECT_TRUE(program) << format(program.error());
    const Box box = *meshRegion(*program, {std::nullopt, resolution});
    if (cell)
        *cell = std::max({box.hi[0] - box.lo[0], box.hi[1] - box.lo[1], box.hi[2] - box.lo[2]}) / resolution;
    Result<Device> device = createDevice({.validation = true});
    EXPECT_TRUE(device);
    Session session(std::move(*device));
    session.setProgram(std::move(*program));
    const Result<MesherResult> result = session.polygonise({box, resolution, method});
    EXPECT_TRUE(result) << format(result.error());
    const test::TempDir folder;
    const std::string path = folder.path("solid.glb");
    const auto written = exportMesh(session.download(*result), path);
    EXPECT_TRUE(written) << format(written.error());
    EXPECT_TRUE(session.device().validationMessages().empty());
    EXPECT_FALSE(result->capped);
    return *reportOnFile(path);
}

void expectSound(const Report& report, const std::string& name) {
    EXPECT_EQ(report.boundaryEdges, 0u) << name;
    EXPECT_EQ(report.nonManifoldEdges, 0u) << name;
    EXPECT_EQ(report.nonManifoldVertices, 0u) << name;
    EXPECT_EQ(report.flippedEdges, 0u) << name;
    EXPECT_EQ(report.degenerateTriangles, 0u) << name;
}

TEST(AnalyticSolids, VolumeAreaBoundsAndTopology) {
    for (const Row& row : rows()) {
        SCOPED_TRACE(row.name);
        double cell = 0;
        const Report report = measure(row.graph, 128, &cell);
        expectSound(report, row.name);
        EXPECT_EQ(report.eulerCharacteristic, row.euler);
        EXPECT_EQ(report.shells, static_cast<uint64_t>(row.shells));
        // A smooth solid converges with h²; a sharp edge loses up to (2 - √2) h of area a metre of it, h² of
        // volume.
        const double smooth = 1.0 * cell * cell / std::min({0.2, 1.0}) / 0.2;
        EXPECT_NEAR(report.volume, row.volume, row.volume * smooth * 2 + row.edgeLength * cell * cell)
            << "cell " << cell;
        if (row.area > 0) {
            EXPECT_NEAR(report.area, row.area,
                        row.area * smooth * 2 + row.edgeLength * (2 - std::numbers::sqrt2) * cell)
                << "cell " << cell;
        }
        for (int axis = 0; axis < 3; ++axis) {
            if (row.halfExtents[axis] == 0) continue;
            const double slack = row.pointed ? cell : 0.02 * cell + 1e-6;
            EXPECT_NEAR(report.boundsMax[axis], row.halfExtents[axis], slack) << "axis " << axis;
            EXPECT_NEAR(report.boundsMin[axis], -row.halfExtents[axis], slack) << "axis " << axis;
        }
    }
}

TEST(AnalyticSolids, DualContouringKeepsTheirEdges) {
    for (const Row& row : rows()) {
        SCOPED_TRACE(row.name);
        double cell = 0;
        const Report report = measure(row.graph, 128, &cell, MeshMethod::dualContouring);
        expectSound(report, row.name);
        EXPECT_EQ(report.eulerCharacteristic, row.euler);
        EXPECT_EQ(report.shells, static_cast<uint64_t>(row.shells));
        const double smooth = 2 * cell * cell / 0.2;
        EXPECT_NEAR(report.volume, row.volume, row.volume * smooth);
        if (row.area > 0) { EXPECT_NEAR(report.area, row.area, row.area * smooth); }
        for (int axis = 0; axis < 3; ++axis) {
            if (row.halfExtents[axis] == 0) continue;
            const double slack = row.pointed ? cell : 0.1 * cell;
            EXPECT_NEAR(report.boundsMax[axis], row.halfExtents[axis], slack) << "axis " << axis;
            EXPECT_NEAR(report.boundsMin[axis], -row.halfExtents[axis], slack) << "axis " << axis;
        }
    }
}

TEST(AnalyticSolids, DualContouringIsExactWhereFacesAreFlat) {
    const Report box = measure(single("box", Inputs().set("half_extents", vec(0.51, 0.73, 0.615))), 64,
                               nullptr, MeshMethod::dualContouring);
    EXPECT_NEAR(box.volume, 8 * 0.51 * 0.73 * 0.615, 1e-5);
    EXPECT_NEAR(box.area, 8 * (0.51 * 0.73 + 0.73 * 0.615 + 0.615 * 0.51), 1e-5);
    EXPECT_NEAR(box.boundsMax[1], 0.73, 1e-6);
    EXPECT_GT(box.smallestAngle, 20.0);
    // Half of it cut away by a region: the cut is as sharp.
    Result<Program> program = compile(single("box", {}));
    ASSERT_TRUE(program);
    Result<Device> device = createDevice({.validation = true});
    ASSERT_TRUE(device);
    Session session(std::move(*device));
    session.setProgram(std::move(*program));
    const Result<MesherResult> result =
        session.polygonise({Box{{-2, -2, -2}, {0.123, 2, 2}}, 50, MeshMethod::dualContouring});
    ASSERT_TRUE(result);
    EXPECT_TRUE(result->capped);
    const Mesh mesh = session.download(*result);
    const Report report = reportOnMesh(mesh.positions, mesh.indices);
    EXPECT_TRUE(report.closedManifold());
    EXPECT_NEAR(report.volume, 1.123 * 4, 1e-4);
    EXPECT_NEAR(report.area, 2 * 4 + 4 * 2 * 1.123, 1e-4);
    for (const glm::vec3& normal : mesh.normals)  // each along an axis
        EXPECT_NEAR(std::max({std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)}), 1.0f, 1e-4f);
}

TEST(AnalyticSolids, MengerSponges) {
    const int eulers[] = {-8, -160, -2816};
    for (int level = 1; level <= 3; ++level) {
        SCOPED_TRACE(level);
        // The unit cube minus a cross of square tubes in each of its 20^(n-1) subcubes.
        const std::string code =
            "d = max(abs(p.x), abs(p.y), abs(p.z)) - 0.5; float size = 1.0;"
            "for (int i = 0; i < " +
            std::to_string(level) +
            "; i++) { c = abs(mod(p + size / 2.0, vec3(size)) - size / 2.0) - size / 6.0; d = max(d, "
            "-min(max(c.x, c.y), min(max(c.y, c.z), max(c.x, c.z)))); size /= 3.0; } return d;";
        double cell = 0;
        const Report report = measure(coded(code), 160, &cell);
        expectSound(report, "menger");
        EXPECT_EQ(report.eulerCharacteristic, eulers[level - 1]);
        EXPECT_EQ(report.shells, 1u);
        const double volume = std::pow(20.0 / 27.0, level),
                     area = 2 * std::pow(20.0 / 9.0, level) + 4 * std::pow(8.0 / 9.0, level);
        EXPECT_NEAR(report.volume, volume, 0.03 * volume);
        EXPECT_NEAR(report.area, area, 0.12 * area);
    }
}

TEST(AnalyticSolids, APolygonizeNodeGivesRegionAndResolution) {
    Nodes nodes;
    nodes.add("ball", "sphere", {});
    nodes.add("mesh", "polygonize",
              Inputs()
                  .set("surface", from("ball"))
                  .set("region_min", vec(-1.2, -1.2, -1.2))
                  .set("region_max", vec(1.2, 1.2, 0.6))
                  .set("resolution", {40.0}));
    nodes.add("bend", "reroute", Inputs().set("value", from("mesh")));
    nodes.add("out", "output", Inputs().set("mesh", from("bend")));
    for (const Error& error : check(nodes.graph)) ADD_FAILURE() << format(error);
    Result<Program> program = compile(nodes.graph);
    ASSERT_TRUE(program) << format(program.error());
    EXPECT_EQ(program->resolution, 40);
    ASSERT_TRUE(program->region.has_value());
    EXPECT_EQ(*program->region, (Box{{-1.2, -1.2, -1.2}, {1.2, 1.2, 0.6}}));
    EXPECT_TRUE(program->exactness.exact());
}

TEST(AnalyticSolids, ASurfaceThatLeavesTheRegionIsClosedOnItsFaces) {
    Result<Program> program = compile(single("sphere", {}));
    ASSERT_TRUE(program);
    Result<Device> device = createDevice({.validation = true});
    ASSERT_TRUE(device);
    Session session(std::move(*device));
    session.setProgram(std::move(*program));
    const Box region{{-0.31, -1.3, -0.57}, {0.42, 0.123, 1.2}};  // no side a multiple of the cell
    const Result<MesherResult> result = session.polygonise({region, 61});
    ASSERT_TRUE(result);
    EXPECT_TRUE(result->capped);
    const Mesh mesh = session.download(*result);
    const Report report = reportOnMesh(mesh.positions, mesh.indices);
    EXPECT_TRUE(report.closedManifold());
    const double lo[] = {-0.31, -1.0, -0.57}, hi[] = {0.42, 0.123, 1.0};
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(report.boundsMin[axis], lo[axis], 1e-3);
        EXPECT_NEAR(report.boundsMax[axis], hi[axis], 1e-3);
    }
}

TEST(AnalyticSolids, ErrorFallsWithTheSquareOfTheCell) {
    const double exact = 4.0 / 3.0 * kPi * 0.343;
    double errors[3], cells[3];
    for (int i = 0; i < 3; ++i) {
        const Report report = measure(single("sphere", Inputs().set("radius", {0.7})), 32 << i, &cells[i]);
        errors[i] = std::abs(report.volume - exact);
    }
    for (int i = 1; i < 3; ++i) {
        const double order = std::log(errors[i - 1] / errors[i]) / std::log(cells[i - 1] / cells[i]);
        EXPECT_GT(order, 1.8);
        EXPECT_LT(order, 2.2);
    }
}

}  // namespace fw::analytic_mesh_test
