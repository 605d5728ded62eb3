// Where times are on the screen, how they are written, what a hand snaps to, and how curves become lines.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "editor/panels/playback.h"
#include "editor/timeline/curves.h"
#include "editor/timeline/state.h"

namespace fw::editor::timeline_view_test {

TEST(TimeView, ZoomsToTheCursorAndPans) {
    TimeView view{.from = 0, .to = 10, .left = 100, .right = 1100};
    EXPECT_EQ(view.x(5), 600.0f);
    EXPECT_EQ(view.time(350), 2.5);
    const double under = view.time(350);
    view.zoom(3, 350);
    EXPECT_NEAR(view.time(350), under, 1e-9);
    EXPECT_LT(view.length(), 10.0);
    view.zoom(-3, 350);
    EXPECT_NEAR(view.from, 0.0, 1e-9);
    view.pan(-100);
    EXPECT_NEAR(view.from, 1.0, 1e-9);
    for (int i = 0; i < 200; ++i) view.zoom(5, 600);
    EXPECT_GT(view.length(), 0.0);
    for (int i = 0; i < 400; ++i) view.zoom(-5, 600);
    EXPECT_TRUE(std::isfinite(view.x(1.0)));
    view.show(2, 4);
    EXPECT_LT(view.from, 2.0);
    EXPECT_GT(view.to, 4.0);
    view.show(3, 3);
    EXPECT_GT(view.length(), 0.0);
}

TEST(ValueView, IsUpsideUp) {
    ValueView view{.lo = -1, .hi = 3, .top = 100, .bottom = 500};
    EXPECT_EQ(view.y(3), 100.0f);
    EXPECT_EQ(view.y(-1), 500.0f);
    EXPECT_EQ(view.value(300), 1.0);
    const double under = view.value(200);
    view.zoom(2, 200);
    EXPECT_NEAR(view.value(200), under, 1e-9);
    view.show(5, 5);
    EXPECT_GT(view.hi, view.lo);
}

TEST(TimeText, SaysFramesAsFrames) {
    EXPECT_EQ(timeText(175.0 / 30.0, 30, true), "175");
    EXPECT_EQ(timeText(175.0 / 30.0, 30, false), "5 s 25 f");
    EXPECT_EQ(timeText(5.0, 30, false), "5 s");
    EXPECT_EQ(timeText(0.0, 30, false), "0 s");
    EXPECT_EQ(timeText(0.5, 24, false), "12 f");
    EXPECT_EQ(timeText(0.01, 30, false), "0.01 s");
    EXPECT_EQ(timeText(0.01, 30, true), "0.30");
    EXPECT_EQ(timeText(1001.0 / 30000.0, 29.97002997, true), "1");
    EXPECT_EQ(frameAt(5.83333, 30), std::optional(175l));
    EXPECT_FALSE(frameAt(5.84, 30));
    EXPECT_EQ(nearestFrame(5.84, 30), 175.0 / 30.0);
    for (long frame = 0; frame < 5000; ++frame)  // whatever the rate, a frame is said without a fraction
        for (double rate : {24.0, 25.0, 30.0, 60.0})
            EXPECT_EQ(timeText(double(frame) / rate, rate, false).find('.'), std::string::npos);
}

TEST(RulerMarks, StandOnFramesAndSeconds) {
    for (double length : {0.2, 1.0, 4.0, 30.0, 600.0, 86400.0})
        for (double rate : {24.0, 30.0, 29.97})
            for (bool frames : {false, true}) {
                const TimeView view{.from = 0.3 * length, .to = 1.3 * length, .left = 0, .right = 1000};
                const std::vector<RulerMark> marks = rulerMarks(view, rate, frames, 60);
                ASSERT_FALSE(marks.empty()) << length << " " << rate;
                EXPECT_LT(marks.size(), 400u);
                float last = -1e9f;
                std::size_t labels = 0;
                for (const RulerMark& mark : marks) {
                    EXPECT_TRUE(frameAt(mark.time, rate)) << mark.time << " at " << rate;
                    EXPECT_GE(mark.time, view.from - 1e-9);
                    EXPECT_LE(mark.time, view.to + 1e-9);
                    if (mark.label.empty()) continue;
                    ++labels;
                    EXPECT_EQ(mark.label.find('.'), std::string::npos) << mark.label;
                    EXPECT_GE(view.x(mark.time) - last, 59.0f) << length << " " << rate;
                    last = view.x(mark.time);
                }
                EXPECT_GE(labels, length > 0.1 ? 1u : 0u) << length << " " << rate << " " << frames;
            }
    const TimeView view{.from = 0, .to = 2, .left = 0, .right = 1000};
    std::string all;
    for (const RulerMark& mark : rulerMarks(view, 30, false, 60))
        all += mark.label.empty() ? "" : mark.label + ", ";
    EXPECT_EQ(all, "0 s, 5 f, 10 f, 15 f, 20 f, 25 f, 1 s, 5 f, 10 f, 15 f, 20 f, 25 f, 2 s, ");
}

TEST(SnappedTime, GoesToMarkersThenToFrames) {
    EXPECT_EQ(snappedTime(1.02, 10, {}, 0.1, false), 1.0);
    EXPECT_EQ(snappedTime(1.02, 10, {1.07}, 0.1, false), 1.07);
    EXPECT_EQ(snappedTime(1.02, 10, {1.07, 1.03}, 0.1, false), 1.03) << "the nearer one";
    EXPECT_EQ(snappedTime(1.02, 10, {1.5}, 0.1, false), 1.0);
    EXPECT_EQ(snappedTime(1.02, 10, {1.03}, 0.1, true), 1.02) << "freely";
}

Track cubicTrack(int count, double apart) {
    Track track;
    track.name = "radius", track.node = "ball";
    for (int i = 0; i < count; ++i)
        track.keys.push_back(
            {.time = i * apart, .value = {std::sin(i * 1.7)}, .interpolation = Interpolation::cubic});
    return track;
}

TEST(CurvePoints, LieOnTheCurve) {
    const Track track = cubicTrack(6, 0.5);
    const TimeView times{.from = -0.5, .to = 3.5, .left = 0, .right = 800};
    const ValueView values{.lo = -2, .hi = 2, .top = 0, .bottom = 400};
    std::vector<ImVec2> points;
    curvePoints(track, 0, times, values, 1.0f, points);
    ASSERT_GT(points.size(), 20u);
    EXPECT_EQ(points.front().x, 0.0f);
    EXPECT_EQ(points.back().x, 800.0f);
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_NEAR(points[i].y, values.y(evaluate(track, times.time(points[i].x))[0]), 0.1f);
        EXPECT_GE(points[i].x, i > 0 ? points[i - 1].x : 0.0f);
    }
    // Between two points nothing is missed that could be seen.
    for (std::size_t i = 1; i < points.size(); ++i) {
        const float x = 0.5f * (points[i - 1].x + points[i].x);
        EXPECT_NEAR(0.5f * (points[i - 1].y + points[i].y), values.y(evaluate(track, times.time(x))[0]),
                    1.0f);
    }
}

