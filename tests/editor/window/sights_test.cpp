// Which of a preview's pictures is drawn next, and which is told.
#include "editor/preview/sights.h"

#include <gtest/gtest.h>

namespace fw::editor::sights_test {

using std::chrono::milliseconds;

const Clock::time_point kStart{};

PreviewEye eyeAt(double distance, int width = 100) {
    Camera camera;
    camera.position = {0, 0, distance};
    return {camera, width, 80};
}

std::vector<Sight> threeSights() {
    std::vector<Sight> sights;
    EXPECT_TRUE(aimSights(sights, {eyeAt(1), eyeAt(2), eyeAt(3)}, kStart));
    return sights;
}

/// Draws what is next until all is done, at most so often: in which order.
std::vector<std::size_t> drawn(std::vector<Sight>& sights, std::size_t first, bool refines, int most) {
    std::vector<std::size_t> order;
    std::size_t turned = first;
    for (int i = 0; i < most; ++i) {
        const auto next = nextSight(sights, first, turned, refines);
        if (!next) break;
        Sight& sight = sights[*next];
        if (std::exchange(turned, *next) != *next) sight.refined = 0;
        takeDrawn(sight);
        if (sight.refined >= 3) takeRest(sight), sight.rests = true;
        order.push_back(*next);
    }
    return order;
}

TEST(Sights, TheOneWithTheHandIsDrawnFirstAndRefinedFirst) {
    std::vector<Sight> sights = threeSights();
    EXPECT_EQ(drawn(sights, 1, true, 50), (std::vector<std::size_t>{1, 0, 2, 1, 1, 1, 0, 0, 0, 2, 2, 2}))
        << "each to its end before the renderer turns to another";
    EXPECT_EQ(nextSight(sights, 1, 2, true), std::nullopt);
}

TEST(Sights, NothingIsRefinedUnderAHand) {
    std::vector<Sight> sights = threeSights();
    EXPECT_EQ(drawn(sights, 0, false, 50), (std::vector<std::size_t>{0, 1, 2}));
}

TEST(Sights, OnlyWhatLooksOtherwiseIsDue) {
    std::vector<Sight> sights = threeSights();
    drawn(sights, 0, true, 50);
    EXPECT_FALSE(aimSights(sights, {eyeAt(1), eyeAt(2), eyeAt(3)}, kStart));
    EXPECT_EQ(nextSight(sights, 2, 0, true), std::nullopt) << "the hand alone changes no picture";
    EXPECT_TRUE(aimSights(sights, {eyeAt(1), eyeAt(4), eyeAt(3)}, kStart));
    EXPECT_EQ(drawn(sights, 0, false, 50), (std::vector<std::size_t>{1}));
    EXPECT_TRUE(aimSights(sights, {eyeAt(1), eyeAt(4), eyeAt(3, 50)}, kStart)) << "another size";
    EXPECT_TRUE(sights[2].due);
    EXPECT_TRUE(aimSights(sights, {eyeAt(1), {}}, kStart));
    EXPECT_EQ(nextSight(sights, 1, 0, true), std::nullopt) << "no picture is wanted of that";
}

TEST(Sights, OneThatWaitsForLongIsDrawnUnderAHandToo) {
    std::vector<Sight> sights = threeSights();
    drawn(sights, 0, false, 50);
    const auto at = [](int ms) { return kStart + milliseconds(ms); };
    for (int ms = 0; ms <= 200; ms += 50) {
        for (Sight& sight : sights) sight.outdate(at(ms));
        EXPECT_EQ(nextSight(sights, 0, 0, false), 0u) << "the one under the hand goes before the others";
        takeDrawn(sights[0]);
    }
    EXPECT_EQ(staleSight(sights, 0, at(200)), std::nullopt);
    const auto stale = staleSight(sights, 0, at(300));
    ASSERT_TRUE(stale);
    takeDrawn(sights[*stale]);
    EXPECT_EQ(staleSight(sights, 0, at(300)), 3 - *stale) << "the other one then";
    // What is drawn and due again waits anew.
    sights[*stale].outdate(at(300));
    takeDrawn(sights[3 - *stale]);
    EXPECT_EQ(staleSight(sights, 0, at(400)), std::nullopt);
}

TEST(Sights, WhatIsToldIsNeverWorseThanBefore) {
    std::vector<Sight> sights = threeSights();
    Sight& sight = sights[0];
    EXPECT_TRUE(takeDrawn(sight)) << "a fresh one";
    EXPECT_TRUE(takeDrawn(sight));
    EXPECT_FALSE(takeDrawn(sight)) << "of three";
    EXPECT_TRUE(takeDrawn(sight));
    const auto best = sight.told;
    sight.refined = 0;  // the renderer was turned to another
    for (int i = 1; i <= 7; ++i) EXPECT_FALSE(takeDrawn(sight)) << i;
    EXPECT_EQ(sight.told, best);
    EXPECT_TRUE(takeRest(sight)) << "of seven, and no more will come";
    EXPECT_NE(sight.told, best);
    EXPECT_FALSE(takeRest(sight));
}

TEST(Sights, AnEditThatChangesNothingSeenDrawsNothing) {
    std::vector<Sight> sights = threeSights();
    Sight& sight = sights[0];
    const SightOf of{.content = 7, .width = 100, .height = 80};
    EXPECT_FALSE(isDrawnOf(sight, of)) << "there is no picture yet";
    takeDrawn(sight), takeDrawn(sight);
    sight.of = of, sight.rests = true;
    sight.outdate(kStart);
    EXPECT_TRUE(isDrawnOf(sight, of));
    EXPECT_TRUE(!sight.due && sight.rests && sight.best == 2);
    sight.outdate(kStart);
    SightOf other = of;
    other.content = 8;
    EXPECT_FALSE(isDrawnOf(sight, other));
    EXPECT_TRUE(sight.due && !sight.rests && sight.refined == 0 && sight.best == 0);
}

TEST(Sights, ASketchIsTheFirstToBecomeAPicture) {
    std::vector<Sight> sights = threeSights();
    drawn(sights, 0, true, 50);
    for (Sight& sight : sights) sight.outdate(kStart);
    takeDrawn(sights[0]);
    takeSketch(sights[1]), takeSketch(sights[2]);
    EXPECT_TRUE(sights[1].told && sights[1].rough && !sights[1].due);
    EXPECT_EQ(nextSight(sights, 0, 0, false), std::nullopt) << "not while a hand moves";
    sights[0].rests = false;
    EXPECT_EQ(nextSight(sights, 0, 0, true, false), 0u) << "a newer wish may come any time";
    EXPECT_EQ(nextSight(sights, 0, 0, true), 1u) << "before the first is refined";
    EXPECT_TRUE(takeDrawn(sights[1])) << "it is told though it is but one";
    EXPECT_EQ(nextSight(sights, 0, 1, true), 2u);
    takeDrawn(sights[2]);
    EXPECT_FALSE(sights[2].rough);
}

TEST(Sights, WhatTheRendererIsAtTheEndOfIsToldAgainOrForAnotherEye) {
    std::vector<Sight> sights = threeSights();
    const SightOf of{.content = 7, .width = 1, .height = 1};
    sights[0].picture.pixels = {1, 2, 3, 4};
    sights[0].of = of;
    takeDrawn(sights[0]);
    sights[0].forget(kStart);  // another document, of which there is no picture, and back
    EXPECT_TRUE(!sights[0].told && sights[0].due);
    EXPECT_FALSE(isDrawnOf(sights[0], of));
    EXPECT_TRUE(takeSame(sights[0], sights, of));
    ASSERT_TRUE(sights[0].told);
    EXPECT_EQ(sights[0].told->pixels, sights[0].picture.pixels);
    EXPECT_FALSE(takeSame(sights[0], sights, of)) << "that is told";
    EXPECT_TRUE(takeSame(sights[1], sights, of)) << "the same view in another of the pictures";
    ASSERT_TRUE(sights[1].told);
    EXPECT_EQ(sights[1].told->pixels, sights[0].picture.pixels);
    EXPECT_TRUE(!sights[1].due && sights[1].rests);
}

}  // namespace fw::editor::sights_test
