// Rounds of a given radius, distances that are measured on a grid, and what is made even by them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "graph/check/check.h"
#include "graph/compile/compile.h"
#include "graph/document/json.h"
#include "graph/evaluate/evaluate.h"

namespace fw::walls_test {

Graph graphOf(const std::string& nodes, const std::string& shown) {
    Result<Graph> graph = parseGraph(
        R"({"fieldwright": 1, "nodes": [)" + nodes +
            R"(, {"id": "out", "type": "output", "inputs": {"surface": {"from": ")" + shown + R"("}}}]})",
        "walls.field.json", nullptr);
    EXPECT_TRUE(graph) << format(graph.error());
    return graph ? std::move(*graph) : Graph();
}
Program programOf(const std::string& nodes, const std::string& shown) {
    Result<Program> made = compile(graphOf(nodes, shown));
    EXPECT_TRUE(made) << format(made.error());
    return made ? std::move(*made) : Program();
}
/// What is shown, whose tape is made once.
class Field {
  public:
    Field(const std::string& nodes, const std::string& shown)
        : program(programOf(nodes, shown)), tape(makeTape(program.ir, program.distance(), {})) {}
    double cell() const { return program.ir.volumes().back()->grid.cell; }
    double operator()(const Point& p) {
        double value = 0;
        machine.evaluate(tape, std::span(&p, 1), std::span(&value, 1));
        return value;
    }

  private:
    Program program;
    Tape tape;
    TapeMachine<double> machine;
};

/// Two half-spaces whose faces meet along z, with so many degrees between them inside their union's corner.
std::string faces(double degrees) {
    // The solids lie below y = 0, and below the plane that is turned up from it by 180 - degrees.
    const double tilt = std::numbers::pi * (180 - degrees) / 180;
    return R"({"id": "a", "type": "plane", "inputs": {"normal": [0, 1, 0]}},
              {"id": "b", "type": "plane", "inputs": {"normal": [)" +
           std::to_string(-std::sin(tilt)) + ", " + std::to_string(std::cos(tilt)) + ", 0]}}, ";
}

TEST(ExactRound, HasItsRadiusAtAllAngles) {
    const double radius = 0.2;
    for (double degrees = 30; degrees <= 150; degrees += 15) {
        SCOPED_TRACE(degrees);
        const double half = 0.5 * std::numbers::pi * degrees / 180;
        // Outside of both, in the corner between their faces; the ball's middle is on its bisector.
        const double tilt = std::numbers::pi * (180 - degrees) / 180;
        const std::array<double, 2> m = {0, 1}, n = {-std::sin(tilt), std::cos(tilt)};
        const double c = m[0] * n[0] + m[1] * n[1], s = radius / (1 + c);
        const Point middle = {s * (m[0] + n[0]), s * (m[1] + n[1]), 0.3};
        ASSERT_NEAR(std::hypot(middle[0], middle[1]), radius / std::sin(half), 1e-9);
        for (const auto& [type, sign] : {std::pair("union", 1.0), {"intersect", -1.0}}) {
            Field program(
                faces(degrees) + R"({"id": "u", "type": ")" + type +
                    R"(", "inputs": {"a": {"from": "a"}, "b": {"from": "b"}, "radius": 0.2, "profile": "exact"}})",
                "u");
            // Of an intersection the middle is inside, opposite.
            const Point centre = {sign * middle[0], sign * middle[1], middle[2]};
            // On the round, between the places where it touches the faces.
            const double width = std::numbers::pi - 2 * half;
            for (int i = -5; i <= 5; ++i) {
                const double turned = 0.09 * i * width;
                const double toCorner = std::atan2(-centre[1], -centre[0]) + turned;
                const Point on = {centre[0] + radius * std::cos(toCorner),
                                  centre[1] + radius * std::sin(toCorner), 0.1};
                EXPECT_NEAR(program(on), 0.0, 0.002 * radius) << type << ' ' << i;
                const Point before = {centre[0] + 0.5 * radius * std::cos(toCorner),
                                      centre[1] + 0.5 * radius * std::sin(toCorner), 0.1};
                EXPECT_NEAR(program(before), sign * 0.5 * radius, 0.002 * radius) << type << ' ' << i;
            }
            // The faces beyond are what they were.
            EXPECT_NEAR(program({-sign * (3.0 / std::tan(half) + 1), 0, 0}), 0.0, 1e-9) << type;
        }
    }
}

