// Nodes shown in place of the output, and their small pictures.
#include "editor/preview/thumbnail.h"

#include <gtest/gtest.h>

#include "editor/preview/pinned.h"
#include "graph/compile/compile.h"
#include "runtime/particles/particle_fields.h"
#include "tests/support/editor/graphs.h"
#include "tests/support/gpu.h"

namespace fw::editor::thumbnail_test {

/// A red ball in a group, whose only output is a number; a box, and what has no end.
constexpr char kGraph[] = R"({"fieldwright": 1,
  "groups": [{"id": "inner", "inputs": [{"name": "size", "type": "float", "value": 0.5}],
    "outputs": [{"name": "twice", "type": "float"}], "nodes": [
      {"id": "in", "type": "group_input"},
      {"id": "ball", "type": "sphere", "inputs": {"radius": {"from": "in", "output": "size"}}},
      {"id": "red", "type": "material", "inputs": {"surface": {"from": "ball"}, "base_color": [1, 0, 0]}},
      {"id": "end", "type": "group_output", "inputs": {"twice": {"from": "in", "output": "size"}}}]}],
  "nodes": [
    {"id": "box", "type": "box"},
    {"id": "given", "type": "group", "group": "inner", "inputs": {"size": 3}},
    {"id": "plane", "type": "plane"},
    {"id": "nothing", "type": "subtract", "inputs": {"a": {"from": "box"}, "b": {"from": "box"}}},
    {"id": "out", "type": "output", "inputs": {"surface": {"from": "box"}}}]})";

Graph graph() { return editor::test::parsed(kGraph); }

double distanceAt(const Graph& shown, const Point& p) {
    const Result<Program> program = compile(shown);
    EXPECT_TRUE(program) << (program ? "" : format(program.error()));
    return program ? evaluate(program->ir, program->distance(), program->parameters(), p) : NAN;
}

TEST(Pinned, ANodeOfTheDocument) {
    Graph without = graph();
    std::erase_if(without.nodes, [](const Node& node) { return node.type == "output"; });
    EXPECT_NEAR(distanceAt(showingNode(without, "plane"), {1, 2, 3}), 2.0, 1e-12) << "an output is added";
    EXPECT_EQ(showingNode(graph(), "out"), graph());
    EXPECT_EQ(showingNode(graph(), "no_such_node"), graph());
}

TEST(Pinned, SeveralAreSeenTogether) {
    const std::vector<std::string> paths = {"box", "plane"};
    const std::string both = pinnedTogether(paths);
    EXPECT_EQ(both, "box + plane");
    EXPECT_EQ(pinnedNodes(both), paths);
    EXPECT_EQ(pinnedNodes("inner/ball"), std::vector<std::string>{"inner/ball"});
    EXPECT_TRUE(pinnedNodes("").empty());
    const auto alone = [&](const char* path, const Point& p) {
        return distanceAt(showingNode(graph(), path), p);
    };
    for (const Point& p : {Point{0, 5, 0}, Point{3, 0.2, 0}, Point{0.3, 0.4, 0.2}, Point{1, -2, 1}})
        EXPECT_EQ(distanceAt(showingNode(graph(), both), p), std::min(alone("box", p), alone("plane", p)));
    const Graph three = showingNode(graph(), "box + plane + nothing");
    EXPECT_EQ(three.nodes.size(), graph().nodes.size() + 2);
    EXPECT_EQ(showingNode(graph(), "box + gone"), showingNode(graph(), "box"));
    // In a group as in its instance.
    const Graph inner = showingNode(graph(), "inner/ball + inner/red");
    EXPECT_NEAR(distanceAt(inner, {5, 0, 0}), 2.0, 1e-12);
    EXPECT_TRUE(makesSurface(*graph().node("box")));
    EXPECT_FALSE(makesSurface(*graph().node("out")));
}

TEST(Pinned, ANodeInAGroupIsSeenAsInItsInstance) {
    EXPECT_NEAR(distanceAt(showingNode(graph(), "inner/ball"), {5, 0, 0}), 2.0, 1e-12);
    Graph unused = graph();
    std::erase_if(unused.nodes, [](const Node& node) { return node.id == "given"; });
    EXPECT_NEAR(distanceAt(showingNode(unused, "inner/red"), {5, 0, 0}), 4.5, 1e-12) << "with defaults";
}

