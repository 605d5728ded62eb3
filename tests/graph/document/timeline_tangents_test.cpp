// Tangents of keys, markers and the range: what a document says of them, and what its curves do.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "graph/check/check.h"
#include "graph/document/json.h"
#include "graph/document/timeline.h"

namespace fw::timeline_tangents_test {

constexpr const char* kNodes = R"({"fieldwright": 1, "nodes": [
  {"id": "ball", "type": "sphere", "inputs": {"radius": 0.8}},
  {"id": "moved", "type": "translate", "inputs": {"surface": {"from": "ball"}}},
  {"id": "out", "type": "output", "inputs": {"surface": {"from": "moved"}}}],
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
std::string offset(const std::string& keys, const std::string& more = "") {
    return R"({"length": 4, "tracks": [{"node": "moved", "input": "offset", "interpolation": "cubic", )" +
           more + "\"keys\": [" + keys + "]}]}";
}
std::string finding(const std::string& timeline) {
    const std::vector<Error> all = check(graphWith(timeline));
    return all.empty() ? "" : format(all[0]);
}

/// Random keys of two components, each side given, automatic, flat or linear.
Track randomTrack(std::mt19937& random, bool given) {
    const auto number = [&](double lo, double hi) { return std::uniform_real_distribution(lo, hi)(random); };
    Track track;
    double time = number(0, 2);
    for (int i = 0, count = 2 + int(number(0, 6)); i < count; ++i) {
        Key key{.time = time, .value = {number(-5, 5), number(-5, 5)}, .interpolation = Interpolation::cubic};
        key.tangents = Tangents(int(number(0, 3.999)));
        if (given || number(0, 1) < 0.5) key.in = {number(-9, 9), number(-9, 9)};
        if (given || number(0, 1) < 0.5) key.out = {number(-9, 9)};
        track.keys.push_back(std::move(key));
        time += number(0.05, 3);
    }
    return track;
}

TEST(Tangents, AreReadAsTheyAreWritten) {
    const Timeline timeline = timelineOf(offset(
        R"({"time": 0, "value": [0, 0, 0], "out": [1, 2, 3]},
           {"time": 1, "value": [1, 1, 1], "in": 2, "out": 2, "tangents": "broken"},
           {"time": 2, "value": [1, 1, 1], "tangents": "auto"}, {"time": 3, "value": [0, 0, 0]})",
        R"("tangents": "flat", )"));
    ASSERT_EQ(timeline.tracks.size(), 1u);
    const std::vector<Key>& keys = timeline.tracks[0].keys;
    EXPECT_EQ(keys[0].out, (std::vector<double>{1, 2, 3}));
    EXPECT_TRUE(keys[0].in.empty());
    EXPECT_EQ(keys[1].in, std::vector{2.0});
    EXPECT_EQ(keys[1].tangents, Tangents::broken);
    EXPECT_EQ(keys[2].tangents, Tangents::automatic);
    EXPECT_EQ(keys[3].tangents, Tangents::flat) << "as the track has it";
    EXPECT_EQ(slopeAt(timeline.tracks[0], 0, 2, KeySide::out), 3.0);
    EXPECT_EQ(slopeAt(timeline.tracks[0], 1, 2, KeySide::in), 2.0) << "one for all";
    EXPECT_EQ(slopeAt(timeline.tracks[0], 3, 0, KeySide::in), 0.0);
    EXPECT_EQ(slopeAt(timeline.tracks[0], 2, 0, KeySide::in), -0.5) << "between 1 at 1 s and 0 at 3 s";
}

TEST(Tangents, AndMarkersAndTheRangeAreWrittenAsTheyWere) {
    const Graph graph = graphWith(
        R"({"length": 4, "range": [1, 3], "markers": [{"name": "open", "pen": 2, "time": 1.5}, {"time": 2}],
            "tracks": [{"node": "ball", "input": "radius", "keys": [{"time": 0, "value": 1, "out": 2}]}]})");
    EXPECT_EQ(writeGraph(*parseGraph(writeGraph(graph), "", nullptr)), writeGraph(graph));
    std::vector<Error> warnings;
    const Result<Timeline> timeline = readTimeline(graph, &warnings);
    ASSERT_TRUE(timeline);
    EXPECT_EQ(warnings.size(), 1u) << "of the pen alone";
    EXPECT_EQ(timeline->range, (TimeRange{1, 3}));
    ASSERT_EQ(timeline->markers.size(), 2u);
    EXPECT_EQ(timeline->markers[0].name, "open");
    EXPECT_EQ(timeline->markers[1].time, 2.0);
    EXPECT_TRUE(check(graph).size() == 1u);
}

