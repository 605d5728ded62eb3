// What a click on the picture selects: the node whose shape is seen there, whatever stands behind it.
#include "editor/viewport/pick.h"

#include <gtest/gtest.h>

#include <cmath>

#include "editor/document/edits.h"
#include "editor/document/paths.h"
#include "editor/viewport/aside.h"
#include "graph/bounds/region.h"
#include "graph/compile/compile.h"
#include "graph/document/json.h"
#include "runtime/particles/particle_fields.h"
#include "runtime/render/view.h"
#include "tests/support/gpu.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::editor::pick_test {

/// Seen from (7, 5, 9) towards the origin.
Seen seenOf(Graph graph) {
    Seen seen{.graph = std::make_shared<const Graph>(std::move(graph)),
              .region = {{-20, -20, -20}, {20, 20, 20}},
              .aspect = 1.4};
    seen.camera = {.position = {7, 5, 9}, .target = {0, 0, 0}, .fov = 45};
    return seen;
}

Graph parsed(const std::string& text) {
    const Result<Graph> graph = parseGraph(text, "", nullptr);
    EXPECT_TRUE(graph) << format(graph.error());
    return graph ? *graph : Graph{};
}

Graph nodes(const std::string& list, const std::string& rest = "") {
    return parsed(R"({"fieldwright": 1, "nodes": [)" + list + "]" + rest + "}");
}

/// What is picked where this point is seen.
std::string at(const Seen& seen, glm::vec3 point) {
    const glm::vec4 clip = toClip(cameraView(seen.camera, {}, float(seen.aspect))) * glm::vec4(point, 1.0f);
    return Picker().pick(seen, double(clip.x / clip.w), double(clip.y / clip.w));
}

Graph sample(const std::string& name) {
    const Result<Graph> graph =
        readGraph(std::string(FIELDWRIGHT_SOURCE_DIR) + "/samples/" + name + ".field.json", nullptr);
    EXPECT_TRUE(graph) << format(graph.error());
    return graph ? *graph : Graph{};
}

const char* const kTwo = R"(
  {"id": "box", "type": "box", "inputs": {"half_extents": [0.5, 0.5, 0.5]}},
  {"id": "ball", "type": "sphere", "inputs": {"radius": 0.5}},
  {"id": "left", "type": "translate", "inputs": {"surface": {"from": "box"}, "offset": [-2, 0, 0]}},
  {"id": "right", "type": "transform", "inputs": {"surface": {"from": "ball"}, "translation": [2, 0, 0],
    "scale": 2}},
  {"id": "both", "type": "union", "inputs": {"a": {"from": "left"}, "b": {"from": "right"}}},
  {"id": "out", "type": "output", "inputs": {"surface": {"from": "both"}}})";

TEST(Pick, TheShapeUnderTheCursorThroughTransforms) {
    const Seen seen = seenOf(nodes(kTwo));
    EXPECT_EQ(at(seen, {-2, 0, 0}), "box");
    EXPECT_EQ(at(seen, {2, 0, 0}), "ball");
    EXPECT_EQ(at(seen, {0, 0, 0}), "") << "between the two there is nothing";
    EXPECT_EQ(at(seen, {2, 0.9f, 0}), "ball") << "it is twice as large as its node says";
    EXPECT_EQ(at(seen, {-2, 0.9f, 0}), "");
}

TEST(Pick, NothingOutsideOfTheRegionOrTheSolid) {
    Seen seen = seenOf(nodes(kTwo));
    EXPECT_EQ(Picker().pick(seen, 0.99, 0.99), "");
    seen.region = {{-20, -20, -20}, {0, 20, 20}};
    EXPECT_EQ(at(seen, {2, 0, 0}), "");
    EXPECT_EQ(at(seen, {-2, 0, 0}), "box");
}

TEST(Pick, WhatIsPinnedIsWhatIsHit) {
    Seen seen = seenOf(nodes(kTwo));
    seen.pinned = "ball";
    EXPECT_EQ(at(seen, {0, 0, 0}), "ball");
    EXPECT_EQ(at(seen, {2, 0, 0}), "");
}

