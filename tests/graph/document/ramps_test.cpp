// Ramps of colours and curves: what they give at stops, between and beyond them, their intervals, live stops,
// and lists that cannot be.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "graph/check/check.h"
#include "graph/compile/compile.h"
#include "graph/compile/live_program.h"
#include "graph/document/input_value.h"
#include "graph/document/json.h"
#include "graph/evaluate/evaluate.h"
#include "graph/language/lower.h"

namespace fw::ramps_test {

using language::Lowering;
using language::Value;

/// A ramp or a curve of x.
struct Lowered {
    Lowering state;
    Value value;

    Lowered(const char* node, std::vector<double> list, const std::vector<std::string>& words) {
        const NodeType& type = *findNodeType(node);
        Value x{Type::scalar}, entries{type.inputs[1].type};
        x.ids[0] = state.ir.position(0);
        entries.points = std::make_shared<const std::vector<double>>(std::move(list));
        std::vector<Value> inputs = {x, entries};
        for (std::size_t i = 2; i < type.inputs.size(); ++i) {
            inputs.push_back(language::defaultValue(state, type.inputs[i]));
            if (i - 2 < words.size()) inputs.back().text = words[i - 2];
        }
        const Result<std::vector<Value>> made = language::lowerNode(state, type, inputs);
        EXPECT_TRUE(made) << (made ? "" : format(made.error()));
        if (made) value = made->front();
    }
    double at(double x, int channel = 0) const {
        return evaluate(state.ir, value.ids[std::size_t(channel)], {}, Point{x, 0, 0});
    }
    Interval over(double lo, double hi, int channel = 0) const {
        return evaluateInterval(state.ir, value.ids[std::size_t(channel)], {}, {{lo, 0, 0}, {hi, 0, 0}});
    }
};

const std::vector<double> kStops = {-1, 0.0, 0.1, 0.2, 0, 1.0, 0.5, 0.0, 2, 0.5, 0.25, 3.0};

TEST(Ramps, AStopGivesItsColourAndTheEndsGoOn) {
    for (const char* how : {"linear", "smooth", "constant"}) {
        const Lowered ramp("color_ramp", kStops, {how});
        for (int c = 0; c < 3; ++c) {
            for (std::size_t i = 0; i < 3; ++i)
                EXPECT_NEAR(ramp.at(kStops[4 * i], c), kStops[4 * i + 1 + std::size_t(c)], 1e-15) << how;
            EXPECT_EQ(ramp.at(-1e6, c), kStops[std::size_t(1 + c)]) << how;
            EXPECT_EQ(ramp.at(1e6, c), kStops[std::size_t(9 + c)]) << how;
        }
    }
}

TEST(Ramps, BetweenStopsAsTheWordSays) {
    EXPECT_NEAR(Lowered("color_ramp", kStops, {"linear"}).at(0.5), 0.875, 1e-15);
    EXPECT_NEAR(Lowered("color_ramp", kStops, {"linear"}).at(0.5, 2), 0.75, 1e-15);
    EXPECT_NEAR(Lowered("color_ramp", kStops, {"smooth"}).at(0.5), 1.0 - 0.5 * (0.15625), 1e-15);
    EXPECT_NEAR(Lowered("color_ramp", kStops, {"smooth"}).at(1.0), 0.75, 1e-15);
    EXPECT_EQ(Lowered("color_ramp", kStops, {"constant"}).at(1.999), 1.0);
    EXPECT_EQ(Lowered("color_ramp", kStops, {"constant"}).at(-0.001), 0.0);
    const Lowered one("color_ramp", {5, 0.1, 0.2, 0.3}, {});
    EXPECT_EQ(one.at(0, 1), 0.2);
    EXPECT_TRUE(one.state.ir.isConstant(one.value.ids[0]));
}

TEST(Ramps, TwoStopsInOnePlaceAreAnEdge) {
    const std::vector<double> edges = {0, 0.0, 0, 0, 0, 0.25, 0, 0, 1, 0.5, 0, 0, 1, 1.0, 0, 0};
    for (const char* how : {"linear", "smooth", "constant"}) {
        const Lowered ramp("color_ramp", edges, {how});
        EXPECT_EQ(ramp.at(-1e-9), 0.0) << how;
        EXPECT_EQ(ramp.at(0), 0.25) << how;
        EXPECT_NEAR(ramp.at(1 - 1e-12), how == std::string("constant") ? 0.25 : 0.5, 1e-9) << how;
        EXPECT_EQ(ramp.at(1), 1.0) << how;
    }
    for (const char* how : {"smooth", "linear"})
        for (const char* ends : {"linear", "constant"}) {
            const Lowered curve("curve", {0, 0, 0, 3, 1, 4, 1, -1}, {how, ends});
            EXPECT_EQ(curve.at(-1), 0.0) << how;
            EXPECT_EQ(curve.at(0), 3.0) << how;
            EXPECT_NEAR(curve.at(0.5), 3.5, 1e-12) << how;
            EXPECT_EQ(curve.at(5), -1.0) << how;
        }
}

TEST(Ramps, ACurveGoesThroughItsPointsAndOn) {
    const std::vector<double> points = {-1, 2, 0, 0, 1, 1, 4, 2.5};
    for (const char* how : {"smooth", "linear"}) {
        const Lowered on("curve", points, {how, "linear"}), still("curve", points, {how, "constant"});
        for (std::size_t i = 0; i < 4; ++i) {
            EXPECT_NEAR(on.at(points[2 * i]), points[2 * i + 1], 1e-14) << how;
            EXPECT_NEAR(still.at(points[2 * i]), points[2 * i + 1], 1e-14) << how;
        }
        EXPECT_NEAR(on.at(-3), 6, 1e-12) << how;
        EXPECT_NEAR(on.at(6), 3.5, 1e-12) << how;
        EXPECT_NEAR(still.at(-3), 2, 1e-12) << how;
        EXPECT_NEAR(still.at(6), 2.5, 1e-12) << how;
    }
    EXPECT_NEAR(Lowered("curve", points, {"linear"}).at(2.5), 1.75, 1e-14);
    EXPECT_EQ(Lowered("curve", {3, 7}, {}).at(-10), 7.0);
    // The plain one passes a number on as it is, everywhere.
    const Lowered plain("curve", {0, 0, 1, 1}, {"linear"});
    for (const double x : {-2.5, 0.25, 1e5}) EXPECT_NEAR(plain.at(x), x, 1e-12 * std::abs(x));
}

std::vector<double> randomList(std::mt19937& random, int size) {
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<double> list;
    double place = -unit(random);
    for (int count = 1 + int(random() % 8); count > 0; --count) {
        list.push_back(place);
        for (int i = 1; i < size; ++i) list.push_back(2 * unit(random));
        if (random() % 6 != 0) place += 0.02 + unit(random);
    }
    return list;
}

TEST(Ramps, ASmoothCurveRisesOnlyWhereItsPointsDo) {
    std::mt19937 random(5);
    for (int n = 0; n < 60; ++n) {
        const std::vector<double> points = randomList(random, 2);
        const Lowered curve("curve", points, {"smooth"});
        for (std::size_t i = 0; i + 3 < points.size(); i += 2) {
            const double a = points[i], b = points[i + 2], rise = points[i + 3] - points[i + 1];
            double last = curve.at(a);
            if (a == b) continue;
            for (int k = 1; k < 40; ++k) {
                const double next = curve.at(a + (b - a) * k / 40);
                EXPECT_GE((next - last) * rise, -1e-12) << "seed 5, curve " << n;
                last = next;
            }
            // No kink at a point between two others that lie elsewhere.
            if (i == 0 || points[i - 2] == a) continue;
            const double h = 1e-6, before = (curve.at(a) - curve.at(a - h)) / h,
                         after = (curve.at(a + h) - curve.at(a)) / h;
            EXPECT_NEAR(before, after, 1e-2) << "seed 5, curve " << n;
        }
    }
}

TEST(Ramps, IntervalsHoldAndAreNarrow) {
    std::mt19937 random(9);
    std::uniform_real_distribution<double> unit(0, 1);
    const auto probe = [&](const char* node, const char* how, int channels, int n) {
        const std::vector<double> list = randomList(random, channels + 1);
        const Lowered ramp(node, list, {how});
        const bool straight = how != std::string("smooth");
        for (int k = 0; k < 12; ++k) {
            const double lo = -1 + 5 * unit(random), hi = lo + (k % 3 == 0 ? 3.0 : 0.1) * unit(random);
            for (int c = 0; c < channels; ++c) {
                const Interval bound = ramp.over(lo, hi, c);
                double least = ramp.at(lo, c), most = least;
                const auto look = [&](double x) {
                    least = std::min(least, ramp.at(x, c)), most = std::max(most, ramp.at(x, c));
                };
                for (int i = 0; i <= 60; ++i) look(lo + (hi - lo) * i / 60);
                for (std::size_t i = 0; i < list.size(); i += std::size_t(channels) + 1) {
                    if (list[i] > lo && list[i] <= hi) look(list[i]), look(std::nextafter(list[i], -1e9));
                }
                const std::string which = std::string(node) + " " + how + " " + std::to_string(n);
                EXPECT_LE(bound.lo, least + 1e-12) << which;
                EXPECT_GE(bound.hi, most - 1e-12) << which;
                // Straight pieces: what is found is all that there is. Of bent ones no more than twice that
                // and what the box's width times the steepest slope may add.
                const double slack = straight ? 1e-9 : (most - least) + 40 * (hi - lo);
                EXPECT_GE(bound.lo, least - slack) << which;
                EXPECT_LE(bound.hi, most + slack) << which;
                if (node == std::string("curve")) continue;  // it goes on beyond its ends
                EXPECT_GE(bound.lo, -1e-12) << which;
                EXPECT_LE(bound.hi, 2 + 1e-12) << which;
            }
        }
    };
    for (int n = 0; n < 40; ++n) {
        for (const char* how : {"linear", "smooth", "constant"}) probe("color_ramp", how, 3, n);
        for (const char* how : {"smooth", "linear"}) probe("curve", how, 1, n);
    }
    // A small box within a smooth piece is as narrow as its slope makes it, not as wide as the piece.
    const Lowered curve("curve", {0, 0, 1, 1, 3, 1.2}, {"smooth"});
    const Interval narrow = curve.over(0.5, 0.501);
    EXPECT_LT(narrow.hi - narrow.lo, 0.01);
    const Lowered ramp("color_ramp", {0, 0, 0, 0, 1, 1, 1, 1}, {"smooth"});
    EXPECT_LT(ramp.over(0.9, 0.901).hi - ramp.over(0.9, 0.901).lo, 0.01);
}

constexpr const char* kPainted = R"({"fieldwright": 1, "nodes": [
    {"id": "at", "type": "position"},
    {"id": "height", "type": "separate_xyz", "inputs": {"vector": {"from": "at"}}},
    {"id": "ramp", "type": "color_ramp", "inputs": {"value": {"from": "height", "output": "y"},
        "stops": [[0, 0, 0, 0], [0.5, 1, 0.5, 0], [1, 1, 1, 1]], "interpolation": "smooth"}},
    {"id": "bump", "type": "curve", "inputs": {"value": {"from": "height", "output": "x"},
        "points": [[-1, 0.25], [0, 1], [1, 0.25]]}},
    {"id": "ball", "type": "sphere", "inputs": {"radius": {"from": "bump"}}},
    {"id": "paint", "type": "material", "inputs": {"surface": {"from": "ball"}, "base_color": {"from": "ramp"}}},
    {"id": "out", "type": "output", "inputs": {"surface": {"from": "paint"}}}]})";

