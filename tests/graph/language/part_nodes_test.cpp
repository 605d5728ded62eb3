// Threads against the standard's table, gears that turn in each other, springs along their helix, and what
// documents in other units make of them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <random>

#include "graph/compile/compile.h"
#include "graph/document/json.h"
#include "graph/evaluate/evaluate.h"
#include "graph/outlines/gear.h"

namespace fw::part_nodes_test {

constexpr double kTurn = 2 * std::numbers::pi;

/// The field of one node, of the last of several, or of code.
class Field {
  public:
    Field(const std::string& type, const std::string& inputs, const std::string& unit = "m")
        : Field(R"({"id": "n", "type": ")" + type + R"(", "inputs": {)" + inputs + "}}", unit, 0) {}
    /// `nodes`: their objects; what is shown is called n.
    static Field ofNodes(const std::string& nodes) { return {nodes, "m", 0}; }
    static Field ofCode(const std::string& code) {
        return {R"({"id": "n", "type": "expression", "code": ")" + code + "\"}", "m", 0};
    }
    double operator()(double x, double y, double z) const {
        const Point p{x, y, z};
        double value = 0;
        machine.evaluate(tape, std::span(&p, 1), std::span(&value, 1));
        return value;
    }

  private:
    Field(const std::string& nodes, const std::string& unit, int) {
        const Result<Graph> graph =
            parseGraph(R"({"fieldwright": 1, "unit": ")" + unit + R"(", "nodes": [)" + nodes +
                           R"(, {"id": "out", "type": "output", "inputs": {"surface": {"from": "n"}}}]})",
                       "part.field.json", nullptr);
        EXPECT_TRUE(graph) << format(graph.error());
        Result<Program> made = compile(*graph);
        EXPECT_TRUE(made) << format(made.error());
        if (!made) return;
        program = std::move(*made);
        tape = makeTape(program.ir, program.distance(), {});
    }
    Program program;
    Tape tape;
    mutable TapeMachine<double> machine;
};

/// Where the field leaves the solid, on the way out from the axis at a height and an angle.
double radiusAt(const Field& field, double y, double angle, double most) {
    double lo = 0, hi = most;
    for (int i = 0; i < 60; ++i) {
        const double r = 0.5 * (lo + hi);
        (field(r * std::sin(angle), y, r * std::cos(angle)) < 0 ? lo : hi) = r;
    }
    return lo;
}

TEST(Thread, HasTheDiametersOfTheStandard) {
    // ISO 724, of the coarse threads of ISO 261: nominal, pitch and minor diameter, and the pitch,
    // millimetres.
    struct Row {
        double major, middle, minor, pitch;
    };
    constexpr Row kTable[] = {
        {3, 2.675, 2.459, 0.5},     {4, 3.545, 3.242, 0.7},    {5, 4.480, 4.134, 0.8},
        {6, 5.350, 4.917, 1},       {8, 7.188, 6.647, 1.25},   {10, 9.026, 8.376, 1.5},
        {12, 10.863, 10.106, 1.75}, {14, 12.701, 11.835, 2},   {16, 14.701, 13.835, 2},
        {18, 16.376, 15.294, 2.5},  {20, 18.376, 17.294, 2.5}, {22, 20.376, 19.294, 2.5},
        {24, 22.051, 20.752, 3},    {27, 25.051, 23.752, 3},   {30, 27.727, 26.211, 3.5},
        {33, 30.727, 29.211, 3.5},  {36, 33.402, 31.670, 4},   {39, 36.402, 34.670, 4},
        {42, 39.077, 37.129, 4.5},  {45, 42.077, 40.129, 4.5}, {48, 44.752, 42.587, 5},
        {52, 48.752, 46.587, 5},    {56, 52.428, 50.046, 5.5}, {60, 56.428, 54.046, 5.5},
        {64, 60.103, 57.505, 6}};
    for (const Row& row : kTable) {
        const std::string name = "M" + std::to_string(int(row.major));
        SCOPED_TRACE(name);
        const Field field("thread", R"("size": ")" + name + R"(", "height": 100)", "mm");
        const double angle = 0.7;
        double most = 0, least = 1e9;
        int above = 0;
        constexpr int kSteps = 512;
        for (int i = 0; i < kSteps; ++i) {
            const double radius = radiusAt(field, row.pitch * i / kSteps, angle, row.major);
            most = std::max(most, radius), least = std::min(least, radius);
            above += radius > 0.5 * row.middle;  // at the pitch diameter ridge and groove are as wide
        }
        EXPECT_NEAR(2 * most, row.major, 0.01);
        EXPECT_NEAR(2 * least, row.minor, 0.01);
        EXPECT_NEAR(above, 0.5 * kSteps, 0.01 * kSteps);
        // A turn on it has risen by its pitch; the thread is right-handed.
        for (const double turn : {0.25, 0.5, 0.9})
            EXPECT_NEAR(radiusAt(field, 0.3 * row.pitch + turn * row.pitch, angle + turn * kTurn, row.major),
                        radiusAt(field, 0.3 * row.pitch, angle, row.major), 1e-6);
    }
    // In metres it is the same screw.
    const Field metres("thread", R"("size": "M8", "height": 0.1)");
    EXPECT_NEAR(radiusAt(metres, 0.3e-3, 0.7, 0.008),
                1e-3 * radiusAt(Field("thread", R"("size": "M8", "height": 100)", "mm"), 0.3, 0.7, 8), 1e-9);
}

