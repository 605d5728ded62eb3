// Ramps of colours and curves in the inspector: the edits of their lists, and the bar and the box by real
// mouse and keys.
#include <gtest/gtest.h>

#include <cmath>

#include "editor/ramps/edits.h"
#include "graph/evaluate/evaluate.h"
#include "graph/language/lower.h"
#include "tests/support/editor/program.h"

namespace fw::editor::ramps_test {

using ramps::List;
using test::Program;

const List kThree{Type::stops, {0, 1, 0, 0, 0.5, 0, 1, 0, 1, 0, 0, 1}};
const List kCurve{Type::points, {-1, 2, 0, 0, 2, 1}};

std::vector<double> placesIn(const List& list) {
    std::vector<double> all;
    for (std::size_t i = 0; i < list.count(); ++i) all.push_back(list.at(i));
    return all;
}

TEST(RampEdits, AnEntryGoesPastOthersInOrder) {
    const auto right = ramps::moved(kThree, 0, 0.75);
    EXPECT_EQ(right.entry, 1u);
    EXPECT_EQ(right.list.numbers, (std::vector<double>{0.5, 0, 1, 0, 0.75, 1, 0, 0, 1, 0, 0, 1}));
    const auto left = ramps::moved(kThree, 2, -1);
    EXPECT_EQ(left.entry, 0u);
    EXPECT_EQ(left.list.at(0), -1.0);
    // In one place it stays on the side that it came from.
    EXPECT_EQ(ramps::moved(kThree, 0, 0.5).entry, 0u);
    EXPECT_EQ(ramps::moved(kThree, 2, 0.5).entry, 2u);
    EXPECT_EQ(ramps::moved(kThree, 1, 0.5).list, kThree);
    const auto there = ramps::replaced(kCurve, 1, std::array{3.0, -1.0});
    EXPECT_EQ(there.entry, 2u);
    EXPECT_EQ(there.list.numbers, (std::vector<double>{-1, 2, 2, 1, 3, -1}));
}

TEST(RampEdits, EntriesComeAndGo) {
    const auto more = ramps::inserted(kThree, std::array{0.5, 1.0, 1.0, 1.0});
    ASSERT_TRUE(more);
    EXPECT_EQ(more->entry, 2u) << "behind the one that is there";
    EXPECT_EQ(ramps::removed(more->list, 2)->list, kThree);
    EXPECT_EQ(ramps::removed(kThree, 0)->entry, 0u);
    EXPECT_FALSE(ramps::removed({Type::stops, {0, 1, 1, 1}}, 0)) << "the last one";
    List full{Type::points, {}};
    for (std::size_t i = 0; i < kMostStops; ++i) full.numbers.insert(full.numbers.end(), {double(i), 0});
    EXPECT_FALSE(ramps::inserted(full, std::array{0.5, 0.5}));
    EXPECT_FALSE(ramps::divided(full, 3, ""));
    const auto half = ramps::divided(kThree, 1, "linear");
    EXPECT_EQ(half->entry, 2u);
    EXPECT_EQ(std::vector<double>(half->list.entry(2).begin(), half->list.entry(2).end()),
              (std::vector<double>{0.75, 0, 0.5, 0.5}));
    EXPECT_EQ(ramps::divided(kThree, 2, "linear")->list.at(2), 0.75) << "of the last the one before";
    EXPECT_EQ(ramps::divided(kCurve, 1, "")->list.numbers, (std::vector<double>{-1, 2, 0, 0, 1, 0.5, 2, 1}));
    EXPECT_FALSE(ramps::divided({Type::stops, {}}, 0, "linear"));
}

TEST(RampEdits, ReversedAndDistributed) {
    List uneven = kThree;
    uneven.numbers[4] = 0.2;
    EXPECT_EQ(placesIn(ramps::reversed(uneven)), (std::vector<double>{0, 0.8, 1}));
    EXPECT_EQ(ramps::reversed(uneven).entry(0)[3], 1.0) << "blue is first";
    EXPECT_EQ(ramps::reversed(ramps::reversed(uneven)), uneven);
    EXPECT_EQ(ramps::distributed(uneven), kThree);
    EXPECT_EQ(placesIn(ramps::distributed(kCurve)), (std::vector<double>{-1, 0.5, 2}));
    EXPECT_EQ(ramps::reversed(kCurve).numbers, (std::vector<double>{-1, 1, 1, 0, 2, 2}));
}

TEST(RampEdits, AListThatIsNoneIsMended) {
    const auto isOne = [](const List& list) { return !orderProblem(list.type, list.numbers); };
    EXPECT_EQ(ramps::mended(kThree), kThree);
    EXPECT_EQ(ramps::mended(kCurve), kCurve);
    EXPECT_TRUE(isOne(ramps::mended({Type::stops, {}})));
    EXPECT_TRUE(isOne(ramps::mended({Type::points, {}})));
    EXPECT_EQ(ramps::mended({Type::points, {2, 7, -1, 8, 2, 9}}).numbers,
              (std::vector<double>{-1, 8, 2, 7, 2, 9}));
    EXPECT_EQ(ramps::mended({Type::stops, {0, 1, -2, 3}}).numbers, (std::vector<double>{0, 1, 0, 3}));
    List many{Type::stops, {}};
    for (int i = 1000; i >= 0; --i) many.numbers.insert(many.numbers.end(), {double(i), 1.0, 0.5, 0.25});
    const List fewer = ramps::mended(many);
    EXPECT_TRUE(isOne(fewer));
    ASSERT_EQ(fewer.count(), kMostStops);
    EXPECT_EQ(fewer.at(0), 0.0);
    EXPECT_EQ(fewer.at(kMostStops - 1), 1000.0);
}

TEST(RampEdits, WhatIsSeenHasRoomForAll) {
    EXPECT_EQ(ramps::placesOf(kThree).lo, 0.0);
    EXPECT_EQ(ramps::placesOf({Type::stops, {0.25, 0, 0, 0, 0.5, 0, 0, 0}}).hi, 1.0);
    EXPECT_EQ(ramps::placesOf(kCurve).lo, -1.0);
    EXPECT_GT(ramps::placesOf({Type::stops, {7, 0, 0, 0}}).span(), 0.5) << "one alone";
    EXPECT_LT(ramps::heightsOf(kCurve).lo, 0.0);
    EXPECT_GT(ramps::heightsOf({Type::points, {0, 5, 1, 5}}).span(), 0.5) << "a level one";
    // However large the numbers are, a range has an inside.
    for (const double far : {5e15, -1e17, 1e300}) {
        EXPECT_GT(ramps::placesOf({Type::points, {far, 0}}).span(), 1e-7 * std::abs(far));
        EXPECT_GT(ramps::heightsOf({Type::points, {0, far, 1, far}}).span(), 1e-10 * std::abs(far));
    }
    EXPECT_EQ(ramps::rounded(0.2903, {0, 1}, 150), 0.29);
    EXPECT_EQ(ramps::rounded(1234.4, {0, 5000}, 150), 1230.0);
}

TEST(RampEdits, ColoursAreThoseOfTheNode) {
    List edges = kThree;
    edges.numbers.insert(edges.numbers.end(), {1, 0.5, 0.5, 2, 3, 0, 0, 0});
    const NodeType& type = *findNodeType("color_ramp");
    for (const std::string& how : type.inputs[2].options) {
        language::Lowering state;
        language::Value x{Type::scalar}, list{Type::stops}, word{Type::string};
        x.ids[0] = state.ir.position(0);
        list.points = std::make_shared<const std::vector<double>>(edges.numbers);
        word.text = how;
        const auto made = language::lowerNode(state, type, {x, list, word});
        ASSERT_TRUE(made);
        for (double at = -0.55; at < 3.5; at += 0.05)
            for (std::size_t c = 0; c < 3; ++c)
                EXPECT_NEAR(ramps::colorAt(edges, how, at)[c],
                            evaluate(state.ir, made->front().ids[c], {}, Point{at, 0, 0}), 1e-12)
                    << how << " at " << at;
    }
    const std::vector<double> heights = ramps::curveValues(kCurve, "linear", "constant", -2, 2, 5);
    EXPECT_EQ(heights, (std::vector<double>{2, 2, 0, 0.5, 1}));
    EXPECT_TRUE(ramps::curveValues({Type::points, {1, 0, 0, 0}}, "", "", 0, 1, 5).empty()) << "out of order";
}

/// The lightness and the two others of OKLab (Ottosson 2020).
std::array<double, 3> lab(std::span<const double> rgb) {
    const auto root = [&](double r, double g, double b) {
        return std::cbrt(r * rgb[0] + g * rgb[1] + b * rgb[2]);
    };
    const double l = root(0.4122214708, 0.5363325363, 0.0514459929),
                 m = root(0.2119034982, 0.6806995451, 0.1073969566),
                 s = root(0.0883024619, 0.2817188376, 0.6299787005);
    return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
            1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
            0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

TEST(RampEdits, PresetsAreRampsAndTheRainbowIsEven) {
    for (const ramps::Preset& preset : ramps::presets()) {
        EXPECT_EQ(orderProblem(Type::stops, preset.stops), std::nullopt) << preset.name;
        const List stretched = ramps::stretched(preset, {-3, 5});
        EXPECT_EQ(stretched.at(0), -3.0);
        EXPECT_EQ(stretched.at(stretched.count() - 1), 5.0);
        for (const double number : preset.stops) EXPECT_TRUE(number >= 0.0 && number <= 1.0) << preset.name;
        if (preset.name != "Rainbow") continue;
        const List rainbow{Type::stops, {preset.stops.begin(), preset.stops.end()}};
        std::array<double, 3> last{};
        for (std::size_t i = 0; i < rainbow.count(); ++i) {
            const auto seen = lab(rainbow.entry(i).subspan(1));
            EXPECT_NEAR(seen[0], 0.75, 2e-3);
            if (i > 0) { EXPECT_NEAR(std::hypot(seen[1] - last[1], seen[2] - last[2]), 0.0918, 2e-3); }
            last = seen;
        }
    }
}

class RampInspector : public testing::Test {
  protected:
    void SetUp() override {
        ASSERT_TRUE(program.works()) << "Xvfb, xdotool or xclip is not installed: run ./.install test";
        original = program.save();
        program.frameAll();
    }
    std::vector<double> numbers(const char* node, const char* input) {
        const InputValue* value = program.saved().node(node)->input(input);
        return value ? std::get<std::vector<double>>(value->value) : std::vector<double>{};
    }
    List stops() { return {Type::stops, numbers("ramp", "stops")}; }
    List points() { return {Type::points, numbers("bump", "points")}; }

    /// The middle of what has just this colour to the right of and below a place, at least so many pixels.
    std::optional<ImVec2> find(ImVec2 from, std::array<int, 3> color, std::size_t least = 20) const {
        const Picture seen = program.screen();
        double x = 0, y = 0, count = 0;
        for (int v = int(from.y); v < seen.height; ++v)
            for (int u = int(from.x); u < seen.width; ++u) {
                const uint8_t* pixel =
                    &seen.pixels[4 * (std::size_t(v) * std::size_t(seen.width) + std::size_t(u))];
                if (pixel[0] != color[0] || pixel[1] != color[1] || pixel[2] != color[2]) continue;
                x += u, y += v, ++count;
            }
        if (count < double(least)) return {};
        return ImVec2{float(x / count), float(y / count)};
    }
    ImVec2 waitForHandle(ImVec2 from, std::array<int, 3> color) {
        std::optional<ImVec2> found;
        EXPECT_TRUE(test::eventually([&] { return (found = find(from, color)).has_value(); }));
        return found.value_or(ImVec2{});
    }

    Program program{R"({"fieldwright": 1, "nodes": [
        {"id": "pos", "type": "position", "at": [-320, 0]},
        {"id": "height", "type": "separate_xyz", "at": [-200, 0], "inputs": {"vector": {"from": "pos"}}},
        {"id": "ramp", "type": "color_ramp", "at": [0, 0], "inputs": {"value": {"from": "height", "output": "y"},
            "stops": [[0, 1, 0, 0], [0.5, 0, 1, 0], [1, 0, 0, 1]]}},
        {"id": "bump", "type": "curve", "at": [0, 200], "inputs": {"value": {"from": "height"},
            "points": [[0, 0.5], [1, 1]]}},
        {"id": "ball", "type": "sphere", "at": [260, 200], "inputs": {"radius": {"from": "bump"}}},
        {"id": "paint", "type": "material", "at": [480, 0],
         "inputs": {"surface": {"from": "ball"}, "base_color": {"from": "ramp"}}},
        {"id": "out", "type": "output", "at": [720, 0], "inputs": {"surface": {"from": "paint"}, "resolution": 16}}]})"};
    std::string original;
};

