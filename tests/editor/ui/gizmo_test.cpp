// Gizmos: what can be dragged is read off descriptors, stands where the field says, and a drag over known
// points gives known numbers.
#include "editor/viewport/grips.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "graph/compile/compile.h"
#include "graph/document/json.h"

namespace fw::editor::gizmo_test {

using Kind = Handle::Kind;

const Camera kCamera{.position = {5, 4, 7}, .target = {0.5, 0, 0}, .fov = 40};
const Area kPlace{{100, 50}, {740, 530}};

Graph nodes(const std::string& list) {
    const Result<Graph> graph = parseGraph(R"({"fieldwright": 1, "nodes": [)" + list + "]}", "", nullptr);
    EXPECT_TRUE(graph) << format(graph.error());
    return graph ? *graph : Graph{};
}

Node nodeOf(const std::string& text) { return nodes(text).nodes.at(0); }

Handle handleOf(const Node& node, const std::string& input, const Placement& placement = {}) {
    for (Handle& handle : handlesOf(node, placement, {}))
        if (handle.input == input) return handle;
    ADD_FAILURE() << node.type << " has no handle " << input;
    return {};
}

ImVec2 seenAt(const Lens& lens, const glm::dvec3& point) {
    const auto pixel = lens.project(point);
    EXPECT_TRUE(pixel);
    return pixel.value_or(ImVec2());
}

void expectNumbers(const std::vector<double>& numbers, const std::vector<double>& wanted, double within) {
    ASSERT_EQ(numbers.size(), wanted.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) EXPECT_NEAR(numbers[i], wanted[i], within) << i;
}

TEST(Placement, IsWhatTheNodesFieldDoes) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> number(0.3, 1.7), place(-1.0, 1.0);
    std::set<std::string> placed;
    for (const NodeType& type : nodeTypes()) {
        if (type.body.empty() || std::ranges::count(type.inputs, Type::surface, &InputSpec::type) != 1)
            continue;
        Graph graph = nodes(R"({"id": "box", "type": "box", "inputs": {"half_extents": [0.5, 0.3, 0.2]}},
            {"id": "out", "type": "output", "inputs": {"surface": {"from": "it"}}})");
        Node node;
        node.id = "it", node.type = type.id;
        for (const InputSpec& input : type.inputs) {
            if (input.type == Type::surface) node.set(input.name, {.value = Link{"box", ""}});
            const double factor = input.unit == "degrees" ? 50.0 : 1.0;
            if (isPlace(input) || isAngles(input) || (isFactor(input) && input.type == Type::vec3))
                node.set(input.name,
                         {.value = std::vector<double>{factor * number(random), factor * number(random),
                                                       factor * number(random)}});
            else if (isFactor(input))
                node.set(input.name, {.value = number(random)});
        }
        graph.nodes.push_back(node);
        const std::optional<Placement> placement = placementBy(node);
        if (!placement) continue;
        const bool moved = placement->linear != glm::dmat3(1.0) || placement->shift != glm::dvec3(0.0);
        if (!moved) continue;
        placed.insert(type.id);
        const Result<Program> outer = compile(graph);
        graph.nodes[1].set("surface", {.value = Link{"box", ""}});
        const Result<Program> inner = compile(graph);
        ASSERT_TRUE(outer && inner) << type.id;
        for (int i = 0; i < 200; ++i) {
            const glm::dvec3 q(place(random), place(random), place(random)), p = placement->of(q);
            const double in = evaluate(inner->ir, inner->distance(), {}, {q.x, q.y, q.z}),
                         out = evaluate(outer->ir, outer->distance(), {}, {p.x, p.y, p.z});
            if (std::abs(in) > 1e-6) { EXPECT_EQ(in < 0, out < 0) << type.id; }
        }
    }
    EXPECT_EQ(placed, (std::set<std::string>{"translate", "rotate", "scale", "stretch", "transform"}));
}