TEST(Pick, WallsOfAHoleBelongToTheDrill) {
    const Seen seen = seenOf(nodes(R"(
      {"id": "block", "type": "box", "inputs": {"half_extents": [2, 2, 2]}},
      {"id": "drill", "type": "infinite_cylinder", "inputs": {"radius": 1}},
      {"id": "bend", "type": "reroute", "inputs": {"value": {"from": "drill"}}},
      {"id": "part", "type": "subtract", "inputs": {"a": {"from": "block"}, "b": {"from": "bend"}}},
      {"id": "out", "type": "output", "inputs": {"surface": {"from": "part"}}})"));
    EXPECT_EQ(at(seen, {0, 0, 2}), "block");
    EXPECT_EQ(at(seen, {0, 2, 1.6f}), "block");
    EXPECT_EQ(at(seen, {-0.6f, 1.8f, -0.8f}), "drill") << "seen through the opening at the top";
}

TEST(Pick, RepeatsAndDeformationsLeadToTheirShape) {
    const Seen seen = seenOf(nodes(R"(
      {"id": "ball", "type": "sphere", "inputs": {"radius": 0.4}},
      {"id": "row", "type": "repeat", "inputs": {"surface": {"from": "ball"}, "period": [1.5, 0, 0],
        "count": [3, 1, 1]}},
      {"id": "floor", "type": "box", "inputs": {"half_extents": [3, 0.1, 3]}},
      {"id": "low", "type": "translate", "inputs": {"surface": {"from": "floor"}, "offset": [0, -1, 0]}},
      {"id": "twisted", "type": "twist", "inputs": {"surface": {"from": "low"}, "rate": 5}},
      {"id": "all", "type": "union", "inputs": {"a": {"from": "row"}, "b": {"from": "twisted"},
        "radius": 0.05}},
      {"id": "out", "type": "output", "inputs": {"surface": {"from": "all"}}})"));
    for (const float x : {-1.5f, 0.0f, 1.5f}) EXPECT_EQ(at(seen, {x, 0, 0}), "ball") << x;
    EXPECT_EQ(at(seen, {0, -0.9f, 2}), "floor");
}

TEST(Pick, NodesInGroupsAreNamedByTheWayToThem) {
    const Seen seen = seenOf(nodes(R"(
      {"id": "one", "type": "group", "group": "pair"},
      {"id": "two", "type": "group", "group": "pair"},
      {"id": "up", "type": "translate", "inputs": {"surface": {"from": "two"}, "offset": [0, 2.5, 0]}},
      {"id": "both", "type": "union", "inputs": {"a": {"from": "one"}, "b": {"from": "up"}}},
      {"id": "out", "type": "output", "inputs": {"surface": {"from": "both"}}})",
                                   R"(, "groups": [{"id": "pair",
      "outputs": [{"name": "surface", "type": "surface"}], "nodes": [
      {"id": "ball", "type": "sphere", "inputs": {"radius": 0.5}},
      {"id": "bar", "type": "capsule", "inputs": {"a": [1, 0, 0], "b": [2, 0, 0], "radius": 0.2}},
      {"id": "sum", "type": "union", "inputs": {"a": {"from": "ball"}, "b": {"from": "bar"}}},
      {"id": "end", "type": "group_output", "inputs": {"surface": {"from": "sum"}}}]}])"));
    EXPECT_EQ(at(seen, {0, 0, 0}), "one/ball");
    EXPECT_EQ(at(seen, {1.5f, 0, 0}), "one/bar");
    EXPECT_EQ(at(seen, {0, 2.5f, 0}), "two/ball");
    EXPECT_EQ(at(seen, {1.5f, 2.5f, 0}), "two/bar");
}

