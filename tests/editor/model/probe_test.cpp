// What the probe reads at a point, what a line through a field crosses, and what is measured.
#include "editor/probe/probe.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "graph/compile/compile.h"
#include "graph/evaluate/gradients.h"
#include "tests/support/editor/graphs.h"

namespace fw::editor::test::probe_test {

const LengthUnit &metre = *lengthUnit("m"), &mm = *lengthUnit("mm");

Seen seenOf(Graph graph) {
    Seen seen{.graph = std::make_shared<const Graph>(std::move(graph)), .region = {{-3, -3, -3}, {3, 3, 3}}};
    seen.camera = {.position = {0, 0, 9}, .target = {0, 0, 0}, .fov = 45};
    return seen;
}

std::vector<Reading> readingsAt(const Seen& seen, const Point& point, const std::string& scope = "") {
    ScopeFields fields;
    EXPECT_EQ(fields.take(seen, scope), "");
    return fields.at(point);
}

const Reading* of(const std::vector<Reading>& readings, const std::string& node,
                  const std::string& output = {}) {
    for (const Reading& reading : readings)
        if (reading.node == node && (output.empty() || reading.output == output)) return &reading;
    return nullptr;
}

Reading at(const Seen& seen, const Point& point, const std::string& node, const std::string& scope = "") {
    const std::vector<Reading> readings = readingsAt(seen, point, scope);
    const Reading* reading = of(readings, node);
    return reading ? *reading : Reading{};
}

Tape tapeOf(const Graph& graph) {
    const Result<fw::Program> program = compile(graph, {});
    EXPECT_TRUE(program);
    return makeTape(program->ir, program->distance(), {});
}

const char* const kTwo = R"(
  {"id": "ball", "type": "sphere", "inputs": {"radius": 0.5}},
  {"id": "box", "type": "box", "inputs": {"half_extents": [0.5, 0.5, 0.5]}},
  {"id": "right", "type": "translate", "inputs": {"surface": {"from": "box"}, "offset": {"from": "off"}}},
  {"id": "off", "type": "vector_math", "inputs": {"op": "subtract", "a": [2, 0, 0], "b": {"from": "none"}}},
  {"id": "none", "type": "vector_math", "inputs": {"op": "subtract", "a": {"from": "place"}, "b": {"from": "place"}}},
  {"id": "red", "type": "material", "inputs": {"surface": {"from": "ball"}, "base_color": {"from": "ink"}}},
  {"id": "ink", "type": "color", "inputs": {"value": [0.9, 0.25, 0.1]}},
  {"id": "place", "type": "position"},
  {"id": "size", "type": "value", "inputs": {"value": 3}},
  {"id": "grown", "type": "scale", "inputs": {"surface": {"from": "red"}, "factor": {"from": "size"}}},
  {"id": "small", "type": "scale", "inputs": {"surface": {"from": "grown"}, "factor": 0.3333333333333333}},
  {"id": "both", "type": "union", "inputs": {"a": {"from": "small"}, "b": {"from": "right"}}},
  {"id": "alone", "type": "sphere"},
  {"id": "out", "type": "output", "inputs": {"surface": {"from": "both"}}})";

TEST(Probe, ReadsEveryWireAtAPoint) {
    const Seen seen = seenOf(graphOf(kTwo));
    const std::vector<Reading> readings = readingsAt(seen, {0.3, 0.4, 1.2});
    const auto number = [&](const char* node, std::size_t i = 0) {
        const Reading* reading = of(readings, node);
        return reading && i < reading->numbers.size() ? reading->numbers[i] : NAN;
    };
    EXPECT_DOUBLE_EQ(number("ball"), 0.8) << "1.3 m from the middle of a ball of 0.5";
    EXPECT_DOUBLE_EQ(number("place", 0), 0.3);
    EXPECT_DOUBLE_EQ(number("place", 2), 1.2);
    EXPECT_EQ(of(readings, "place")->type, Type::vec3);
    EXPECT_DOUBLE_EQ(number("size"), 3.0);
    EXPECT_DOUBLE_EQ(number("ink", 1), 0.25);
    EXPECT_DOUBLE_EQ((*of(readings, "red")->color)[0], 0.9);
    EXPECT_DOUBLE_EQ((*of(readings, "red")->color)[2], 0.1);
    EXPECT_NEAR(of(readings, "ball")->slope, 1.0, 1e-12);
    EXPECT_EQ(of(readings, "size")->slope, 0.0);
    EXPECT_EQ(of(readings, "both")->part, "a");
    EXPECT_FALSE(of(readings, "alone")) << "the output does not need it";
    // The box is nearer to a point beside it; the whole is what fieldwright eval prints.
    const Reading near = at(seen, {1.3, 0.1, 0.0}, "both");
    EXPECT_EQ(near.part, "b");
    EXPECT_NEAR(near.numbers[0], 0.2, 1e-12);
    const Result<fw::Program> program = compile(*seen.graph);
    ASSERT_TRUE(program);
    for (const Point& p : {Point{0.3, 0.4, 1.2}, {1.3, 0.1, 0}, {-1, 0.7, 0.2}, {2, 0, 0}})
        EXPECT_NEAR(at(seen, p, "out").numbers.at(0), evaluate(program->ir, program->distance(), {}, p),
                    1e-15);
}