TEST(Placement, WhatMovesInWaysOfItsOwnHasNone) {
    for (const char* type : {"repeat", "polar_repeat", "twist", "bend", "mirror", "extrude"})
        EXPECT_FALSE(placementBy(nodeOf(std::string(R"({"id": "a", "type": ")") + type + "\"}"))) << type;
    for (const char* type : {"offset", "shell", "union", "subtract", "material", "reroute"}) {
        const auto by = placementBy(nodeOf(std::string(R"({"id": "a", "type": ")") + type + "\"}"));
        ASSERT_TRUE(by) << type;
        EXPECT_EQ(by->of({1, 2, 3}), glm::dvec3(1, 2, 3)) << type;
    }
}

TEST(Placement, FollowsTheWayToWhatIsShown) {
    const Graph graph = nodes(R"(
      {"id": "ball", "type": "sphere"},
      {"id": "up", "type": "translate", "inputs": {"surface": {"from": "ball"}, "offset": [0, 1, 0]}},
      {"id": "big", "type": "scale", "inputs": {"surface": {"from": "up"}, "factor": 2}},
      {"id": "soft", "type": "offset", "inputs": {"surface": {"from": "big"}}},
      {"id": "many", "type": "repeat", "inputs": {"surface": {"from": "soft"}}},
      {"id": "lone", "type": "sphere"},
      {"id": "out", "type": "output", "inputs": {"surface": {"from": "many"}}})");
    EXPECT_EQ(wayToShown(graph, "", "ball", "big"), (NodeIds{"up", "big"}));
    EXPECT_EQ(wayToShown(graph, "", "big", ""), (NodeIds{"soft", "many", "out"}));
    EXPECT_EQ(wayToShown(graph, "", "big", "big"), NodeIds{});
    EXPECT_FALSE(wayToShown(graph, "", "lone", "")) << "it is not in the picture";
    EXPECT_FALSE(wayToShown(graph, "", "many", "big")) << "it lies behind";
    const Placement some = placementAlong(graph, "", *wayToShown(graph, "", "ball", "soft"));
    EXPECT_EQ(some.of({1, 0, 0}), glm::dvec3(2, 2, 0));
    EXPECT_EQ(some.why, "");
    const Placement all = placementAlong(graph, "", *wayToShown(graph, "", "ball", ""));
    EXPECT_EQ(all.of({1, 0, 0}), glm::dvec3(2, 2, 0)) << "as far as is known";
    EXPECT_NE(all.why.find("Repeat"), std::string::npos) << all.why;
}

TEST(Lens, ARayThroughAPointsPixelMeetsThePoint) {
    const Lens lens(kCamera, kPlace);
    for (const glm::dvec3& p : {glm::dvec3(0, 0, 0), glm::dvec3(1, 2, -1), glm::dvec3(-2, 0.5, 3)}) {
        const glm::dvec3 to = glm::normalize(p - lens.eye), ray = glm::normalize(lens.ray(seenAt(lens, p)));
        EXPECT_NEAR(glm::dot(to, ray), 1.0, 1e-9);
    }
    EXPECT_FALSE(lens.project({20, 16, 28})) << "behind the eye";
    const glm::dvec3 across = glm::normalize(lens.right) * lens.metresPerPixel({0.5, 0, 0});
    EXPECT_NEAR(seenAt(lens, glm::dvec3(0.5, 0, 0) + across).x - seenAt(lens, {0.5, 0, 0}).x, 1.0f, 0.01f);
}

TEST(Gizmo, ArrowsDraggedAlongTheirAxisGiveTheMetres) {
    const Lens lens(kCamera, kPlace);
    const Node node = nodeOf(R"({"id": "a", "type": "translate", "inputs": {"offset": [0.5, -0.25, 0]}})");
    const Handle handle = handleOf(node, "offset");
    EXPECT_EQ(handle.kind, Kind::move);
    EXPECT_EQ(handle.origin, glm::dvec3(0.5, -0.25, 0));
    for (int axis = 0; axis < 3; ++axis)
        for (const double metres : {0.8, -0.6}) {
            glm::dvec3 by(0.0);
            by[axis] = metres;
            const glm::dvec3 tip = handle.tip(axis, 0.7);
            HandleDrag drag = takeHandle(handle, axis, lens, seenAt(lens, tip), 1.0);
            std::vector<double> wanted = handle.numbers;
            wanted[std::size_t(axis)] += metres;
            expectNumbers(dragTo(drag, lens, seenAt(lens, tip + by), false, false), wanted, 0.006);
            expectNumbers(dragTo(drag, lens, seenAt(lens, tip), false, false), handle.numbers, 0.006);
        }
}

