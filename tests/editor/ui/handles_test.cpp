// What can be held in the picture: every entry of the table, several nodes at once, about other points and
// along other axes, steps, and the parts of the scene.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <random>

#include "editor/viewport/marks.h"
#include "editor/viewport/pick.h"
#include "editor/viewport/together.h"
#include "graph/compile/compile.h"
#include "graph/document/json.h"
#include "graph/document/named_parameters.h"

namespace fw::editor::handles_test {

using Kind = Handle::Kind;

const Camera kCamera{.position = {5, 4, 7}, .target = {0.2, 0, 0}, .fov = 40};
const Area kPlace{{100, 50}, {740, 530}};

Graph document(const std::string& nodes, const std::string& more = "") {
    const Result<Graph> graph =
        parseGraph(R"({"fieldwright": 1, "nodes": [)" + nodes + "]" + more + "}", "", nullptr);
    EXPECT_TRUE(graph) << format(graph.error());
    return graph ? *graph : Graph{};
}

ImVec2 seenAt(const Lens& lens, const glm::dvec3& point) { return lens.project(point).value_or(ImVec2()); }

/// Lengths, places, angles and boxes that have no handle, and why.
const std::map<std::string, std::string> kWithout = {
    {"cylinder.rounding", "it rounds what the sizes say"},
    {"box.rounding", "it rounds what the sizes say"},
    {"extrude.rounding", "it rounds what the sizes say"},
    {"box_frame.thickness", "of twelve bars"},
    {"gyroid.thickness", "a wall that is everywhere"},
    {"schwarz_p.thickness", "a wall that is everywhere"},
    {"diamond.thickness", "a wall that is everywhere"},
    {"star.inner_radius", "its notches are where the number of tips says"},
    {"offset.distance", "it is everywhere on the surface"},
    {"shell.thickness", "it is everywhere on the surface"},
    {"true_distance.margin", "it is everywhere around the solid"},
    {"round_edges.radius", "it is along all edges"},
    {"chamfer_edges.size", "it is along all edges"},
    {"lattice.thickness", "of struts or walls that are everywhere"},
    {"tube.radius", "its ball is all along the spline"},
    {"voronoi_foam.cell", "its walls are where chance has them"},
    {"voronoi_foam.thickness", "of walls that are everywhere"},
    {"displace.amount", "it is everywhere on the surface"},
    {"particle_dynamics.turbulence_size", "it has no place"},
    {"particle_dynamics.radius", "of every particle"},
    {"sph_fluid.spacing", "of every particle"},
    {"decimate.error", "it is everywhere on the mesh"},
    {"particles_to_field.drop", "of every particle"},
    {"particles_to_field.radius", "of every particle"},
    {"particles_to_field.margin", "around a box that is found"},
    {"mesh_to_field.margin", "around a box that is found"},
    {"smooth.within", "of every vertex"},
    {"smooth.spare", "of every vertex"},
    {"text.size", "its letters are where the font says"},
    {"svg_file.size", "its edges are where the drawing says"},
    {"dxf_file.size", "its edges are where the drawing says"},
    {"revolve.angle", "its ends are at the profile, wherever that is"},
    {"gear.module", "its teeth are where their number says"},
    {"gear.pressure_angle", "of every flank"},
    {"gear.backlash", "of every tooth"},
    {"thread.height", "half of it is at each end"},
    {"thread.fit", "it is everywhere on the surface"},
    {"thread.diameter", "of an own thread alone"},
    {"thread.pitch", "of an own thread alone"},
    {"spring.radius", "its wire is where the height says"},
    {"spring.pitch", "its turns are where their number says"},
    {"spring.wire", "it is everywhere on the wire"},
    {"polygon.points", "its outline has a panel of its own, in which points are drawn"},
    {"from_distance.value", "a distance that is computed"},
};

bool mayBeHeld(const NodeType& type, const InputSpec& input) {
    if (input.grip || isPlace(input) || isAngles(input) || isFactor(input) || isExtent(input)) return true;
    if (type.category == Category::combine || input.value.kind == InputDefault::Kind::position) return false;
    if (input.name == "normal" || input.name == "axis") return true;
    return input.unit == "m" || input.unit == "degrees" || input.unit == "degrees/m";
}

Node nodeOfType(const NodeType& type) {
    Node node;
    node.id = "it", node.type = type.id;
    for (const InputSpec& input : type.inputs)
        if (input.grip.kind == Grip::Kind::corner && input.value.kind == InputDefault::Kind::none)
            node.set(input.name, {.value = std::vector<double>(3, input.name.ends_with("min") ? -1.0 : 1.0)});
    return node;
}

/// Another value of the handle's axis, and what it is held at then.
void expectFollows(const Handle& handle, int axis, const Lens& lens, const std::string& name) {
    const double length = kHandlePixels * lens.metresPerPixel(handle.origin);
    Handle after = handle;
    const std::size_t i = std::size_t(axis);
    if (handle.kind == Kind::aim) {
        const glm::dvec3 d = glm::normalize(vectorOf(handle.numbers) / glm::length(vectorOf(handle.numbers)) +
                                            glm::dvec3(0.3, 0.2, 0.1));
        after.numbers = {d.x, d.y, d.z};
    } else {
        after.numbers[i] += handle.kind == Kind::angle ? 12.0 : handle.kind == Kind::scale ? 0.0 : 0.2;
    }
    HandleDrag drag = takeHandle(handle, axis, lens, seenAt(lens, handle.tip(axis, length)), 1.0);
    const glm::dvec3 to = handle.kind == Kind::move    ? handle.tip(axis, length) + 0.2 * handle.axes[axis]
                          : handle.kind == Kind::scale ? handle.tip(axis, 1.5 * length)
                                                       : after.tip(axis, length);
    if (handle.kind == Kind::scale) after.numbers[handle.numbers.size() == 1 ? 0 : i] *= 1.5;
    const std::vector<double> got = dragTo(drag, lens, seenAt(lens, to), false, false);
    ASSERT_EQ(got.size(), after.numbers.size()) << name;
    for (std::size_t c = 0; c < got.size(); ++c)
        EXPECT_NEAR(got[c], after.numbers[c], handle.kind == Kind::angle ? 1.0 : 0.03) << name << " " << axis;
}

TEST(Handles, EveryPlaceSizeAngleAndBoxOfTheTableCanBeHeld) {
    const Lens lens(kCamera, kPlace);
    std::set<std::string> without;
    for (const NodeType& type : nodeTypes()) {
        const Type made = type.outputs.empty() ? Type::scalar : type.outputs.front().type;
        if (made != Type::surface && made != Type::particles && made != Type::mesh) continue;
        const Node node = nodeOfType(type);
        const std::vector<Handle> handles = handlesOf(node, {}, {});
        for (const InputSpec& input : type.inputs) {
            if (!mayBeHeld(type, input)) continue;
            const std::string name = type.id + "." + input.name;
            const auto found = std::ranges::find(handles, input.name, &Handle::input);
            if (found == handles.end()) {
                EXPECT_TRUE(kWithout.contains(name)) << name << " cannot be held";
                without.insert(name);
                continue;
            }
            EXPECT_EQ(found->refusal, "") << name;
            if (found->kind != Kind::turn)  // those have tests of their own
                for (int axis = 0; axis < std::min(found->count, int(found->numbers.size())); ++axis)
                    if (isSeen(*found, axis, lens)) expectFollows(*found, axis, lens, name);
            Node wired = node;
            wired.set(input.name, {.value = Link{"other", ""}});
            for (const Handle& handle : handlesOf(wired, {}, {}))
                if (handle.input == input.name) { EXPECT_NE(handle.refusal, "") << name << " is wired"; }
        }
    }
    for (const auto& [name, why] : kWithout)
        EXPECT_TRUE(without.contains(name)) << name << " can be held after all";
}

TEST(Handles, AnglesPointWhereTheShapesDo) {
    // At its tip the end of the ring, and the side of the cone, whatever the angle.
    for (const auto& [type, wanted] :
         std::map<std::string, double>{{"capped_torus", -0.1}, {"solid_angle", 0.0}})
        for (const double angle : {20.0, 70.0, 130.0}) {
            const Graph graph = document(R"({"id": "it", "type": ")" + type +
                                         R"(", "inputs": {"half_angle": )" + std::to_string(angle) + R"(}},
              {"id": "out", "type": "output", "inputs": {"surface": {"from": "it"}}})");
            const Result<Program> program = compile(graph);
            ASSERT_TRUE(program);
            for (const Handle& handle : handlesOf(graph.nodes[0], {}, {})) {
                if (handle.kind != Kind::angle) continue;
                const glm::dvec3 tip = handle.tip(0, 0.0);
                EXPECT_NEAR(evaluate(program->ir, program->distance(), {}, {tip.x, tip.y, tip.z}), wanted,
                            1e-9)
                    << type << " " << angle;
            }
        }
}

