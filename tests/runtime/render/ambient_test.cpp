// Ambient occlusion against closed forms: what rests converges to them, what moves stays near.
//
// Receivers are points of the floor y = 0, seen from above by a camera that the test computes depth and
// normals for. The closed forms are those of cosine-weighted occlusion: form factors of discs, segments of
// the unit disc (Nusselt).
#include "runtime/render/ambient.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <numbers>

#include "graph/compile/compile.h"
#include "graph/document/json.h"
#include "graph/emit/glsl.h"
#include "tests/support/gpu.h"

namespace fw::ambient_test {

constexpr uint32_t kWidth = 96, kHeight = 80;
constexpr VkExtent3D kExtent = {kWidth, kHeight, 1};
constexpr uint32_t kUpwards = 32767u << 16;  // +y, octahedral
constexpr uint32_t kRough = 0xffu << 24;     // no ground

std::string fieldOf(const std::string& code) {
    const Result<Graph> graph = parseGraph(R"({"fieldwright": 1, "nodes": [
        {"id": "scene", "type": "expression", "code": ")" +
                                               code + R"("},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "scene"}}}]})",
                                           "scene", nullptr);
    if (!graph) throw SystemError(format(graph.error()));
    const Result<Program> program = compile(*graph);
    if (!program) throw SystemError(format(program.error()));
    return emitField(*program);
}

/// From above, turned about the y axis by an angle in degrees.
gpu::View viewFrom(float degrees, float height = 3.0f) {
    const float a = glm::radians(degrees);
    const glm::vec3 eye(1.5f * std::sin(a), height, 1.5f * std::cos(a));
    return lookFrom(eye, glm::vec3(0), glm::radians(45.0f), float(kWidth) / kHeight, 0.1f);
}

/// Along this ray of a pixel one is a metre farther along the view's axis.
glm::vec3 rayOf(const gpu::View& view, uint32_t x, uint32_t y) {
    const glm::vec2 place = (glm::vec2(x, y) + 0.5f) / glm::vec2(kWidth, kHeight) * 2.0f - 1.0f;
    return view.forward + place.x * view.right - place.y * view.up;
}

