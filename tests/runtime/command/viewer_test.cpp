// What keys and the mouse do to time and camera, without a window; and what is drawn over the picture.
#include "runtime/window/viewer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "runtime/window/overlay.h"

namespace fw::viewer_test {

Viewer viewerOf(int width, int height) {
    Viewer viewer;
    viewer.length = 4.0;
    viewer.framesPerSecond = 10.0;
    viewer.seen = {.position = {0, 0, 10}, .target = {0, 0, 0}, .fov = 40};
    viewer.resize(width, height);
    return viewer;
}

TEST(Viewer, TimeRunsUnlessPausedOrStill) {
    Viewer viewer = viewerOf(800, 600);
    viewer.pass(0.5);
    EXPECT_EQ(viewer.seconds, 0.5);
    viewer.key(ViewerKey::pause);
    viewer.pass(0.5);
    EXPECT_EQ(viewer.seconds, 0.5);
    viewer.key(ViewerKey::pause);
    viewer.pass(5.0);
    EXPECT_EQ(viewer.seconds, 5.5);
    EXPECT_EQ(viewer.shownTime(), 1.5);
    viewer.moves = false;
    viewer.dirty = false;
    viewer.pass(1.0);
    EXPECT_EQ(viewer.seconds, 5.5);
    EXPECT_FALSE(viewer.dirty);
}

TEST(Viewer, StepsByFramesAndJumpsToTheEnds) {
    Viewer viewer = viewerOf(800, 600);
    viewer.seconds = 0.52;
    viewer.key(ViewerKey::forward);
    EXPECT_TRUE(viewer.paused);
    EXPECT_DOUBLE_EQ(viewer.seconds, 0.6);
    viewer.key(ViewerKey::back);
    viewer.key(ViewerKey::back);
    EXPECT_DOUBLE_EQ(viewer.seconds, 0.4);
    viewer.key(ViewerKey::start);
    viewer.key(ViewerKey::back);
    EXPECT_EQ(viewer.seconds, 0.0);
    viewer.key(ViewerKey::end);
    EXPECT_EQ(viewer.seconds, 4.0);
}

TEST(Viewer, TheBarScrubs) {
    Viewer viewer = viewerOf(800, 600);
    viewer.move(400, 590);
    viewer.press(MouseButton::left);
    EXPECT_DOUBLE_EQ(viewer.seconds, 2.0);
    EXPECT_TRUE(viewer.paused);
    viewer.move(200, 300);  // the mouse may leave the bar
    EXPECT_DOUBLE_EQ(viewer.seconds, 1.0);
    viewer.move(-50, 590);
    EXPECT_EQ(viewer.seconds, 0.0);
    viewer.move(9999, 590);
    EXPECT_DOUBLE_EQ(viewer.seconds, 3.9);  // the last frame: the end of a loop is its beginning
    viewer.release(MouseButton::left);
    viewer.move(100, 590);
    EXPECT_DOUBLE_EQ(viewer.seconds, 3.9);
    EXPECT_FALSE(viewer.ownCamera);
}

TEST(Viewer, OrbitKeepsTheDistanceAndNeverTurnsOver) {
    Viewer viewer = viewerOf(800, 600);
    viewer.move(100, 100);
    viewer.press(MouseButton::left);
    for (int i = 1; i < 200; ++i) {
        viewer.move(100 + 37 * i, 100 + 91 * i);
        const Camera camera = viewer.orbit.camera();
        EXPECT_NEAR(std::hypot(camera.position[0], camera.position[1], camera.position[2]), 10.0, 1e-9);
        EXPECT_GT(std::hypot(camera.position[0], camera.position[2]), 0.1);
        EXPECT_EQ(camera.target, (std::array<double, 3>{}));
        EXPECT_EQ(camera.fov, 40.0);
    }
    EXPECT_TRUE(viewer.ownCamera);
    viewer.key(ViewerKey::resetCamera);
    EXPECT_FALSE(viewer.ownCamera);
}

TEST(Viewer, DraggingMovesWhatIsUnderTheMouseAlong) {
    Viewer viewer = viewerOf(800, 600);
    viewer.move(400, 300);
    viewer.press(MouseButton::right);
    viewer.move(400, 600);  // half the height: the view's lower edge, 10 m away
    const double half = 10.0 * std::tan(20.0 * 3.14159265358979 / 180.0);
    EXPECT_NEAR(viewer.orbit.target[1], half, 1e-9);
    viewer.move(100, 600);
    EXPECT_NEAR(viewer.orbit.target[0], half, 1e-9);
    EXPECT_NEAR(viewer.orbit.target[2], 0.0, 1e-9);
    viewer.scroll(3);
    EXPECT_LT(viewer.orbit.distance, 7.0);
    for (int i = 0; i < 1000; ++i) viewer.scroll(-5);
    EXPECT_TRUE(std::isfinite(viewer.orbit.camera().position[2]));
}

TEST(Viewer, AnOrbitIsTheCameraItCameFrom) {
    const Camera camera{.position = {3, 4, -2}, .target = {1, -1, 0.5}, .fov = 33};
    const Camera again = Orbit::from(camera).camera();
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(again.position[i], camera.position[i], 1e-12);
    EXPECT_EQ(again.target, camera.target);
}

TEST(Viewer, EscapeLeavesFullScreenFirst) {
    Viewer viewer = viewerOf(800, 600);
    viewer.key(ViewerKey::fullScreen);
    viewer.key(ViewerKey::leave);
    EXPECT_FALSE(viewer.fullScreen || viewer.closed);
    viewer.key(ViewerKey::leave);
    EXPECT_TRUE(viewer.closed);
}

TEST(Viewer, AWindowWithoutAreaIsSafe) {
    for (const auto& [width, height] : {std::pair{0, 0}, {1, 1}, {1, 4000}}) {
        Viewer viewer = viewerOf(width, height);
        viewer.move(0, 0);
        viewer.press(MouseButton::left);
        viewer.move(5, 5);
        viewer.release(MouseButton::left);
        viewer.move(0, 0);
        viewer.press(MouseButton::right);
        viewer.move(-5, 5);
        viewer.scroll(1);
        for (const double x : viewer.orbit.camera().position) EXPECT_TRUE(std::isfinite(x));
        EXPECT_TRUE(std::isfinite(viewer.seconds));
    }
}

Picture grey(int width, int height) {
    return {width, height, std::vector<uint8_t>(4 * std::size_t(width) * std::size_t(height), 128)};
}

TEST(Overlay, FitsEverySizeAndShowsWhatItShould) {
    for (const auto& [width, height] : {std::pair{1, 1}, {16, 16}, {800, 600}, {2000, 20}}) {
        Viewer viewer = viewerOf(width, height);
        viewer.help = true;
        Picture picture = grey(width, height);
        drawOverlay(picture, viewer, std::string(5000, 'x'));
        EXPECT_EQ(picture.pixels.size(), 4 * std::size_t(width) * std::size_t(height));
    }
    Viewer viewer = viewerOf(800, 600);
    viewer.seconds = 3.0;
    Picture plain = grey(800, 600), bare = grey(800, 600), helped = grey(800, 600);
    viewer.moves = false;
    drawOverlay(bare, viewer, "");
    EXPECT_EQ(bare.pixels, plain.pixels);
    viewer.help = true;
    drawOverlay(helped, viewer, "");
    EXPECT_NE(helped.pixels, plain.pixels);
    viewer.help = false, viewer.moves = true;
    drawOverlay(bare, viewer, "");
    const auto red = [&](int x) { return bare.pixels[4 * (586 * 800 + std::size_t(x))]; };
    EXPECT_GT(red(600), 200);  // the mark at three quarters, the played part, and the rest
    EXPECT_GT(red(100), 200);
    EXPECT_LT(red(790), 160);
}

TEST(Overlay, OverNothingItMayBeLaidOverAnything) {
    Viewer viewer = viewerOf(800, 600);
    viewer.help = true;
    Picture at = grey(800, 600), alone{800, 600, std::vector<uint8_t>(4 * 800 * 600)};
    const Picture below = at;
    drawOverlay(at, viewer, "a message");
    drawOverlay(alone, viewer, "a message");
    for (std::size_t i = 0; i < at.pixels.size(); i += 4)
        for (std::size_t c = 0; c < 3; ++c) {
            const double part = alone.pixels[i + 3] / 255.0;
            ASSERT_NEAR(at.pixels[i + c], alone.pixels[i + c] + (1.0 - part) * below.pixels[i + c], 2.0);
        }
}

}  // namespace fw::viewer_test