TEST(Probe, ColoursAreKnownByWhereTheyGo) {
    const Seen seen = seenOf(graphOf(kTwo));
    const Boxes boxes(*seen.graph, "");
    const CanvasValues values = valuesOf(boxes, readingsAt(seen, {1, 0, 0}), metre);
    ASSERT_TRUE(values.contains("ink"));
    ASSERT_TRUE(values.at("ink")[0].color);
    EXPECT_DOUBLE_EQ((*values.at("ink")[0].color)[1], 0.25);
    EXPECT_FALSE(values.at("place")[0].color) << "a place is no colour";
    EXPECT_EQ(values.at("ball")[0].words, "0.5 m");
    EXPECT_EQ(values.at("size")[0].words, "3");
    EXPECT_EQ(values.at("place")[0].words, "(1, 0, 0)");
    EXPECT_FALSE(values.contains("out")) << "it has no output";
    EXPECT_FALSE(values.contains("alone"));
}

TEST(Probe, WhatHasNoFieldHasNoValue) {
    const Seen seen = seenOf(graphOf(R"(
      {"id": "ball", "type": "sphere", "inputs": {"radius": 0.5}},
      {"id": "muted", "type": "offset", "muted": true, "inputs": {"surface": {"from": "ball"}, "distance": 1}},
      {"id": "mesh", "type": "polygonize", "inputs": {"surface": {"from": "muted"}}},
      {"id": "out", "type": "output", "inputs": {"mesh": {"from": "mesh"}}})"));
    const std::vector<Reading> readings = readingsAt(seen, {1, 0, 0});
    ASSERT_TRUE(of(readings, "ball"));
    EXPECT_EQ(of(readings, "ball")->numbers, std::vector{0.5});
    for (const char* node : {"muted", "mesh", "out"}) EXPECT_FALSE(of(readings, node)) << node;
    ScopeFields fields;
    const std::string without = fields.take(seenOf(graphOf(R"({"id": "a", "type": "sphere"})")), "");
    EXPECT_NE(without.find("output"), std::string::npos) << without;
    EXPECT_EQ(
        fields.take(seenOf(graphOf(R"({"id": "a", "type": "sphere"}, {"id": "out", "type": "output"},
      {"id": "idle", "type": "group", "group": "g"})",
                                   R"(, "groups": [{"id": "g", "outputs": [{"name": "s", "type": "surface"}],
      "nodes": [{"id": "b", "type": "sphere"},
                {"id": "end", "type": "group_output", "inputs": {"s": {"from": "b"}}}]}])")),
                    "g"),
        "Nothing here leads to the output.");
}

TEST(Probe, GroupsAreReadInTheirFirstInstance) {
    const Seen seen = seenOf(graphOf(R"(
      {"id": "one", "type": "group", "group": "pair", "inputs": {"r": 0.25}},
      {"id": "two", "type": "group", "group": "pair", "inputs": {"r": 0.75}},
      {"id": "both", "type": "union", "inputs": {"a": {"from": "one"}, "b": {"from": "two"}}},
      {"id": "out", "type": "output", "inputs": {"surface": {"from": "both"}}})",
                                     R"(, "groups": [{"id": "pair",
      "inputs": [{"name": "r", "type": "float"}], "outputs": [{"name": "surface", "type": "surface"}], "nodes": [
      {"id": "in", "type": "group_input"},
      {"id": "ball", "type": "sphere", "inputs": {"radius": {"from": "in", "output": "r"}}},
      {"id": "end", "type": "group_output", "inputs": {"surface": {"from": "ball"}}}]}])"));
    EXPECT_EQ(at(seen, {1, 0, 0}, "ball", "pair").numbers, std::vector{0.75});
    EXPECT_EQ(at(seen, {1, 0, 0}, "in", "pair").numbers, std::vector{0.25});
    EXPECT_EQ(at(seen, {1, 0, 0}, "two").numbers, std::vector{0.25});
    ScopeFields fields;
    EXPECT_EQ(fields.take(seen, "none"), "The group has no instance.");
}

