// The timeline: what curves pass through, what reading and check() say of bad ones, what a document is at a
// time.
#include "graph/document/timeline.h"
#include "graph/compile/compile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "graph/check/check.h"
#include "graph/document/json.h"
#include "graph/document/named_parameters.h"

namespace fw::timeline_test {

constexpr const char* kNodes = R"({"fieldwright": 1, "nodes": [
  {"id": "ball", "type": "sphere", "inputs": {"radius": 0.8}},
  {"id": "moved", "type": "translate", "inputs": {"surface": {"from": "ball"}}},
  {"id": "loop", "type": "expression", "inputs": {"n": 3, "f": {"from": "moved"}},
   "code": "d = f; for (int i = 0; i < n; i++) d = d + 0; return d;"},
  {"id": "size", "type": "parameter", "inputs": {"name": "size", "value": 1, "min": 0.5, "max": 2}},
  {"id": "box", "type": "box"},
  {"id": "both", "type": "morph", "inputs": {"a": {"from": "loop"}, "b": {"from": "box"}}},
  {"id": "out", "type": "output", "inputs": {"surface": {"from": "both"}}}],
 "parameters": [{"name": "radius", "node": "ball", "input": "radius", "min": 0.5, "max": 0.9}],
 "scene": {"camera": {"position": [4, 3, 5], "fov": 40}, "lights": [{"strength": 1}]},
 "timeline": )";

Graph graphWith(const std::string& timeline) {
    const Result<Graph> graph = parseGraph(kNodes + timeline + "}", "a.field.json", nullptr);
    EXPECT_TRUE(graph) << (graph ? "" : format(graph.error()));
    return graph ? *graph : Graph{};
}
Timeline timelineOf(const std::string& text) {
    const Result<Timeline> timeline = readTimeline(graphWith(text));
    EXPECT_TRUE(timeline) << (timeline ? "" : format(timeline.error()));
    return timeline ? *timeline : Timeline{};
}
/// A track of one component with these keys.
Track trackOf(const std::vector<Key>& keys) {
    Track track;
    track.keys = keys;
    return track;
}
Key keyAt(double time, double value, Interpolation interpolation, Ease ease = Ease::none) {
    return {.time = time, .value = {value}, .interpolation = interpolation, .ease = ease};
}

std::vector<std::string> findings(const std::string& timeline) {
    std::vector<std::string> texts;
    for (const Error& finding : check(graphWith(timeline))) texts.push_back(format(finding));
    return texts;
}
void expectFinding(const std::string& timeline, const std::vector<std::string>& parts) {
    const std::vector<std::string> texts = findings(timeline);
    ASSERT_EQ(texts.size(), 1u) << timeline << (texts.empty() ? "" : "\n" + texts[0] + "\n" + texts.back());
    for (const std::string& part : parts) EXPECT_NE(texts[0].find(part), std::string::npos) << texts[0];
}
std::string tracks(const std::string& text) { return "{\"tracks\": [" + text + "]}"; }
std::string radius(const std::string& keys, const std::string& more = "") {
    return tracks(R"({"node": "ball", "input": "radius", )" + more + "\"keys\": [" + keys + "]}");
}

TEST(Timeline, ReadsWhatIsThereAndDefaultsWhatIsNot) {
    const Timeline none = timelineOf("{}");
    EXPECT_EQ(none, Timeline{});
    EXPECT_EQ(*readTimeline(Graph{}), Timeline{.endless = true});
    const Timeline timeline = timelineOf(R"({"length": 8, "loop": "ping-pong", "fps": 24, "tracks": [
        {"node": "ball", "input": "radius", "interpolation": "cubic", "ease": "in", "keys": [
          {"time": 0, "value": 1}, {"time": 2.5, "value": 2, "interpolation": "step", "ease": "none"}]},
        {"parameter": "size", "keys": [{"time": 1, "value": [1]}]},
        {"scene": "camera.position", "keys": [{"time": 1, "value": [1, 2, 3]}]}]})");
    EXPECT_EQ(timeline.length, 8.0);
    EXPECT_EQ(timeline.loop, Loop::pingPong);
    EXPECT_EQ(timeline.framesPerSecond, 24.0);
    ASSERT_EQ(timeline.tracks.size(), 3u);
    const Track& first = timeline.tracks[0];
    EXPECT_EQ(first.target, Track::Target::input);
    EXPECT_EQ(first.node + "." + first.name, "ball.radius");
    EXPECT_EQ(first.keys[0].interpolation, Interpolation::cubic);
    EXPECT_EQ(first.keys[0].ease, Ease::in);
    EXPECT_EQ(first.keys[1].interpolation, Interpolation::step);
    EXPECT_EQ(first.keys[1].ease, Ease::none);
    EXPECT_EQ(timeline.tracks[1].target, Track::Target::parameter);
    EXPECT_EQ(timeline.tracks[2].keys[0].value, (std::vector<double>{1, 2, 3}));
    // Without a length the last key ends it.
    EXPECT_EQ(timelineOf(radius(R"({"time": 0, "value": 0.5}, {"time": 6, "value": 0.6})")).length, 6.0);
}

