// Edits of the scene and of the timeline: JSON that stays as it was written but for what is edited.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

#include "editor/document/scene_edits.h"
#include "editor/document/timeline_edits.h"
#include "tests/support/editor/graphs.h"

namespace fw::editor::scene_timeline_test {

using editor::test::errorsOf;

/// A ball, and what follows the nodes.
Graph read(const std::string& rest) {
    return editor::test::graphOf(R"({"id": "ball", "type": "sphere", "inputs": {"radius": 2}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "ball"}}})",
                                 rest);
}

const Moved kRadius{Track::Target::input, "ball", "radius"};

std::vector<double> times(const Graph& graph) {
    std::vector<double> list;
    const Result<Timeline> timeline = readTimeline(graph);
    EXPECT_TRUE(timeline);
    if (timeline && !timeline->tracks.empty())
        for (const Key& key : timeline->tracks[0].keys) list.push_back(key.time);
    return list;
}

Graph key(const Graph& graph, double time, double value) {
    return setKey(graph, kRadius, time, std::vector{value});
}

TEST(SceneEdits, ChangeOneValueAndKeepTheRest) {
    const Graph graph = read(R"(, "scene": {"mood": "dusk", "sun": {"azimuth": 3, "spots": [1]}})");
    const Graph set = setSceneValue(graph, "sun.strength", 4.0);
    EXPECT_EQ(set.scene->dump(), R"({"mood":"dusk","sun":{"azimuth":3,"spots":[1],"strength":4.0}})");
    EXPECT_EQ(clearSceneValue(set, "sun.strength").scene, graph.scene);
    EXPECT_EQ(clearSceneValue(graph, "fog.density").scene, graph.scene) << "there is none";
}

TEST(SceneEdits, MakeTheSceneAndWhatIsOff) {
    Graph graph = setSceneValue(read(""), "fog.density", 0.25);
    EXPECT_EQ(graph.scene->dump(), R"({"fog":{"density":0.25}})");
    graph = switchScene(graph, "fog", false);
    EXPECT_FALSE(readScene(graph.scene)->fog);
    graph = setSceneValue(graph, "fog.density", 0.5);
    EXPECT_EQ(readScene(graph.scene)->fog->density, 0.5);
    EXPECT_EQ(switchScene(graph, "fog", true).scene, graph.scene) << "it is on";
    EXPECT_TRUE(readScene(switchScene(read(""), "sky", true).scene)->sky);
    EXPECT_FALSE(readScene(switchScene(read(""), "sun", false).scene)->sun);
}

TEST(SceneEdits, APathBeyondAListChangesNothing) {
    const Graph graph = read(R"(, "scene": {"lights": [{"type": "point"}]})");
    EXPECT_EQ(setSceneValue(graph, "lights.1.strength", 2.0), graph);
    EXPECT_EQ(setSceneValue(read(""), "lights.0.strength", 2.0), read(""));
    EXPECT_EQ((*setSceneValue(graph, "lights.0.strength", 2.0).scene)["lights"][0]["strength"], 2.0);
}

TEST(SceneEdits, TheCameraComesAndGoes) {
    const Camera camera{.position = {1, 2, 3}, .target = {0, 1, 0}, .fov = 50};
    const Graph graph = setSceneCamera(read(R"(, "scene": {"camera": {"lens": "old"}})"), camera);
    EXPECT_EQ(*readScene(graph.scene)->camera, camera);
    EXPECT_EQ((*graph.scene)["camera"]["lens"], "old");
    EXPECT_FALSE(readScene(setSceneCamera(graph, std::nullopt).scene)->camera);
}

TEST(SceneEdits, LampsAreReadBackAsTheyWereAdded) {
    Graph graph = read("");
    for (std::size_t i = 0; i < lampTypes().size(); ++i) {
        Lamp lamp;
        lamp.type = Lamp::Type(i), lamp.position = {double(i) + 1, 2, 3}, lamp.strength = 7;
        graph = addLamp(graph, lamp);
        const Result<Scene> scene = readScene(graph.scene);
        ASSERT_TRUE(scene) << scene.error().message;
        ASSERT_EQ(scene->lights.size(), i + 1);
        EXPECT_EQ(scene->lights[i], lamp);
    }
    while (readScene(graph.scene)->lights.size() < kMostLights) graph = addLamp(graph, Lamp{});
    EXPECT_EQ(addLamp(graph, Lamp{}), graph);
    EXPECT_EQ(errorsOf(graph), "");
}

TEST(SceneEdits, TracksFollowTheLampsThatStay) {
    Graph graph = addLamp(addLamp(addLamp(read(""), Lamp{}), Lamp{}), Lamp{});
    for (const char* path : {"lights.0.strength", "lights.1.strength", "lights.2.color.x", "exposure"})
        graph = setKey(graph, {Track::Target::scene, "", path}, 0.0, std::vector{1.0});
    ASSERT_EQ(errorsOf(graph), "");
    graph = removeLamp(graph, 1);
    EXPECT_EQ(errorsOf(graph), "");
    const Result<Timeline> timeline = readTimeline(graph);
    ASSERT_TRUE(timeline);
    std::vector<std::string> paths;
    for (const Track& track : timeline->tracks) paths.push_back(track.name);
    EXPECT_EQ(paths, (std::vector<std::string>{"lights.0.strength", "lights.1.color.x", "exposure"}));
    EXPECT_EQ(removeLamp(graph, 2), graph);
    EXPECT_FALSE(removeLamp(removeLamp(graph, 0), 0).scene->contains("lights"));
}

TEST(TimelineEdits, TheFirstKeyMakesTrackAndTimeline) {
    const Graph graph = key(read(""), 1.0, 3.0);
    EXPECT_EQ(errorsOf(graph), "");
    const Result<Timeline> timeline = readTimeline(graph);
    ASSERT_TRUE(timeline);
    EXPECT_EQ(timeline->length, kDefaultTimelineLength) << "which a key in its middle does not shorten";
    ASSERT_EQ(timeline->tracks.size(), 1u);
    EXPECT_EQ(movedBy(timeline->tracks[0]), kRadius);
    EXPECT_EQ(timeline->tracks[0].keys[0].value, std::vector{3.0});
    EXPECT_EQ(trackOf(*timeline, kRadius), std::optional<std::size_t>(0));
    EXPECT_EQ(trackOfInput(graph, *timeline, {"ball", "radius"}), std::optional<std::size_t>(0));
    EXPECT_FALSE(trackOfInput(graph, *timeline, {"ball", "p"}));
}

TEST(TimelineEdits, KeysStayInTheOrderOfTheirTimes) {
    Graph graph = key(key(key(read(""), 2.0, 1.0), 0.5, 2.0), 1.0, 3.0);
    EXPECT_EQ(times(graph), (std::vector{0.5, 1.0, 2.0}));
    graph = key(graph, 1.0 + 0.5 * kSameTime, 9.0);
    EXPECT_EQ(times(graph), (std::vector{0.5, 1.0, 2.0})) << "the same key";
    EXPECT_EQ(evaluate(readTimeline(graph)->tracks[0], 1.0), std::vector{9.0});
    graph = moveKey(graph, 0, 0, 1.5);
    EXPECT_EQ(times(graph), (std::vector{1.0, 1.5, 2.0}));
    graph = moveKey(graph, 0, 2, 1.5);
    EXPECT_EQ(times(graph), (std::vector{1.0, 1.5})) << "it took the other's place";
    EXPECT_EQ(evaluate(readTimeline(graph)->tracks[0], 1.5), std::vector{1.0});
    graph = moveKey(graph, 0, 1, -3.0);
    EXPECT_EQ(times(graph), (std::vector{0.0, 1.0}));
    EXPECT_EQ(moveKey(graph, 0, 7, 1.0).timeline, graph.timeline);
    EXPECT_EQ(moveKey(graph, 3, 0, 1.0).timeline, graph.timeline);
}

TEST(TimelineEdits, TheLastKeyTakesTheTrackAlong) {
    Graph graph = key(key(read(""), 0.0, 1.0), 1.0, 2.0);
    graph = removeKey(graph, 0, 0);
    EXPECT_EQ(times(graph), std::vector{1.0});
    graph = removeKey(graph, 0, 0);
    EXPECT_TRUE(readTimeline(graph)->tracks.empty());
    EXPECT_EQ(errorsOf(graph), "");
    EXPECT_TRUE(readTimeline(removeTrack(key(graph, 0.0, 1.0), 0))->tracks.empty());
}

TEST(TimelineEdits, WhatIsUnknownIsKept) {
    Graph graph = read(R"(, "timeline": {"mood": 1, "tracks": [{"node": "ball", "input": "radius",
        "hand": 2, "interpolation": "cubic", "keys": [{"time": 0, "value": 1, "pen": 3},
        {"time": 4, "value": 2, "interpolation": "step"}]}]})");
    graph = setTimelineLength(moveKey(graph, 0, 0, 5.0), 6.0);
    graph = setLoop(setFramesPerSecond(graph, 24.0), Loop::pingPong);
    EXPECT_EQ((*graph.timeline)["mood"], 1);
    EXPECT_EQ((*graph.timeline)["tracks"][0]["hand"], 2);
    EXPECT_EQ((*graph.timeline)["tracks"][0]["keys"][1]["pen"], 3) << "it went along with its key";
    const Result<Timeline> timeline = readTimeline(graph);
    ASSERT_TRUE(timeline);
    EXPECT_EQ(timeline->length, 6.0);
    EXPECT_EQ(timeline->framesPerSecond, 24.0);
    EXPECT_EQ(timeline->loop, Loop::pingPong);
}

