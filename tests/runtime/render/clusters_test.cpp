// What a pass draws of a mesh: all that can be seen, and little that cannot.
#include "runtime/render/clusters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>

#include "graph/document/json.h"
#include "runtime/play/session.h"
#include "runtime/render/view.h"
#include "tests/support/gpu.h"

namespace fw::clusters_test {

using Triangle = std::array<uint32_t, 3>;

struct Culled {
    std::vector<gpu::MeshVertex> vertices;
    std::vector<Triangle> all, drawn;

    /// Whether a triangle may be seen: none of its sides of the picture has it wholly outside, and it faces
    /// the eye.
    bool visible(const Triangle& triangle, const glm::mat4& clip, const glm::vec4& eye, bool backs) const {
        glm::vec3 p[3];
        int outside[4] = {};
        for (int i = 0; i < 3; ++i) {
            p[i] = vertices[triangle[std::size_t(i)]].position;
            const glm::vec4 at = clip * glm::vec4(p[i], 1);
            outside[0] += at.x<-at.w, outside[1] += at.x> at.w;
            outside[2] += at.y<-at.w, outside[3] += at.y> at.w;
        }
        if (std::count(outside, outside + 4, 3) > 0) return false;
        const glm::vec3 ray = eye.w != 0.0f ? p[0] - glm::vec3(eye) : glm::vec3(eye);
        return backs || glm::dot(glm::cross(p[1] - p[0], p[2] - p[0]), ray) < 0.0f;
    }
};

Culled cullOf(const std::string& code, int resolution, const glm::mat4& clip, const glm::vec4& eye,
              bool backs) {
    const Result<Graph> graph = parseGraph(R"({"fieldwright": 1, "nodes": [
        {"id": "scene", "type": "expression", "code": ")" +
                                               code + R"("},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "scene"}}}]})",
                                           "scene", nullptr);
    Result<Device> created = createDevice({.validation = true});
    Session session(std::move(*created));
    session.setProgram(*compile(*graph));
    const MesherResult mesh = *session.polygonise({{}, resolution});
    const Device& device = session.device();
    Clusters clusters = createClusters(device);
    Commands commands(device);
    boundClusters(commands, clusters, session.meshBuffers(), mesh.triangles, 1);
    cullClusters(commands, clusters, session.meshBuffers(), clip, eye, backs);
    submit(commands);
    Culled culled;
    culled.vertices = download<gpu::MeshVertex>(device, session.meshBuffers().vertices, mesh.vertices);
    culled.all = download<Triangle>(device, session.meshBuffers().triangles, mesh.triangles);
    const auto counts = download<gpu::ClusterCounts>(device, clusters.counts, 1);
    culled.drawn = download<Triangle>(device, clusters.indices, counts[0].draw[0] / 3);
    EXPECT_EQ(device.validationMessages(), std::vector<std::string>());
    return culled;
}

/// Everything visible is drawn; at most `most` of all triangles are.
void expectSeen(Culled culled, const glm::mat4& clip, const glm::vec4& eye, bool backs, double most) {
    std::sort(culled.drawn.begin(), culled.drawn.end());
    std::size_t visible = 0;
    for (const Triangle& triangle : culled.all) {
        if (!culled.visible(triangle, clip, eye, backs)) continue;
        ++visible;
        ASSERT_TRUE(std::binary_search(culled.drawn.begin(), culled.drawn.end(), triangle));
    }
    EXPECT_GT(visible, 0u);
    const double part = double(culled.drawn.size()) / double(culled.all.size());
    std::printf("%.1f %% of the triangles are visible, %.1f %% are drawn\n",
                100.0 * double(visible) / double(culled.all.size()), 100.0 * part);
    EXPECT_LE(part, most);
}

TEST(Clusters, OfABallHalfIsDrawn) {
    const glm::vec3 eye(0, 0, 9);
    const glm::mat4 clip = toClip(lookFrom(eye, glm::vec3(0), 0.5f, 1.0f));
    expectSeen(cullOf("return length(p) - 1.0;", 128, clip, glm::vec4(eye, 1), false), clip,
               glm::vec4(eye, 1), false, 0.65);
}

TEST(Clusters, BesideThePictureNothingIsDrawn) {
    const glm::vec3 eye(0, 0, 9);
    const glm::mat4 clip = toClip(lookFrom(eye, glm::vec3(1.0f, 0.4f, 0), 0.08f, 1.0f));
    expectSeen(cullOf("return length(p) - 1.0;", 128, clip, glm::vec4(eye, 1), true), clip, glm::vec4(eye, 1),
               true, 0.25);
}

TEST(Clusters, TheTowerFromOutsideAndAlongTheSun) {
    const char* tower =
        "d = box(pos, vec3(1, 2, 1)); c = abs(mod(pos, 0.5) - 0.25) - 0.15; "
        "d = max(d, -min(max(c.x, c.y), max(c.y, c.z), max(c.x, c.z))); return d;";
    const glm::vec3 eye(4, 3, 5), sun = glm::normalize(glm::vec3(-1, -2, 0.5));
    const glm::mat4 clip = toClip(lookFrom(eye, glm::vec3(0), 0.6f, 1.5f));
    expectSeen(cullOf(tower, 96, clip, glm::vec4(eye, 1), false), clip, glm::vec4(eye, 1), false, 0.995);
    expectSeen(cullOf(tower, 96, glm::mat4(0.1f), glm::vec4(sun, 0), false), glm::mat4(0.1f),
               glm::vec4(sun, 0), false, 0.6);
}

}  // namespace fw::clusters_test