TEST(Handles, APlaneIsHeldWhereItIsAndAlongItsNormal) {
    const Graph graph =
        document(R"({"id": "it", "type": "plane", "inputs": {"normal": [3, 4, 0], "offset": 0.5}})");
    const std::vector<Handle> handles = handlesOf(graph.nodes[0], {}, {});
    ASSERT_EQ(handles.size(), 2u);
    EXPECT_EQ(handles[0].kind, Kind::aim);
    EXPECT_NEAR(glm::distance(handles[0].origin, glm::dvec3(0.3, 0.4, 0.0)), 0.0, 1e-12);
    EXPECT_NEAR(glm::distance(handles[1].tip(0, 0.0), glm::dvec3(0.3, 0.4, 0.0)), 0.0, 1e-12);
    EXPECT_TRUE(handles[1].placing);
}

TEST(Handles, AFaceOfABoxStopsAtTheOther) {
    const Lens lens(kCamera, kPlace);
    const Graph graph = document(R"({"id": "it", "type": "sph_fluid"})");
    for (const Handle& handle : handlesOf(graph.nodes[0], {}, {})) {
        if (handle.input != "tank_min") continue;
        EXPECT_EQ(handle.tip(0, 0.0), glm::dvec3(-1, 1, 0)) << "the middle of the left side";
        HandleDrag drag = takeHandle(handle, 0, lens, seenAt(lens, {-1, 1, 0}), 1.0);
        EXPECT_LT(dragTo(drag, lens, seenAt(lens, {1.8, 1, 0}), false, false)[0], 1.0);
    }
}