TEST(Thread, FitIsPlayBetweenBoltAndNut) {
    const Field bolt("thread", R"("size": "M10", "height": 60, "fit": 0.1)", "mm"),
        nut("thread", R"("size": "M10", "height": 60, "kind": "nut", "fit": 0.2)", "mm");
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int i = 0; i < 20'000; ++i) {
        const double angle = 3.2 * unit(random), y = 20 * unit(random), r = 4.7 + 0.6 * unit(random);
        const double x = r * std::sin(angle), z = r * std::cos(angle);
        EXPECT_NEAR(bolt(x, y, z) - nut(x, y, z), 0.3, 1e-6);
    }
    // Chamfered: at its very end a bolt is as thick as its core.
    EXPECT_NEAR(radiusAt(bolt, 29.999, 1, 10), 0.5 * 8.376 - 0.1, 0.15);
}

TEST(Gear, TeethTurnInEachOtherWithoutMeeting) {
    for (const auto& [a, b] : {std::pair{20, 20}, {8, 30}, {12, 13}, {6, 6}, {17, 120}}) {
        SCOPED_TRACE(std::to_string(a) + " and " + std::to_string(b));
        const auto one = outlineOfGear({.module = 1, .teeth = a}),
                   other = outlineOfGear({.module = 1, .teeth = b});
        ASSERT_TRUE(one && other);
        double deepest = 1;
        for (int step = 0; step < 24; ++step) {
            const double turn = kTurn / a * step / 24, back = kTurn / 2 + kTurn / (2.0 * b) - turn * a / b;
            double close = 1;
            for (const Arc& arc : (*one)->arcs)
                for (const double share : {0.0, 0.5}) {
                    const glm::dvec2 p = placeOn(arc, share);
                    const glm::dvec2 q{std::cos(turn) * p.x - std::sin(turn) * p.y - 0.5 * (a + b),
                                       std::sin(turn) * p.x + std::cos(turn) * p.y};
                    if (glm::length(q) > 0.5 * b + 1.5) continue;
                    const double value = sampleOutline(**other, std::cos(back) * q.x + std::sin(back) * q.y,
                                                       std::cos(back) * q.y - std::sin(back) * q.x)
                                             .value;
                    close = std::min(close, value);
                }
            deepest = std::min(deepest, close);
            if (a > 10) { EXPECT_LT(close, 0.01) << "two teeth always touch"; }
        }
        EXPECT_GT(deepest, -3e-5) << "of a module";
    }
}

/// The area where a field is below 0 within a square, found by quarters of it: no value changes by more than
/// the way to it. `deepest` becomes the least value.
double areaInside(const Field& field, double x, double y, double half, double least, double& deepest) {
    const double value = field(x, y, 0);
    deepest = std::min(deepest, value);
    if (value > half * std::numbers::sqrt2) return 0;
    if (value < -half * std::numbers::sqrt2 || half < least) return value < 0 ? 4 * half * half : 0;
    double area = 0;
    for (const double dx : {-0.5, 0.5})
        for (const double dy : {-0.5, 0.5})
            area += areaInside(field, x + dx * half, y + dy * half, 0.5 * half, least, deepest);
    return area;
}

TEST(Gear, NodesThatTurnTogetherHaveNothingInCommon) {
    struct Pair {
        int a, b;
        double angle;
    };
    for (const Pair& pair : {Pair{12, 20, 20},
                             {20, 20, 20},
                             {17, 53, 20},
                             {18, 40, 14.5},
                             {32, 32, 14.5},
                             {10, 24, 25},
                             {8, 9, 30},
                             {13, 60, 17.5},
                             {5, 35, 20}}) {
        SCOPED_TRACE(std::to_string(pair.a) + " and " + std::to_string(pair.b) + " at " +
                     std::to_string(pair.angle));
        const auto gear = [&](const char* id, int teeth) {
            return R"({"id": ")" + std::string(id) +
                   R"(", "type": "gear", "inputs": {"module": 1, "teeth": )" + std::to_string(teeth) +
                   R"(, "pressure_angle": )" + std::to_string(pair.angle) + "}}, ";
        };
        const auto turned = [](const std::string& id, const std::string& what, double degrees) {
            return R"({"id": ")" + id + R"(", "type": "rotate", "inputs": {"surface": {"from": ")" + what +
                   R"("}, "angles": [0, 0, )" + std::to_string(degrees) + "]}}, ";
        };
        // A turn of the first: at every tooth another place of the mesh, so that all of a pitch is seen.
        const int steps = std::getenv("FIELDWRIGHT_LONG") ? 60 : 8;
        double deepest = 1, most = 0;
        for (int step = 0; step < steps; ++step) {
            const double turn = 360.0 * step / steps + 360.0 / pair.a * step / steps,
                         back = 180 + 180.0 / pair.b - turn * pair.a / pair.b;
            const Field common = Field::ofNodes(
                gear("a", pair.a) + gear("b", pair.b) + turned("one", "a", turn) +
                turned("other", "b", back) +
                R"({"id": "apart", "type": "translate", "inputs": {"surface": {"from": "other"}, "offset": [)" +
                std::to_string(0.5 * (pair.a + pair.b)) + R"(, 0, 0]}},
                       {"id": "n", "type": "intersect", "inputs": {"a": {"from": "one"}, "b": {"from": "apart"}}})");
            // Within two modules of the line through the centres both gears are; beyond five nothing meets.
            most = std::max(most, areaInside(common, 0.5 * pair.a, 0, 6, 2e-5, deepest));
        }
        EXPECT_GT(deepest, -3e-5) << "of a module";
        EXPECT_LT(most, 3e-5) << "of a module's square";
    }
}