Graph parsed(const std::string& text) {
    const Result<Graph> graph = parseGraph(text, "a.field.json", nullptr);
    EXPECT_TRUE(graph) << (graph ? "" : format(graph.error()));
    return graph ? *graph : Graph{};
}

TEST(Ramps, StopsThatAreLiveMoveWithoutAnotherProgram) {
    Graph graph = parsed(kPainted);
    CompileOptions options;
    options.live = {"ramp.stops", "bump.points"};
    EXPECT_TRUE(checkLive(graph, options));
    const Result<LiveProgram> before = compileLive(graph, options);
    ASSERT_TRUE(before) << format(before.error());
    EXPECT_EQ(before->inputs.at("ramp.stops").slots.size(), 12u);
    EXPECT_EQ(before->inputs.at("bump.points").slots.size(), 6u);
    graph.node("ramp")->set("stops", listValue(Type::stops, {0, 0, 0, 0, 0.75, 1, 0.5, 0.25, 0.75, 1, 1, 1}));
    graph.node("bump")->set("points", listValue(Type::points, {-1, 0.5, 0.25, 1.5, 1, 0.25}));
    const Result<LiveProgram> after = compileLive(graph, options);
    ASSERT_TRUE(after);
    EXPECT_EQ(before->program.structureHash, after->program.structureHash);
    const std::vector<double> values = after->valuesAt(0.0);
    const Result<Program> folded = compile(graph);
    ASSERT_TRUE(folded);
    EXPECT_NE(folded->structureHash, after->program.structureHash);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> within(-1.5, 1.5);
    for (int i = 0; i < 200; ++i) {
        const Point p = {within(random), within(random), within(random)};
        for (std::size_t c = 0; c < folded->surface.size(); ++c)
            EXPECT_NEAR(evaluate(before->program.ir, before->program.surface[c], values, p),
                        evaluate(folded->ir, folded->surface[c], {}, p), 1e-9)
                << c;
    }
}