TEST(Handles, StepsAndTargetsAreKept) {
    const Lens lens(kCamera, kPlace);
    const Graph graph = document(R"({"id": "a", "type": "translate"})");
    const Handle handle = handlesOf(graph.nodes[0], {}, {}).at(0);
    Steps steps(true);
    steps.metres = 0.3;
    HandleDrag drag = takeHandle(handle, 0, lens, seenAt(lens, handle.tip(0, 0.5)), 1.0);
    EXPECT_NEAR(dragTo(drag, lens, seenAt(lens, handle.tip(0, 1.15)), false, steps)[0], 0.6, 1e-12);
    drag = takeHandle(handle, kAcrossView, lens, seenAt(lens, handle.origin), 1.0);
    drag.target = {0.25, 0.5, -0.75};
    const std::vector<double> there = dragTo(drag, lens, seenAt(lens, {1, 1, 1}), false, steps);
    EXPECT_NEAR(there[0], 0.25, 0.006);
    EXPECT_NEAR(there[1], 0.5, 0.006);
    EXPECT_NEAR(there[2], -0.75, 0.006);
}

TEST(Picker, SaysWhereTheSurfaceIs) {
    const Graph graph = document(R"({"id": "ball", "type": "sphere"},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "ball"}}})");
    Picker picker;
    Seen seen;
    seen.graph = std::make_shared<const Graph>(graph);
    seen.region = {{-1.1, -1.1, -1.1}, {1.1, 1.1, 1.1}};
    seen.camera = {.position = {0, 0, 8}, .target = {0, 0, 0}, .fov = 40};
    const auto hit = picker.hit(seen, 0.0, 0.0);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(std::hypot((*hit)[0], (*hit)[1], (*hit)[2] - 1.0), 0.0, 1e-4);
    EXPECT_FALSE(picker.hit(seen, 0.9, 0.9));
}

