// Many keys at once: selecting, moving, scaling, copying and pasting them, their tangents, markers, the
// range.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "editor/document/key_edits.h"
#include "graph/document/named_parameters.h"
#include "tests/support/editor/graphs.h"

namespace fw::editor::timeline_edits_test {

using editor::test::errorsOf;

constexpr const char* kNodes = R"({"id": "ball", "type": "sphere", "inputs": {"radius": 2}},
    {"id": "cube", "type": "box"},
    {"id": "moved", "type": "translate", "inputs": {"surface": {"from": "ball"}}},
    {"id": "both", "type": "union", "inputs": {"a": {"from": "moved"}, "b": {"from": "cube"}}},
    {"id": "out", "type": "output", "inputs": {"surface": {"from": "both"}}})";

Graph read(const std::string& tracks, const std::string& more = "") {
    return editor::test::graphOf(
        kNodes, R"(, "timeline": {"length": 10, "fps": 10, )" + more + R"("tracks": [)" + tracks + "]}");
}

const Moved kRadius{Track::Target::input, "ball", "radius"}, kOffset{Track::Target::input, "moved", "offset"},
    kExtents{Track::Target::input, "cube", "half_extents"}, kExposure{Track::Target::scene, "", "exposure"};

const std::string kRadiusTrack = R"({"node": "ball", "input": "radius", "keys": [
    {"time": 0, "value": 1}, {"time": 1, "value": 2, "pen": "red"}, {"time": 2, "value": 3}, {"time": 4, "value": 5}]})";
const std::string kOffsetTrack = R"({"node": "moved", "input": "offset", "interpolation": "cubic", "keys": [
    {"time": 1, "value": [0, 0, 0]}, {"time": 3, "value": [1, 2, 3]}]})";

KeySelection select(const std::vector<std::pair<Moved, std::vector<double>>>& keys) {
    KeySelection selection;
    for (const auto& [moved, times] : keys)
        for (double time : times) selection.add(moved, time);
    return selection;
}

Track trackOf(const Graph& graph, const Moved& moved) {
    const Result<Timeline> timeline = readTimeline(graph);
    EXPECT_TRUE(timeline);
    const auto index = timeline ? editor::trackOf(*timeline, moved) : std::nullopt;
    return index ? timeline->tracks[*index] : Track{};
}
/// "0:1 1:2", times and first values.
std::string keys(const Graph& graph, const Moved& moved) {
    std::string text;
    for (const Key& key : trackOf(graph, moved).keys) {
        char word[64];
        std::snprintf(word, sizeof word, "%s%.4g:%.4g", text.empty() ? "" : " ", key.time, key.value[0]);
        text += word;
    }
    return text;
}

TEST(KeySelection, AddsTakesAwayAndFinds) {
    KeySelection selection = select({{kRadius, {2, 0, 1}}, {kOffset, {3}}});
    EXPECT_EQ(selection.size(), 4u);
    EXPECT_EQ(*selection.of(kRadius), (std::vector<double>{0, 1, 2}));
    EXPECT_TRUE(selection.contains(kRadius, 1 + 0.5 * kSameTime));
    EXPECT_FALSE(selection.contains(kRadius, 1.5));
    EXPECT_FALSE(selection.contains(kOffset, 1));
    EXPECT_EQ(selection.span(), std::pair(0.0, 3.0));
    selection.add(kRadius, 1);
    EXPECT_EQ(selection.size(), 4u) << "it is there";
    selection.toggle(kRadius, 1);
    selection.toggle(kOffset, 3);
    EXPECT_EQ(selection, select({{kRadius, {0, 2}}}));
    selection.toggle(kOffset, 3);
    EXPECT_EQ(selection.tracks.size(), 2u);
}

TEST(KeySelection, FollowsTheTimeline) {
    const Timeline timeline = *readTimeline(read(kRadiusTrack + "," + kOffsetTrack));
    EXPECT_EQ(allKeys(timeline).size(), 6u);
    const KeySelection some = select({{kRadius, {1, 7}}, {kExposure, {0}}});
    EXPECT_EQ(stillThere(some, timeline), select({{kRadius, {1}}}));
    EXPECT_EQ(inverted(some, timeline), select({{kRadius, {0, 2, 4}}, {kOffset, {1, 3}}}));
    EXPECT_EQ(joined(select({{kRadius, {0}}}), some).size(), 4u);
}