TEST(TimelineEdits, ALengthThatFollowedFromTheLastKeyIsWrittenDown) {
    const Graph graph = read(R"(, "timeline": {"tracks": [{"node": "ball", "input": "radius",
        "keys": [{"time": 0, "value": 1}, {"time": 4, "value": 2}]}]})");
    EXPECT_EQ(readTimeline(moveKey(graph, 0, 1, 2.0))->length, 4.0);
}

TEST(TimelineEdits, AChoiceIsWrittenOnlyWhereItIsNotTheTracks) {
    Graph graph = read(R"(, "timeline": {"tracks": [{"node": "ball", "input": "radius",
        "interpolation": "cubic", "keys": [{"time": 0, "value": 1}, {"time": 4, "value": 2}]}]})");
    for (const Interpolation wanted : {Interpolation::step, Interpolation::linear, Interpolation::cubic}) {
        graph = setInterpolation(graph, 0, 0, wanted);
        EXPECT_EQ(readTimeline(graph)->tracks[0].keys[0].interpolation, wanted);
        EXPECT_EQ(readTimeline(graph)->tracks[0].keys[1].interpolation, Interpolation::cubic);
    }
    EXPECT_FALSE((*graph.timeline)["tracks"][0]["keys"][0].contains("interpolation"));
    for (const Ease wanted : {Ease::in, Ease::out, Ease::inOut, Ease::none}) {
        graph = setEase(graph, 0, 1, wanted);
        EXPECT_EQ(readTimeline(graph)->tracks[0].keys[1].ease, wanted);
    }
    EXPECT_FALSE((*graph.timeline)["tracks"][0]["keys"][1].contains("ease"));
}

