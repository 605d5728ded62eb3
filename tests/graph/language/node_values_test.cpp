// Known volumes, extents and single values of the node types: what a property test cannot see, such as a
// wrong axis, size or side.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "graph/compile/compile.h"
#include "graph/document/json.h"
#include "graph/evaluate/evaluate.h"

namespace fw::node_values_test {

using std::numbers::pi;

/// Compiles nodes written as in a file; the last is the one shown.
Program show(const std::string& nodes) {
    const std::size_t id = nodes.rfind("\"id\": \"") + 7;
    const std::string last = nodes.substr(id, nodes.find('"', id) - id);
    const std::string text = R"({"fieldwright": 1, "nodes": [)" + nodes +
                             R"(, {"id": "out", "type": "output", "inputs": {"surface": {"from": ")" + last +
                             R"("}}}]})";
    std::vector<Error> warnings;
    const Result<Graph> graph = parseGraph(text, "test", &warnings);
    EXPECT_TRUE(graph) << (graph ? "" : format(graph.error()));
    EXPECT_TRUE(warnings.empty()) << format(warnings.front());
    const Result<Program> program = compile(*graph);
    EXPECT_TRUE(program) << (program ? "" : format(program.error())) << "\n" << nodes;
    return program ? *program : Program{};
}

/// One node with its inputs.
std::string node(const std::string& id, const std::string& type, const std::string& inputs) {
    return R"({"id": ")" + id + R"(", "type": ")" + type + R"(", "inputs": {)" + inputs + "}}";
}
Program shape(const std::string& type, const std::string& inputs) { return show(node("it", type, inputs)); }

double valueAt(const Program& program, const Point& p) {
    return evaluate(program.ir, program.distance(), {}, p);
}

/// Volume of f < 0 within ±extent: one random point in each of n^3 cells, so that the error falls as n^-2 at
/// a surface of finite area.
double volume(const Program& program, const Point& extent, int n = 64) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> within(0, 1);
    std::vector<Point> points;
    for (int i = 0; i < n * n * n; i++) {
        const int cell[3] = {i % n, i / n % n, i / n / n};
        Point p;
        for (int axis = 0; axis < 3; axis++)
            p[axis] = extent[axis] * (2 * (cell[axis] + within(random)) / n - 1);
        points.push_back(p);
    }
    std::vector<double> values(points.size());
    evaluate(program.ir, program.distance(), {}, points, values);
    const auto inside = std::count_if(values.begin(), values.end(), [](double v) { return v < 0; });
    return 8 * extent[0] * extent[1] * extent[2] * double(inside) / double(points.size());
}

void expectVolume(const Program& program, const Point& extent, double expected) {
    EXPECT_NEAR(volume(program, extent), expected, 0.004 * expected);
}

/// The solid's extents: it touches these faces of its box and does not reach beyond.
void expectExtent(const Program& program, const Point& lo, const Point& hi) {
    std::mt19937_64 random(9);
    for (int axis = 0; axis < 3; axis++) {
        for (double side : {-1.0, 1.0}) {
            const double face = side < 0 ? lo[axis] : hi[axis];
            std::vector<Point> points(20000);
            for (Point& p : points) {
                for (int k = 0; k < 3; k++) p[k] = std::uniform_real_distribution(lo[k], hi[k])(random);
                p[axis] = face + side * 1e-9;
            }
            std::vector<double> values(points.size());
            evaluate(program.ir, program.distance(), {}, points, values);
            const double nearest = *std::ranges::min_element(values);
            ASSERT_GE(nearest, 0) << "inside beyond face " << axis << " " << side;
            EXPECT_LT(nearest, 0.03) << "does not reach face " << axis << " " << side;
        }
    }
}