TEST(Gizmo, TheMiddleMovesAcrossTheView) {
    const Lens lens(kCamera, kPlace);
    const Handle handle = handleOf(nodeOf(R"({"id": "a", "type": "translate"})"), "offset");
    HandleDrag drag = takeHandle(handle, kAcrossView, lens, seenAt(lens, handle.origin), 1.0);
    const glm::dvec3 by = 0.9 * glm::normalize(lens.right) - 0.4 * glm::normalize(lens.up);
    expectNumbers(dragTo(drag, lens, seenAt(lens, handle.origin + by), false, false), {by.x, by.y, by.z},
                  0.006);
}

TEST(Gizmo, BehindATransformAMetreOfThePictureIsWhatItIsThere) {
    const Lens lens(kCamera, kPlace);
    const Node behind = nodeOf(R"({"id": "b", "type": "transform", "inputs": {"translation": [0, 1, 0],
        "rotation": [0, 90, 0], "scale": 2}})");
    const Handle handle =
        handleOf(nodeOf(R"({"id": "a", "type": "translate", "inputs": {"offset": [0.5, 0, 0]}})"), "offset",
                 *placementBy(behind));
    EXPECT_NEAR(glm::distance(handle.origin, glm::dvec3(0, 1, -1)), 0.0, 1e-9)
        << "x became -z, twice as long";
    const glm::dvec3 tip = handle.tip(0, 0.5);
    HandleDrag drag = takeHandle(handle, 0, lens, seenAt(lens, tip), 1.0);
    expectNumbers(dragTo(drag, lens, seenAt(lens, tip + glm::dvec3(0, 0, -1.2)), false, false), {1.1, 0, 0},
                  0.006);
}

TEST(Gizmo, RingsTurnAboutTheirAxisWhateverTheOtherAnglesAre) {
    const Node node = nodeOf(
        R"({"id": "a", "type": "transform", "inputs": {"translation": [0.3, 0, 0], "rotation": [20, 40, -30]}})");
    const Handle handle = handleOf(node, "rotation");
    EXPECT_EQ(handle.kind, Kind::turn);
    const glm::dmat3 before = turned(vectorOf(handle.numbers));
    for (const Camera& camera : {kCamera, Camera{.position = {-6, 1, 2}, .target = {0, 0, 0}, .fov = 40}})
        for (int axis = 0; axis < 3; ++axis) {
            const Lens lens(camera, kPlace);
            const glm::dvec3 n = handle.axes[axis], view = glm::normalize(handle.origin - lens.eye);
            const bool edgeOn = std::abs(glm::dot(n, view)) < 0.2;
            const glm::dvec3 from = glm::normalize(glm::cross(n, view)) * 0.8;
            const double degrees = edgeOn ? 5.0 : 35.0;
            const glm::dmat3 turn(glm::rotate(glm::dmat4(1.0), glm::radians(degrees), n));
            if (edgeOn) continue;  // has a test of its own
            HandleDrag drag = takeHandle(handle, axis, lens, seenAt(lens, handle.origin + from), 1.0);
            const std::vector<double> numbers =
                dragTo(drag, lens, seenAt(lens, handle.origin + turn * from), false, false);
            EXPECT_NEAR(numbers[std::size_t(axis)] - handle.numbers[std::size_t(axis)], degrees, 0.11);
            const glm::dmat3 after = turned(vectorOf(numbers)), wanted = turn * before;
            for (int i = 0; i < 3; ++i) EXPECT_LT(glm::distance(after[i], wanted[i]), 0.01) << axis;
        }
}

TEST(Gizmo, ARingSeenEdgeOnTurnsWithItsNearSide) {
    const Lens lens({.position = {0, 0, 8}, .target = {0, 0, 0}, .fov = 40}, kPlace);
    const Handle handle = handleOf(nodeOf(R"({"id": "a", "type": "rotate"})"), "angles");
    HandleDrag drag = takeHandle(handle, 1, lens, {420, 290}, 1.0);
    // Pulled to the right in front, it turns from +z towards +x: about +y, counter-clockwise from above.
    const std::vector<double> numbers = dragTo(drag, lens, {430, 290}, false, false);
    EXPECT_NEAR(numbers[1], glm::degrees(10.0 / kHandlePixels), 0.5);
    EXPECT_EQ(numbers[0], 0.0);
}