TEST(ExactRound, OfAHoleInABoxIsACircle) {
    // A round bore through a plate: in a section through its axis the round of the rim is a circle.
    Field program(R"(
        {"id": "plate", "type": "box", "inputs": {"half_extents": [1, 0.3, 1]}},
        {"id": "bore", "type": "cylinder", "inputs": {"radius": 0.3, "half_height": 2}},
        {"id": "cut", "type": "subtract", "inputs": {"a": {"from": "plate"}, "b": {"from": "bore"},
            "radius": 0.1, "profile": "exact"}})",
                  "cut");
    for (double around = 0; around < 6; around += 0.7)
        for (double angle = 0.1; angle < 1.5; angle += 0.2) {
            const double r = 0.4 - 0.1 * std::cos(angle), y = 0.2 + 0.1 * std::sin(angle);
            EXPECT_NEAR(program({r * std::cos(around), y, r * std::sin(around)}), 0.0, 0.001)
                << around << ' ' << angle;
        }
}

double boxDistance(const Point& p, const Point& half) {
    double outside = 0, inside = -1e9;
    for (std::size_t i = 0; i < 3; ++i) {
        const double q = std::abs(p[i]) - half[i];
        outside += std::max(q, 0.0) * std::max(q, 0.0);
        inside = std::max(inside, q);
    }
    return inside > 0 ? std::sqrt(outside) : inside;
}

TEST(TrueDistance, OfWhatHasNoneIsThatOfTheSolid) {
    // A box whose values are three times too steep, and grow unevenly.
    Field program(R"(
        {"id": "bad", "type": "expression", "code":
            "q = abs(p) - vec3(0.5, 0.3, 0.4); d = max(q.x, q.y, q.z); return d * (3.0 + sin(9.0 * p.x));"},
        {"id": "t", "type": "true_distance", "inputs": {"surface": {"from": "bad"}, "resolution": 64, "margin": 0.2}})",
                  "t");
    const double cell = program.cell();
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> along(-0.65, 0.65);
    double worst = 0, sum = 0;
    int count = 0;
    for (int i = 0; i < 20000; ++i) {
        const Point p = {along(random), along(random) * 0.7, along(random) * 0.85};
        const double off = std::abs(program(p) - boxDistance(p, {0.5, 0.3, 0.4}));
        worst = std::max(worst, off), sum += off, ++count;
    }
    EXPECT_LT(worst, 0.5 * cell);
    EXPECT_LT(sum / count, 0.02 * cell);
}

TEST(TrueDistance, IsEvenForWhatIsBentAndTwisted) {
    const std::string bent = R"(
        {"id": "box", "type": "box", "inputs": {"half_extents": [0.8, 0.25, 0.3]}},
        {"id": "twisted", "type": "twist", "inputs": {"surface": {"from": "box"}, "rate": 60}},
        {"id": "bent", "type": "bend", "inputs": {"surface": {"from": "twisted"}, "rate": 50}})";
    Field field(bent, "bent");
    Field measured(bent + R"(, {"id": "t", "type": "true_distance", "inputs": {"surface": {"from": "bent"},
            "resolution": 128, "margin": 0.15}})",
                   "t");
    // A ball of that radius about a place touches the surface: a smaller one does not, a larger one does.
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> along(-1, 1);
    const auto crosses = [&](const Point& p, double radius) {
        const bool inside = field(p) < 0;
        for (int n = 0; n < 6000; ++n) {
            const Point way = {along(random), along(random), along(random)};
            const double size = std::hypot(way[0], way[1], way[2]);
            Point on;
            for (std::size_t k = 0; k < 3; ++k) on[k] = p[k] + way[k] / size * radius;
            if (size <= 1 && (field(on) < 0) != inside) return true;
        }
        return false;
    };
    const double cell = measured.cell();
    int tried = 0, off = 0;
    while (tried < 100) {
        const Point p = {along(random), along(random), 0.4 * along(random)};
        const double found = measured(p);
        if (std::abs(found) > 0.12 || std::abs(found) < 0.04) continue;
        ++tried;
        EXPECT_EQ(found < 0, field(p) < 0);
        off += crosses(p, 0.98 * std::abs(found)) || !crosses(p, 1.02 * std::abs(found));
        // Beside a crease of the distance what is between samples is rounded off.
        EXPECT_FALSE(crosses(p, std::abs(found) - 0.3 * cell))
            << found << " at " << p[0] << ' ' << p[1] << ' ' << p[2];
        EXPECT_TRUE(crosses(p, std::abs(found) + 0.9 * cell))
            << found << " at " << p[0] << ' ' << p[1] << ' ' << p[2];
    }
    EXPECT_LE(off, 6);
}