TEST(TimelineEdits, ATimelineThatCannotBeReadIsLeftAsItIs) {
    Graph graph = read("");
    graph.timeline = Json::parse(R"({"tracks": 7})");
    EXPECT_EQ(key(graph, 0.0, 1.0), graph);
    EXPECT_EQ(removeTrack(graph, 0), graph);
    EXPECT_EQ(setLoop(graph, Loop::once), graph);
}

TEST(TimelineEdits, SaysWhatCannotMove) {
    const Graph graph = read("");
    EXPECT_EQ(motionRefusal(graph, {"ball", "radius"}), "");
    EXPECT_NE(motionRefusal(graph, {"ball", "p"}), "");
    EXPECT_NE(motionRefusal(graph, {"out", "surface"}), "");
    EXPECT_NE(motionRefusal(graph, {"out", "resolution"}), "");
    EXPECT_NE(motionRefusal(graph, {"nobody", "radius"}), "");
}

TEST(TimelineEdits, AnySequenceLeavesASoundDocument) {
    std::mt19937 random(5);
    const auto below = [&](std::size_t n) { return std::size_t(random() % n); };
    Graph graph = read("");
    for (int step = 0; step < 400; ++step) {
        const double time = double(below(40)) / 4.0;
        switch (below(6)) {
            case 0:
            case 1: graph = key(graph, time, 0.5 + double(below(9))); break;
            case 2: graph = moveKey(graph, below(2), below(8), time); break;
            case 3: graph = removeKey(graph, below(2), below(8)); break;
            case 4: graph = setInterpolation(graph, 0, below(8), Interpolation(below(3))); break;
            case 5: graph = setEase(graph, 0, below(8), Ease(below(4))); break;
        }
        ASSERT_EQ(errorsOf(graph), "") << "after step " << step << ": " << graph.timeline->dump();
        const Result<Graph> again = parseGraph(writeGraph(graph), "", nullptr);
        ASSERT_TRUE(again);
        ASSERT_EQ(again->timeline, graph.timeline);
    }
}

}  // namespace fw::editor::scene_timeline_test