TEST(Timeline, StepsAndRampsAndRestsBeyondItsKeys) {
    const Track steps = trackOf({keyAt(1, 5, Interpolation::step), keyAt(2, 7, Interpolation::step)});
    EXPECT_EQ(evaluate(steps, 0.0)[0], 5.0);
    EXPECT_EQ(evaluate(steps, 1.999)[0], 5.0);
    EXPECT_EQ(evaluate(steps, 2.0)[0], 7.0);
    EXPECT_EQ(evaluate(steps, 9.0)[0], 7.0);
    const Track ramp = trackOf({keyAt(1, 5, Interpolation::linear), keyAt(3, 9, Interpolation::linear)});
    EXPECT_EQ(evaluate(ramp, 0.5)[0], 5.0);
    EXPECT_EQ(evaluate(ramp, 1.5)[0], 6.0);
    EXPECT_EQ(evaluate(ramp, 2.0)[0], 7.0);
    EXPECT_EQ(evaluate(ramp, 4.0)[0], 9.0);
}

TEST(Timeline, EasesFromZeroToOneWithoutTurningBack) {
    for (const Ease ease : {Ease::none, Ease::in, Ease::out, Ease::inOut}) {
        EXPECT_EQ(eased(ease, 0.0), 0.0);
        EXPECT_EQ(eased(ease, 1.0), 1.0);
        for (int i = 0; i < 100; ++i) EXPECT_LT(eased(ease, i / 100.0), eased(ease, (i + 1) / 100.0));
    }
    const double h = 1e-6;  // slow where the name says
    EXPECT_NEAR(eased(Ease::in, h) / h, 0.0, 1e-5);
    EXPECT_NEAR((1 - eased(Ease::out, 1 - h)) / h, 0.0, 1e-5);
    EXPECT_NEAR(eased(Ease::inOut, h) / h, 0.0, 1e-5);
    EXPECT_NEAR((1 - eased(Ease::inOut, 1 - h)) / h, 0.0, 1e-5);
    EXPECT_EQ(eased(Ease::inOut, 0.5), 0.5);
}

/// Random keys, the same for the same seed.
Track randomTrack(std::mt19937& random, Interpolation interpolation) {
    const auto number = [&](double lo, double hi) { return std::uniform_real_distribution(lo, hi)(random); };
    Track track;
    double time = number(0, 2);
    for (int i = 0, count = 2 + static_cast<int>(number(0, 6)); i < count; ++i) {
        track.keys.push_back(keyAt(time, number(-5, 5), interpolation));
        time += number(0.01, 3);
    }
    return track;
}

TEST(TimelineProperty, EveryCurvePassesThroughItsKeys) {
    std::mt19937 random(1);
    for (int round = 0; round < 500; ++round)
        for (const Interpolation kind : {Interpolation::step, Interpolation::linear, Interpolation::cubic}) {
            const Track track = randomTrack(random, kind);
            for (const Key& key : track.keys) EXPECT_NEAR(evaluate(track, key.time)[0], key.value[0], 1e-12);
        }
}

TEST(TimelineProperty, LinearAndCubicDoNotJump) {
    std::mt19937 random(2);
    for (int round = 0; round < 200; ++round)
        for (const Interpolation kind : {Interpolation::linear, Interpolation::cubic}) {
            const Track track = randomTrack(random, kind);
            for (const Key& key : track.keys)
                EXPECT_NEAR(evaluate(track, key.time - 1e-9)[0], evaluate(track, key.time + 1e-9)[0], 1e-4);
        }
}