/// The G-buffer of the floor where `seen` holds; a picture of its ambient occlusion.
class Floor {
  public:
    Floor(
        const std::string& code, const AmbientOptions& options,
        std::function<bool(glm::vec3)> seenWhere = [](glm::vec3) { return true; })
        : ambient(createAmbient(device, fieldOf(code), options)),
          gbuffer(createGBuffer(device, {})),
          depth(createImage(device, {.extent = kExtent, .format = VK_FORMAT_R32_SFLOAT})),
          block(createBuffer(device, sizeof(gpu::RenderFrame), Memory::upload)),
          seen(std::move(seenWhere)) {
        Commands commands(device);
        imageBarrier(commands, depth, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
        resizeGBuffer(commands, gbuffer, kExtent);
        submit(commands);
    }

    void draw(const gpu::View& view) {
        std::vector<float> depths(kWidth * kHeight, 0.0f);
        std::vector<glm::uvec4> surfaces(kWidth * kHeight, glm::uvec4(0));
        points.assign(kWidth * kHeight, glm::vec3(0));
        for (uint32_t i = 0; i < depths.size(); ++i) {
            const glm::vec3 ray = rayOf(view, i % kWidth, i / kWidth);
            const float along = (level - view.eye.y) / ray.y;
            points[i] = view.eye + ray * along;
            if (!seen(points[i])) continue;
            depths[i] = view.near / along;
            surfaces[i] = {std::bit_cast<uint32_t>(depths[i]), kUpwards, 0, kRough};
        }
        const Buffer depthBytes = createBuffer(device, 4 * depths.size(), Memory::upload);
        const Buffer surfaceBytes = createBuffer(device, 16 * depths.size(), Memory::upload);
        upload(device, depthBytes, depths);
        upload(device, surfaceBytes, surfaces);
        gpu::RenderFrame frame{};
        frame.now = view;
        frame.before = before.value_or(view);
        frame.size = {kWidth, kHeight};
        frame.tiles = tilesOf(kExtent);
        frame.number = number++;
        frame.resting = before && std::memcmp(&*before, &view, sizeof view) == 0 && ambient.hasHistory;
        frame.lo = glm::vec3(-1e9f);
        frame.hi = glm::vec3(1e9f);
        frame.stepScale = 1.0f;
        frame.ground = -1e30f;
        describeAmbient(ambient, frame);
        upload(device, block, std::vector{frame});
        before = view;
        gbuffer.current = 1 - gbuffer.current;
        Commands commands(device);
        copy(commands, depthBytes, depth, true);
        copy(commands, surfaceBytes, gbuffer.now(), true);
        barrier(commands);
        listTiles(commands, gbuffer, depth, block);
        drawAmbient(commands, ambient, gbuffer, frame, block, live);
        submit(commands);
    }

    void rest(const gpu::View& view) {
        for (int i = 0; i < 2000 && !converged(ambient); ++i) draw(view);
        ASSERT_TRUE(converged(ambient));
    }

    std::vector<float> openness() {
        std::vector<float> result;
        for (const uint32_t word : history()) result.push_back(float(word & 0xffff) / 65535.0f);
        return result;
    }
    /// Share of the pixels that are known by more than these rays.
    double knownBy(uint32_t rays) {
        const std::vector<uint32_t> words = history();
        return double(std::ranges::count_if(words, [&](uint32_t word) { return word >> 16 > rays; })) /
               double(words.size());
    }
    std::vector<uint32_t> history() {
        const Buffer bytes = createBuffer(device, 4ull * kWidth * kHeight, Memory::readback);
        Commands commands(device);
        copy(commands, bytes, ambient.now(), false);
        barrier(commands);
        submit(commands);
        return download<uint32_t>(device, bytes, kWidth * kHeight);
    }

    /// Mean and greatest difference from a closed form of the openness.
    void expectNear(const std::function<double(glm::vec3)>& expected, double mean, double most,
                    const char* what) {
        const std::vector<float> found = openness();
        double sum = 0, greatest = 0;
        int count = 0;
        for (std::size_t i = 0; i < found.size(); ++i) {
            if (!seen(points[i])) continue;
            const double difference = std::abs(found[i] - expected(points[i]));
            sum += difference, greatest = std::max(greatest, difference), ++count;
        }
        ASSERT_GT(count, 500);
        std::printf("%s: mean difference %.4f, greatest %.4f over %d pixels\n", what, sum / count, greatest,
                    count);
        EXPECT_LE(sum / count, mean) << what;
        EXPECT_LE(greatest, most) << what;
    }

    Device& device = test::device();
    Ambient ambient;
    GBuffer gbuffer;
    Image depth;
    Buffer block;
    std::function<bool(glm::vec3)> seen;
    std::vector<glm::vec3> points;
    std::optional<gpu::View> before;
    uint32_t number = 0;  ///< of the frame
    float level = 0;      ///< y of the floor
    FieldBuffers live;    ///< its parameters

  private:
    void copy(Commands& commands, const Buffer& buffer, const Image& image, bool toImage) {
        VkBufferImageCopy region{};
        region.imageSubresource = {image.aspect, 0, 0, 1};
        region.imageExtent = image.extent;
        const VkImageLayout layout =
            toImage ? VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL : VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
        imageBarrier(commands, image, VK_IMAGE_LAYOUT_GENERAL, layout);
        if (toImage)
            vkCmdCopyBufferToImage(commands.handle, buffer.handle, image.handle, layout, 1, &region);
        else
            vkCmdCopyImageToBuffer(commands.handle, image.handle, layout, buffer.handle, 1, &region);
        imageBarrier(commands, image, layout, VK_IMAGE_LAYOUT_GENERAL);
    }
};

const AmbientOptions kLong{.radius = 20.0f, .bias = 0.002f, .samples = 19};

TEST(Ambient, AnEmptyFloorIsOpen) {
    Floor floor("return p.y;", {.bias = 0.002f});
    floor.rest(viewFrom(0));
    floor.expectNear([](glm::vec3) { return 1.0; }, 0.0, 0.0, "floor");
}

TEST(Ambient, BesideAWallTheShortRaysSeeASegment) {
    // A wall at x = 0 fills x < 0; rays of length a see it closer than a.
    const float a = 0.6f;
    Floor floor("return min(p.y, p.x);", {.radius = a, .bias = 0.002f, .samples = 19},
                [](glm::vec3 p) { return p.x > 0.02f; });
    floor.rest(viewFrom(20));
    floor.expectNear(
        [&](glm::vec3 p) {
            const double s = std::min(p.x / a, 1.0f);
            return 1.0 - (std::acos(s) - s * std::sqrt(1 - s * s)) / std::numbers::pi;
        },
        0.02, 0.06, "wall, rays of 0.6 m");
}

TEST(Ambient, UnderASphereThatRestsOnTheFloor) {
    const float r = 0.5f;
    Floor floor("return min(p.y, length(p - vec3(0, 0.5, 0)) - 0.5);", kLong,
                [&](glm::vec3 p) { return std::hypot(p.x, p.z) > 0.5f * r; });
    floor.rest(viewFrom(0));
    floor.expectNear(
        [&](glm::vec3 p) { return 1.0 - std::pow(1.0 + (p.x * p.x + p.z * p.z) / (r * r), -1.5); }, 0.02,
        0.08, "resting sphere");
}

TEST(Ambient, InACornerOfThreePlanes) {
    Floor floor("return min(p.y, min(p.x, p.z));", kLong,
                [](glm::vec3 p) { return p.x > 0.1f && p.z > 0.1f; });
    floor.rest(viewFrom(30));
    floor.expectNear([](glm::vec3) { return 0.25; }, 0.03, 0.08, "corner of a room");
}

TEST(Ambient, SharedAndOwnRaysGiveTheSame) {
    const char* scene = "return min(p.y, length(p - vec3(0, 0.5, 0)) - 0.5);";
    Floor together(scene, {.bias = 0.002f}), apart(scene, {.bias = 0.002f, .balance = false});
    for (float degrees : {0.0f, 0.0f, 3.0f}) {
        together.draw(viewFrom(degrees));
        apart.draw(viewFrom(degrees));
        EXPECT_EQ(together.openness(), apart.openness());
    }
}

TEST(Ambient, GroupsThatTakeHolesInTurnsGiveTheSame) {
    const std::string scene = "return min(p.y, length(p - vec3(0, 0.5, 0)) - 0.5);", field = fieldOf(scene);
    Floor once(scene, {.bias = 0.002f}), often(scene, {.bias = 0.002f});
    const std::vector<std::string> few = {"AMBIENT_MOST_GROUPS 4u"};
    often.ambient.trace =
        createComputePipeline(often.device, {.name = "render/ambient.comp", .field = field, .defines = few});
    often.ambient.addRays = createComputePipeline(
        often.device, {.name = "render/ambient_holes.comp", .field = field, .defines = few});
    once.draw(viewFrom(0));
    often.draw(viewFrom(0));
    EXPECT_EQ(once.openness(), often.openness());
}

TEST(Ambient, AfterAMoveTheFirstFrameIsNearTheConvergedOne) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    const char* scene = "return min(p.y, length(p - vec3(0, 0.5, 0)) - 0.5);";
    Floor moving(scene, {.bias = 0.002f}), resting(scene, {.bias = 0.002f});
    moving.rest(viewFrom(0));
    const std::vector<glm::vec3> before = moving.points;
    const gpu::View view = viewFrom(5);
    moving.draw(view);
    resting.rest(view);
    const std::vector<float> first = moving.openness(), last = resting.openness();
    double keptSum = 0, holeSum = 0;
    int kept = 0, holes = 0;
    for (std::size_t i = 0; i < first.size(); ++i) {
        const glm::vec4 clip = toClip(viewFrom(0)) * glm::vec4(moving.points[i], 1);
        const bool wasSeen = std::max(std::abs(clip.x), std::abs(clip.y)) < clip.w;
        (wasSeen ? keptSum : holeSum) += std::abs(first[i] - last[i]);
        ++(wasSeen ? kept : holes);
    }
    ASSERT_GT(holes, 20);
    std::printf("after 5 degrees: %.4f where history was kept (%d pixels), %.4f in holes (%d)\n",
                keptSum / kept, kept, holeSum / holes, holes);
    EXPECT_LT((keptSum + holeSum) / (kept + holes), 0.05);
    EXPECT_LT(holeSum / holes, 0.05);
}