const char* const kTwo = R"(
  {"id": "block", "type": "box", "inputs": {"half_extents": [0.5, 0.3, 0.2]}},
  {"id": "ball", "type": "sphere", "inputs": {"radius": 0.4}},
  {"id": "there", "type": "transform", "inputs": {"surface": {"from": "ball"}, "translation": [1, 0.5, 0],
      "rotation": [10, 20, 30]}},
  {"id": "both", "type": "union", "inputs": {"a": {"from": "block"}, "b": {"from": "there"}}},
  {"id": "all", "type": "transform", "inputs": {"surface": {"from": "both"}, "translation": [0, 1, 0],
      "rotation": [0, 90, 0], "scale": 2}},
  {"id": "out", "type": "output", "inputs": {"surface": {"from": "all"}}})";

/// After the motion, the field is what it was, moved: whatever stands behind the nodes.
void expectMoved(const Graph& before, const Graph& after, const Motion& motion) {
    const Result<Program> was = compile(before), is = compile(after);
    ASSERT_TRUE(was && is);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-3.0, 3.0);
    for (int i = 0; i < 100; ++i) {
        const glm::dvec3 p(place(random), place(random), place(random)),
            about = motion.about.value_or(glm::dvec3(0.0));
        const glm::dvec3 q = about + motion.turn * ((p - about) * motion.factor) + motion.shift;
        EXPECT_NEAR(evaluate(is->ir, is->distance(), {}, {q.x, q.y, q.z}),
                    motion.factor * evaluate(was->ir, was->distance(), {}, {p.x, p.y, p.z}), 2e-3);
    }
}

TEST(Together, SeveralNodesGoAsOneWhateverStandsBehindThem) {
    const Graph graph = document(kTwo);
    const glm::dmat3 turn(glm::rotate(glm::dmat4(1.0), 0.7, glm::normalize(glm::dvec3(1, 2, 3))));
    for (const Motion& motion : {Motion{.shift = {0.5, -0.25, 1}, .about = glm::dvec3(0.0)},
                                 Motion{.turn = turn, .about = glm::dvec3(1, 2, 0)},
                                 Motion{.factor = 1.5, .about = glm::dvec3(-1, 0, 1)}}) {
        const Tool tool = motion.factor != 1.0           ? Tool::scale
                          : motion.turn != glm::dmat3(1) ? Tool::turn
                                                         : Tool::move;
        std::vector<Placing> placings = placingsOf(graph, "", {"block", "ball"}, "", 0.0, tool);
        ASSERT_EQ(placings.size(), 2u);
        const auto start = withPlacings(graph, "", placings);
        ASSERT_TRUE(start);
        EXPECT_EQ(start->nodes.size(), graph.nodes.size() + 1) << "the box had nothing to move it";
        expectMoved(graph, moved(*start, "", placings, motion), motion);
    }
}

TEST(Together, EachAboutItsOwnPlaceStaysThere) {
    const Graph graph = document(kTwo);
    std::vector<Placing> placings = placingsOf(graph, "", {"there"}, "", 0.0, Tool::turn);
    ASSERT_EQ(placings.size(), 1u);
    EXPECT_EQ(placings[0].node, "there");
    const Motion motion{.turn = glm::dmat3(glm::rotate(glm::dmat4(1.0), 0.5, glm::dvec3(0, 1, 0)))};
    const Graph after = moved(graph, "", placings, motion);
    EXPECT_EQ(inputNumbers(*findNode(after.nodes, "there"), "translation"), (std::vector<double>{1, 0.5, 0}));
    EXPECT_NE(inputNumbers(*findNode(after.nodes, "there"), "rotation"), (std::vector<double>{10, 20, 30}));
}

TEST(Together, WhatAnotherSelectedNodeMovesIsNotMovedTwice) {
    const Graph graph = document(kTwo);
    const auto nodes = [&](const std::set<std::string>& selection) {
        std::set<std::string> moving;
        for (const Placing& placing : placingsOf(graph, "", selection, "", 0.0, Tool::move))
            moving.insert(placing.node);
        return moving;
    };
    EXPECT_EQ(nodes({"ball", "there"}), (std::set<std::string>{"there"}));
    EXPECT_EQ(nodes({"both", "all"}), (std::set<std::string>{"all"}));
}