TEST(Probe, ReadsAtTheTimeShown) {
    Seen seen = seenOf(graphOf(R"(
      {"id": "ball", "type": "sphere", "inputs": {"radius": 0.5}},
      {"id": "out", "type": "output", "inputs": {"surface": {"from": "ball"}}})",
                               R"(, "timeline": {"length": 2, "tracks": [{"node": "ball", "input": "radius",
      "keys": [{"time": 0, "value": 1}, {"time": 2, "value": 2}]}]})"));
    ScopeFields fields;
    for (const double seconds : {0.0, 0.5, 1.5}) {
        seen.seconds = seconds;
        EXPECT_EQ(fields.take(seen, ""), "");
        EXPECT_NEAR(of(fields.at({3, 0, 0}), "ball")->numbers[0], 2.0 - 0.5 * seconds, 1e-12);
    }
}

TEST(Probe, GradientsOfAllAreThoseOfEach) {
    const Result<fw::Program> program = compile(graphOf(kTwo));
    ASSERT_TRUE(program);
    const std::vector<IrId> roots(program->surface.begin(), program->surface.end());
    for (const Point& p : {Point{0.3, 0.4, 1.2}, {1.3, 0.1, 0.2}, {2.7, 0.7, 0.9}}) {
        const std::vector<ValueGradient> all = evaluateGradients(program->ir, roots, {}, p);
        for (std::size_t i = 0; i < roots.size(); ++i) {
            ValueGradient one{};
            evaluateGradient(program->ir, roots[i], {}, std::span(&p, 1), std::span(&one, 1));
            EXPECT_EQ(all[i].value, one.value);
            EXPECT_EQ(all[i].gradient, one.gradient);
        }
    }
}

TEST(Probe, AnswersWhatIsWished) {
    ProbeWork work;
    ProbeWish wish{.seen = seenOf(graphOf(kTwo)), .scope = "", .reads = true};
    wish.hits = true, wish.place = {0.0, 0.0};
    ProbeAnswer answer = work.answer(wish);
    ASSERT_TRUE(answer.hit);
    EXPECT_NEAR((*answer.hit)[2], 0.5, 1e-9) << "the ball's front";
    EXPECT_NEAR(of(answer.readings, "ball")->numbers[0], 0.0, 1e-9);
    EXPECT_EQ(valueWords(*of(answer.readings, "ball"), 3, metre), "0 m");
    // A point that is known stays, wherever the mouse is.
    wish.point = Point{0, 0, 2}, wish.line = Segment{{-3, 0, 0}, {3, 0, 0}}, wish.plotted = "both";
    answer = work.answer(wish);
    EXPECT_NEAR(of(answer.readings, "ball")->numbers[0], 1.5, 1e-12);
    ASSERT_TRUE(answer.plot);
    EXPECT_EQ(answer.plot->walls.size(), 2u);
    wish.plotted = "alone";
    EXPECT_FALSE(work.answer(wish).plot);
    wish.place = {0.9, 0.9};
    EXPECT_FALSE(work.answer(wish).hit);
}