TEST(Gizmo, MoreThanOneTurnAddsUp) {
    const Lens lens({.position = {0, 8, 0.01}, .target = {0, 0, 0}, .fov = 40}, kPlace);
    const Handle handle = handleOf(nodeOf(R"({"id": "a", "type": "rotate"})"), "angles");
    const auto at = [&](double degrees) {
        return seenAt(lens, {std::cos(glm::radians(degrees)), 0, -std::sin(glm::radians(degrees))});
    };
    HandleDrag drag = takeHandle(handle, 1, lens, at(0), 1.0);
    std::vector<double> numbers;
    for (int degrees = 20; degrees <= 500; degrees += 20)
        numbers = dragTo(drag, lens, at(degrees), false, false);
    EXPECT_NEAR(numbers[1], 500.0, 0.2);
}

TEST(Gizmo, BoxesScaleByTheirLength) {
    const Lens lens(kCamera, kPlace);
    const double length = kHandlePixels * lens.metresPerPixel({0, 0, 0});
    const Handle one =
        handleOf(nodeOf(R"({"id": "a", "type": "scale", "inputs": {"factor": 1.5}})"), "factor");
    HandleDrag drag = takeHandle(one, 2, lens, seenAt(lens, one.tip(2, length)), 1.0);
    expectNumbers(dragTo(drag, lens, seenAt(lens, one.tip(2, 2 * length)), false, false), {3.0}, 0.02);
    const Handle each = handleOf(nodeOf(R"({"id": "a", "type": "stretch"})"), "factors");
    drag = takeHandle(each, 0, lens, seenAt(lens, each.tip(0, length)), 1.0);
    expectNumbers(dragTo(drag, lens, seenAt(lens, each.tip(0, 0.5 * length)), false, false), {0.5, 1, 1},
                  0.02);
    drag = takeHandle(each, 0, lens, seenAt(lens, each.tip(0, length)), 1.0);
    EXPECT_GT(dragTo(drag, lens, seenAt(lens, each.tip(0, -9 * length)), false, false)[0], 0.0)
        << "a factor stays above 0";
}

TEST(Gizmo, BoxesOfExtentsStandAtTheirLengthAndAreNeverNegative) {
    const Lens lens(kCamera, kPlace);
    const Handle handle = handleOf(
        nodeOf(R"({"id": "a", "type": "box", "inputs": {"half_extents": [1, 0.5, 0.25]}})"), "half_extents");
    EXPECT_EQ(handle.kind, Kind::extent);
    EXPECT_EQ(handle.tip(1, 99.0), glm::dvec3(0, 0.5, 0));
    HandleDrag drag = takeHandle(handle, 1, lens, seenAt(lens, {0, 0.5, 0}), 1.0);
    expectNumbers(dragTo(drag, lens, seenAt(lens, {0, 0.8, 0}), false, false), {1, 0.8, 0.25}, 0.006);
    expectNumbers(dragTo(drag, lens, seenAt(lens, {0, -1, 0}), false, false), {1, 0, 0.25}, 0.006);
}

TEST(Gizmo, FineCountsATenthAndSnappingGoesInSteps) {
    const Lens lens(kCamera, kPlace);
    const Handle handle = handleOf(nodeOf(R"({"id": "a", "type": "translate"})"), "offset");
    const ImVec2 from = seenAt(lens, handle.tip(0, 0.5)), to = seenAt(lens, handle.tip(0, 1.26));
    HandleDrag drag = takeHandle(handle, 0, lens, from, 1.0);
    expectNumbers(dragTo(drag, lens, to, true, false), {0.076, 0, 0}, 0.002);
    drag = takeHandle(handle, 0, lens, from, 1.0);
    EXPECT_EQ(dragTo(drag, lens, to, false, true), (std::vector<double>{0.8, 0, 0}));
    for (int tenths = 1; tenths < 15; ++tenths) {
        const ImVec2 there = seenAt(lens, handle.tip(0, 0.5 + 0.1 * tenths));
        EXPECT_EQ(dragTo(drag, lens, there, false, true)[0], tenths / 10.0) << "as few digits as name it";
    }
    const Handle angles = handleOf(nodeOf(R"({"id": "a", "type": "rotate"})"), "angles");
    const auto at = [&](double degrees) {
        return seenAt(lens, {std::cos(glm::radians(degrees)), 0, -std::sin(glm::radians(degrees))});
    };
    drag = takeHandle(angles, 1, lens, at(0), 1.0);
    expectNumbers(dragTo(drag, lens, at(40), false, true), {0, 45, 0}, 1e-9);
}