/// The mean of the pixels that are not as the first.
std::array<double, 3> meanColor(const Picture& picture, std::size_t& count) {
    std::array<double, 3> sum{};
    count = 0;
    for (std::size_t i = 0; i < picture.pixels.size(); i += 4) {
        if (std::equal(&picture.pixels[i], &picture.pixels[i] + 3, &picture.pixels[0])) continue;
        for (std::size_t c = 0; c < 3; ++c) sum[c] += picture.pixels[i + c];
        ++count;
    }
    for (double& c : sum) c /= double(std::max<std::size_t>(count, 1));
    return sum;
}

TEST(Thumbnail, ShowsTheNodesOwnField) {
    const Result<Thumbnail> red = thumbnail(graph(), "inner/red");
    ASSERT_TRUE(red) << format(red.error());
    ASSERT_EQ(red->picture.pixels.size(), std::size_t(4 * kThumbnailSide * kThumbnailSide));
    std::size_t seen = 0;
    const auto color = meanColor(red->picture, seen);
    // A ball that is framed fills about half of the picture.
    EXPECT_NEAR(double(seen) / (kThumbnailSide * kThumbnailSide), 0.5, 0.25);
    EXPECT_GT(color[0], 100);
    EXPECT_LT(color[1], 10);
}

TEST(Thumbnail, IsMadeAnewOnlyIfTheNodeChanged) {
    Graph edited = graph();
    const Result<Thumbnail> first = thumbnail(edited, "box");
    ASSERT_TRUE(first);
    InputValue radius;
    radius.value = 0.7;
    edited.groups[0].nodes[1].set("radius", radius);
    const Result<Thumbnail> same = thumbnail(edited, "box", {}, first->made);
    ASSERT_TRUE(same);
    EXPECT_EQ(same->made, first->made);
    EXPECT_TRUE(same->picture.pixels.empty());
    InputValue extents;
    extents.value = std::vector<double>{1, 2, 3};
    edited.node("box")->set("half_extents", extents);
    const Result<Thumbnail> other = thumbnail(edited, "box", {}, first->made);
    ASSERT_TRUE(other);
    EXPECT_NE(other->made, first->made);
    EXPECT_NE(other->picture.pixels, first->picture.pixels);
}

TEST(Thumbnail, WhatHasNoEndIsSeenAndWhatIsNothingSaysSo) {
    std::size_t seen = 0;
    const Result<Thumbnail> plane = thumbnail(graph(), "plane");
    ASSERT_TRUE(plane) << format(plane.error());
    meanColor(plane->picture, seen);
    EXPECT_GT(seen, 100u);
    EXPECT_FALSE(thumbnail(graph(), "nothing"));
    EXPECT_FALSE(thumbnail(graph(), "no_such_node"));
    EXPECT_FALSE(thumbnail(graph(), "inner/in")) << "gives no surface";
}

TEST(Thumbnail, ShowsTheParticlesOfThePicture) {
    const Graph graph = editor::test::parsed(R"({"fieldwright": 1, "nodes": [
        {"id": "drop", "type": "emitter", "inputs": {"shape": "point", "burst": 1, "velocity": [0, 0, 0]}},
        {"id": "field", "type": "particles_to_field", "inputs": {"particles": {"from": "drop"},
          "region_min": [-1, -1, -1], "region_max": [1, 1, 1], "radius": 0.5, "resolution": 32}},
        {"id": "other", "type": "particles_to_field", "inputs": {"particles": {"from": "drop"}}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "field"}}}]})");
    const Result<Thumbnail> before = thumbnail(graph, "field");
    ASSERT_TRUE(before) << format(before.error());
    EXPECT_TRUE(before->particles);
    EXPECT_TRUE(before->picture.pixels.empty());
    Result<Program> program = compile(graph);
    ASSERT_TRUE(program);
    ASSERT_TRUE(makeParticles(*program, graph, 0.0, {}, fw::test::device()));
    const Result<Thumbnail> ball = thumbnail(graph, "field", program->ir.volumes(), before->made);
    ASSERT_TRUE(ball) << format(ball.error());
    std::size_t seen = 0;
    meanColor(ball->picture, seen);
    EXPECT_NEAR(double(seen) / (kThumbnailSide * kThumbnailSide), 0.5, 0.25) << "a ball, not its grid";
    EXPECT_FALSE(thumbnail(graph, "other", program->ir.volumes())) << "is not in the picture";
}

}  // namespace fw::editor::thumbnail_test