TEST(Pick, TheTimelineMovesWhatIsHit) {
    Seen seen = seenOf(nodes(R"(
      {"id": "ball", "type": "sphere", "inputs": {"radius": 0.5}},
      {"id": "moved", "type": "translate", "inputs": {"surface": {"from": "ball"}}},
      {"id": "out", "type": "output", "inputs": {"surface": {"from": "moved"}}})",
                             R"(, "timeline": {"length": 2, "tracks": [{"node": "moved", "input": "offset",
      "keys": [{"time": 0, "value": [0, 0, 0]}, {"time": 1, "value": [2, 0, 0]}]}]})"));
    EXPECT_EQ(at(seen, {0, 0, 0}), "ball");
    seen.seconds = 1.0;
    EXPECT_EQ(at(seen, {0, 0, 0}), "");
    EXPECT_EQ(at(seen, {2, 0, 0}), "ball");
}

TEST(Pick, APickerAnswersForWhatIsSeenNow) {
    Picker picker;
    Seen seen = seenOf(nodes(kTwo));
    const auto inTheMiddle = [&] { return picker.pick(seen, 0, 0); };
    EXPECT_EQ(inTheMiddle(), "");
    seen.pinned = "box";
    EXPECT_EQ(inTheMiddle(), "box");
    EXPECT_EQ(inTheMiddle(), "box") << "as it was kept";
    seen.graph = seenOf(nodes(R"({"id": "box", "type": "sphere"})")).graph;
    seen.pinned = "box";
    EXPECT_EQ(inTheMiddle(), "box");
    seen.graph = seenOf(nodes(R"(
      {"id": "ball", "type": "sphere", "inputs": {"radius": 0.5}},
      {"id": "moved", "type": "translate", "inputs": {"surface": {"from": "ball"}}},
      {"id": "out", "type": "output", "inputs": {"surface": {"from": "moved"}}})",
                              R"(, "timeline": {"length": 2, "tracks": [{"node": "moved", "input": "offset",
      "keys": [{"time": 0, "value": [0, 0, 0]}, {"time": 1, "value": [2, 0, 0]}]}]})"))
                     .graph;
    seen.pinned = "";
    EXPECT_EQ(inTheMiddle(), "ball");
    seen.seconds = 1.0;
    EXPECT_EQ(inTheMiddle(), "");
    seen.graph = seenOf(nodes(R"({"id": "ball", "type": "no such type"})")).graph;
    EXPECT_EQ(inTheMiddle(), "");
}

TEST(Pick, Samples) {
    const Seen figure = seenOf(sample("figure"));
    EXPECT_EQ(at(figure, {0, 1.4f, 0.2f}), "head_ball");
    EXPECT_EQ(at(figure, {0, 0.2f, 0}), "torso");
    EXPECT_EQ(at(figure, {0.9f, 0.45f, 0.12f}), "arm");
    EXPECT_EQ(at(figure, {0.37f, -1.2f, 0}), "leg");
    EXPECT_EQ(at(figure, {-0.37f, -1.2f, 0}), "leg") << "its mirror image";
    const Seen part = seenOf(sample("csg_part"));
    EXPECT_EQ(at(part, {0.56f, 0.56f, 0.56f}), "ball") << "a corner of the block, rounded";
    const Seen tower = seenOf(sample("tower"));
    EXPECT_EQ(at(tower, {0.98f, 1.98f, 0.98f}), "tower") << "a corner";
    EXPECT_EQ(at(tower, {0.0f, 1.98f, 0.0f}), "tower");
}

