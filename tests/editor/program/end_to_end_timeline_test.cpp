// The timeline in the real window: keys, curves, tangents, markers and the range, by real mouse and keys,
// seen in the saved file and on the screen.
#include <gtest/gtest.h>

#include <cmath>

#include "editor/shell/theme.h"
#include "graph/document/named_parameters.h"
#include "graph/document/timeline.h"
#include "tests/support/editor/program.h"

namespace fw::editor::test::end_to_end_timeline_test {

constexpr const char* kDocument = R"({"fieldwright": 1, "nodes": [
    {"id": "ball", "type": "sphere", "at": [0, 0], "inputs": {"radius": 0.8}},
    {"id": "out", "type": "output", "at": [260, 0], "inputs": {"surface": {"from": "ball"}, "resolution": 16}}],
  "scene": {"camera": {"position": [4, 3, 6]}},
  "timeline": {"length": 5, "fps": 30, "tracks": [
    {"node": "ball", "input": "radius", "interpolation": "cubic", "keys": [
      {"time": 0, "value": 0.5}, {"time": 1, "value": 1.2}, {"time": 2.5, "value": 0.4}, {"time": 5, "value": 0.5}]},
    {"scene": "camera.position", "keys": [{"time": 0, "value": [4, 3, 6]}, {"time": 5, "value": [6, 3, 0]}]}]}})";

class EndToEndTimeline : public testing::Test {
  protected:
    void SetUp() override {
        ASSERT_TRUE(program.works()) << "Xvfb, xdotool or xclip is not installed: run ./.install test";
        program.moveTo({200, 60});
        program.frameAll();
    }

    /// Opens it and finds out where its times are.
    void open() {
        program.keys("Ctrl+T");
        const Area add = program.waitFor("Add track");
        lower = {{0, add.hi.y + 4}, {1276, 790}};
        const Area name = program.waitFor("ball · radius", lower);
        row = name.centre().y;
        strip = {{170, add.hi.y + 4}, {1276, 790}};
        const Area one = program.waitFor("1 s", strip), three = program.waitFor("3 s", strip);
        ruler = one.centre().y + 2;
        perSecond = 0.5f * (three.lo.x - one.lo.x);
        zero = one.lo.x - 3.0f - perSecond;  // a label stands beside its line
    }
    float x(double time) const { return zero + float(time) * perSecond; }
    ImVec2 key(double time) const { return {x(time), row}; }

    std::vector<double> times(std::size_t track = 0) {
        const Result<Timeline> timeline = readTimeline(program.saved());
        EXPECT_TRUE(timeline);
        std::vector<double> list;
        if (timeline && track < timeline->tracks.size())
            for (const Key& each : timeline->tracks[track].keys)
                list.push_back(std::round(each.time * 30.0) / 30.0 == each.time ? each.time : -1.0);
        return list;
    }
    Timeline timeline() { return *readTimeline(program.saved()); }

    /// How far the pixel is from this colour, the largest of its channels.
    int off(const Picture& picture, ImVec2 at, ImU32 color) const {
        const std::size_t i = 4 * (std::size_t(at.y) * std::size_t(picture.width) + std::size_t(at.x));
        int most = 0;
        for (unsigned c = 0; c < 3; ++c)
            most = std::max(most, std::abs(int(picture.pixels[i + c]) - int((color >> (8 * c)) & 255u)));
        return most;
    }
    bool has(ImVec2 at, ImU32 color, float around) const {
        const Picture seen = program.screen();
        for (float y = at.y - around; y <= at.y + around; ++y)
            for (float u = at.x - around; u <= at.x + around; ++u)
                if (off(seen, {u, y}, color) < 40) return true;
        return false;
    }

    Program program{kDocument};
    Area lower, strip;
    float row = 0, ruler = 0, zero = 0, perSecond = 1;
};

TEST_F(EndToEndTimeline, AKeyIsDraggedAndItsWayComesBack) {
    open();
    program.drag({key(1), key(2.5), key(2)});
    EXPECT_EQ(times(), (std::vector{0.0, 2.0, 2.5, 5.0})) << "the key that it passed over is back";
    EXPECT_TRUE(eventually([&] { return has(key(2), themeColor(ThemeColor::selected), 2); }));
    EXPECT_FALSE(has(key(1), themeColor(ThemeColor::text), 4));
    program.keys("Ctrl+Z");
    EXPECT_EQ(times(), (std::vector{0.0, 1.0, 2.5, 5.0}));

    // Onto another: it takes its place, and one step gives both back.
    program.drag({key(1), key(2), key(2.5)});
    EXPECT_EQ(times(), (std::vector{0.0, 2.5, 5.0}));
    EXPECT_EQ(timeline().tracks[0].keys[1].value[0], 1.2);
    program.keys("Ctrl+Z");
    EXPECT_EQ(times(), (std::vector{0.0, 1.0, 2.5, 5.0}));

    // Escape takes the drag back.
    const std::string before = program.save();
    program.drag({key(1), key(1.6), key(2)}, 1, "", false, false);
    program.waitFor("Key at 2 s");
    program.keys("Escape");
    program.release();
    EXPECT_EQ(program.save(), before);
}