TEST(Together, TheHandleStandsAtThePivotAlongTheAxes) {
    const Graph graph = document(kTwo);
    const std::vector<Placing> placings = placingsOf(graph, "", {"block", "there"}, "", 0.0, Tool::move);
    ASSERT_EQ(placings.size(), 2u);
    const auto at = [&](PivotAt pivot, AxesOf axes = AxesOf::world) {
        return handleTogether(placings, "there", Tool::move, axes, pivot, {7, 8, 9});
    };
    const glm::dvec3 there(0, 2, -2);
    EXPECT_LT(glm::distance(at(PivotAt::own).origin, there), 1e-9);
    EXPECT_LT(glm::distance(at(PivotAt::selection).origin, 0.5 * (there + glm::dvec3(0, 1, 0))), 1e-9);
    EXPECT_EQ(at(PivotAt::world).origin, glm::dvec3(0.0));
    EXPECT_EQ(at(PivotAt::point).origin, glm::dvec3(7, 8, 9));
    EXPECT_EQ(at(PivotAt::own).axes, glm::dmat3(1.0));
    EXPECT_LT(glm::distance(at(PivotAt::own, AxesOf::numbers).axes[0], glm::dvec3(0, 0, -1)), 1e-9);
    EXPECT_LT(
        glm::distance(at(PivotAt::own, AxesOf::own).axes[0], turned({0, 90, 0}) * turned({10, 20, 30})[0]),
        1e-9);
}

TEST(Together, AnglesAreFoundFromRotations) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> angle(-180.0, 180.0);
    for (int i = 0; i < 200; ++i) {
        glm::dvec3 degrees(angle(random), angle(random), angle(random));
        if (i % 10 == 0) degrees.y = i % 20 == 0 ? 90.0 : -90.0;
        const glm::dmat3 wanted = turned(degrees);
        const glm::dvec3 found = anglesOf(wanted, degrees + glm::dvec3(3, -2, 1));
        const glm::dmat3 got = turned(found);
        for (int c = 0; c < 3; ++c) EXPECT_LT(glm::distance(got[c], wanted[c]), 1e-6) << i;
        if (i % 10 != 0) { EXPECT_LT(glm::distance(found, degrees), 1e-6) << "the nearest of its names"; }
    }
}

TEST(Together, FeaturesArePlacesOfTheOthers) {
    const Graph graph = document(kTwo);
    const std::vector<glm::dvec3> features = featuresOf(graph, "", {"there"}, "", 0.0);
    const auto has = [&](const glm::dvec3& wanted) {
        return std::ranges::any_of(features,
                                   [&](const glm::dvec3& f) { return glm::distance(f, wanted) < 1e-9; });
    };
    EXPECT_TRUE(has({0, 1, 0})) << "the middle of the box";
    EXPECT_TRUE(has({0, 1, -1})) << "its right face";
    EXPECT_TRUE(has({0.4, 1.6, -1})) << "a corner";
    EXPECT_FALSE(has({0, 2, -2})) << "the ball goes along";
}

