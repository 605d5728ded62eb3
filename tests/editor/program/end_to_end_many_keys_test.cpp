// More keys than pixels in the real window: one among many is still found, taken and moved, in rows and in
// curves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "editor/shell/theme.h"
#include "graph/document/timeline.h"
#include "tests/support/editor/program.h"

namespace fw::editor::test::end_to_end_many_keys_test {

constexpr int kKeys = 2000, kSpike = 1200;  // ten a second; one of another value than all others

std::string document() {
    std::string keys;
    for (int i = 0; i < kKeys; ++i)
        keys += (i ? ", " : "") + std::string(R"({"time": )") + std::to_string(i / 10) + "." +
                std::to_string(i % 10) + R"(, "value": )" + (i == kSpike ? "0.9" : "0.5") + "}";
    return R"({"fieldwright": 1, "nodes": [
        {"id": "ball", "type": "sphere", "at": [0, 0], "inputs": {"radius": 0.8}},
        {"id": "out", "type": "output", "at": [260, 0], "inputs": {"surface": {"from": "ball"}, "resolution": 16}}],
      "timeline": {"length": 200, "fps": 30, "tracks": [
        {"node": "ball", "input": "radius", "interpolation": "linear", "keys": [)" +
           keys + "]}]}}";
}

struct EndToEndManyKeys : testing::Test {
    void SetUp() override {
        ASSERT_TRUE(program.works()) << "Xvfb, xdotool or xclip is not installed: run ./.install test";
        program.keys("Ctrl+T");
        const Area add = program.waitFor("Add track");
        strip = {{170, add.hi.y + 4}, {1276, 775}};
        row = program.waitFor("ball · radius", Area{{0, add.hi.y + 4}, {170, 790}}).centre().y;
        const Area first = program.waitFor("45 s", strip), second = program.waitFor("165 s", strip);
        perSecond = (second.lo.x - first.lo.x) / 120.0f;
        zero = first.lo.x - 3.0f - 45.0f * perSecond;  // a label stands beside its line
    }
    float x(double time) const { return zero + float(time) * perSecond; }
    Track track() { return readTimeline(program.saved())->tracks.at(0); }
    /// The times that are no keys any more.
    std::vector<double> gone() {
        std::vector<double> all;
        const Track now = track();
        for (int i = 0; i < kKeys; ++i)
            if (std::ranges::none_of(now.keys,
                                     [&](const Key& key) { return std::abs(key.time - 0.1 * i) < 1e-6; }))
                all.push_back(0.1 * i);
        return all;
    }
    /// How far the pixel is from this colour, the largest of its channels.
    static int off(const Picture& picture, int u, int v, ImU32 color) {
        const std::size_t i = 4 * (std::size_t(v) * std::size_t(picture.width) + std::size_t(u));
        int most = 0;
        for (unsigned c = 0; c < 3; ++c)
            most = std::max(most, std::abs(int(picture.pixels[i + c]) - int((color >> (8 * c)) & 255u)));
        return most;
    }
    /// How many pixels of the line down at this place, within the strip, have the colour.
    int down(float at, ImU32 color) const {
        const Picture seen = program.screen();
        int count = 0;
        for (int v = int(strip.lo.y); v < int(strip.hi.y); ++v) count += off(seen, int(at), v, color) < 30;
        return count;
    }

    Program program{document()};
    Area strip;
    float row = 0, zero = 0, perSecond = 1;
};

TEST_F(EndToEndManyKeys, AreTakenOneByOneByABoxAndAsACurve) {
    const ImU32 selected = themeColor(ThemeColor::selected), plain = themeColor(ThemeColor::node);
    // A strip from the first to the last key.
    EXPECT_TRUE(eventually([&] { return down(x(3), plain) > 4 && down(x(196), plain) > 4; }));
    program.click({x(60), row});
    program.waitFor("Key at");
    EXPECT_TRUE(eventually([&] { return down(x(60), selected) > 2; })) << "one among many is seen selected";
    EXPECT_EQ(down(x(63), selected), 0);
    program.keys("Delete");
    const std::vector<double> one = gone();
    ASSERT_EQ(one.size(), 1u);
    EXPECT_NEAR(one[0], 60.0, 1.0 / double(perSecond)) << "the nearest to the mouse";
    program.keys("Ctrl+Z");

    program.drag({{x(100), row + 40}, {x(90), row + 20}, {x(80), row - 5}});
    program.waitFor("keys", Area{{80, 560}, {260, strip.lo.y}});
    EXPECT_TRUE(eventually([&] { return down(x(81), selected) > 4 && down(x(99), selected) > 4; }));
    EXPECT_EQ(down(x(78), selected), 0);
    EXPECT_EQ(down(x(102), selected), 0);
    program.keys("Delete");
    const std::vector<double> boxed = gone();
    EXPECT_NEAR(double(boxed.size()), 200.0, 10.0);
    EXPECT_NEAR(boxed.front(), 80.0, 0.5);
    EXPECT_NEAR(boxed.back(), 100.0, 0.5);
    program.keys("Ctrl+Z");

    // As a curve.
    program.clickOn("Curves", Area{{0, strip.lo.y}, {200, 790}});
    const Area keysButton = program.waitFor("Keys");
    strip.lo.y = keysButton.hi.y + 30;
    // The one that is higher than the others is seen, though many are in its column: above the line of the
    // rest.
    const ImU32 ink = themeColor(ThemeColor::text);
    float spike = 0;
    EXPECT_TRUE(eventually([&] {
        for (spike = x(120) - 3; spike <= x(120) + 3; ++spike)
            if (down(spike, ink) > 60) return true;
        return false;
    }));
    EXPECT_LT(down(x(90), ink), 8) << "elsewhere it is a line";
    float top = strip.lo.y;
    const Picture seen = program.screen();
    while (top < strip.hi.y && off(seen, int(spike), int(top), ink) > 60) ++top;
    // It is taken at its top, and dragged along.
    program.moveTo({x(120), top + 1});
    program.waitFor("120 s", Area{{x(120) - 60, strip.lo.y}, {x(120) + 160, 790}});
    program.drag({{x(120), top + 1}, {x(130), top + 1}, {x(150), top + 1}});
    const Track now = track();
    const auto highest = std::ranges::max_element(now.keys, {}, [](const Key& key) { return key.value[0]; });
    EXPECT_NEAR(highest->time, 150.0, 1.5 / double(perSecond));
    EXPECT_NEAR(highest->value[0], 0.9, 0.02);
}

}  // namespace fw::editor::test::end_to_end_many_keys_test