TEST(TrueDistance, OtherPartsMayBeLive) {
    const Graph graph = graphOf(
        R"({"id": "moving", "type": "sphere", "inputs": {"radius": 2}},
        {"id": "s", "type": "expression", "code": "return 3.0 * length(p) - 0.123456;"},
        {"id": "t", "type": "true_distance", "inputs": {"surface": {"from": "s"}, "resolution": 16}},
        {"id": "u", "type": "union", "inputs": {"a": {"from": "t"}, "b": {"from": "moving"}}})",
        "u");
    const Result<Program> program = compile(graph, {.live = {"moving.radius"}});
    ASSERT_TRUE(program) << format(program.error());
    EXPECT_EQ(program->live.size(), 1u);
}

TEST(TrueDistance, IsCancelled) {
    const Graph graph = graphOf(
        R"({"id": "s", "type": "expression", "code": "return 3.0 * length(p) - 0.987654;"},
        {"id": "t", "type": "true_distance", "inputs": {"surface": {"from": "s"}, "resolution": 16}})",
        "t");
    std::stop_source stop;
    stop.request_stop();
    const Result<Program> cancelled = compile(graph, {.stop = stop.get_token()});
    ASSERT_FALSE(cancelled);
    EXPECT_EQ(cancelled.error().code, Error::Code::cancelled);
    EXPECT_TRUE(compile(graph));
}

TEST(TrueDistance, SaysWhatItCannotMeasure) {
    const auto messageOf = [](const std::string& nodes, const std::string& shown,
                              const CompileOptions& options = {}) {
        const Result<Program> made = compile(graphOf(nodes, shown), options);
        return made ? std::string() : format(made.error());
    };
    EXPECT_NE(messageOf(R"({"id": "l", "type": "lattice"},
        {"id": "t", "type": "true_distance", "inputs": {"surface": {"from": "l"}}})",
                        "t")
                  .find("is unbounded, so its distances cannot be measured"),
              std::string::npos);
    const std::string moving =
        R"({"id": "s", "type": "expression", "code": "return length(p) * 2.0 - 1.0 - 0.1 * sin(time);"},
        {"id": "t", "type": "true_distance", "inputs": {"surface": {"from": "s"}, "resolution": 16}})";
    EXPECT_EQ(messageOf(moving, "t"), "");
    EXPECT_NE(messageOf(moving, "t", {.live = {"time"}}).find("'time', which moves"), std::string::npos);
    EXPECT_EQ(messageOf(R"({"id": "s", "type": "expression", "code": "return 2.0 + length(p);"},
        {"id": "t", "type": "true_distance", "inputs": {"surface": {"from": "s"}}})",
                        "t"),
              "")
        << "nothing is as far away as it says";
}

TEST(Walls, ThatWouldBeUnevenAreWarnedOf) {
    const std::string twisted = R"({"id": "box", "type": "box"},
        {"id": "twisted", "type": "twist", "inputs": {"surface": {"from": "box"}}}, )";
    const std::string shell = R"({"id": "wall", "type": "shell", "inputs": {"surface": {"from": ")";
    const auto warnings = [](const Graph& graph) {
        std::string all;
        for (const Error& finding : check(graph)) all += format(finding) + "\n";
        return all;
    };
    const std::string found = warnings(graphOf(twisted + shell + "twisted\"}}}", "wall"));
    EXPECT_NE(found.find("node 'wall', input 'surface'"), std::string::npos) << found;
    EXPECT_NE(found.find("behind node 'twisted'"), std::string::npos) << found;
    EXPECT_EQ(
        warnings(graphOf(
            twisted +
                R"({"id": "t", "type": "true_distance", "inputs": {"surface": {"from": "twisted"}}}, )" +
                shell + "t\"}}}",
            "wall")),
        "");
    EXPECT_EQ(warnings(graphOf(R"({"id": "box", "type": "box"}, )" + shell + "box\"}}}", "wall")), "");
}