TEST_F(EndToEndTimeline, SeveralKeysAreMovedScaledCopiedAndDeleted) {
    open();
    program.drag({{x(0.5), row + 8}, {x(1.5), row - 4}, {x(2.8), row - 8}});
    program.waitFor("2 keys", std::nullopt);
    program.drag({key(1), key(1.2), key(1.5)});
    EXPECT_EQ(times(), (std::vector{0.0, 1.5, 3.0, 5.0}));
    // The bar above the keys: its end scales about the other one.
    const float bar = row - 12;
    EXPECT_TRUE(eventually([&] { return has({x(1.5) - 3, bar}, themeColor(ThemeColor::selected), 1); }));
    program.drag({{x(3.0) + 3, bar}, {x(3.3) + 3, bar}, {x(4.5) + 3, bar}});
    EXPECT_EQ(times(), (std::vector{0.0, 1.5, 4.5, 5.0}));
    program.keys("Ctrl+Z", 2);
    EXPECT_EQ(times(), (std::vector{0.0, 1.0, 2.5, 5.0}));

    // Ctrl adds and takes away; what is copied is pasted at the time shown.
    program.click(key(1));
    program.click(key(2.5), 1, "ctrl");
    program.waitFor("2 keys");
    program.keys("Ctrl+C");
    program.click({x(3), ruler});
    program.keys("Ctrl+V");
    EXPECT_EQ(times(), (std::vector{0.0, 1.0, 2.5, 3.0, 4.5, 5.0}));
    program.keys("Delete");
    EXPECT_EQ(times(), (std::vector{0.0, 1.0, 2.5, 5.0}));
    program.keys("Ctrl+A");
    program.waitFor("6 keys");
    program.keys("Right");
    EXPECT_EQ(times()[0], 1.0 / 30.0);
    EXPECT_EQ(times(1)[1], 151.0 / 30.0);
}

TEST_F(EndToEndTimeline, ATangentIsTurned) {
    open();
    program.click(key(1));
    program.waitFor("Key at 1 s");
    program.clickOn("Curves", lower);
    // There is more room for them.
    const Area keysButton = program.waitFor("Keys");
    row = program.waitFor("ball · radius", Area{{0, keysButton.hi.y}, {200, 790}}).centre().y;
    // The key's mark is framed in the colour of what is active.
    ImVec2 at(x(1), 0);
    ASSERT_TRUE(eventually([&] {
        const Picture seen = program.screen();
        float first = 1e9f, last = 0;
        for (float y = row - 8; y < 785; ++y)
            for (float u = at.x - 6; u <= at.x; ++u)
                if (off(seen, {u, y}, themeColor(ThemeColor::active)) < 60)
                    first = std::min(first, y), last = std::max(last, y);
        at.y = 0.5f * (first + last);
        return last > first + 4 && last < first + 16;
    }));
    // The tangent's end is some way off, on the curve's side; it is turned downwards.
    const auto ending = [&](float to) {
        const Picture seen = program.screen();
        for (float angle = -1.5f; angle <= 1.5f; angle += 0.02f) {
            const ImVec2 end(at.x + to * 42.0f * std::cos(angle), at.y + 42.0f * std::sin(angle));
            if (end.y > row - 16 && end.y < 785 && off(seen, end, themeColor(ThemeColor::text)) < 30 &&
                off(seen, {end.x, end.y + 2}, themeColor(ThemeColor::text)) < 30)
                return std::optional(end);
        }
        return std::optional<ImVec2>();
    };
    const std::optional<ImVec2> end = ending(1.0f);
    ASSERT_TRUE(end);
    program.drag({*end, {at.x + 30, at.y + 10}, {at.x + 20, at.y + 40}});
    const auto slopes = [&] {
        const Key turned = timeline().tracks[0].keys.at(1);
        EXPECT_EQ(turned.in.size(), 1u);
        EXPECT_EQ(turned.out.size(), 1u);
        return std::pair(turned.in.empty() ? 0.0 : turned.in[0], turned.out.empty() ? 0.0 : turned.out[0]);
    };
    const auto [in, out] = slopes();
    EXPECT_LT(out, -0.1);
    EXPECT_EQ(in, out) << "both sides turn together";
    // The curve, which comes down to the key now, is drawn above it.
    EXPECT_TRUE(eventually([&] {
        const Picture seen = program.screen();
        for (float y = at.y - 120; y < at.y - 15; ++y)
            if (off(seen, {x(0.7), y}, themeColor(ThemeColor::text)) < 60) return true;
        return false;
    }));

    // With Alt one side by itself; undo takes each back.
    program.drag({{at.x + 42.0f * 0.447f, at.y + 42.0f * 0.894f}, {at.x + 30, at.y + 10}, {at.x + 40, at.y}},
                 1, "alt");
    EXPECT_NEAR(slopes().second, 0.0, 0.05 * std::abs(out));
    EXPECT_EQ(slopes().first, in);
    EXPECT_EQ(timeline().tracks[0].keys.at(1).tangents, Tangents::broken);
    program.waitFor("Broken");
    program.keys("Ctrl+Z", 2);
    EXPECT_TRUE(timeline().tracks[0].keys.at(1).out.empty());

    // The key itself goes up and along.
    program.drag({at, {at.x + 20, at.y + 5}, {x(1.5), at.y + 12}});
    const Key moved = timeline().tracks[0].keys.at(1);
    EXPECT_EQ(moved.time, 1.5);
    EXPECT_LT(moved.value[0], 1.15);
}