TEST(NodeValues, SolidsHaveTheirVolumes) {
    expectVolume(shape("sphere", R"("radius": 0.7)"), {0.75, 0.75, 0.75}, 1.436755040);
    expectVolume(shape("box", R"("half_extents": [0.5, 0.4, 0.7])"), {0.55, 0.45, 0.75}, 1.12);
    expectVolume(shape("box_max", R"("half_extents": [0.5, 0.4, 0.7])"), {0.55, 0.45, 0.75}, 1.12);
    expectVolume(shape("box", R"("half_extents": [0.5, 0.4, 0.7], "rounding": 0.1)"), {0.5, 0.4, 0.7},
                 1.093870199);
    expectVolume(shape("cylinder", R"("radius": 0.4, "half_height": 0.6)"), {0.42, 0.62, 0.42}, 0.603185789);
    expectVolume(shape("cylinder", R"("radius": 0.5, "half_height": 0.6, "rounding": 0.1)"), {0.5, 0.6, 0.5},
                 0.929596336);
    expectVolume(shape("torus", R"("major_radius": 0.6, "minor_radius": 0.2)"), {0.8, 0.2, 0.8}, 0.473741011);
    expectVolume(shape("capsule", R"("a": [0, -0.4, 0], "b": [0, 0.4, 0], "radius": 0.3)"), {0.3, 0.7, 0.3},
                 0.339292007);
    expectVolume(shape("cone", R"("radius": 0.5, "height": 0.9)"), {0.5, 0.9, 0.5}, 0.235619449);
    expectVolume(shape("capped_cone", R"("radius_bottom": 0.6, "radius_top": 0.25, "half_height": 0.5)"),
                 {0.6, 0.5, 0.6}, 0.599520598);
    expectVolume(shape("ellipsoid", R"("radii": [0.8, 0.6, 0.4])"), {0.8, 0.6, 0.4}, 0.804247719);
    expectVolume(shape("octahedron", R"("size": 0.8)"), {0.8, 0.8, 0.8}, 0.682666667);
    expectVolume(shape("pyramid", R"("half_side": 0.5, "height": 0.8)"), {0.5, 0.8, 0.5}, 0.266666667);
    expectVolume(shape("prism", R"("sides": 6, "apothem": 0.5, "half_height": 0.4)"), {0.6, 0.5, 0.4},
                 0.692820323);
    expectVolume(shape("cut_sphere", R"("radius": 0.7, "height": -0.2)"), {0.7, 0.7, 0.7}, 1.017876020);
    expectVolume(shape("link", R"("half_length": 0.25, "major_radius": 0.3, "minor_radius": 0.1)"),
                 {0.4, 0.65, 0.1}, pi * 0.01 * (2 * pi * 0.3 + 1.0));
    expectVolume(shape("capped_torus", R"("half_angle": 90, "major_radius": 0.5, "minor_radius": 0.1)"),
                 {0.6, 0.6, 0.1}, pi * 0.01 * pi * 0.5 + 4 * pi * 0.001 / 3);
    expectVolume(shape("solid_angle", R"("half_angle": 60, "radius": 0.8)"), {0.8, 0.8, 0.8},
                 2 * pi * 0.512 * 0.5 / 3);
    expectVolume(shape("box_frame", R"("half_extents": [0.5, 0.5, 0.5], "thickness": 0.1)"), {0.5, 0.5, 0.5},
                 12 * 0.6 * 0.04 + 8 * 0.008);
    const double golden = std::numbers::phi;
    expectVolume(shape("tetrahedron", R"("size": 0.9)"), {0.9, 0.9, 0.9}, 8 * std::sqrt(3.0) / 27 * 0.729);
    const double pentagonEdge = 0.9 * 4 / (std::sqrt(3.0) * (1 + std::sqrt(5.0)));
    expectVolume(shape("dodecahedron", R"("size": 0.9)"), {0.9, 0.9, 0.9},
                 (15 + 7 * std::sqrt(5.0)) / 4 * std::pow(pentagonEdge, 3));
    const double triangleEdge = 0.9 * 2 / std::sqrt(golden * std::sqrt(5.0));
    expectVolume(shape("icosahedron", R"("size": 0.9)"), {0.9, 0.9, 0.9},
                 5 * (3 + std::sqrt(5.0)) / 12 * std::pow(triangleEdge, 3));
    // Between the tangent circles of the balls a frustum, beyond them caps: 0.5 below, 0.25 above, centres
    // 0.75 apart.
    const double b = 1.0 / 3, a = std::sqrt(8.0) / 3;
    const auto below = [](double r, double h) {
        return pi * (2 * r * r * r / 3 + r * r * h - h * h * h / 3);
    };
    const double r1 = 0.5 * a, r2 = 0.25 * a, height = 0.75 + 0.25 * b - 0.5 * b;
    expectVolume(
        shape("round_cone", ""), {0.5, 1.0, 0.5},
        below(0.5, 0.5 * b) + pi * height * (r1 * r1 + r1 * r2 + r2 * r2) / 3 + below(0.25, -0.25 * b));
}