TEST(Ramps, FilesKeepStopsToTheByte) {
    const std::string text = writeGraph(parsed(kPainted));
    EXPECT_NE(text.find("\"stops\": [[0, 0, 0, 0], [0.5, 1, 0.5, 0], [1, 1, 1, 1]]"), std::string::npos)
        << text;
    EXPECT_EQ(writeGraph(parsed(text)), text);
}

/// What is said of this list as the stops of the node, or the points.
std::string said(const std::string& list, const char* type = "color_ramp", const char* input = "stops") {
    const std::string text = "{\"fieldwright\": 1, \"nodes\": [\n  {\"id\": \"heat\", \"type\": \"" +
                             std::string(type) + "\", \"inputs\": {\n    \"" + input + "\": " + list + "}}]}";
    const Result<Graph> graph = parseGraph(text, "a.field.json", nullptr);
    if (!graph) return format(graph.error());
    for (const Error& finding : check(*graph))
        if (finding.severity == Error::Severity::error && finding.node == "heat") return format(finding);
    return "";
}
std::string many(const std::string& entry, int count) {
    std::string list = "[" + entry;
    for (int i = 1; i < count; ++i) list += ", " + entry;
    return list + "]";
}

TEST(Ramps, ListsThatCannotBeAreNamedWithARemedy) {
    const auto expect = [](const std::string& found, const char* words) {
        EXPECT_NE(found.find("a.field.json:3:"), std::string::npos) << found;
        EXPECT_NE(found.find("'heat'"), std::string::npos) << found;
        EXPECT_NE(found.find(words), std::string::npos) << found;
    };
    EXPECT_EQ(said("[[0, 0, 0, 0], [0, 1, 1, 1], [1, 4, 0, 0]]"), "");
    EXPECT_EQ(said(many("[0, 0, 0, 0]", 32)), "");
    EXPECT_EQ(said("[[0, 0], [1, -1]]", "curve", "points"), "");
    EXPECT_EQ(said("[[1, 0], [0, 0], [0, 1]]", "polygon", "points"), "") << "an outline has no order";
    expect(said("[[0.5, 0, 0, 0], [0.25, 1, 1, 1]]"),
           "stop 2 lies at 0.25, before the one that precedes it, at 0.5: sort them");
    expect(said(many("[0, 0, 0, 0]", 33)), "33 stops: at most 32 are allowed, remove some");
    expect(said("[]"), "expected an array of stops [position, red, green, blue], not an empty array");
    expect(said("[[0, 0, -1, 0]]"), "the colour of stop 1 has the component -1: it must be at least 0");
    expect(said("[[0, 0, 0, \"a\"]]"), "an array of something other than four numbers");
    expect(said("[[0, 0, 0, 0], [1, 1]]"), "an array of something other than four numbers");
    expect(said("[[0, 0, 0]]"),
           "expected an array of stops [position, red, green, blue], not an array of 1 knot");
    expect(said("[[0, 0, 0, 0, 0, 0]]"), "an array of something other than two, three, four or five numbers");
    expect(said("[[0, 0], [1, 1]]"), "not an array of 2 pairs");
    expect(said("[0, 1]"), "not an array of 2 numbers");
    expect(said("{\"from\": \"heat\"}"), "but this input takes stops");
    expect(said("[[1, 0], [0, 0]]", "curve", "points"), "point 2 lies at 0");
    expect(said(many("[0, 0]", 33), "curve", "points"), "33 points: at most 32");
    expect(said("[]", "curve", "points"), "not an empty array");
}