TEST(Pick, EverySampleIsHitInItsMiddleOrBesideIt) {
    for (const char* name : {"brick_block", "cube_morph", "goblet", "gyroid_sphere", "menger", "mushroom",
                             "table_and_stool", "talk_8_repeat_xy", "tower_expression"}) {
        const Graph graph = sample(name);
        const Result<Program> program = compile(graph);
        ASSERT_TRUE(program) << name;
        Seen seen = seenOf(graph);
        const Region region = findRegion(program->ir, program->distance(), program->parameters());
        seen.region = program->region.value_or(region.box);
        if (region.extent != Extent::bounded && !program->region) continue;
        int hits = 0;
        for (int i = 0; i < 5; ++i)
            for (int j = 0; j < 5; ++j) {
                const auto along = [](double lo, double hi, int k) {
                    return float(lo + (hi - lo) * (k + 0.5) / 5.0);
                };
                const std::string path = at(seen, {along(seen.region.lo[0], seen.region.hi[0], i),
                                                   along(seen.region.lo[1], seen.region.hi[1], j), 0});
                if (path.empty()) continue;
                ++hits;
                const auto [scope, id] = placeOf(graph, path);
                EXPECT_NE(findNode(nodesOf(graph, scope), id), nullptr) << name << " has no " << path;
            }
        EXPECT_GT(hits, 4) << name;
    }
}

TEST(Pick, ANodesOwnSolidHasItsBounds) {
    const Graph graph = nodes(kTwo);
    const auto box = solidOf(graph, "box", 0.0), right = solidOf(graph, "right", 0.0);
    ASSERT_TRUE(box && right);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(box->lo[i], -0.5, 0.01);
        EXPECT_NEAR(box->hi[i], 0.5, 0.01);
        EXPECT_NEAR(right->hi[i], i == 0 ? 3.0 : 1.0, 0.02);
    }
    EXPECT_FALSE(solidOf(nodes(R"({"id": "floor", "type": "plane"})"), "floor", 0.0)) << "without end";
}

TEST(Aside, TheNewestQuestionIsAnswered) {
    std::mutex mutex;
    std::condition_variable wake;
    int answers = 0;
    std::vector<int> worked;
    Aside aside([&] {
        std::lock_guard lock(mutex);
        ++answers;
        wake.notify_all();
    });
    bool released = false;
    for (int i = 0; i < 5; ++i)
        aside.ask([&, i]() -> Aside::Answer {
            std::unique_lock lock(mutex);
            worked.push_back(i);
            wake.wait(lock, [&] { return released; });
            return [](Editor&) {};
        });
    std::unique_lock lock(mutex);
    released = true;
    wake.notify_all();
    wake.wait(lock, [&] { return answers > 0 && worked.back() == 4; });
    EXPECT_LE(worked.size(), 5u);
    lock.unlock();
    while (aside.busy()) std::this_thread::yield();
    EXPECT_TRUE(aside.take());
    EXPECT_FALSE(aside.take());
}

TEST(Pick, ParticlesWhereTheyAreAndNotWhereTheyMightBe) {
    const fw::test::TempDir dir;
    fw::test::writeText(dir.path("one.xyz"), "0 0 0\n");
    Graph graph = nodes(R"(
      {"id": "file", "type": "particle_file", "inputs": {"path": "one.xyz"}},
      {"id": "drop", "type": "particles_to_field", "inputs": {"particles": {"from": "file"}, "radius": 0.5,
        "resolution": 32, "region_min": [-2, -2, -2], "region_max": [2, 2, 2]}},
      {"id": "slab", "type": "box", "inputs": {"half_extents": [1.5, 0.1, 1.5]}},
      {"id": "low", "type": "translate", "inputs": {"surface": {"from": "slab"}, "offset": [0, -1, 0]}},
      {"id": "both", "type": "union", "inputs": {"a": {"from": "drop"}, "b": {"from": "low"}}},
      {"id": "out", "type": "output", "inputs": {"surface": {"from": "both"}}})");
    graph.path = dir.path("a.field.json");
    Seen seen = seenOf(graph);
    Result<Program> program = compile(graph);
    ASSERT_TRUE(program);
    ASSERT_TRUE(makeParticles(*program, graph, 0.0, {}, fw::test::device()));
    EXPECT_EQ(at(seen, {1.2, -0.9, 1.2}), "drop");  // of which nothing is known yet
    seen.particles = program->ir.volumes();
    EXPECT_EQ(at(seen, {1.2, -0.9, 1.2}), "slab");
    EXPECT_EQ(at(seen, {0, 0, 0}), "drop");
}

}  // namespace fw::editor::pick_test