TEST(Gizmo, TheMouseFindsWhatIsDrawnThere) {
    const Lens lens(kCamera, kPlace);
    const std::vector<Handle> arrows = handlesOf(
        nodeOf(R"({"id": "a", "type": "capsule", "inputs": {"a": [0, -1, 0], "b": [0, 1, 0]}})"), {}, {});
    ASSERT_EQ(arrows.size(), 3u) << "both ends, and the thickness";
    const double length = kHandlePixels * lens.metresPerPixel({0, 1, 0});
    EXPECT_EQ(handleAt(arrows, lens, seenAt(lens, arrows[1].tip(2, 0.9 * length)), 1.0), (HandleHit{1, 2}));
    EXPECT_EQ(handleAt(arrows, lens, seenAt(lens, arrows[0].tip(0, 0.9 * length)), 1.0), (HandleHit{0, 0}));
    EXPECT_EQ(handleAt(arrows, lens, seenAt(lens, arrows[0].origin), 1.0), (HandleHit{0, kAcrossView}));
    EXPECT_FALSE(handleAt(arrows, lens, {kPlace.lo.x + 5, kPlace.lo.y + 5}, 1.0));
    const std::vector<Handle> rings = handlesOf(nodeOf(R"({"id": "a", "type": "rotate"})"), {}, {});
    ASSERT_EQ(rings.size(), 1u);
    for (int axis = 0; axis < 3; ++axis) {
        const std::vector<ImVec2> ring = ringOf(rings[0], axis, lens, 1.0);
        ASSERT_GT(ring.size(), 20u);
        const auto hit = handleAt(rings, lens, ring[ring.size() / 3], 1.0);
        ASSERT_TRUE(hit);
        EXPECT_EQ(hit->axis, axis);
    }
}

TEST(Gizmo, WhatIsWiredOrAnimatedIsRefusedWithAReason) {
    const Node wired = nodeOf(R"({"id": "a", "type": "translate", "inputs": {"offset": {"from": "dice"}}})");
    EXPECT_NE(handleOf(wired, "offset").refusal.find("dice"), std::string::npos);
    const Node plain = nodeOf(R"({"id": "a", "type": "translate"})");
    EXPECT_EQ(handleOf(plain, "offset").refusal, "");
    const std::vector<Handle> moved = handlesOf(plain, {}, {"a.offset"});
    ASSERT_EQ(moved.size(), 1u);
    EXPECT_NE(moved[0].refusal, "");
    EXPECT_TRUE(handlesOf(nodeOf(R"({"id": "a", "type": "polygon"})"), {}, {}).empty());
    EXPECT_TRUE(handlesOf(nodeOf(R"({"id": "a", "type": "output"})"), {}, {}).empty());
}

const char* const kChain = R"(
  {"id": "ball", "type": "polygon"},
  {"id": "soft", "type": "offset", "inputs": {"surface": {"from": "ball"}}},
  {"id": "there", "type": "translate", "inputs": {"surface": {"from": "soft"}, "offset": [0, 1, 0]}},
  {"id": "block", "type": "box"},
  {"id": "both", "type": "union", "inputs": {"a": {"from": "there"}, "b": {"from": "block"}}},
  {"id": "all", "type": "transform", "inputs": {"surface": {"from": "both"}, "translation": [2, 0, 0]}},
  {"id": "lone", "type": "box"},
  {"id": "out", "type": "output", "inputs": {"surface": {"from": "all"}}})";

