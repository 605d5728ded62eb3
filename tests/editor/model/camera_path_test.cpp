// The way of the scene's camera, as the viewport draws it.
#include "editor/viewport/camera_path.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "tests/support/editor/graphs.h"

namespace fw::editor::camera_path_test {

Graph read(const std::string& tracks) {
    return editor::test::graphOf(
        R"({"id": "ball", "type": "sphere"}, {"id": "out", "type": "output", "inputs": {"surface": {"from": "ball"}}})",
        R"(, "scene": {"camera": {"position": [4, 3, 5], "target": [0, 1, 0], "fov": 40}},
            "timeline": {"length": 4, "tracks": [)" +
            tracks + "]}");
}

std::optional<CameraPath> pathOf(const std::string& tracks, double seconds) {
    const Graph graph = read(tracks);
    return cameraPathOf(graph, *readTimeline(graph), seconds);
}

TEST(CameraPath, LeadsThroughItsKeys) {
    const auto path = pathOf(R"({"scene": "camera.position", "keys": [
        {"time": 0, "value": [0, 0, 8]}, {"time": 1, "value": [8, 0, 0]}, {"time": 4, "value": [8, 6, 0]}]})",
                             2.5);
    ASSERT_TRUE(path);
    EXPECT_EQ(path->keys, (std::vector<glm::dvec3>{{0, 0, 8}, {8, 0, 0}, {8, 6, 0}}));
    EXPECT_EQ(path->line.front(), glm::dvec3(0, 0, 8));
    EXPECT_EQ(path->line.back(), glm::dvec3(8, 6, 0));
    EXPECT_EQ(path->now.position, (Triple{8, 3, 0}));
    EXPECT_EQ(path->now.target, (Triple{0, 1, 0}));
    EXPECT_EQ(path->now.fov, 40.0);
    double longest = 0.0;
    for (std::size_t i = 1; i < path->line.size(); ++i)
        longest = std::max(longest, glm::distance(path->line[i - 1], path->line[i]));
    EXPECT_LT(longest, 0.5);
}

TEST(CameraPath, IsOfComponentsToo) {
    const auto path = pathOf(
        R"({"scene": "camera.position.y", "keys": [{"time": 0, "value": 1}, {"time": 4, "value": 9}]})", 4.0);
    ASSERT_TRUE(path);
    EXPECT_EQ(path->line.front(), glm::dvec3(4, 1, 5));
    EXPECT_EQ(path->line.back(), glm::dvec3(4, 9, 5));
}

TEST(CameraPath, OfATargetAloneHasNoLine) {
    const auto path = pathOf(R"({"scene": "camera.target", "keys": [{"time": 0, "value": [1, 0, 0]}]})", 0.0);
    ASSERT_TRUE(path);
    EXPECT_TRUE(path->line.empty());
    EXPECT_EQ(path->now.target, (Triple{1, 0, 0}));
}

TEST(CameraPath, IsThereOnlyIfTheCameraMoves) {
    EXPECT_FALSE(pathOf("", 0.0));
    EXPECT_FALSE(pathOf(R"({"scene": "camera.fov", "keys": [{"time": 0, "value": 30}]})", 0.0));
    EXPECT_FALSE(pathOf(R"({"node": "ball", "input": "radius", "keys": [{"time": 0, "value": 2}]})", 0.0));
}

TEST(CameraPath, AFrustumIsWhatThePictureShows) {
    const Camera camera{.position = {0, 0, 10}, .target = {0, 0, 0}, .fov = 90};
    const std::vector<glm::dvec3> frustum = frustumOf(camera, 2.0, 3.0);
    ASSERT_EQ(frustum.size(), 5u);
    const std::vector<glm::dvec3> wanted = {{0, 0, 10}, {-6, -3, 7}, {6, -3, 7}, {6, 3, 7}, {-6, 3, 7}};
    for (std::size_t i = 0; i < 5; ++i) EXPECT_LT(glm::distance(frustum[i], wanted[i]), 1e-4) << i;
}

}  // namespace fw::editor::camera_path_test