TEST_F(EndToEndTimeline, MarkersAndTheRange) {
    open();
    program.click({x(2), ruler});
    program.click({x(3.2), row + 40});  // the keyboard stays on the strip
    program.keys("M");
    const Area flag = program.waitFor("Marker 1", strip);
    Timeline now = timeline();
    ASSERT_EQ(now.markers.size(), 1u);
    EXPECT_EQ(now.markers[0].time, 2.0);
    program.doubleClick(flag.centre());
    program.type("door\n");
    program.waitFor("door", strip);
    program.drag({{x(2), flag.centre().y}, {x(2.5), flag.centre().y}, {x(3), flag.centre().y}});
    now = timeline();
    ASSERT_EQ(now.markers.size(), 1u);
    EXPECT_EQ(now.markers[0].name, "door");
    EXPECT_EQ(now.markers[0].time, 3.0);

    // Ctrl and a drag in the ruler: what is played over and over.
    program.drag({{x(1), ruler}, {x(2), ruler}, {x(4), ruler}}, 1, "ctrl");
    EXPECT_EQ(timeline().range, (TimeRange{1, 4}));
    EXPECT_TRUE(eventually([&] { return has({x(3.5), ruler - 12}, themeColor(ThemeColor::warning), 5); }));
    program.click({x(2), ruler}, 1, "ctrl");
    EXPECT_FALSE(timeline().range);
}

TEST_F(EndToEndTimeline, ANumberOnTheCanvasIsAKey) {
    program.set("ball", "radius", 0, "0.9");
    EXPECT_EQ(timeline().tracks[0].keys.at(0).value[0], 0.9);
    EXPECT_EQ(inputNumbers(*program.graph().node("ball"), "radius"), std::vector{0.8}) << "its own stays";
    const ImVec2 field = program.field("ball", "radius");
    program.drag({field, {field.x + 20, field.y}, {field.x + 60, field.y}});
    const double dragged = timeline().tracks[0].keys.at(0).value[0];
    EXPECT_GT(dragged, 1.0);
    program.keys("Ctrl+Z");
    EXPECT_EQ(timeline().tracks[0].keys.at(0).value[0], 0.9) << "a drag is one step";
    program.click(field, 3);
    program.clickOn("Remove animation");
    EXPECT_EQ(timeline().tracks.size(), 1u);
    EXPECT_EQ(inputNumbers(*program.graph().node("ball"), "radius"), std::vector{0.9});
    program.click(field, 3);
    program.clickOn("Insert key");
    EXPECT_EQ(timeline().tracks.size(), 2u);
}

TEST_F(EndToEndTimeline, TheCamerasTrackIsSeenWhereItIsNotFollowed) {
    const ImVec2 picture(1050, 200);
    EXPECT_FALSE(program.sees("The camera's track is not followed"));
    program.waitFor("triangles");
    program.drag({picture, {picture.x + 30, picture.y + 5}, {picture.x + 120, picture.y + 40}});
    program.waitFor("The camera's track is not followed");
    program.clickOn("Follow it");
    program.waitUntilGone("The camera's track is not followed");
    EXPECT_FALSE(program.sees("Reset view"));
}

}  // namespace fw::editor::test::end_to_end_timeline_test