TEST(NodeValues, ACappedTorusEndsAsABallAndAsARing) {
    const Program ball =
        shape("capped_torus", R"("half_angle": 0, "major_radius": 0.5, "minor_radius": 0.1)");
    const Program ring =
        shape("capped_torus", R"("half_angle": 180, "major_radius": 0.5, "minor_radius": 0.1)");
    for (const double x : {0.0, 1e-9, -1e-9, 0.1, -0.3})
        for (const double y : {-0.5, -0.2, 0.0, 0.3, 0.5, 0.8})
            for (const double z : {0.0, 0.2}) {
                EXPECT_NEAR(valueAt(ball, {x, y, z}), std::hypot(x, y - 0.5, z) - 0.1, 1e-12);
                EXPECT_NEAR(valueAt(ring, {x, y, z}), std::hypot(std::hypot(x, y) - 0.5, z) - 0.1, 1e-12);
            }
}

TEST(NodeValues, FlatShapesHaveTheirAreas) {
    const auto extruded = [](const std::string& type, const std::string& inputs) {
        return show(node("flat", type, inputs) + "," +
                    node("it", "extrude", R"("surface": {"from": "flat"}, "half_height": 0.5)"));
    };
    const Point extent{0.8, 0.8, 0.5};
    expectVolume(extruded("circle", R"("radius": 0.7)"), extent, pi * 0.49);
    expectVolume(extruded("rectangle", R"("half_extents": [0.7, 0.3])"), extent, 0.84);
    expectVolume(extruded("regular_polygon", R"("sides": 5, "apothem": 0.5)"), extent,
                 5 * 0.25 * std::tan(pi / 5));
    expectVolume(extruded("star", R"("points": 5, "outer_radius": 0.7, "inner_radius": 0.3)"), extent,
                 5 * 0.21 * std::sin(pi / 5));
    expectVolume(extruded("polygon", ""), extent, 0.9);
    // A square wound twice around itself, the inner turn cut out by the even-odd rule.
    expectVolume(
        extruded(
            "polygon",
            R"("points": [[-0.7,-0.7],[0.7,-0.7],[0.7,0.7],[-0.7,0.7],[-0.7,-0.7],[-0.3,-0.3],[0.3,-0.3],[0.3,0.3],[-0.3,0.3],[-0.3,-0.3]])"),
        extent, 1.96 - 0.36);
    const Program lens = show(node("flat", "circle", R"("radius": 0.2)") + "," +
                              node("it", "revolve", R"("surface": {"from": "flat"}, "offset": 0.6)"));
    expectVolume(lens, {0.8, 0.2, 0.8}, 0.473741011);
}