TEST(Keys, AreMovedTogether) {
    const Graph graph = read(kRadiusTrack + "," + kOffsetTrack);
    const KeysEdited moved = retimed(graph, select({{kRadius, {0, 1}}, {kOffset, {3}}}), {.shift = 0.5});
    EXPECT_EQ(keys(moved.graph, kRadius), "0.5:1 1.5:2 2:3 4:5");
    EXPECT_EQ(keys(moved.graph, kOffset), "1:0 3.5:1");
    EXPECT_EQ(moved.selection, select({{kRadius, {0.5, 1.5}}, {kOffset, {3.5}}}));
    EXPECT_EQ((*moved.graph.timeline)["tracks"][0]["keys"][1]["pen"], "red") << "it went along";
    EXPECT_EQ(errorsOf(moved.graph), "");
}

TEST(Keys, ThatMoveOverOthersWin) {
    const Graph graph = read(kRadiusTrack);
    const KeysEdited on = retimed(graph, select({{kRadius, {0, 1}}}), {.shift = 1.0});
    EXPECT_EQ(keys(on.graph, kRadius), "1:1 2:2 4:5") << "the one at 2 s is gone, the one from 1 s is not";
    const KeysEdited beyond = retimed(graph, select({{kRadius, {0}}}), {.shift = 3.0});
    EXPECT_EQ(keys(beyond.graph, kRadius), "1:2 2:3 3:1 4:5") << "passing takes nothing away";
    // A drag starts from what was there when it began: on its way back it gives all back.
    EXPECT_EQ(retimed(graph, select({{kRadius, {0, 1}}}), {.shift = 0.0}).graph.timeline, graph.timeline);
}

TEST(Keys, StopAtTheBeginningTogether) {
    const KeysEdited moved = retimed(read(kRadiusTrack), select({{kRadius, {1, 2}}}), {.shift = -5.0});
    EXPECT_EQ(keys(moved.graph, kRadius), "0:2 1:3 4:5") << "as far apart as they were";
}

TEST(Keys, AreScaledAboutATime) {
    const Graph graph = read(kRadiusTrack);
    const KeySelection all = select({{kRadius, {0, 1, 2, 4}}});
    EXPECT_EQ(keys(retimed(graph, all, {.pivot = 0, .factor = 2}).graph, kRadius), "0:1 2:2 4:3 8:5");
    EXPECT_EQ(keys(retimed(graph, all, {.pivot = 4, .factor = 0.5}).graph, kRadius), "2:1 2.5:2 3:3 4:5");
    EXPECT_EQ(keys(retimed(graph, all, {.pivot = 0, .factor = 0.26, .framesPerSecond = 10}).graph, kRadius),
              "0:1 0.3:2 0.5:3 1:5")
        << "on frames";
    EXPECT_EQ(keys(retimed(graph, all, {.pivot = 0, .factor = 0.01, .framesPerSecond = 10}).graph, kRadius),
              "0:5")
        << "of those that fall together the last one is left";
}

TEST(KeysProperty, AScaledCurveIsTheSameCurveInAnotherTime) {
    std::mt19937 random(7);
    const auto number = [&](double lo, double hi) { return std::uniform_real_distribution(lo, hi)(random); };
    for (int round = 0; round < 50; ++round) {
        Graph graph = read(R"({"node": "moved", "input": "offset", "interpolation": "cubic", "keys": [
            {"time": 1, "value": [0, 0, 0], "out": [2, -1, 0]}, {"time": 2, "value": [1, 2, 3], "in": 1, "out": -3},
            {"time": 3, "value": [0, 1, 0], "tangents": "flat"}, {"time": 3.5, "value": [2, 1, 0]}]})");
        const double pivot = number(0, 3), factor = number(0.3, 2.5), shift = number(3, 6);
        const KeysEdited scaled = retimed(graph, select({{kOffset, {1, 2, 3, 3.5}}}),
                                          {.pivot = pivot, .factor = factor, .shift = shift});
        const Track before = trackOf(graph, kOffset), after = trackOf(scaled.graph, kOffset);
        for (double t = 1.0; t <= 3.5; t += 0.07)
            for (std::size_t c = 0; c < 3; ++c)
                EXPECT_NEAR(evaluate(before, t)[c], evaluate(after, pivot + (t - pivot) * factor + shift)[c],
                            1e-9);
    }
}