TEST(RoundEdges, RollABallAlongThem) {
    // Of a box made of half-spaces, by what a box with rounded edges is.
    Field round(R"({"id": "box", "type": "box", "inputs": {"half_extents": [0.5, 0.4, 0.3]}},
        {"id": "r", "type": "round_edges", "inputs": {"surface": {"from": "box"}, "radius": 0.1, "resolution": 72}})",
                "r");
    const double cell = round.cell();
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> along(-1, 1);
    for (int i = 0; i < 4000; ++i) {
        // A place on the round box: in a random direction from a random place of the box within.
        Point way = {along(random), along(random), along(random)};
        const double size = std::hypot(way[0], way[1], way[2]);
        if (size < 0.1 || size > 1) continue;
        Point p;
        for (std::size_t k = 0; k < 3; ++k)
            p[k] = std::copysign((k == 0 ? 0.4 : k == 1 ? 0.3 : 0.2) + 0.1 * std::abs(way[k]) / size, way[k]);
        EXPECT_NEAR(round(p), 0.0, 0.12 * cell) << p[0] << ' ' << p[1] << ' ' << p[2];
    }
    // An inner edge: of an L, filled by the ball's round.
    Field inner(R"(
        {"id": "a", "type": "box", "inputs": {"half_extents": [0.5, 0.1, 0.3]}},
        {"id": "b", "type": "box", "inputs": {"half_extents": [0.1, 0.5, 0.3]}},
        {"id": "m", "type": "translate", "inputs": {"surface": {"from": "b"}, "offset": [0, 0.4, 0]}},
        {"id": "u", "type": "union", "inputs": {"a": {"from": "a"}, "b": {"from": "m"}}},
        {"id": "r", "type": "round_edges", "inputs": {"surface": {"from": "u"}, "radius": 0.15, "edges": "inner", "resolution": 96}})",
                "r");
    for (double angle = 0.05; angle < 1.5; angle += 0.1)
        EXPECT_NEAR(inner({0.25 - 0.15 * std::cos(angle), 0.25 - 0.15 * std::sin(angle), 0.05}), 0.0, 0.003)
            << angle;
    EXPECT_NEAR(inner({0.5, 0.1, 0.3}), 0.0, 0.005) << "outer corners stay";
}

TEST(RoundEdges, ThatLeaveNothingSaySo) {
    const Result<Program> made =
        compile(graphOf(R"({"id": "box", "type": "box", "inputs": {"half_extents": [1, 1, 0.05]}},
        {"id": "r", "type": "round_edges", "inputs": {"surface": {"from": "box"}, "radius": 0.1}})",
                        "r"));
    ASSERT_FALSE(made);
    EXPECT_NE(format(made.error()).find("node 'r', input 'radius': leaves nothing"), std::string::npos)
        << format(made.error());
}

TEST(ChamferEdges, CutThemFlat) {
    // A box turned askew, so that its edges run between the grid's samples.
    Field cut(R"({"id": "box", "type": "box", "inputs": {"half_extents": [0.5, 0.4, 0.3]}},
        {"id": "turned", "type": "rotate", "inputs": {"surface": {"from": "box"}, "angles": [0, 0, 20]}},
        {"id": "c", "type": "chamfer_edges", "inputs": {"surface": {"from": "turned"}, "size": 0.1, "resolution": 96}})",
              "c");
    const double cell = cut.cell(), turn = 20 * std::numbers::pi / 180;
    const auto at = [&](double x, double y, double z) {
        return cut({std::cos(turn) * x - std::sin(turn) * y, std::sin(turn) * x + std::cos(turn) * y, z});
    };
    std::mt19937_64 random(6);
    std::uniform_real_distribution<double> part(0.2, 0.8), along(-0.15, 0.15);
    for (int i = 0; i < 500; ++i) {
        const double t = part(random), s = along(random), sx = i & 1 ? 1 : -1, sy = i & 2 ? 1 : -1;
        EXPECT_NEAR(at(sx * (0.5 - 0.1 * t), sy * (0.4 - 0.1 * (1 - t)), s), 0.0, 0.15 * cell) << i;
        EXPECT_NEAR(at(sx * (0.5 - 0.1 * t), s, sy * (0.3 - 0.1 * (1 - t))), 0.0, 0.15 * cell) << i;
        EXPECT_NEAR(at(s, sx * (0.4 - 0.1 * t), sy * (0.3 - 0.1 * (1 - t))), 0.0, 0.15 * cell) << i;
        EXPECT_NEAR(at(sx * 0.5, s, s), 0.0, 0.1 * cell) << "faces stay";
    }
    EXPECT_NEAR(at(0.5, 0.4, 0.0), 0.1 / std::numbers::sqrt2, 1.0 * cell);
}