TEST(TimelineProperty, CubicHasNoKinkAndFollowsParabolas) {
    std::mt19937 random(3);
    for (int round = 0; round < 200; ++round) {
        Track track = randomTrack(random, Interpolation::cubic);
        const double h = 1e-6;
        for (std::size_t i = 1; i + 1 < track.keys.size(); ++i) {
            const double t = track.keys[i].time, middle = evaluate(track, t)[0];
            const double left = (middle - evaluate(track, t - h)[0]) / h,
                         right = (evaluate(track, t + h)[0] - middle) / h;
            EXPECT_NEAR(left, right, 2e-2 * (1 + std::abs(left)));
        }
        for (Key& key : track.keys) key.value[0] = 3 - key.time + 0.5 * key.time * key.time;
        for (std::size_t i = 1; i + 2 < track.keys.size(); ++i)
            for (int step = 0; step < 10; ++step) {
                const double t =
                    track.keys[i].time + step / 10.0 * (track.keys[i + 1].time - track.keys[i].time);
                EXPECT_NEAR(evaluate(track, t)[0], 3 - t + 0.5 * t * t, 1e-9);
            }
    }
}

TEST(Timeline, AClosedTrackIsSmoothAcrossTheSeam) {
    const std::string keys =
        R"({"time": 0, "value": 0.5}, {"time": 1, "value": 0.9}, {"time": 3, "value": 0.6}, {"time": 4, "value": 0.5})";
    const Track closed = timelineOf(radius(keys, "\"interpolation\": \"cubic\", ")).tracks[0];
    EXPECT_TRUE(closed.closed);
    const double h = 1e-6, out = (evaluate(closed, h)[0] - 0.5) / h,
                 in = (0.5 - evaluate(closed, 4 - h)[0]) / h;
    EXPECT_NEAR(out, in, 1e-4);
    EXPECT_GT(std::abs(out), 0.01);
    Timeline open = timelineOf("{\"loop\": \"once\", " + radius(keys).substr(1));
    EXPECT_FALSE(open.tracks[0].closed);
}

TEST(Timeline, Loops) {
    Timeline timeline;
    timeline.length = 4;
    timeline.endless = true;
    EXPECT_EQ(timelineTime(timeline, 9.0), 9.0);
    timeline.endless = false;
    timeline.tracks.push_back(trackOf({keyAt(0, 0, Interpolation::linear)}));
    timeline.loop = Loop::once;
    for (const auto& [seconds, expected] : {std::pair{-1.0, 0.0}, {1.0, 1.0}, {4.0, 4.0}, {9.0, 4.0}})
        EXPECT_EQ(timelineTime(timeline, seconds), expected);
    timeline.loop = Loop::repeat;
    for (const auto& [seconds, expected] : {std::pair{-1.0, 3.0}, {1.0, 1.0}, {4.0, 0.0}, {9.0, 1.0}})
        EXPECT_EQ(timelineTime(timeline, seconds), expected);
    timeline.loop = Loop::pingPong;
    for (const auto& [seconds, expected] :
         {std::pair{-1.0, 1.0}, {1.0, 1.0}, {4.0, 4.0}, {5.0, 3.0}, {9.0, 1.0}})
        EXPECT_EQ(timelineTime(timeline, seconds), expected);
    std::mt19937 random(4);
    for (const Loop loop : {Loop::once, Loop::repeat, Loop::pingPong})
        for (int i = 0; i < 1000; ++i) {
            timeline.loop = loop;
            const double time = timelineTime(timeline, std::uniform_real_distribution(-1e4, 1e4)(random));
            EXPECT_GE(time, 0.0);
            EXPECT_LE(time, 4.0);
        }
}