TEST(Keys, RiseWithinTheInputsRange) {
    const Graph graph = read(kRadiusTrack + "," + kOffsetTrack);
    const KeySelection some = select({{kRadius, {0, 1}}, {kOffset, {3}}});
    EXPECT_EQ(keys(raised(graph, some, 0, 2.5), kRadius), "0:3.5 1:4.5 2:3 4:5");
    EXPECT_EQ(trackOf(raised(graph, some, 2, 2.5), kOffset).keys[1].value, (std::vector{1.0, 2.0, 5.5}));
    EXPECT_EQ(keys(raised(graph, some, 2, 2.5), kRadius), keys(graph, kRadius)) << "it has no third number";
    const Graph low = raised(graph, some, 0, -100.0);
    EXPECT_GE(trackOf(low, kRadius).keys[0].value[0], 0.0);
    EXPECT_EQ(errorsOf(low), "");
}

TEST(Keys, ThatGoTakeTheTrackAlong) {
    const Graph graph = read(kRadiusTrack + "," + kOffsetTrack);
    const Graph left = withoutKeys(graph, select({{kRadius, {0, 1, 2, 4}}, {kOffset, {1}}}));
    const Result<Timeline> timeline = readTimeline(left);
    ASSERT_TRUE(timeline);
    ASSERT_EQ(timeline->tracks.size(), 1u);
    EXPECT_EQ(keys(left, kOffset), "3:1");
}

TEST(Keys, AreDuplicatedAfterThemselves) {
    const KeysEdited twice = duplicatedKeys(read(kRadiusTrack), select({{kRadius, {0, 1}}}), 1.5);
    EXPECT_EQ(keys(twice.graph, kRadius), "0:1 1:2 1.5:1 2:3 2.5:2 4:5");
    EXPECT_EQ(twice.selection, select({{kRadius, {1.5, 2.5}}}));
    EXPECT_EQ(keys(duplicatedKeys(read(kRadiusTrack), select({{kRadius, {0, 1}}}), 1.0).graph, kRadius),
              "0:1 1:1 2:2 4:5")
        << "copies win";
}

TEST(Keys, AreCopiedAndPasted) {
    const Graph graph = read(kRadiusTrack + "," + kOffsetTrack);
    const std::string text = copyKeys(graph, select({{kRadius, {1, 2}}, {kOffset, {3}}}));
    std::size_t left = 9;
    const Result<KeysEdited> pasted = pasteKeys(graph, text, 5.0, nullptr, &left);
    ASSERT_TRUE(pasted) << pasted.error().message;
    EXPECT_EQ(left, 0u);
    EXPECT_EQ(keys(pasted->graph, kRadius), "0:1 1:2 2:3 4:5 5:2 6:3");
    EXPECT_EQ(keys(pasted->graph, kOffset), "1:0 3:1 7:1");
    EXPECT_EQ(pasted->selection, select({{kRadius, {5, 6}}, {kOffset, {7}}}));
    EXPECT_EQ(trackOf(pasted->graph, kOffset).keys[2].interpolation, Interpolation::cubic);
    EXPECT_EQ((*pasted->graph.timeline)["tracks"][0]["keys"][4]["pen"], "red");
    EXPECT_EQ(errorsOf(pasted->graph), "");

    // In a document without these tracks they are made.
    const Graph plain = editor::test::graphOf(kNodes);
    const Result<KeysEdited> made = pasteKeys(plain, text, 0.0, nullptr);
    ASSERT_TRUE(made);
    EXPECT_EQ(keys(made->graph, kRadius), "0:2 1:3");
    EXPECT_EQ(errorsOf(made->graph), "");
}

TEST(Keys, ArePastedFromOneTrackIntoAnother) {
    const Graph graph =
        read(kRadiusTrack + "," + kOffsetTrack +
             R"(, {"node": "cube", "input": "half_extents", "keys": [{"time": 0, "value": [1, 1, 1]}]})");
    const std::string vectors = copyKeys(graph, select({{kOffset, {1, 3}}}));
    const Result<KeysEdited> pasted = pasteKeys(graph, vectors, 2.0, &kExtents);
    ASSERT_TRUE(pasted) << pasted.error().message;
    EXPECT_EQ(trackOf(pasted->graph, kExtents).keys.size(), 3u);
    EXPECT_EQ(trackOf(pasted->graph, kExtents).keys[2].value, (std::vector<double>{1, 2, 3}));
    EXPECT_EQ(keys(pasted->graph, kOffset), keys(graph, kOffset));
    const Result<KeysEdited> refused = pasteKeys(graph, vectors, 2.0, &kRadius);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().message, "the keys have 3 numbers, those of ball · radius have 1");
}