TEST(Ambient, AHistoryOfAnotherSurfaceIsRejected) {
    // The floor drops by a quarter of a metre: every normal stays, every plane is another.
    const auto scene = [](const char* height) {
        return std::string("return min(p.y + ") + height + ", length(p - vec3(0.3, 0.6, 0)) - 0.5);";
    };
    const AmbientOptions options{.bias = 0.002f, .samples = 16, .samplesMoving = 16};
    Floor moved(scene("0.25"), options), fresh(scene("0.25"), options);
    for (int i = 0; i < 8; ++i) moved.draw(viewFrom(0));
    moved.level = fresh.level = -0.25f;
    fresh.number = moved.number;  // the same turn of the rays
    moved.draw(viewFrom(0));
    fresh.draw(viewFrom(0));
    EXPECT_EQ(moved.openness(), fresh.openness());
}

TEST(Ambient, ASurfaceThatMovesAlongItsNormalKeepsItsHistory) {
    // The floor sinks by a fifth of a metre a frame, farther than a plane of then may be from one of now.
    const Result<Graph> graph = parseGraph(R"({"fieldwright": 1, "nodes": [
        {"id": "ground", "type": "plane"},
        {"id": "floor", "type": "translate", "inputs": {"surface": {"from": "ground"}, "offset": [0, 0, 0]}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "floor"}}}]})",
                                           "", nullptr);
    ASSERT_TRUE(graph) << format(graph.error());
    const Result<Program> program = compile(*graph, {.live = {"floor.offset"}});
    ASSERT_TRUE(program) << format(program.error());
    const AmbientOptions options{.bias = 0.002f};
    const auto known = [&](bool toldBefore) {
        Floor floor("return p.y;", options);
        floor.ambient = createAmbient(floor.device, emitField(*program), options);
        const Buffer now = createBuffer(floor.device, 12, Memory::upload),
                     before = createBuffer(floor.device, 12, Memory::upload);
        floor.live = {.parameters = &now, .before = toldBefore ? &before : nullptr};
        for (int i = 0; i < 5; ++i) {
            floor.level = -0.2f * float(i);
            upload(floor.device, now, std::vector{0.0f, floor.level, 0.0f});
            upload(floor.device, before, std::vector{0.0f, std::min(floor.level + 0.2f, 0.0f), 0.0f});
            floor.draw(viewFrom(0.02f * float(i)));
        }
        return floor.knownBy(uint32_t(options.raysNew));
    };
    EXPECT_EQ(known(false), 0.0);
    EXPECT_GT(known(true), 0.6);  // all but what was beyond the picture's edge
}

TEST(Ambient, AForgottenHistoryIsOfNoEffect) {
    const char* scene = "return min(p.y, length(p - vec3(0, 0.5, 0)) - 0.5);";
    Floor floor(scene, {.bias = 0.002f}), fresh(scene, {.bias = 0.002f});
    for (int i = 0; i < 8; ++i) floor.draw(viewFrom(0));
    fresh.number = floor.number;
    forgetHistory(floor.ambient);
    floor.draw(viewFrom(0));
    fresh.draw(viewFrom(0));
    EXPECT_EQ(floor.openness(), fresh.openness());
}

}  // namespace fw::ambient_test