TEST(TangentsProperty, TheDerivativeAtAKeyIsItsSlope) {
    std::mt19937 random(11);
    const double h = 1e-6;
    for (int round = 0; round < 500; ++round) {
        const Track track = randomTrack(random, round % 2 == 0);
        for (std::size_t i = 0; i < track.keys.size(); ++i)
            for (std::size_t c = 0; c < 2; ++c) {
                const Key& key = track.keys[i];
                const double at = key.value[c];
                if (i + 1 < track.keys.size()) {
                    const double slope = slopeAt(track, i, c, KeySide::out);
                    EXPECT_NEAR((evaluate(track, key.time + h)[c] - at) / h, slope,
                                2e-2 * (1 + std::abs(slope)));
                    EXPECT_EQ(slope, key.out.empty() ? slope : key.out[0]);
                }
                if (i > 0) {
                    const double slope = slopeAt(track, i, c, KeySide::in);
                    EXPECT_NEAR((at - evaluate(track, key.time - h)[c]) / h, slope,
                                2e-2 * (1 + std::abs(slope)));
                    EXPECT_EQ(slope, key.in.empty() ? slope : key.in[c]);
                }
            }
    }
}

TEST(TangentsProperty, EveryCubicIsFoundAgain) {
    // A polynomial of the third degree is its own Hermite curve, whatever its keys.
    std::mt19937 random(12);
    const auto number = [&](double lo, double hi) { return std::uniform_real_distribution(lo, hi)(random); };
    for (int round = 0; round < 300; ++round) {
        const double a = number(-2, 2), b = number(-2, 2), c = number(-2, 2), d = number(-2, 2);
        const auto value = [&](double t) { return a + t * (b + t * (c + t * d)); };
        Track track = randomTrack(random, true);
        for (Key& key : track.keys) {
            const double slope = b + key.time * (2 * c + key.time * 3 * d);
            key.value = {value(key.time)}, key.in = {slope}, key.out = {slope};
        }
        const double from = track.keys.front().time, to = track.keys.back().time;
        for (int i = 0; i <= 20; ++i) {
            const double t = from + (to - from) * i / 20.0;
            EXPECT_NEAR(evaluate(track, t)[0], value(t), 1e-8 * (1 + std::abs(value(t))));
        }
    }
}

TEST(TangentsProperty, GivenAsTheyAreFoundTheyChangeNothing) {
    std::mt19937 random(13);
    for (int round = 0; round < 200; ++round) {
        Track track = randomTrack(random, false), written = track;
        for (std::size_t i = 0; i < track.keys.size(); ++i)
            for (std::size_t c = 0; c < 2; ++c) {
                if (c == 0) written.keys[i].in.clear(), written.keys[i].out.clear();
                written.keys[i].in.push_back(slopeAt(track, i, c, KeySide::in));
                written.keys[i].out.push_back(slopeAt(track, i, c, KeySide::out));
            }
        for (int i = 0; i < 30; ++i) {
            const double t = std::uniform_real_distribution(0.0, track.keys.back().time)(random);
            EXPECT_EQ(evaluate(track, t), evaluate(written, t));
        }
    }
}

TEST(Tangents, FlatAndLinearAreWhatTheySay) {
    const std::string keys =
        R"({"time": 0, "value": [0, 0, 0]}, {"time": 1, "value": [3, 0, 0]}, {"time": 3, "value": [4, 0, 0]})";
    const Track flat = timelineOf(offset(keys, R"("tangents": "flat", )")).tracks[0];
    const Track linear = timelineOf(offset(keys, R"("tangents": "linear", )")).tracks[0];
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(slopeAt(flat, i, 0, KeySide::out), 0.0);
    EXPECT_EQ(slopeAt(linear, 1, 0, KeySide::in), 3.0);
    EXPECT_EQ(slopeAt(linear, 1, 0, KeySide::out), 0.5);
    for (int i = 0; i <= 10; ++i) EXPECT_NEAR(evaluate(linear, i / 10.0)[0], 3.0 * i / 10.0, 1e-12);
    // Flat curves stay between their keys.
    for (int i = 0; i <= 30; ++i) {
        const double x = evaluate(flat, i / 10.0)[0];
        EXPECT_GE(x, 0.0);
        EXPECT_LE(x, 4.0);
    }
}