TEST(Keys, ThatCannotBePastedSayWhy) {
    const Graph graph = read(kRadiusTrack);
    for (const char* text :
         {"", "{}", "[]", "keys", R"({"nodes": []})", R"({"keys_of": 3})",
          R"({"keys_of": [{"node": "ball", "input": "radius", "keys": []}]})",
          R"({"keys_of": [{"node": "ball", "input": "radius", "keys": [{"time": -1, "value": 1}]}]})"})
        EXPECT_EQ(pasteKeys(graph, text, 0.0, nullptr).error().message, "the clipboard holds no keys")
            << text;
    const char* stranger =
        R"({"keys_of": [{"node": "nobody", "input": "radius", "keys": [{"time": 0, "value": 1}]}]})";
    EXPECT_NE(pasteKeys(graph, stranger, 0.0, nullptr).error().message.find("nothing here moves"),
              std::string::npos);
    std::size_t left = 0;
    const char* half =
        R"({"keys_of": [{"node": "nobody", "input": "radius", "keys": [{"time": 0, "value": 1}]},
                        {"scene": "exposure", "keys": [{"time": 0, "value": 1}]}]})";
    const Result<KeysEdited> some = pasteKeys(graph, half, 0.0, nullptr, &left);
    ASSERT_TRUE(some);
    EXPECT_EQ(left, 1u);
    EXPECT_EQ(keys(some->graph, kExposure), "0:1");
}

TEST(Keys, GetTheirChoicesTogether) {
    const Graph graph = read(kRadiusTrack + "," + kOffsetTrack);
    const KeySelection some = select({{kRadius, {0, 1}}, {kOffset, {1}}});
    const Graph cubic = setInterpolations(graph, some, Interpolation::cubic);
    EXPECT_EQ(trackOf(cubic, kRadius).keys[1].interpolation, Interpolation::cubic);
    EXPECT_EQ(trackOf(cubic, kRadius).keys[2].interpolation, Interpolation::linear);
    EXPECT_FALSE((*cubic.timeline)["tracks"][1]["keys"][0].contains("interpolation")) << "the track has it";
    EXPECT_EQ(trackOf(setEases(graph, some, Ease::out), kRadius).keys[0].ease, Ease::out);
}

TEST(Tangents, AreChosen) {
    const Graph graph = read(kOffsetTrack);
    const KeySelection one = select({{kOffset, {3}}});
    const auto key = [&](const Graph& of) { return trackOf(of, kOffset).keys[1]; };
    EXPECT_EQ(tangentsOf(key(graph)), TangentChoice::automatic);
    for (const TangentChoice choice : {TangentChoice::flat, TangentChoice::linear, TangentChoice::unified,
                                       TangentChoice::broken, TangentChoice::automatic}) {
        const Graph set = setTangents(graph, one, choice);
        EXPECT_EQ(tangentsOf(key(set)), choice);
        EXPECT_EQ(errorsOf(set), "");
    }
    EXPECT_EQ(
        setTangents(setTangents(graph, one, TangentChoice::broken), one, TangentChoice::automatic).timeline,
        graph.timeline)
        << "nothing is left of it";
    // Of its own, slopes are what they were.
    const Track before = trackOf(graph, kOffset),
                after = trackOf(setTangents(graph, one, TangentChoice::broken), kOffset);
    for (double t = 1.0; t <= 3.0; t += 0.1) EXPECT_EQ(evaluate(before, t), evaluate(after, t));
}

TEST(Tangents, AreTurnedTogetherOrApart) {
    const Graph graph = read(R"({"node": "moved", "input": "offset", "interpolation": "cubic", "keys": [
        {"time": 0, "value": [0, 0, 0]}, {"time": 1, "value": [1, 2, 3]}, {"time": 2, "value": [4, 0, 0]}]})");
    const auto slope = [&](const Graph& of, std::size_t c, KeySide side) {
        return slopeAt(trackOf(of, kOffset), 1, c, side);
    };
    const Graph both = setSlope(graph, kOffset, 1, 0, KeySide::out, 7.0, false);
    EXPECT_EQ(slope(both, 0, KeySide::out), 7.0);
    EXPECT_EQ(slope(both, 0, KeySide::in), 7.0);
    EXPECT_EQ(slope(both, 1, KeySide::out), slope(graph, 1, KeySide::out)) << "the others stay";
    EXPECT_EQ(tangentsOf(trackOf(both, kOffset).keys[1]), TangentChoice::unified);
    const Graph apart = setSlope(both, kOffset, 1, 0, KeySide::in, -2.0, true);
    EXPECT_EQ(slope(apart, 0, KeySide::out), 7.0);
    EXPECT_EQ(slope(apart, 0, KeySide::in), -2.0);
    EXPECT_EQ(tangentsOf(trackOf(apart, kOffset).keys[1]), TangentChoice::broken);
    const Graph further = setSlope(apart, kOffset, 1, 0, KeySide::out, 1.0, false);
    EXPECT_EQ(slope(further, 0, KeySide::in), -2.0) << "broken ones stay apart";
    const Graph united = setTangents(further, select({{kOffset, {1}}}), TangentChoice::unified);
    EXPECT_EQ(slope(united, 0, KeySide::in), -0.5);
    EXPECT_EQ(slope(united, 0, KeySide::out), -0.5);
    EXPECT_EQ(setSlope(graph, kOffset, 1.5, 0, KeySide::in, 1.0, false).timeline, graph.timeline) << "no key";
}

