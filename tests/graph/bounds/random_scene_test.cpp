// The random scenes and the sampler that tests of the region search rely on: scenes use the whole node
// library that they should, and the sampler finds known bounds.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/graph/code_field.h"
#include "tests/support/graph/random_scene.h"
#include "tests/support/graph/solid_bounds.h"

namespace fw::random_scene_test {

using test::SolidBounds;

SolidBounds boundsOf(const std::string& code, std::vector<test::SceneAnchor> anchors) {
    const test::CodeField field = test::fieldOfCode(code);
    return test::sampleSolid(field.ir, field.distance, {}, anchors, std::nullopt);
}

/// The sampled box is within the true one, and at most `slack` smaller on each side.
void expectBounds(const std::string& code, std::vector<test::SceneAnchor> anchors, const Box& box,
                  double slack) {
    SCOPED_TRACE(code);
    const SolidBounds solid = boundsOf(code, std::move(anchors));
    ASSERT_TRUE(solid.found);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_GE(solid.box.lo[axis], box.lo[axis] - 1e-12);
        EXPECT_LE(solid.box.lo[axis], box.lo[axis] + slack);
        EXPECT_LE(solid.box.hi[axis], box.hi[axis] + 1e-12);
        EXPECT_GE(solid.box.hi[axis], box.hi[axis] - slack);
        EXPECT_TRUE(solid.reliable[axis]);
    }
}

TEST(SolidBounds, OfKnownSolids) {
    expectBounds("return box(p, vec3(1, 2, 3));", {{{}, 5.0}}, {{-1, -2, -3}, {1, 2, 3}}, 1e-6);
    expectBounds("return min(sphere(p, 1), sphere(p - vec3(5, 0, 0), 0.1));", {{{}, 1.2}, {{5, 0, 0}, 1.0}},
                 {{-1, -1, -1}, {5.1, 1, 1}}, 1e-6);
    const double r = std::sqrt(0.5);
    // The corner of a rotated box, and a thin shell.
    expectBounds("return box(vec3(p.x + p.z, p.y * sqrt(2.0), p.z - p.x) * sqrt(0.5), vec3(1, 0.5, 0.2));",
                 {{{}, 2.0}}, {{-1.2 * r, -0.5, -1.2 * r}, {1.2 * r, 0.5, 1.2 * r}}, 1e-3);
    expectBounds("return abs(sphere(p, 1)) - 0.002;", {{{}, 1.5}},
                 {{-1.002, -1.002, -1.002}, {1.002, 1.002, 1.002}}, 1e-4);
}

TEST(SolidBounds, OfNothing) { EXPECT_FALSE(boundsOf("return length(p) + 0.1;", {{{}, 1.0}}).found); }

TEST(SolidBounds, DisproveABoxThatIsTooSmall) {
    const Box box{{-1, -1, -1}, {1, 1, 1}};
    EXPECT_DOUBLE_EQ(test::distanceOutside(box, {0, 3, 1.5}), 2.0);
    EXPECT_DOUBLE_EQ(test::distanceOutside(box, {0, 0.75, 0}), -0.25);
}

TEST(RandomScene, IsTheSameForTheSameSeed) {
    EXPECT_EQ(test::randomScene(7).json, test::randomScene(7).json);
    EXPECT_NE(test::randomScene(7).json, test::randomScene(8).json);
    EXPECT_NE(test::randomScene(7).json, test::randomMovingScene(7).json);
    EXPECT_EQ(test::sceneNumber(-0.0304), "-0.0304");
    EXPECT_EQ(test::sceneNumber(1200.0), "1200");
    EXPECT_EQ(test::sceneNumber(0.0), "0");
}

TEST(RandomScene, UsesTheNodesOfEverydayScenes) {
    std::string all;
    for (uint32_t seed = 1; seed <= 1000; ++seed) all += test::randomScene(seed).json;
    for (const char* text : {"box",
                             "sphere",
                             "cylinder",
                             "torus",
                             "capsule",
                             "cone",
                             "capped_cone",
                             "round_cone",
                             "ellipsoid",
                             "octahedron",
                             "pyramid",
                             "prism",
                             "tetrahedron",
                             "dodecahedron",
                             "icosahedron",
                             "link",
                             "capped_torus",
                             "box_frame",
                             "box_max",
                             "cut_sphere",
                             "solid_angle",
                             "vesica",
                             "spring",
                             "extrude",
                             "revolve",
                             "loft",
                             "text",
                             "gear",
                             "star",
                             "polygon",
                             "regular_polygon",
                             "circle",
                             "rectangle",
                             "spline",
                             "helix",
                             "tube",
                             "sweep",
                             "expression",
                             "translate",
                             "rotate",
                             "transform",
                             "scale",
                             "stretch",
                             "mirror",
                             "repeat",
                             "polar_repeat",
                             "twist",
                             "bend",
                             "taper",
                             "elongate",
                             "warp",
                             "offset",
                             "shell",
                             "displace",
                             "noise",
                             "round_edges",
                             "true_distance",
                             "infinite_cylinder",
                             "plane",
                             "gyroid",
                             "union",
                             "subtract",
                             "intersect",
                             "xor",
                             "morph",
                             "round",
                             "chamfer",
                             "stairs",
                             "exact",
                             "groove",
                             "mm"})
        EXPECT_NE(all.find(": \"" + std::string(text) + "\""), std::string::npos) << text;
}

}  // namespace fw::random_scene_test