TEST(Tangents, TheEndsOfAClosedTrackAreOneKey) {
    const auto track = [&](const std::string& first, const std::string& last) {
        return timelineOf(offset(R"({"time": 0, "value": [1, 0, 0])" + first +
                                 R"(}, {"time": 1, "value": [2, 0, 0]}, {"time": 2.5, "value": [0, 0, 0]},
                                    {"time": 4, "value": [1, 0, 0])" +
                                 last + "}"))
            .tracks[0];
    };
    const double h = 1e-6;
    for (const auto& [first, last] : {std::pair{"", ""},
                                      {", \"in\": 3, \"out\": 3", ""},
                                      {"", ", \"in\": -2, \"out\": -2"},
                                      {", \"tangents\": \"flat\"", ""},
                                      {", \"out\": 1.5", ", \"in\": 1.5"}}) {
        const Track closed = track(first, last);
        ASSERT_TRUE(closed.closed);
        const double out = (evaluate(closed, h)[0] - 1.0) / h, in = (1.0 - evaluate(closed, 4 - h)[0]) / h;
        EXPECT_NEAR(out, in, 1e-4) << first << last;
        EXPECT_EQ(slopeAt(closed, 0, 0, KeySide::in), slopeAt(closed, 3, 0, KeySide::in)) << first << last;
    }
    EXPECT_EQ(slopeAt(track(", \"in\": 3, \"out\": 3", ""), 3, 0, KeySide::in), 3.0);
    EXPECT_EQ(slopeAt(track(", \"in\": 3, \"out\": 5", ", \"in\": 4"), 3, 0, KeySide::in), 4.0)
        << "its own comes first";
}

TEST(Tangents, DoNotBendWhatIsNotCubic) {
    Track track;
    track.keys = {{.time = 0, .value = {0}, .in = {9}, .out = {9}}, {.time = 1, .value = {1}, .in = {9}}};
    EXPECT_EQ(evaluate(track, 0.25)[0], 0.25);
    track.keys[0].interpolation = Interpolation::step;
    EXPECT_EQ(evaluate(track, 0.25)[0], 0.0);
}

TEST(Timeline, MovesAlikeWhateverItsMarkers) {
    const std::string keys = R"({"time": 0, "value": [1, 0, 0]})";
    const Timeline plain = timelineOf(offset(keys));
    Timeline other = plain;
    other.markers = {{.time = 1, .name = "a"}}, other.range = TimeRange{1, 2};
    EXPECT_TRUE(moveAlike(plain, other));
    EXPECT_FALSE(plain == other);
    other.tracks[0].keys[0].out = {1};
    EXPECT_FALSE(moveAlike(plain, other));
}

TEST(TangentsBad, FormAndSense) {
    const std::string key = R"({"time": 0, "value": [0, 0, 0], )";
    for (const auto& [text, part] :
         {std::pair{offset(key + R"("in": "up"})"), "\"in\" must be a number or an array of 1 to 4 numbers"},
          {offset(key + R"("tangents": "soft"})"), "\"tangents\" must be one of \"auto\", \"flat\""},
          {offset(key + R"("out": [1, 2]})"), "the key at 0 s has 2 slopes \"out\" for 3 numbers"},
          {std::string(R"({"markers": 3})"), "\"markers\" must be an array of markers"},
          {std::string(R"({"markers": [{"name": "a"}]})"), "the marker has no \"time\""},
          {std::string(R"({"markers": [7]})"), "a marker is an object such as"},
          {std::string(R"({"markers": [{"time": -1}]})"), "a marker's time must be a number from 0 on"},
          {std::string(R"({"range": [1]})"), "\"range\" must be an array of two times"},
          {std::string(R"({"range": [2, 1]})"), "must begin at 0 or later and end after that"},
          {std::string(R"({"length": 3, "range": [5, 6]})"), "beyond the timeline's length of 3 s"},
          {std::string(R"({"rnage": [5, 6]})"), "did you mean 'range'?"}})
        EXPECT_NE(finding(text).find(part), std::string::npos) << text << "\n" << finding(text);
}

}  // namespace fw::timeline_tangents_test