TEST(Gizmo, GripsOfLengthsEndWhereTheLengthDoes) {
    // A shape that is larger has at its grip's end what it had before: the surface, or the middle of its
    // tube.
    std::size_t grips = 0;
    for (const NodeType& type : nodeTypes()) {
        const bool shape = type.category == Category::shape || type.category == Category::shape2d;
        for (const InputSpec& input : type.inputs) {
            if (input.grip.kind != Grip::Kind::length) continue;
            ++grips;
            EXPECT_EQ(input.unit, "m") << type.id << "." << input.name;
            EXPECT_EQ(input.type, Type::scalar) << type.id << "." << input.name;
            const int from =
                inputIndex(type, input.grip.from.substr(input.grip.from.starts_with('-') ? 1 : 0));
            EXPECT_TRUE(input.grip.from.empty() || from >= 0) << type.id << "." << input.name;
            const bool changes = std::ranges::count(type.inputs, Type::surface, &InputSpec::type) > 0;
            // A period ends a cell farther, wherever in the wall that is; a plane's offset has its normal.
            if (!shape || changes || input.name == "period" || !input.grip.with.empty()) continue;
            double fields[2] = {};
            for (int i = 0; i < 2; ++i) {
                Graph graph =
                    nodes(R"({"id": "out", "type": "output", "inputs": {"surface": {"from": "it"}}})");
                Node node;
                node.id = "it", node.type = type.id;
                const double value = input.value.numbers.at(0) * (i == 0 ? 1.0 : 1.1) + (i == 0 ? 0.0 : 0.01);
                node.set(input.name, {.value = value});
                const Handle handle = handleOf(node, input.name);
                const glm::dvec3 tip = handle.tip(0, 1.0);
                graph.nodes.push_back(node);
                const Result<Program> program = compile(graph, {});
                ASSERT_TRUE(program) << format(program.error());
                fields[i] = evaluate(program->ir, program->distance(), {}, {tip.x, tip.y, tip.z});
            }
            EXPECT_NEAR(fields[0], fields[1], 1e-9) << type.id << "." << input.name;
        }
    }
    EXPECT_GT(grips, 30u);
}

TEST(Gizmo, ALengthIsDraggedAlongItsGrip) {
    const Camera camera{.position = {0, 0, 10}, .target = {0, 0, 0}, .fov = 40};
    const Lens lens(camera, kPlace);
    const Handle handle =
        handleOf(nodeOf(R"({"id": "a", "type": "cone", "inputs": {"height": 2, "radius": 1}})"), "radius");
    EXPECT_EQ(handle.count, 1);
    EXPECT_EQ(handle.origin, glm::dvec3(0, -2, 0)) << "at the base";
    HandleDrag drag = takeHandle(handle, 0, lens, seenAt(lens, {1, -2, 0}), 1.0);
    expectNumbers(dragTo(drag, lens, seenAt(lens, {1.5, -2, 0}), false, false), {1.5}, 0.02);
    expectNumbers(dragTo(drag, lens, seenAt(lens, {-3, -2, 0}), false, false), {0.0}, 1e-12);
    expectNumbers(dragTo(drag, lens, seenAt(lens, {1.52, -2, 0}), false, true), {1.5}, 1e-12);
    const auto hit = handleAt({handle}, lens, seenAt(lens, {1, -2, 0}), 1.0);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->axis, 0);
}

TEST(Grips, AShapeIsHeldWhereItStands) {
    const Graph graph = nodes(kChain);
    const Grips ball = gripsOf(graph, "", "ball", "", 0.0, Tool::move);
    ASSERT_EQ(ball.handles.size(), 1u);
    EXPECT_EQ(ball.handles[0].node, "there");
    EXPECT_EQ(ball.handles[0].origin, glm::dvec3(2, 1, 0)) << "moved by both";
    const Grips pinned = gripsOf(graph, "", "ball", "there", 0.0, Tool::move);
    ASSERT_EQ(pinned.handles.size(), 1u);
    EXPECT_EQ(pinned.handles[0].origin, glm::dvec3(0, 1, 0));
    EXPECT_TRUE(gripsOf(graph, "", "lone", "", 0.0, Tool::move).handles.empty()) << "it is not seen";
}