TEST(Markers, AreAddedMovedRenamedAndRemoved) {
    Graph graph = read(kRadiusTrack);
    EXPECT_EQ(freshMarkerName(*readTimeline(graph)), "Marker 1");
    graph = addMarker(graph, 2.0, "Marker 1");
    graph = addMarker(addMarker(graph, 1.0, "door"), 2.0, "twice");
    Result<Timeline> timeline = readTimeline(graph);
    ASSERT_EQ(timeline->markers.size(), 2u) << "there was one at 2 s";
    EXPECT_EQ(freshMarkerName(*timeline), "Marker 2");
    graph = renameMarker(moveMarker(graph, 0, 3.5), 1, "gate");
    timeline = readTimeline(graph);
    EXPECT_EQ(timeline->markers[0].time, 3.5);
    EXPECT_EQ(timeline->markers[1].name, "gate");
    EXPECT_EQ(errorsOf(graph), "");
    EXPECT_EQ(removeMarker(graph, 5), graph);
    graph = removeMarker(removeMarker(graph, 0), 0);
    EXPECT_EQ(graph.timeline, read(kRadiusTrack).timeline) << "nothing is left of them";
}

TEST(Range, IsKeptInTheDocument) {
    const Graph graph = setRange(read(kRadiusTrack), TimeRange{1, 3});
    EXPECT_EQ(readTimeline(graph)->range, (TimeRange{1, 3}));
    EXPECT_EQ(setRange(graph, TimeRange{3, 1}).timeline, graph.timeline);
    EXPECT_EQ(setRange(graph, std::nullopt).timeline, read(kRadiusTrack).timeline);
}

TEST(Keys, GoAlongWithADuplicatedNode) {
    const Graph graph =
        read(kRadiusTrack + R"(, {"node": "moved", "input": "offset.y", "keys": [{"time": 0, "value": 1}]},
        {"parameter": "size", "keys": [{"time": 0, "value": [1, 1, 1]}]})");
    Graph with = graph;
    ExposedParameter size;
    size.name = "size", size.node = "cube", size.input = "half_extents";
    with.parameters.push_back(size);
    ASSERT_EQ(errorsOf(with), "");
    const std::vector<std::string> nodes = {"ball", "moved", "cube"};
    const Edited twice = duplicate(with, "", nodes, false);
    ASSERT_EQ(twice.nodes.size(), 3u);
    EXPECT_EQ(errorsOf(twice.graph), "");
    ASSERT_EQ(readTimeline(twice.graph)->tracks.size(), 6u);
    EXPECT_EQ(keys(twice.graph, {Track::Target::input, "ball_2", "radius"}), keys(graph, kRadius));
    EXPECT_EQ(keys(twice.graph, {Track::Target::input, "moved_2", "offset.y"}), "0:1");
    EXPECT_EQ(keys(twice.graph, {Track::Target::input, "cube_2", "half_extents"}), "0:1");
}

const Plug kRadiusPlug{"ball", "radius"}, kOffsetPlug{"moved", "offset"};