TEST_F(RampInspector, StopsAndPointsAreDraggedAddedAndRemoved) {
    const Area side{{800, 0}, {1280, 800}};
    program.click(program.title("ramp"));
    // Below the bar, which has the same colours.
    const ImVec2 words = program.waitFor("Stops", side).lo, from{words.x, words.y + 15.0f};
    ImVec2 red, green, blue;
    EXPECT_TRUE(test::eventually([&] {  // the panel narrows once it knows that it has a bar to scroll
        const float before = blue.x;
        program.save();
        red = waitForHandle(from, {255, 0, 0}), green = waitForHandle(from, {0, 255, 0}),
        blue = waitForHandle(from, {0, 0, 255});
        return blue.x == before && std::abs(green.x - 0.5f * (red.x + blue.x)) < 1.0f;
    })) << "in the middle of the bar";
    const float wide = blue.x - red.x;
    ASSERT_GT(wide, 60.0f);
    const auto at = [&](float share) { return ImVec2{red.x + share * wide, green.y}; };

    // A drag moves it, as one step.
    program.drag({at(0.5f), at(0.6f), at(0.75f)});
    EXPECT_NEAR(stops().at(1), 0.75, 0.01);
    EXPECT_EQ(stops().entry(1)[2], 1.0);
    program.keys("Ctrl+Z");
    EXPECT_EQ(program.save(), original);
    // Past another one.
    program.drag({at(0.0f), at(0.4f), at(0.8f)});
    EXPECT_NEAR(stops().at(0), 0.5, 1e-9);
    EXPECT_NEAR(stops().at(1), 0.8, 0.01);
    EXPECT_EQ(stops().entry(1)[1], 1.0) << "red is second";
    program.keys("Ctrl+Z");
    // Escape takes it back.
    program.drag({at(0.5f), at(0.6f), at(0.75f)}, 1, {}, true, false);
    program.keys("Escape");
    program.release();
    EXPECT_EQ(program.save(), original);

    // A click on the bar adds one with the colour that is there, by which the keys go on.
    const ImVec2 bar{at(0.25f).x, green.y - 22.0f};
    program.click(bar);
    EXPECT_EQ(stops().count(), 4u);
    EXPECT_NEAR(stops().at(1), 0.25, 0.01);
    EXPECT_NEAR(stops().entry(1)[1], 0.5, 0.02);
    EXPECT_NEAR(stops().entry(1)[2], 0.5, 0.02);
    program.keys("Right", 2);
    EXPECT_NEAR(stops().at(1), 0.27, 0.01);
    program.keys("Tab");
    program.keys("Left");
    EXPECT_NEAR(stops().at(2), 0.49, 1e-9) << "the next one, green";
    program.keys("Delete");
    EXPECT_EQ(stops().count(), 3u);
    EXPECT_EQ(program.graph().nodes.size(), 7u) << "no node is";
    program.keys("Ctrl+Z", 5);
    EXPECT_EQ(program.save(), original);

    // Dragged away it goes; dragged away and back it stays.
    program.drag({at(0.5f), {at(0.5f).x, green.y + 60}, {at(0.5f).x, green.y + 120}});
    EXPECT_EQ(placesIn(stops()), (std::vector<double>{0, 1}));
    program.keys("Ctrl+Z");
    EXPECT_EQ(program.save(), original);
    program.drag({at(0.5f), {at(0.5f).x, green.y + 100}, at(0.5f)});
    EXPECT_EQ(program.save(), original);

    // The tools; their tips go with the mouse.
    program.clickOn("Reverse");
    EXPECT_EQ(stops().entry(0)[3], 1.0);
    program.moveTo({1040, 560});
    program.clickOn("Presets …");
    program.clickOn("Terrain");
    EXPECT_EQ(stops().count(), 7u);
    program.moveTo({1040, 560});
    program.clickOn("Even");
    EXPECT_NEAR(stops().at(1), 0.1667, 1e-9);
    program.keys("Ctrl+Z", 3);
    EXPECT_EQ(program.save(), original);

    // The same of a curve's points.
    program.click(program.title("bump"));
    program.waitFor("Points", side);
    program.wheel({1040, 640}, -20);  // to the end of what is in the panel
    const Area even = program.waitFor("Even", side), x = program.waitFor("x -0.1 … 1.1", side);
    EXPECT_GT(even.lo.y, x.hi.y);
    // The box stands on the words, as wide as they are at least.
    const ImVec2 there{x.lo.x + 30.0f, x.lo.y - 30.0f};
    program.click(there);
    ASSERT_EQ(points().count(), 3u);
    const double px = points().at(1), py = points().entry(1)[1];
    EXPECT_GT(px, 0.0);
    EXPECT_LT(px, 0.6);
    EXPECT_GT(py, 0.45);
    EXPECT_LT(py, 0.8);
    // To the right and up; as one step.
    program.drag({there, {there.x + 10, there.y - 10}, {there.x + 20, there.y - 15}});
    EXPECT_GT(points().at(1), px);
    EXPECT_GT(points().entry(1)[1], py);
    program.keys("Ctrl+Z");
    EXPECT_EQ(points().at(1), px);
    program.keys("Up", 2);
    EXPECT_GT(points().entry(1)[1], py);
    program.keys("Delete");
    program.keys("Ctrl+Z", 4);
    EXPECT_EQ(program.save(), original);
}

TEST(EndToEndRamps, AHundredThousandStopsAreSaidAndMended) {
    std::string stops;
    for (int i = 100'000; i > 0; --i) stops += (stops.empty() ? "[" : ",[") + std::to_string(i) + ",1,0,0]";
    test::Program program(
        R"({"fieldwright": 1, "nodes": [{"id": "ramp", "type": "color_ramp", "at": [0, 0], "inputs": {"stops": [)" +
        stops +
        R"(]}}, {"id": "bump", "type": "curve", "at": [0, 200], "inputs": {"points": [[5e15, 5e15]]}}]})");
    ASSERT_TRUE(program.works()) << "Xvfb, xdotool or xclip is not installed: run ./.install test";
    program.save();
    program.frameAll();
    program.click(program.title("bump"));
    program.waitFor("A number from a number");
    program.click(program.title("ramp"));
    program.waitFor("at most 32");
    program.clickOn("Mend");
    program.waitUntilGone("at most 32");
    const std::vector<double> kept =
        std::get<std::vector<double>>(program.saved().node("ramp")->input("stops")->value);
    EXPECT_EQ(kept.size(), 4 * kMostStops);
    EXPECT_FALSE(orderProblem(Type::stops, kept));
}

}  // namespace fw::editor::ramps_test