TEST(Together, BehindAFactorOfZeroNothingBecomesNoNumber) {
    // Which the checker refuses, and a file may hold.
    const Graph graph = document(R"(
        {"id": "ball", "type": "sphere", "inputs": {"p": [1, 0, 0]}},
        {"id": "plane", "type": "plane", "inputs": {"normal": [0, 1, 0]}},
        {"id": "both", "type": "union", "inputs": {"a": {"from": "ball"}, "b": {"from": "plane"}}},
        {"id": "lift", "type": "translate", "inputs": {"surface": {"from": "both"}}},
        {"id": "turn", "type": "rotate", "inputs": {"surface": {"from": "lift"}}},
        {"id": "none", "type": "scale", "inputs": {"surface": {"from": "turn"}, "factor": 0}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "none"}}})");
    const Lens lens(kCamera, kPlace);
    const auto finite = [](const std::vector<double>& numbers) {
        return std::ranges::all_of(numbers, [](double number) { return std::isfinite(number); });
    };
    for (const Node& node : graph.nodes) {
        const auto way = wayToShown(graph, "", node.id, "");
        if (!way) continue;
        for (const Handle& handle : handlesOf(node, placementAlong(graph, "", *way), {}))
            for (int axis = 0; axis <= handle.count; ++axis) {
                // Only what is moved can be held across the view.
                if (axis == handle.count && (axis != kAcrossView || handle.kind != Handle::Kind::move)) break;
                HandleDrag drag = takeHandle(handle, axis, lens, {300, 300}, 1.0);
                for (const double step : {0.0, 0.1}) {
                    const Steps steps(step > 0.0);
                    EXPECT_TRUE(finite(dragTo(drag, lens, {320, 280}, false, steps)))
                        << node.id << "." << handle.input << " " << axis;
                }
            }
    }
    for (const Tool tool : {Tool::move, Tool::turn, Tool::scale}) {
        std::vector<Placing> placings = placingsOf(graph, "", {"ball", "plane", "lift"}, "", 0.0, tool);
        if (placings.empty()) continue;
        const auto placed = withPlacings(graph, "", placings);
        ASSERT_TRUE(placed);
        const Motion motion{.shift = {1, 2, 3}, .turn = turned({10, 20, 30}), .factor = 2.0};
        const std::string text = writeGraph(moved(*placed, "", placings, motion));
        EXPECT_EQ(text.find("null"), std::string::npos) << text;
        EXPECT_TRUE(parseGraph(text, "", nullptr));
    }
}

TEST(Marks, PartsOfTheSceneAreHeldAndKeepItSound) {
    const Graph graph = document("", R"(, "scene": {"camera": {"position": [0, 0, 8], "target": [0, 0, 0]},
      "lights": [{"type": "spot", "position": [0, 3, 0], "target": [0, 0, 0], "angle": 60}]})");
    const Result<Scene> scene = readScene(graph.scene);
    ASSERT_TRUE(scene);
    const Box region{{-1, -1, -1}, {1, 1, 1}};
    std::set<std::string> parts;
    for (const Mark& mark : marksOf(*scene, region)) parts.insert(mark.part);
    EXPECT_EQ(parts, (std::set<std::string>{"camera", "lights.0", "sun"}));

    const std::vector<Handle> sun = handlesOf(*scene, "sun", region, {});
    ASSERT_EQ(sun.size(), 1u);
    const Result<Scene> risen = readScene(withSceneNumbers(graph, sun[0], {1, 1, 0}).scene);
    ASSERT_TRUE(risen);
    EXPECT_NEAR(risen->sun->azimuth, 90.0, 1e-9);
    EXPECT_NEAR(risen->sun->elevation, 45.0, 1e-9);

    std::map<std::string, Handle> lamp;
    for (const Handle& handle : handlesOf(*scene, "lights.0", region, {"lights.0.position"}))
        lamp[handle.input] = handle;
    EXPECT_NE(lamp["position"].refusal, "") << "a track moves it";
    EXPECT_EQ(lamp["target"].refusal, "");
    EXPECT_NEAR(glm::distance(lamp["angle"].tip(0, 0.0), glm::dvec3(0, 3, 0)), 3.0, 1e-9);
    const Result<Scene> wide = readScene(withSceneNumbers(graph, lamp["angle"], {40}).scene);
    ASSERT_TRUE(wide);
    EXPECT_EQ(wide->lights[0].angle, 80.0);

    const std::vector<Handle> camera = handlesOf(*scene, "camera", region, {});
    ASSERT_EQ(camera.size(), 2u);
    EXPECT_EQ(readScene(withSceneNumbers(graph, camera[0], {1, 2, 3}).scene)->camera->position,
              (Triple{1, 2, 3}));
    EXPECT_EQ(*withSceneNumbers(graph, camera[0], {0, 0, 0}).scene, *graph.scene)
        << "a camera does not stand on its target";
}

}  // namespace fw::editor::handles_test