TEST(NodeValues, CombinationsAndRepetitionsHaveTheirVolumes) {
    const std::string cube = node("cube", "box", R"("half_extents": [0.6, 0.6, 0.6])");
    const auto with = [&](const std::string& other, const std::string& type, const std::string& more = "") {
        return show(cube + "," + other + "," +
                    node("it", type, R"("a": {"from": "cube"}, "b": {"from": "other"})" + more));
    };
    const Point extent{0.65, 0.65, 0.65};
    expectVolume(with(node("other", "sphere", R"("radius": 0.4)"), "subtract"), extent, 1.459917427);
    expectVolume(with(node("other", "sphere", R"("radius": 0.75)"), "intersect"), extent, 1.470265362);
    const double ball = 4 * pi * std::pow(0.75, 3) / 3;
    const Point wide{0.8, 0.8, 0.8};
    expectVolume(with(node("other", "sphere", R"("radius": 0.75)"), "union"), wide,
                 1.728 + ball - 1.470265362);
    expectVolume(with(node("other", "sphere", R"("radius": 0.75)"), "xor"), wide,
                 1.728 + ball - 2 * 1.470265362);
    expectVolume(show(node("ball", "sphere", R"("radius": 0.6)") + "," +
                      node("it", "shell", R"("surface": {"from": "ball"}, "thickness": 0.05)")),
                 extent, 0.453436540);
    expectVolume(show(node("body", "box", R"("half_extents": [0.5, 0.4, 0.7])") + "," +
                      node("it", "twist", R"("surface": {"from": "body"}, "rate": 137)")),
                 {0.87, 0.41, 0.87}, 1.12);
    const std::string bead = node("bead", "sphere", R"("radius": 0.3)") + ",";
    expectVolume(show(bead + node("it", "repeat",
                                  R"("surface": {"from": "bead"}, "period": [1, 1, 1], "count": [4, 4, 4])")),
                 {2, 2, 2}, 7.238229474);
    expectVolume(show(bead + node("it", "repeat",
                                  R"("surface": {"from": "bead"}, "period": [1, 0, 1], "count": [3, 7, 0])")),
                 {2, 0.35, 2}, 3 * 4 * 4 * pi * 0.027 / 3);
    expectVolume(show(node("bead", "sphere", R"("radius": 0.55)") + "," +
                      node("it", "repeat", R"("surface": {"from": "bead"}, "period": [1, 1, 1])")),
                 {0.5, 0.5, 0.5}, 0.671777229);
    expectVolume(
        show(bead + node("aside", "translate", R"("surface": {"from": "bead"}, "offset": [1, 0, 0])") + "," +
             node("it", "polar_repeat", R"("surface": {"from": "aside"}, "count": 5)")),
        {1.4, 0.4, 1.4}, 5 * 4 * pi * 0.027 / 3);
}