TEST(MovedInput, IsSetByAKeyAtTheTime) {
    const Graph graph =
        read(kRadiusTrack + R"(, {"node": "moved", "input": "offset.y", "keys": [{"time": 0, "value": 1}]})");
    EXPECT_EQ(keys(setMovedInput(graph, kRadiusPlug, 3.0, {9.0}), kRadius), "0:1 1:2 2:3 3:9 4:5");
    EXPECT_EQ(keys(setMovedInput(graph, kRadiusPlug, 1.0, {9.0}), kRadius), "0:1 1:9 2:3 4:5");
    EXPECT_EQ(setMovedInput(graph, kRadiusPlug, 3.0, {4.0}), graph) << "it is that";
    // One component is moved, the others are the input's own.
    const Moved y{Track::Target::input, "moved", "offset.y"};
    const Graph up = setMovedInput(graph, kOffsetPlug, 2.0, {0.0, 5.0, 0.0});
    EXPECT_EQ(keys(up, y), "0:1 2:5");
    const Graph aside = setMovedInput(graph, kOffsetPlug, 2.0, {3.0, 1.0, 0.0});
    EXPECT_EQ(keys(aside, y), "0:1");
    EXPECT_EQ(inputNumbers(*aside.node("moved"), "offset")[0], 3.0);
    EXPECT_EQ(errorsOf(up) + errorsOf(aside), "");
}

TEST(MovedInput, KeepsItsNumbersWithoutItsMotion) {
    const Graph still = removeMotion(read(kRadiusTrack + "," + kOffsetTrack), kRadiusPlug, 3.0);
    EXPECT_EQ(readTimeline(still)->tracks.size(), 1u);
    EXPECT_EQ(inputNumbers(*still.node("ball"), "radius"), std::vector{4.0});
    EXPECT_EQ(removeMotion(still, kRadiusPlug, 3.0), still);
}

TEST(MovedInput, GetsAndLosesKeys) {
    const Graph graph = read(kRadiusTrack);
    EXPECT_EQ(keys(insertKeyOf(graph, kRadiusPlug, 3.0), kRadius), "0:1 1:2 2:3 3:4 4:5");
    EXPECT_EQ(keys(removeKeyOf(graph, kRadiusPlug, 2.0), kRadius), "0:1 1:2 4:5");
    EXPECT_EQ(removeKeyOf(graph, kRadiusPlug, 3.0), graph);
    const Graph first = insertKeyOf(graph, kOffsetPlug, 2.0);
    EXPECT_EQ(trackOf(first, kOffset).keys.at(0).value, (std::vector<double>{0, 0, 0}));
    EXPECT_EQ(insertKeyOf(graph, {"both", "a"}, 2.0), graph) << "it is linked";
}

TEST(KeysProperty, AnySequenceLeavesASoundDocument) {
    std::mt19937 random(9);
    const auto below = [&](std::size_t n) { return std::size_t(random() % n); };
    Graph graph = read(kRadiusTrack + "," + kOffsetTrack);
    std::string clipboard;
    for (int step = 0; step < 400; ++step) {
        const Timeline timeline = *readTimeline(graph);
        KeySelection selection;
        for (const Track& track : timeline.tracks)
            for (const Key& key : track.keys)
                if (below(3) == 0) selection.add(movedBy(track), key.time);
        if (timeline.tracks.empty()) graph = setKey(graph, kRadius, 1.0, std::vector{1.0});
        KeysEdited edited{graph, selection};
        const double time = double(below(80)) / 10.0;
        switch (below(9)) {
            case 0: edited = retimed(graph, selection, {.shift = time - 4.0}); break;
            case 1:
                edited =
                    retimed(graph, selection,
                            {.pivot = time, .factor = 0.2 + 0.1 * double(below(20)), .framesPerSecond = 10});
                break;
            case 2: edited.graph = raised(graph, selection, below(3), double(below(10)) - 5.0); break;
            case 3: edited.graph = below(4) ? graph : withoutKeys(graph, selection); break;
            case 4: edited = duplicatedKeys(graph, selection, time); break;
            case 5: clipboard = copyKeys(graph, selection); break;
            case 6:
                if (Result<KeysEdited> pasted = pasteKeys(graph, clipboard, time, nullptr)) edited = *pasted;
                break;
            case 7: edited.graph = setTangents(graph, selection, TangentChoice(below(5))); break;
            case 8: edited.graph = setInterpolations(graph, selection, Interpolation(below(3))); break;
        }
        graph = edited.graph;
        ASSERT_EQ(errorsOf(graph), "") << "after step " << step << ": " << graph.timeline->dump();
        if (edited.selection != selection) {
            EXPECT_EQ(stillThere(edited.selection, *readTimeline(graph)).size(), edited.selection.size());
        }
        const Result<Graph> again = parseGraph(writeGraph(graph), "", nullptr);
        ASSERT_TRUE(again);
        ASSERT_EQ(again->timeline, graph.timeline);
    }
}

}  // namespace fw::editor::timeline_edits_test