TEST(Grips, ANodesOwnValuesComeFirst) {
    const Graph graph = nodes(kChain);
    const Grips extents = gripsOf(graph, "", "block", "", 0.0, Tool::scale);
    ASSERT_EQ(extents.handles.size(), 1u);
    EXPECT_EQ(extents.handles[0].node, "block");
    EXPECT_EQ(extents.handles[0].origin, glm::dvec3(2, 0, 0));
    const Grips all = gripsOf(graph, "", "all", "", 0.0, Tool::turn);
    ASSERT_EQ(all.handles.size(), 1u);
    EXPECT_EQ(all.handles[0].node, "all");
}

TEST(Grips, InAGroupTheyStandWhereItsOneInstanceStands) {
    const auto graph = [](const std::string& more) {
        const Result<Graph> read = parseGraph(R"({"fieldwright": 1, "nodes": [
          {"id": "one", "type": "group", "group": "lamp"},)" +
                                                  more +
                                                  R"(
          {"id": "up", "type": "scale", "inputs": {"surface": {"from": "one"}, "factor": 3}},
          {"id": "out", "type": "output", "inputs": {"surface": {"from": "up"}}}],
          "groups": [{"id": "lamp", "outputs": [{"name": "surface", "type": "surface"}], "nodes": [
          {"id": "ball", "type": "sphere"},
          {"id": "there", "type": "translate", "inputs": {"surface": {"from": "ball"}, "offset": [1, 0, 0]}},
          {"id": "end", "type": "group_output", "inputs": {"surface": {"from": "there"}}}]}]})",
                                              "", nullptr);
        EXPECT_TRUE(read) << format(read.error());
        return read ? *read : Graph{};
    };
    const Grips once = gripsOf(graph(""), "lamp", "ball", "", 0.0, Tool::move);
    ASSERT_EQ(once.handles.size(), 1u);
    EXPECT_EQ(once.handles[0].origin, glm::dvec3(3, 0, 0));
    EXPECT_EQ(once.why, "");
    const Grips twice = gripsOf(graph(R"({"id": "two", "type": "group", "group": "lamp"},)"), "lamp", "ball",
                                "", 0.0, Tool::move);
    ASSERT_EQ(twice.handles.size(), 1u);
    EXPECT_EQ(twice.handles[0].origin, glm::dvec3(1, 0, 0));
    EXPECT_NE(twice.why, "");
}

TEST(Grips, WhatHasNoneGetsANodeInTheWireAhead) {
    const Graph graph = nodes(kChain);
    for (const Tool tool : {Tool::move, Tool::turn, Tool::scale}) {
        const Grips grips = gripsOf(graph, "", "ball", "", 0.0, tool);
        EXPECT_EQ(grips.tools.size(), 3u);
        if (tool == Tool::move) continue;
        ASSERT_EQ(grips.handles.size(), 1u);
        EXPECT_EQ(grips.handles[0].node, "");
        EXPECT_EQ(grips.ahead, (Plug{"soft", "surface"}));
        const Edited added = insertOnWire(graph, "", *grips.ahead, typeFor(tool).id, {0, 0});
        ASSERT_EQ(added.nodes.size(), 1u);
        const Grips after = gripsOf(added.graph, "", "ball", "", 0.0, tool);
        ASSERT_EQ(after.handles.size(), 1u);
        EXPECT_EQ(after.handles[0].node, added.nodes[0]);
        EXPECT_EQ(after.handles[0].input, grips.handles[0].input);
        EXPECT_EQ(after.handles[0].origin, grips.handles[0].origin);
    }
    EXPECT_EQ(typeFor(Tool::move).id, "translate");
    EXPECT_EQ(typeFor(Tool::turn).id, "rotate");
    EXPECT_EQ(typeFor(Tool::scale).id, "scale");
    const Grips block = gripsOf(graph, "", "block", "", 0.0, Tool::move);
    ASSERT_EQ(block.handles.size(), 1u);
    EXPECT_EQ(block.handles[0].node, "") << "what moves both does not move it alone";
    EXPECT_EQ(block.ahead, (Plug{"both", "b"}));
}

}  // namespace fw::editor::gizmo_test