TEST(ChamferEdges, LeaveThoseThatRunInwards) {
    Field cut(R"(
        {"id": "a", "type": "box", "inputs": {"half_extents": [0.5, 0.1, 0.3]}},
        {"id": "b", "type": "box", "inputs": {"half_extents": [0.1, 0.5, 0.3]}},
        {"id": "m", "type": "translate", "inputs": {"surface": {"from": "b"}, "offset": [0, 0.4, 0]}},
        {"id": "u", "type": "union", "inputs": {"a": {"from": "a"}, "b": {"from": "m"}}},
        {"id": "c", "type": "chamfer_edges", "inputs": {"surface": {"from": "u"}, "size": 0.06, "resolution": 80}})",
              "c");
    const double cell = cut.cell();
    for (double t = 0.1; t < 0.95; t += 0.1) {
        EXPECT_NEAR(cut({0.5 - 0.06 * t, 0.1 - 0.06 * (1 - t), 0.05}), 0.0, 0.15 * cell) << t;
        EXPECT_NEAR(cut({0.1, 0.1 + 0.03 * t, 0.05}), 0.0, 0.15 * cell) << t;
        EXPECT_LT(cut({0.09 - 0.1 * t, 0.09 - 0.1 * t, 0.05}), -0.3 * cell) << "nothing behind it is cut";
    }
}

TEST(ChamferEdges, OfAnySizeLeaveDistances) {
    for (const char* size : {"1e-9", "3", "1e12"}) {
        Field cut(R"({"id": "box", "type": "box", "inputs": {"half_extents": [0.5, 0.4, 0.3]}},
            {"id": "c", "type": "chamfer_edges", "inputs": {"surface": {"from": "box"}, "resolution": 24, "size": )" +
                      std::string(size) + "}}",
                  "c");
        EXPECT_GT(cut({1, 1, 1}), 0.5) << size;
        EXPECT_TRUE(std::isfinite(cut({0, 0, 0}))) << size;
    }
}

/// The rim of a bored cylinder, whose faces are bent: the cut is a cone.
TEST(ChamferEdges, OfRoundFacesAreCones) {
    Field cut(R"({"id": "rod", "type": "cylinder", "inputs": {"radius": 0.5, "half_height": 0.3}},
        {"id": "bore", "type": "infinite_cylinder", "inputs": {"radius": 0.25}},
        {"id": "s", "type": "subtract", "inputs": {"a": {"from": "rod"}, "b": {"from": "bore"}}},
        {"id": "c", "type": "chamfer_edges", "inputs": {"surface": {"from": "s"}, "size": 0.08, "resolution": 96}})",
              "c");
    const double cell = cut.cell();
    for (double angle = 0; angle < 6.2; angle += 0.3)
        for (double t = 0.15; t < 0.9; t += 0.1) {
            const auto at = [&](double r, double y) {
                return cut({r * std::cos(angle), y, r * std::sin(angle)});
            };
            EXPECT_NEAR(at(0.5 - 0.08 * t, 0.3 - 0.08 * (1 - t)), 0.0, 0.25 * cell) << angle << ' ' << t;
            EXPECT_NEAR(at(0.25 + 0.08 * t, 0.3 - 0.08 * (1 - t)), 0.0, 0.4 * cell) << angle << ' ' << t;
            EXPECT_NEAR(at(0.5, 0.2 * (t - 0.5)), 0.0, 0.1 * cell) << "a round face stays";
            EXPECT_NEAR(at(0.25, 0.2 * (t - 0.5)), 0.0, 0.1 * cell) << "a bore stays";
        }
}

}  // namespace fw::walls_test