TEST(CurvePoints, AreThoseThatAreSeen) {
    const Track track = cubicTrack(10000, 0.01);
    const ValueView values{.lo = -1, .hi = 1, .top = 0, .bottom = 400};
    const TimeView few{.from = 50, .to = 50.1, .left = 0, .right = 1000};
    std::vector<ImVec2> points;
    curvePoints(track, 0, few, values, 1.0f, points);
    EXPECT_LE(points.size(), 400u);
    EXPECT_GT(points.size(), 50u);
    const auto [first, last] = keysSeen(track, few);
    EXPECT_EQ(last - first, 10u);
    const std::size_t fine = points.size();
    curvePoints(track, 0, few, values, 8.0f, points);
    EXPECT_LT(points.size(), 0.7 * double(fine)) << "coarser where that is asked for";
}

TEST(KeysInBoxes, AreFound) {
    Timeline timeline;
    timeline.tracks = {cubicTrack(5, 1.0), cubicTrack(5, 0.5)};
    timeline.tracks[1].name = "height";
    EXPECT_EQ(keysInRows(timeline, 0, 0, 0.5, 3.5).size(), 3u);
    EXPECT_EQ(keysInRows(timeline, 0, 7, 0.9, 1.1).size(), 2u);
    EXPECT_EQ(keyNear(timeline.tracks[0], 2.04, 0.1), std::optional<std::size_t>(2));
    EXPECT_FALSE(keyNear(timeline.tracks[0], 2.5, 0.1));
    TimelineState state;
    EXPECT_EQ(keysInCurves(timeline, state, -1, 9, 0.4, 2).size(), 4u) << "sin 1.7 twice and sin 6.8 twice";
    state.hidden = {movedBy(timeline.tracks[1])};
    EXPECT_EQ(keysInCurves(timeline, state, -1, 9, 0.4, 2).size(), 2u);
    const auto range = valuesShown(timeline, state);
    ASSERT_TRUE(range);
    EXPECT_NEAR(range->second, std::sin(1.7), 1e-12);
}

TEST(NextTime, GoesEitherWay) {
    EXPECT_EQ(nextTime({3, 1, 2}, 1, 1), std::optional(2.0));
    EXPECT_EQ(nextTime({3, 1, 2}, 2.5, -1), std::optional(2.0));
    EXPECT_FALSE(nextTime({3, 1, 2}, 3, 1));
    EXPECT_FALSE(nextTime({}, 0, 1));
}

TEST(PlayedTime, RepeatsTheRange) {
    Timeline timeline;
    timeline.length = 10;
    EXPECT_EQ(playedTime(timeline, 12.0), 2.0);
    timeline.range = TimeRange{2, 5};
    EXPECT_EQ(playedTime(timeline, 1.0), 1.0) << "it gets there";
    EXPECT_EQ(playedTime(timeline, 4.0), 4.0);
    EXPECT_EQ(playedTime(timeline, 5.5), 2.5);
    EXPECT_EQ(playedTime(timeline, 9.0), 3.0);
    timeline.loop = Loop::once;
    EXPECT_EQ(playedTime(timeline, 9.0), 3.0) << "whatever the timeline does";
    timeline.range = TimeRange{8, 50};
    EXPECT_EQ(playedTime(timeline, 10.5), 8.5) << "it ends with the timeline";
    timeline.range = TimeRange{20, 30};
    EXPECT_EQ(playedTime(timeline, 12.0), 10.0) << "none of it is there";
}

}  // namespace fw::editor::timeline_view_test