TEST(Probe, ALineCrossesTheWallsOfAShell) {
    const Tape shell = tapeOf(graphOf(R"(
      {"id": "ball", "type": "sphere", "inputs": {"radius": 1}},
      {"id": "hollow", "type": "shell", "inputs": {"surface": {"from": "ball"}, "thickness": 0.05}},
      {"id": "out", "type": "output", "inputs": {"surface": {"from": "hollow"}}})"));
    const Plot plot = plotOf(shell, {{-2, 0, 0}, {2, 0, 0}});
    ASSERT_EQ(plot.crossings.size(), 4u);
    const double expected[] = {0.95, 1.05, 2.95, 3.05};
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(plot.crossings[i], expected[i], 1e-12);
    ASSERT_EQ(plot.walls.size(), 2u);
    for (const Stretch& wall : plot.walls) EXPECT_NEAR(wall.thickness(), 0.1, 1e-12);
    EXPECT_EQ(plot.places.size(), std::size_t(kSamples));
    EXPECT_NEAR(plot.values.front(), 0.95, 1e-12);
    for (std::size_t i = 0; i < plot.slopes.size(); ++i) {
        if (i == std::size_t(kSamples / 2)) continue;  // in the ball's middle there is no gradient
        EXPECT_NEAR(plot.slopes[i], 1.0, 1e-9) << i;
    }
    const std::string table = csvOf(plot);
    EXPECT_TRUE(table.starts_with("along,x,y,z,value,gradient\n0,-2,0,0,0.95,1\n")) << table.substr(0, 80);
    EXPECT_EQ(std::ranges::count(table, '\n'), kSamples + 1);
    // Begun within the wall, or ended there, a stretch has no thickness.
    EXPECT_TRUE(plotOf(shell, {{-1, 0, 0}, {0, 0, 0}}).walls.empty());
    EXPECT_EQ(plotOf(shell, {{-1, 0, 0}, {0, 0, 0}}).crossings.size(), 1u);
    EXPECT_TRUE(plotOf(shell, {{0, 0, 0}, {0, 0, 0}}).crossings.empty());
}

TEST(Probe, WallsAreMeasuredAlongTheInwardNormal) {
    const Tape box = tapeOf(graphOf(R"(
      {"id": "box", "type": "box", "inputs": {"half_extents": [0.5, 0.25, 2]}},
      {"id": "out", "type": "output", "inputs": {"surface": {"from": "box"}}})"));
    for (const auto& [point, thickness] : {std::pair(Point{0.5, 0.1, 0.3}, 1.0),
                                           {Point{0.1, 0.25, 0.2}, 0.5},
                                           {Point{0.1, 0.02, 2}, 4.0},
                                           {Point{-0.5, 0.1, 0.3}, 1.0}}) {
        const std::optional<WallAt> wall = wallAt(box, point, 10.0);
        ASSERT_TRUE(wall);
        EXPECT_NEAR(wall->thickness(), thickness, 1e-12);
    }
    EXPECT_FALSE(wallAt(box, {0.1, 0.02, 2}, 3.0)) << "it does not end within reach";
    // A slanted wall, through the picker as a click finds it.
    const Seen seen = seenOf(graphOf(R"(
      {"id": "box", "type": "box", "inputs": {"half_extents": [1, 1, 1]}},
      {"id": "hollow", "type": "shell", "inputs": {"surface": {"from": "box"}, "thickness": 0.06}},
      {"id": "turned", "type": "rotate", "inputs": {"surface": {"from": "hollow"}, "angles": [20, 30, 0]}},
      {"id": "out", "type": "output", "inputs": {"surface": {"from": "turned"}}})"));
    Picker picker;
    const std::optional<Point> hit = picker.hit(seen, 0.05, 0.05);
    ASSERT_TRUE(hit);
    const std::optional<WallAt> wall = wallAt(*picker.field(seen), *hit, 10.0);
    ASSERT_TRUE(wall);
    EXPECT_NEAR(wall->thickness(), 0.12, 1e-9);
}

TEST(Probe, WhatWasMeasuredIsToldInNumbers) {
    Probe probe;
    EXPECT_EQ(measuredWords(probe, 1, metre), "");
    probe.measured = {{1, 2, 3}};
    EXPECT_EQ(measuredWords(probe, 1, metre), "");
    probe.measured.push_back({1, 5, 7});
    EXPECT_EQ(measuredWords(probe, 1, metre), "Length 5 m\ndx 0 m   dy 3 m   dz 4 m");
    probe.wall = WallAt{{{0, 0, 1}, {0, 0, 0.875}}};
    EXPECT_EQ(measuredWords(probe, 1, metre), "Length 5 m\ndx 0 m   dy 3 m   dz 4 m\nWall 0.125 m");
    EXPECT_EQ(measuredWords(probe, 1, mm), "Length 5 mm\ndx 0 mm   dy 3 mm   dz 4 mm\nWall 0.125 mm");
    probe.wall.reset();
    probe.what = Measure::angle;
    EXPECT_EQ(measuredWords(probe, 1, mm), "") << "two points are no angle";
    probe.measured = {{1, 0, 0}, {0, 0, 0}, {0, 1, 0}};
    EXPECT_EQ(measuredWords(probe, 1, mm), "Angle 90°");
    probe.what = Measure::radius;
    EXPECT_EQ(measuredWords(probe, 1, mm), "Radius 0.707107 mm");
    probe.measured = {{1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
    EXPECT_EQ(measuredWords(probe, 1, mm), "no circle");
    probe.measured.resize(1);
    EXPECT_EQ(measuredWords(probe, 1, mm), "");
    probe.bend = Bend{0.25, 0.25};
    EXPECT_EQ(measuredWords(probe, 1, mm), "Radius 4 mm");
}

TEST(Probe, AnglesAndCirclesGoThroughTheirPoints) {
    EXPECT_NEAR(*angleOf({Point{1, 0, 0}, Point{}, Point{0, 2, 0}}), 90.0, 1e-12);
    EXPECT_NEAR(*angleOf({Point{1, 1, 1}, Point{1, 1, 0}, Point{1, 3, 2}}), 45.0, 1e-12);
    EXPECT_NEAR(*angleOf({Point{1, 0, 0}, Point{}, Point{-3, 1e-9, 0}}), 180.0, 1e-6);
    EXPECT_FALSE(angleOf({Point{1, 0, 0}, Point{1, 0, 0}, Point{0, 2, 0}}));
    // Of a circle of radius 2.5 about (1, 2, 3) in a slanted plane.
    std::array<Point, 3> points;
    for (std::size_t i = 0; i < 3; ++i) {
        const double turn = 0.4 + 1.7 * double(i), x = 2.5 * std::cos(turn), y = 2.5 * std::sin(turn);
        points[i] = {1 + 0.6 * x, 2 + y, 3 + 0.8 * x};
    }
    const auto circle = circleThrough(points);
    ASSERT_TRUE(circle);
    EXPECT_NEAR(circle->radius, 2.5, 1e-12);
    for (std::size_t a = 0; a < 3; ++a) EXPECT_NEAR(circle->centre[a], double(a + 1), 1e-12);
    EXPECT_NEAR(circle->across[0] * circle->along[0] + circle->across[1] * circle->along[1] +
                    circle->across[2] * circle->along[2],
                0.0, 1e-12);
    EXPECT_FALSE(circleThrough({Point{0, 0, 0}, Point{1, 1, 1}, Point{2, 2, 2}}));
}

TEST(Probe, TheSurfaceTellsItsOwnRadius) {
    const auto bent = [](const char* shape, const Point& at) {
        const Tape tape = tapeOf(graphOf(std::string(shape) + R"(,
          {"id": "out", "type": "output", "inputs": {"surface": {"from": "s"}}})"));
        const auto bend = bendAt(tape, at, 30);
        return bend ? bendWords(*bend, 30, mm) : "none";
    };
    constexpr const char* kBall = R"({"id": "s", "type": "sphere", "inputs": {"radius": 5}})";
    EXPECT_EQ(bent(kBall, {3, 4, 0}), "Radius 5 mm");
    EXPECT_EQ(bent(R"({"id": "s", "type": "box", "inputs": {"half_extents": [5, 5, 5]}})", {5, 1, 2}),
              "Flat");
    EXPECT_EQ(
        bent(R"({"id": "s", "type": "cylinder", "inputs": {"radius": 4, "half_height": 9}})", {0, 1, 4}),
        "Radius 4 mm, straight across");
    EXPECT_EQ(bent(R"({"id": "s", "type": "torus", "inputs": {"major_radius": 10, "minor_radius": 2}})",
                   {12, 0, 0}),
              "Radii 2 mm and 12 mm");
    EXPECT_EQ(
        bent(R"({"id": "s", "type": "torus", "inputs": {"major_radius": 10, "minor_radius": 2}})", {8, 0, 0}),
        "Radii 2 mm and 8 mm hollow");
    // No distance, and three times too steep: the surface is the same.
    EXPECT_EQ(
        bent(R"({"id": "s", "type": "expression", "code": "return (dot(p, p) - 25.0) * 3.0;"})", {0, 3, 4}),
        "Radius 5 mm");
}

TEST(Probe, WiresAreTrustedAsFarAsTheirDistance) {
    EXPECT_EQ(trustOf(kExact), WireTrust::exact);
    EXPECT_EQ(trustOf(kExactOutside), WireTrust::bound);
    EXPECT_EQ(trustOf(kBound), WireTrust::bound);
    EXPECT_EQ(trustOf(distorted(2.0)), WireTrust::steep);
    EXPECT_EQ(trustOf(distorted()), WireTrust::steep);
}

}  // namespace fw::editor::test::probe_test