TEST(NodeValues, SolidsStandWhereTheirDocumentationSays) {
    expectExtent(shape("capped_torus", R"("half_angle": 90, "major_radius": 0.5, "minor_radius": 0.1)"),
                 {-0.6, -0.1, -0.1}, {0.6, 0.6, 0.1});
    expectExtent(shape("link", R"("half_length": 0.25, "major_radius": 0.3, "minor_radius": 0.1)"),
                 {-0.4, -0.65, -0.1}, {0.4, 0.65, 0.1});
    expectExtent(shape("cone", R"("radius": 0.5, "height": 0.9)"), {-0.5, -0.9, -0.5}, {0.5, 0, 0.5});
    expectExtent(shape("round_cone", ""), {-0.5, -0.5, -0.5}, {0.5, 1, 0.5});
    expectExtent(shape("round_cone", R"("height": 0.1)"), {-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
    expectExtent(shape("pyramid", R"("half_side": 0.5, "height": 0.8)"), {-0.5, 0, -0.5}, {0.5, 0.8, 0.5});
    expectExtent(shape("prism", R"("sides": 6, "apothem": 0.5, "half_height": 0.4)"),
                 {-1 / std::sqrt(3), -0.5, -0.4}, {1 / std::sqrt(3), 0.5, 0.4});
    expectExtent(shape("cut_sphere", R"("radius": 0.7, "height": -0.2)"), {-0.7, -0.2, -0.7},
                 {0.7, 0.7, 0.7});
    expectExtent(shape("solid_angle", R"("half_angle": 30, "radius": 1)"), {-0.5, 0, -0.5}, {0.5, 1, 0.5});
    expectExtent(shape("vesica", R"("half_height": 0.5, "radius": 0.25)"), {-0.25, -0.5, -0.25},
                 {0.25, 0.5, 0.25});
    expectExtent(shape("dodecahedron", R"("size": 1)"), {-0.9342, -0.9342, -0.9342},
                 {0.9342, 0.9342, 0.9342});
    const std::string body = node("body", "box", R"("half_extents": [0.5, 0.2, 0.3])") + ",";
    expectExtent(show(body + node("it", "rotate", R"("surface": {"from": "body"}, "angles": [90, 0, 90])")),
                 {-0.3, -0.5, -0.2}, {0.3, 0.5, 0.2});
    expectExtent(
        show(
            body +
            node(
                "it", "transform",
                R"("surface": {"from": "body"}, "rotation": [0, 0, 90], "scale": 2, "translation": [1, 2, 3])")),
        {0.6, 1, 2.4}, {1.4, 3, 3.6});
    expectExtent(show(body + node("it", "stretch", R"("surface": {"from": "body"}, "factors": [1, 3, 2])")),
                 {-0.5, -0.6, -0.6}, {0.5, 0.6, 0.6});
    expectExtent(
        show(body + node("it", "elongate", R"("surface": {"from": "body"}, "half_extents": [0.5, 0, 0.1])")),
        {-1, -0.2, -0.4}, {1, 0.2, 0.4});
    expectExtent(show(body + node("it", "offset", R"("surface": {"from": "body"}, "distance": 0.25)")),
                 {-0.75, -0.45, -0.55}, {0.75, 0.45, 0.55});
    expectExtent(
        show(body + node("aside", "translate", R"("surface": {"from": "body"}, "offset": [1, 0, 0])") + "," +
             node("it", "mirror", R"("surface": {"from": "aside"}, "normal": [2, 0, 0], "offset": 0.25)")),
        {-1, -0.2, -0.3}, {1.5, 0.2, 0.3});
}

TEST(NodeValues, SignsAndOrdersAreAsDocumented) {
    const std::string ball = node("ball", "sphere", R"("radius": 1)") + ",";
    const Point centre{0, 0, 0};
    EXPECT_DOUBLE_EQ(
        valueAt(show(ball + node("it", "displace", R"("surface": {"from": "ball"}, "amount": 0.25)")),
                centre),
        -0.75);
    EXPECT_DOUBLE_EQ(
        valueAt(show(ball + node("it", "offset", R"("surface": {"from": "ball"}, "distance": 0.25)")),
                centre),
        -1.25);
    EXPECT_DOUBLE_EQ(valueAt(shape("plane", R"("normal": [0, 3, 0], "offset": 0.5)"), {7, 2, 1}), 1.5);
    // Turned about x, then y, then z: +y goes to +z, stays, and stays; +x stays, goes to -z, and stays.
    const std::string rod = node("rod", "capsule", R"("a": [0, 0, 0], "b": [0, 1, 0], "radius": 0.1)") + ",";
    EXPECT_LT(
        valueAt(show(rod + node("it", "rotate", R"("surface": {"from": "rod"}, "angles": [90, 0, 90])")),
                {0, 0, 0.9}),
        0);
    EXPECT_LT(
        valueAt(show(rod + node("it", "rotate", R"("surface": {"from": "rod"}, "angles": [90, 90, 0])")),
                {0.9, 0, 0}),
        0);
    // A bar along x bent by 30 degrees a metre goes down at its ends.
    const std::string bar = node("bar", "box", R"("half_extents": [1, 0.05, 0.05])") + ",";
    EXPECT_LT(valueAt(show(bar + node("it", "bend", R"("surface": {"from": "bar"})")), {0.5, -0.125, 0}), 0);
    // The smooth union is radius / 4 deep where both distances are equal, the chamfer and the stairs touch
    // its depth.
    const std::string walls = node("x", "plane", R"("normal": [1, 0, 0])") + "," +
                              node("y", "plane", R"("normal": [0, 1, 0])") + ",";
    const auto blended = [&](const std::string& type, const std::string& profile) {
        return show(
            walls +
            node("it", type,
                 R"("a": {"from": "x"}, "b": {"from": "y"}, "radius": 0.4, "steps": 3, "profile": ")" +
                     profile + "\""));
    };
    EXPECT_NEAR(valueAt(blended("union", "round"), centre), -0.1, 1e-15);
    EXPECT_NEAR(valueAt(blended("intersect", "round"), centre), 0.1, 1e-15);
    EXPECT_NEAR(valueAt(blended("union", "chamfer"), centre), -0.4 * std::sqrt(0.5), 1e-15);
    EXPECT_NEAR(valueAt(blended("union", "chamfer"), {0.2, 0.2, 0}), 0, 1e-15);
    int changes = 0;  // of the height on which the stairs' surface stands, seen along x
    double before = -1;
    for (int i = 1; i < 400; i++) {
        double height = 0.5;
        while (height > -0.01 && valueAt(blended("union", "stairs"), {i * 0.001, height, 0}) >= 0)
            height -= 0.01;
        if (before >= 0 && std::abs(height - before) > 0.05) changes++;
        before = height;
        i += 9;
    }
    EXPECT_EQ(changes, 3);
    // Colours: union takes the nearer, subtract keeps the first's.
    const std::string painted =
        ball + node("red", "material", R"("surface": {"from": "ball"}, "base_color": [1, 0, 0])") + "," +
        node("cube", "box", R"("half_extents": [2, 0.1, 0.1])") + "," +
        node("blue", "material", R"("surface": {"from": "cube"}, "base_color": [0, 0, 1])") + ",";
    const auto redAt = [&](const std::string& type, const Point& p) {
        const Program program =
            show(painted + node("it", type, R"("a": {"from": "red"}, "b": {"from": "blue"})"));
        return evaluate(program.ir, program.surface[baseColorComponent], {}, p);
    };
    EXPECT_EQ(redAt("union", {0, 1, 0}), 1);
    EXPECT_EQ(redAt("union", {2, 0, 0}), 0);
    EXPECT_EQ(redAt("subtract", {0.9, 0.1, 0}), 1);
    EXPECT_EQ(redAt("intersect", {0.5, 0.1, 0}), 0);
}

TEST(NodeValues, AGrooveIsCutAlongTheSeamOfEveryBoolean) {
    const std::string walls = node("x", "plane", R"("normal": [1, 0, 0])") + "," +
                              node("y", "plane", R"("normal": [0, 1, 0])") + ",";
    const auto joined = [&](const std::string& type, const std::string& blend) {
        return show(walls + node("it", type, R"("a": {"from": "x"}, "b": {"from": "y"})" + blend));
    };
    for (const char* type : {"union", "intersect", "subtract", "xor"}) {
        SCOPED_TRACE(type);
        const Program sharp = joined(type, ""), cut = joined(type, R"(, "radius": 0.4, "profile": "groove")");
        EXPECT_FALSE(cut.exactness.exact());
        EXPECT_NEAR(cut.exactness.lipschitz, std::sqrt(2.0), 1e-12);
        for (int i = 0; i < 64; ++i) {
            const double angle = (i + 0.5) * pi / 32, x = std::cos(angle), y = std::sin(angle);
            for (const double within : {1e-9, 0.1, 0.3999})
                EXPECT_GT(valueAt(cut, {within * x, within * y, 0}), 0);
            const Point on{0.4 * x, 0.4 * y, 3}, beyond{0.41 * x, 0.41 * y, -2};
            if (valueAt(sharp, on) < 0) { EXPECT_NEAR(valueAt(cut, on), 0, 1e-15); }
            EXPECT_EQ(valueAt(cut, beyond) < 0, valueAt(sharp, beyond) < 0) << beyond[0] << " " << beyond[1];
        }
    }
}

TEST(NodeValues, MathsAgreesWithTheLibrary) {
    const auto value = [](const std::string& inputs) { return valueAt(shape("math", inputs), {0, 0, 0}); };
    EXPECT_DOUBLE_EQ(value(R"("op": "modulo", "a": -0.25, "b": 1)"), 0.75);
    EXPECT_DOUBLE_EQ(value(R"("op": "fmod", "a": -0.25, "b": 1)"), -0.25);
    EXPECT_DOUBLE_EQ(value(R"("op": "power", "a": -2, "b": 3)"), -8);
    EXPECT_DOUBLE_EQ(value(R"("op": "power", "a": 2, "b": -2)"), 0.25);
    EXPECT_DOUBLE_EQ(value(R"("op": "power", "a": 2, "b": 0.5)"), std::sqrt(2));
    EXPECT_DOUBLE_EQ(value(R"("op": "divide", "a": 3, "b": 0)"), 0);
    EXPECT_DOUBLE_EQ(value(R"("op": "atan2", "a": 1, "b": -1)"), std::atan2(1, -1));
    EXPECT_DOUBLE_EQ(value(R"("op": "wrap", "a": 5.5, "b": 1, "c": 3)"), 1.5);
    EXPECT_DOUBLE_EQ(value(R"("op": "ping_pong", "a": 2.75, "b": 1)"), 0.75);
    EXPECT_DOUBLE_EQ(value(R"("op": "snap", "a": 2.75, "b": 0.5)"), 2.5);
    EXPECT_DOUBLE_EQ(value(R"("op": "clamp", "a": 5, "b": 1, "c": 3)"), 3);
    EXPECT_DOUBLE_EQ(value(R"("op": "smoothstep", "a": 1.5, "b": 1, "c": 2)"), 0.5);
    EXPECT_DOUBLE_EQ(value(R"("op": "tanh", "a": 0.5)"), std::tanh(0.5));
    const auto mapped = [](const std::string& inputs) {
        return valueAt(shape("map_range", inputs), {0, 0, 0});
    };
    EXPECT_DOUBLE_EQ(mapped(R"("value": 3, "from_min": 1, "from_max": 2, "to_min": 10, "to_max": 20)"), 30);
    EXPECT_DOUBLE_EQ(
        mapped(R"("value": 3, "from_min": 1, "from_max": 2, "to_min": 10, "to_max": 20, "clamped": true)"),
        20);
    EXPECT_DOUBLE_EQ(mapped(R"("value": 3, "from_min": 1, "from_max": 1)"), 1);
}

/// Copies about the y axis of a ball at (2, 0.2, 0.1), looked at one by one.
TEST(NodeValues, PolarRepeatIsTheUnionOfItsCopies) {
    const std::string aside =
        node("bead", "sphere", R"("radius": 0.3)") + "," +
        node("aside", "translate", R"("surface": {"from": "bead"}, "offset": [2, 0.2, 0.1])");
    for (int count = 1; count <= 12; ++count)
        for (const bool neighbours : {true, false}) {
            const Program program =
                show(aside + "," +
                     node("it", "polar_repeat",
                          R"("surface": {"from": "aside"}, "count": )" + std::to_string(count) +
                              (neighbours ? "" : R"(, "neighbours": false)")));
            for (int n = 0; n < 200; ++n) {
                const double at = 0.31 * n, radius = 0.05 * (n % 70);
                const Point p{radius * std::cos(at), 0.01 * n - 1.0, radius * std::sin(at)};
                double nearest = 1e9;
                for (int k = 0; k < count; ++k) {
                    // From +x towards -z, as a rotation about y goes.
                    const double turn = 2 * pi * k / count;
                    const double x = 2 * std::cos(turn) + 0.1 * std::sin(turn),
                                 z = 0.1 * std::cos(turn) - 2 * std::sin(turn);
                    nearest = std::min(nearest, std::hypot(p[0] - x, p[1] - 0.2, p[2] - z) - 0.3);
                }
                if (neighbours || nearest < 0.0)
                    EXPECT_NEAR(valueAt(program, p), nearest, 1e-9) << count << " copies, point " << n;
                else
                    EXPECT_GE(valueAt(program, p), nearest - 1e-9) << count << " copies, point " << n;
            }
        }
}

TEST(NodeValues, PolarRepeatOfAnyCountInCodeIsDefined) {
    for (const char* count : {"1", "5"}) {  // others are refused
        const Program program =
            show(R"({"id": "it", "type": "expression", "code": "return polar_repeat(sphere(p, 0.3), )" +
                 std::string(count) + R"();"})");
        EXPECT_NEAR(valueAt(program, {2, 0.5, 0.25}), std::hypot(2, 0.5, 0.25) - 0.3, 1e-12) << count;
    }
}

TEST(NodeValues, AnExtrudedSolidIsNotExact) {
    const auto extruded = [](const std::string& more) {
        return show(node("ball", "sphere", "") + "," + node("flat", "circle", "") + "," + more + "," +
                    node("it", "extrude", R"("surface": {"from": "moved"})"));
    };
    const Program solid =
        extruded(node("moved", "translate", R"("surface": {"from": "ball"}, "offset": [0, 0, 0.5])"));
    EXPECT_FALSE(solid.exactness.outside || solid.exactness.inside);
    EXPECT_TRUE(solid.exactness.bound());
    EXPECT_EQ(solid.spoiledBy, "it");
    // 1.062 where the slice of radius sqrt(3) / 2 is 1.134 away.
    EXPECT_NEAR(valueAt(solid, {2, 0, 0}), std::hypot(2, 0.5) - 1, 1e-12);
    EXPECT_TRUE(extruded(node("moved", "rotate", R"("surface": {"from": "flat"}, "angles": [0, 0, 40])"))
                    .exactness.exact());
    EXPECT_FALSE(extruded(node("moved", "rotate", R"("surface": {"from": "flat"}, "angles": [40, 0, 0])"))
                     .exactness.exact());
}

}  // namespace fw::node_values_test