TEST(Ramps, CodeCallsThemWithListsThatItIsGiven) {
    const auto lowered = [](const std::string& code, std::vector<double> stops, std::vector<double> points) {
        Lowering state;
        Value s{Type::stops}, l{Type::points};
        s.points = std::make_shared<const std::vector<double>>(std::move(stops));
        l.points = std::make_shared<const std::vector<double>>(std::move(points));
        const Result<Value> value = language::lowerText(state, code, {{"stops", s}, {"list", l}});
        return value ? std::to_string(state.ir.number(value->ids[0])) : format(value.error());
    };
    const std::vector<double> stops = {0, 0.0, 0, 0, 1, 1.0, 0, 0}, points = {0, 0, 2, 1};
    EXPECT_EQ(lowered("return color_ramp(0.25, stops).r;", stops, points), "0.250000");
    EXPECT_EQ(lowered("return color_ramp(0.25, stops, \"constant\").r;", stops, points), "0.000000");
    EXPECT_EQ(lowered("return curve(3, list);", stops, points), "1.500000");
    EXPECT_EQ(lowered("return curve(3, list, \"linear\", \"constant\");", stops, points), "1.000000");
    EXPECT_NE(lowered("return curve(3, list, \"round\");", stops, points)
                  .find("'round' is not one of its choices: smooth, linear"),
              std::string::npos)
        << lowered("return curve(3, list, \"round\");", stops, points);
    EXPECT_NE(lowered("return curve(3, list);", stops, {1, 0, 0, 0}).find("point 2 lies at 0"),
              std::string::npos);
    EXPECT_NE(lowered("return curve(3, list);", stops, {}).find("there is no point"), std::string::npos);
    EXPECT_NE(lowered("return color_ramp(0.5, list);", stops, points).find("expected a stops"),
              std::string::npos)
        << lowered("return color_ramp(0.5, list);", stops, points);
}

}  // namespace fw::ramps_test