TEST(Gear, IsNeverTakenForOneThatIsNearlyItsSize) {
    const auto one = outlineOfGear({.module = 1e-4}), other = outlineOfGear({.module = 1.00001e-4});
    ASSERT_TRUE(one && other);
    EXPECT_NEAR((*other)->hi.x / (*one)->hi.x, 1.00001, 1e-8);
}

TEST(Gear, HasItsDiametersAndItsBacklash) {
    const auto gear = outlineOfGear({.module = 2, .teeth = 24}),
               loose = outlineOfGear({.module = 2, .teeth = 24, .backlash = 0.1});
    ASSERT_TRUE(gear && loose);
    double most = 0, least = 1e9;
    for (const Arc& arc : (*gear)->arcs)
        most = std::max(most, glm::length(arc.a)), least = std::min(least, glm::length(arc.a));
    EXPECT_NEAR(most, 26, 1e-4);
    EXPECT_NEAR(least, 24 - 2.5, 1e-4);
    const auto thickness = [](const Outline& outline) {  // along the pitch circle, over all teeth
        int inside = 0;
        for (int i = 0; i < 48'000; ++i) {
            const double angle = kTurn * i / 48'000;
            inside += sampleOutline(outline, 24 * std::cos(angle), 24 * std::sin(angle)).value < 0;
        }
        return inside / 48'000.0 * kTurn * 24 / 24;
    };
    EXPECT_NEAR(thickness(**gear), std::numbers::pi, 0.01);
    EXPECT_NEAR(thickness(**loose), std::numbers::pi - 0.1, 0.01);
    const auto thin = outlineOfGear({.module = 2, .teeth = 24, .backlash = 1e3});
    ASSERT_TRUE(thin);
    EXPECT_GT(thickness(**thin), 0.2) << "a tooth is left";
}

TEST(Spring, FollowsItsHelixAndEndsRound) {
    const Field spring("spring", R"("radius": 0.5, "pitch": 0.3, "turns": 2.6, "wire": 0.05)");
    for (double t = -1.3; t <= 1.3; t += 0.01) {
        const double x = 0.5 * std::sin(t * kTurn), z = 0.5 * std::cos(t * kTurn), y = 0.3 * t;
        EXPECT_NEAR(spring(x, y, z), -0.05, 1e-6);
        EXPECT_NEAR(spring(1.06 * x, y, 1.06 * z), 0.03 - 0.05, 2e-3);
    }
    const double past = 1.3 + 0.05;
    EXPECT_GT(spring(0.5 * std::sin(past * kTurn), 0.3 * past, 0.5 * std::cos(past * kTurn)), 0);
    EXPECT_GT(spring(0, 0, 0), 0.4);
    EXPECT_NEAR(spring(0, 10, 0), 10, 0.7);
}

TEST(Revolve, GoesAsFarRoundAsItIsAsked) {
    const Field half = Field::ofCode("return revolve(circle(p, 0.25), 1, 90);");
    EXPECT_LT(half(1, 0, 0), 0);
    EXPECT_LT(half(std::cos(0.7), 0, std::sin(0.7)), 0);
    EXPECT_GT(half(std::cos(0.9), 0, std::sin(0.9)), 0);
    EXPECT_GT(half(-1, 0, 0), 0);
}

TEST(Drawings, AreAsLargeAsTheirFilesInTheDocumentsUnit) {
    // The washer that stands for no file has a unit of 1 m.
    const Field metres("svg_file", R"("size": 0)"), millimetres("svg_file", R"("size": 0)", "mm");
    EXPECT_NEAR(metres(2, 0, 0), 1.5, 1e-6);
    EXPECT_NEAR(millimetres(2000, 0, 0), 1500, 1e-3);
}

}  // namespace fw::part_nodes_test
