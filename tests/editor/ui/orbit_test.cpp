// Moving about in the viewport: what must stay under the mouse stays there.
#include "editor/viewport/orbit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "runtime/render/view.h"

namespace fw::editor::orbit_test {

Orbit somewhere() {
    Orbit orbit;
    orbit.target = {1.0, -2.0, 0.5};
    orbit.azimuth = 0.7, orbit.elevation = 0.4, orbit.distance = 6.0, orbit.fov = 40.0;
    return orbit;
}

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector minus(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

/// Where p is seen, from -1 to 1 along both sides of a picture with this aspect.
std::array<double, 2> seenAt(const Orbit& orbit, const Vector& p, double aspect) {
    const Axes axes = axesOf(orbit);
    const Vector v = minus(p, orbit.camera().position);
    const double along = -dot(v, axes.back), t = std::tan(orbit.fov * std::numbers::pi / 360.0);
    return {dot(v, axes.right) / (along * t * aspect), dot(v, axes.up) / (along * t)};
}

TEST(Orbit, AxesAreThoseOfTheCamera) {
    const Orbit orbit = somewhere();
    const Axes axes = axesOf(orbit);
    EXPECT_NEAR(dot(axes.right, axes.up), 0.0, 1e-12);
    EXPECT_NEAR(dot(axes.right, axes.back), 0.0, 1e-12);
    EXPECT_NEAR(dot(axes.up, axes.up), 1.0, 1e-12);
    const Vector away = minus(orbit.camera().position, orbit.target);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(away[i], orbit.distance * axes.back[i], 1e-12);
}

TEST(Orbit, ZoomKeepsWhatIsUnderTheCursor) {
    for (const double notches : {3.0, -5.0}) {
        Orbit orbit = somewhere();
        const double aspect = 1.5, x = 0.6, y = -0.3;
        const Axes axes = axesOf(orbit);
        const double half = orbit.distance * std::tan(orbit.fov * std::numbers::pi / 360.0);
        Vector p = orbit.target;
        for (std::size_t i = 0; i < 3; ++i) p[i] += half * (x * aspect * axes.right[i] + y * axes.up[i]);
        zoom(orbit, notches, x, y, aspect);
        EXPECT_EQ(orbit.distance<6.0, notches> 0.0);
        EXPECT_NEAR(seenAt(orbit, p, aspect)[0], x, 1e-9);
        EXPECT_NEAR(seenAt(orbit, p, aspect)[1], y, 1e-9);
    }
}

TEST(Orbit, PanMovesTheTargetWithTheMouse) {
    Orbit orbit = somewhere();
    const Vector before = orbit.target;
    pan(orbit, 0.25, 0.1);  // of the height, which is 2 of the places
    EXPECT_NEAR(seenAt(orbit, before, 1.0)[0], 0.5, 1e-9);
    EXPECT_NEAR(seenAt(orbit, before, 1.0)[1], 0.2, 1e-9);
}

TEST(Orbit, LookingAroundKeepsTheEye) {
    Orbit orbit = somewhere();
    const Triple eye = orbit.camera().position;
    look(orbit, 0.2, -0.1);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(orbit.camera().position[i], eye[i], 1e-12);
    EXPECT_NE(orbit.azimuth, somewhere().azimuth);
}

TEST(Orbit, TurningKeepsTheTargetAndStopsOverhead) {
    Orbit orbit = somewhere();
    turn(orbit, 0.0, -100.0);
    EXPECT_EQ(orbit.target, somewhere().target);
    EXPECT_LT(orbit.elevation, 0.5 * std::numbers::pi);
    EXPECT_NEAR(orbit.camera().position[1], orbit.target[1] + orbit.distance, 0.01);
}

TEST(Orbit, FlyingGoesAlongTheView) {
    Orbit orbit = somewhere();
    const Vector eye = orbit.camera().position, back = axesOf(orbit).back;
    fly(orbit, 1.0, 0.0, 0.0, 0.5, false);
    const Vector went = minus(orbit.camera().position, eye);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(went[i], -3.0 * back[i], 1e-12);
    Orbit fast = somewhere();
    fly(fast, 1.0, 0.0, 0.0, 0.5, true);
    EXPECT_NEAR(fast.target[1] - somewhere().target[1], 5.0 * (orbit.target[1] - somewhere().target[1]),
                1e-9);
}

TEST(Orbit, SidesAreWhereTheyAreCalled) {
    const struct {
        Side side;
        Vector back;
    } sides[] = {{Side::front, {0, 0, 1}}, {Side::back, {0, 0, -1}}, {Side::right, {1, 0, 0}},
                 {Side::left, {-1, 0, 0}}, {Side::top, {0, 1, 0}},   {Side::bottom, {0, -1, 0}}};
    for (const auto& [side, back] : sides) {
        Orbit orbit = somewhere();
        lookFrom(orbit, side);
        EXPECT_EQ(orbit.target, somewhere().target);
        for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(axesOf(orbit).back[i], back[i], 1e-12);
    }
}

TEST(Orbit, ThePictureIsTurnedAsTheAxesAre) {
    for (const Side side : {Side::front, Side::back, Side::right, Side::left, Side::top, Side::bottom}) {
        Orbit orbit = somewhere();
        lookFrom(orbit, side);
        const gpu::View view = cameraView(orbit.camera(), {}, 1.0f);
        const Axes axes = axesOf(orbit);
        const glm::vec3 right = glm::normalize(view.right), up = glm::normalize(view.up);
        for (int i = 0; i < 3; ++i) {
            EXPECT_NEAR(double(right[i]), axes.right[std::size_t(i)], 1e-5) << int(side);
            EXPECT_NEAR(double(up[i]), axes.up[std::size_t(i)], 1e-5) << int(side);
        }
    }
}

TEST(Orbit, WhatIsFramedTouchesTheNearerSides) {
    for (const double aspect : {0.5, 2.0}) {
        Orbit orbit = somewhere();
        frame(orbit, {3, 1, 2}, 2.0, aspect);
        EXPECT_EQ(orbit.target, (Vector{3, 1, 2}));
        const double half = std::atan(std::tan(20.0 * std::numbers::pi / 180.0) * std::min(aspect, 1.0));
        const double ball = std::asin(2.0 / orbit.distance);
        EXPECT_LT(ball, half);
        EXPECT_GT(ball, 0.85 * half);
    }
}

}  // namespace fw::editor::orbit_test