TEST(Timeline, AtATimeTheDocumentHasTheTracksValues) {
    const Graph graph = graphWith(tracks(R"(
        {"parameter": "radius", "interpolation": "cubic", "keys": [{"time": 0, "value": 0.5}, {"time": 1, "value": 0.9},
          {"time": 2, "value": 0.9}, {"time": 3, "value": 0.5}]},
        {"node": "moved", "input": "offset.y", "keys": [{"time": 0, "value": 0}, {"time": 2, "value": 4}]},
        {"node": "box", "input": "half_extents", "keys": [{"time": 0, "value": [1, 2, 3]}]},
        {"parameter": "size", "keys": [{"time": 0, "value": 2}]},
        {"scene": "camera.position", "keys": [{"time": 0, "value": [0, 0, 2]}, {"time": 2, "value": [2, 4, 4]}]},
        {"scene": "camera.fov", "keys": [{"time": 0, "value": 30}, {"time": 2, "value": 50}]},
        {"scene": "lights.0.strength", "keys": [{"time": 0, "value": 0}, {"time": 2, "value": 3}]},
        {"scene": "sun.color", "keys": [{"time": 0, "value": [0, 1, 0]}]})"));
    EXPECT_TRUE(check(graph).empty()) << format(check(graph)[0]);
    const Timeline timeline = *readTimeline(graph);
    const Graph then = atTime(graph, timeline, 1.0);
    EXPECT_EQ(inputNumbers(*then.node("ball"), "radius"), std::vector<double>{0.9});
    EXPECT_EQ(inputNumbers(*then.node("moved"), "offset"), (std::vector<double>{0, 2, 0}));
    EXPECT_EQ(inputNumbers(*then.node("box"), "half_extents"), (std::vector<double>{1, 2, 3}));
    EXPECT_EQ(inputNumbers(*then.node("size"), "value"), std::vector<double>{2});
    EXPECT_EQ(*then.scene, Json::parse(R"({"camera": {"position": [1.0, 2.0, 3.0], "fov": 40.0},
        "lights": [{"strength": 1.5}], "sun": {"color": [0.0, 1.0, 0.0]}})"));
    // The curve rises above 0.9 between its keys; the parameter does not.
    EXPECT_GT(evaluate(timeline.tracks[0], 1.5)[0], 0.92);
    EXPECT_EQ(inputNumbers(*atTime(graph, timeline, 1.5).node("ball"), "radius"), std::vector<double>{0.9});
    EXPECT_EQ(animatedInputs(graph, timeline),
              (std::set<std::string>{"ball.radius", "box.half_extents", "moved.offset", "size.value"}));
}

TEST(Timeline, LiveValuesGiveTheFieldOfTheFoldedOnes) {
    const Graph graph = graphWith(tracks(R"(
        {"node": "both", "input": "t", "keys": [{"time": 0, "value": 0}, {"time": 2, "value": 1}]},
        {"node": "moved", "input": "offset", "keys": [{"time": 0, "value": [0, 0, 0]}, {"time": 2, "value": [1, 2, 3]}]})"));
    const Timeline timeline = *readTimeline(graph);
    CompileOptions options;
    options.live = animatedInputs(graph, timeline);
    Result<Program> live = compile(graph, options);
    ASSERT_TRUE(live) << format(live.error());
    EXPECT_EQ(live->live.size(), 4u);
    std::vector<Point> points;
    std::mt19937 random(5);
    for (int i = 0; i < 500; ++i) {
        Point& point = points.emplace_back();
        for (double& x : point) x = std::uniform_real_distribution(-3.0, 3.0)(random);
    }
    for (const double time : {0.0, 0.3, 1.7, 2.0}) {
        const Graph then = atTime(graph, timeline, time);
        for (LiveParameter& parameter : live->live) {
            const std::size_t dot = parameter.name.find('.');
            parameter.value = inputNumbers(*then.node(parameter.name.substr(0, dot)),
                                           parameter.name.substr(dot + 1))[parameter.component];
        }
        const Result<Program> folded = compile(then);
        ASSERT_TRUE(folded);
        std::vector<double> a(points.size()), b(points.size());
        evaluate(live->ir, live->distance(), live->parameters(), points, a);
        evaluate(folded->ir, folded->distance(), folded->parameters(), points, b);
        for (std::size_t i = 0; i < points.size(); ++i) ASSERT_NEAR(a[i], b[i], 1e-9);
    }
}

TEST(Timeline, WritingKeepsUnknownKeys) {
    const Graph graph = graphWith(
        R"({"length": 2, "author": "me", "tracks": [{"node": "ball", "input": "radius", "colour": 3, "keys": [{"time": 0, "value": 0.7, "hint": [1]}]}]})");
    std::vector<Error> warnings;
    ASSERT_TRUE(readTimeline(graph, &warnings));
    EXPECT_EQ(warnings.size(), 3u);
    const std::string text = writeGraph(graph);
    for (const char* key : {"author", "colour", "hint"}) EXPECT_NE(text.find(key), std::string::npos);
    EXPECT_EQ(writeGraph(*parseGraph(text, "", nullptr)), text);
    const std::vector<std::string> texts = findings(R"({"lenght": 2})");
    ASSERT_EQ(texts.size(), 1u);
    EXPECT_NE(texts[0].find("a.field.json:12:25: warning: unknown key 'lenght' of the timeline"),
              std::string::npos)
        << texts[0];
    EXPECT_NE(texts[0].find("did you mean 'length'?"), std::string::npos);
}

TEST(TimelineBad, FormNamesThePlace) {
    expectFinding(R"({"tracks": 3})",
                  {"a.field.json:12:25: error: \"tracks\" must be an array of tracks, not a number"});
    expectFinding(R"({"length": "long"})", {"\"length\" must be a number, not a string"});
    expectFinding(R"({"loop": true})", {"one of \"once\", \"repeat\", \"ping-pong\", not a boolean"});
    expectFinding(R"({"loop": "rewind"})", {"not 'rewind'"});
    expectFinding(tracks("7"), {"12:26", "a track is an object such as"});
    expectFinding(tracks("{\"keys\": []}"), {"a track moves one thing"});
    expectFinding(tracks(R"({"node": "ball", "input": "radius", "scene": "sun", "keys": []})"),
                  {"one thing"});
    expectFinding(tracks(R"({"node": "ball", "input": "radius"})"), {"the track has no keys"});
    expectFinding(radius(""), {"the track has no keys"});
    expectFinding(radius("{\"time\": 1}"), {"the key has no \"value\""});
    expectFinding(radius("{\"value\": 1}"), {"the key has no \"time\""});
    expectFinding(radius(R"({"time": 0, "value": "NaN"})"),
                  {"\"value\" must be a number or an array of 1 to 4 numbers, not a string"});
    expectFinding(radius(R"({"time": 0, "value": null})"), {"not null"});
    expectFinding(radius(R"({"time": 0, "value": [1, 2, 3, 4, 5]})"), {"1 to 4 numbers"});
    expectFinding(radius(R"({"time": 0, "value": 0.6, "ease": "bounce"})"), {"not 'bounce'"});
    EXPECT_FALSE(parseGraph(kNodes + radius(R"({"time": 0, "value": NaN})") + "}", "", nullptr));
    EXPECT_FALSE(parseGraph(kNodes + radius(R"({"time": 0, "value": 1e999})") + "}", "", nullptr));
}

TEST(TimelineBad, KeysThatMakeNoCurve) {
    expectFinding(radius(R"({"time": 1, "value": 0.6}, {"time": 0.5, "value": 0.6})"),
                  {"12:98: error: node 'ball', input 'radius'",
                   "not in the order of their times: 0.5 s comes after 1 s"});
    expectFinding(radius(R"({"time": 1, "value": 0.6}, {"time": 1, "value": 0.7})"), {"two keys at 1 s"});
    expectFinding(radius(R"({"time": -1, "value": 0.6}, {"time": 1, "value": 0.7})"), {"from 0 on, not -1"});
    expectFinding("{\"length\": 1, " + radius(R"({"time": 2, "value": 0.6})").substr(1),
                  {"warning", "at 2 s lies beyond the timeline's length of 1 s"});
    expectFinding(R"({"length": 0})", {"above 0 and at most 86400 s, not 0"});
    expectFinding(R"({"length": 1e9})", {"at most 86400 s"});
    expectFinding(R"({"fps": -30})", {"fps must be above 0"});
    expectFinding(tracks(R"({"node": "moved", "input": "offset", "keys": [{"time": 0, "value": [1, 2]}]})"),
                  {"the key has 2 numbers, the input takes 3"});
    expectFinding(
        tracks(
            R"({"scene": "lights.0.strength", "keys": [{"time": 0, "value": 1}, {"time": 1, "value": [1, 2]}]})"),
        {"the key at 1 s has 2 numbers, the first one has 1"});
    // A NaN cannot be written in a file; a program can put one into a document.
    Graph graph = graphWith(radius(R"({"time": 0, "value": 0.6}, {"time": 1, "value": 0.6})"));
    (*graph.timeline)["tracks"][0]["keys"][1]["value"] = NAN;
    const std::vector<Error> list = check(graph);
    ASSERT_FALSE(list.empty());
    EXPECT_NE(format(list[0]).find("the value of the key at 1 s is not a number"), std::string::npos)
        << format(list[0]);
    (*graph.timeline)["tracks"][0]["keys"][1] = {{"time", INFINITY}, {"value", 0.6}};
    EXPECT_NE(format(check(graph).at(0)).find("from 0 on, not inf"), std::string::npos);
}

TEST(TimelineBad, TargetsThatAreNotThere) {
    const std::string keys = R"("keys": [{"time": 0, "value": 1}]})";
    expectFinding(tracks(R"({"node": "bal", "input": "radius", )" + keys),
                  {"there is no node 'bal'; did you mean 'ball'?"});
    expectFinding(tracks(R"({"node": "ball", "input": "radios", )" + keys),
                  {"no such input; did you mean 'radius'?"});
    expectFinding(tracks(R"({"parameter": "siz", )" + keys), {"no such parameter; did you mean 'size'?"});
    expectFinding(tracks(R"({"node": "moved", "input": "surface", )" + keys),
                  {"warning", "the input is linked"});
    expectFinding(tracks(R"({"node": "out", "input": "resolution", )" + keys), {"cannot move over time"});
    expectFinding(tracks(R"({"node": "both", "input": "profile", )" + keys), {"no such input"});
    expectFinding(tracks(R"({"node": "ball", "input": "p", )" + keys), {"a value of its own"});
    expectFinding(tracks(R"({"node": "ball", "input": "radius.y", )" + keys), {"no such component"});
    expectFinding(tracks(R"({"node": "loop", "input": "m", )" + keys), {"no such input"});
    expectFinding(tracks(R"({"node": "ball", "input": "radius", "keys": [{"time": 0, "value": -1}]})"),
                  {"the value -1 at 0 s is out of the input's range, 0 to inf"});
    expectFinding(tracks(R"({"parameter": "size", "keys": [{"time": 0, "value": 5}]})"), {"range, 0.5 to 2"});
    expectFinding(tracks(R"({"scene": "camera..fov", )" + keys), {"write the way to the value with dots"});
    expectFinding(tracks(R"({"scene": "camera.fov.wide", )" + keys), {"no value there"});
    expectFinding(tracks(R"({"scene": "lights.1.strength", )" + keys), {"no value there"});
    // A loop's bound is known when the graph is compiled, so it cannot move.
    expectFinding(tracks(R"({"node": "loop", "input": "n", )" + keys), {"node 'loop', code 1:"});
}

TEST(TimelineBad, CamerasThatCannotLook) {
    expectFinding(
        tracks(R"({"scene": "camera.fov", "keys": [{"time": 0, "value": 30}, {"time": 1, "value": 400}]})"),
        {"the key at 1 s: the scene's camera.fov must be a number of degrees from 1 to 170"});
    expectFinding(tracks(R"({"scene": "camera.position", "keys": [{"time": 0, "value": [0, 0, 0]}]})"),
                  {"the key at 0 s: the scene's camera stands on its target"});
    expectFinding(tracks(R"({"scene": "camera.position", "keys": [{"time": 0, "value": [0, 1]}]})"),
                  {"camera.position must be three numbers"});
    Graph graph =
        graphWith(tracks(R"({"scene": "camera.position", "keys": [{"time": 0, "value": [1, 2, 3]}]})"));
    (*graph.timeline)["tracks"][0]["keys"][0]["value"][1] = NAN;
    EXPECT_NE(format(check(graph).at(0)).find("the value of the key at 0 s is not a number"),
              std::string::npos);
    graph = graphWith("{}");
    (*graph.scene)["camera"]["target"] = {4, 3, 5};
    EXPECT_NE(
        format(check(graph).at(0)).find("a.field.json:11:22: error: the scene's camera stands on its target"),
        std::string::npos)
        << format(check(graph).at(0));
    (*graph.scene)["camera"] = "wide";
    EXPECT_NE(format(check(graph).at(0)).find("the scene's camera must be an object"), std::string::npos);
}

TEST(TimelineBad, TwoTracksForOneThing) {
    const std::string keys = R"("keys": [{"time": 0, "value": 0.6}]})";
    const auto pair = [&](const std::string& a, const std::string& b) {
        return tracks("{" + a + ", " + keys + ", {" + b + ", " + keys);
    };
    const std::string ball = R"("node": "ball", "input": "radius")";
    expectFinding(pair(ball, ball), {"moves what another track moves, the first in line 12"});
    expectFinding(pair(ball, "\"parameter\": \"radius\""), {"moves what another track moves"});
    const std::string y = R"("node": "moved", "input": "offset.y")",
                      all = R"("node": "moved", "input": "offset")";
    expectFinding(pair(y, all), {"moves what another track moves"});
    expectFinding(pair(all, y), {"moves what another track moves"});
    EXPECT_TRUE(findings(pair(y, R"("node": "moved", "input": "offset.x")")).empty());
    expectFinding(pair("\"scene\": \"sun.size\"", "\"scene\": \"sun.size\""),
                  {"moves what another track moves"});
}

}  // namespace fw::timeline_test
