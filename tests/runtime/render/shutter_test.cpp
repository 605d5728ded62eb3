// What moves while the shutter is open is blurred by as far as it moves; and a live view that rests sees
// through the whole lens.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "graph/document/json.h"
#include "runtime/pictures/kept_paths.h"
#include "runtime/play/player.h"
#include "tests/support/command.h"
#include "tests/support/gpu.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::shutter_test {

constexpr int kWidth = 120, kHeight = 40;
constexpr double kFov = 20, kAway = 5;
/// Pixels a metre, where the block's front is.
const double kScale = kHeight / (2 * (kAway - 0.25) * std::tan(kFov / 2 * std::numbers::pi / 180));

/// A glowing block 1 m wide before black, which goes 1 m a second to the right, from 0.5 m on the left; at
/// two frames a second.
std::string graphOf(const std::string& camera) {
    return R"({"fieldwright": 1, "nodes": [
  {"id": "block", "type": "box", "inputs": {"half_extents": [0.5, 0.25, 0.25]}},
  {"id": "glow", "type": "material", "inputs": {"surface": {"from": "block"},
    "base_color": [0, 0, 0], "emission": [1, 1, 1]}},
  {"id": "move", "type": "translate", "inputs": {"surface": {"from": "glow"}}},
  {"id": "out", "type": "output", "inputs": {"surface": {"from": "move"}, "resolution": 48}}],
 "timeline": {"length": 1, "fps": 2, "tracks": [{"node": "move", "input": "offset", "interpolation": "linear",
   "keys": [{"time": 0, "value": [-0.5, 0, 0]}, {"time": 1, "value": [0.5, 0, 0]}]}]},
 "scene": {"camera": {"position": [0, 0, 5], "target": [0, 0, 0], "fov": 20)" +
           camera + R"(}, "ground": false, "sun": false, "ao": false,
   "sky": {"zenith": [0, 0, 0], "horizon": [0, 0, 0], "ground": [0, 0, 0]}}})";
}

Player open(const std::string& camera) {
    Result<Graph> graph = parseGraph(graphOf(camera), "", nullptr);
    EXPECT_TRUE(graph) << format(graph.error());
    Result<Device> device = createDevice({.validation = true});
    EXPECT_TRUE(device);
    Result<Player> player = Player::create(std::move(*graph), std::move(*device), {});
    EXPECT_TRUE(player) << format(player.error());
    return std::move(*player);
}

/// Light of the middle row, from the left.
std::vector<double> rowAt(const std::string& camera, double time, RenderOptions options = {.samples = 16}) {
    Player player = open(camera);
    LightPicture light;
    options.width = kWidth, options.height = kHeight, options.light = &light;
    player.seek(time);
    const Result<Picture> picture = player.frame(options);
    EXPECT_TRUE(picture) << format(picture.error());
    EXPECT_EQ(player.time(), time);
    for (const std::string& message : player.device().record->messages) ADD_FAILURE() << message;
    std::vector<double> row;
    for (int x = 0; x < kWidth; ++x)
        row.push_back(light.color[4 * std::size_t(kHeight / 2 * kWidth + x) + 1]);
    return row;
}

/// Where the row's right edge passes this share of its brightest pixel, pixels.
double edgeAt(const std::vector<double>& row, double share) {
    const double wanted = share * *std::ranges::max_element(row);
    for (int x = kWidth - 2; x >= 0; --x)
        if (row[std::size_t(x)] >= wanted) {
            const double here = row[std::size_t(x)], next = row[std::size_t(x) + 1];
            return x + 0.5 + (here - wanted) / std::max(here - next, 1e-9);
        }
    return 0;
}

TEST(Shutter, AnEdgeIsARampAsWideAsItMoves) {
    for (const bool paths : {false, true})
        for (const double shutter : {90.0, 180.0, 360.0}) {
            SCOPED_TRACE(shutter);
            const RenderOptions options{.samples = 64, .reference = paths, .bounces = paths ? 1 : 0};
            const std::string camera = R"(, "shutter": )" + std::to_string(shutter);
            const std::vector<double> row = rowAt(camera, 0.25, options);
            // The block's right side is at 0.25 m, and goes on for shutter / 360 / 2 seconds.
            const double moved = shutter / 720 * kScale, side = kWidth / 2.0 + 0.25 * kScale;
            EXPECT_NEAR(edgeAt(row, 0.25) - edgeAt(row, 0.75), 0.5 * moved, 0.15 * moved + 0.5);
            EXPECT_NEAR(edgeAt(row, 0.5), side + 0.5 * moved, 0.8);
        }
}

TEST(Shutter, ShutAndWithoutMotionItIsThePictureOfAMoment) {
    const std::vector<double> plain = rowAt("", 0.25), shut = rowAt(R"(, "shutter": 0)", 0.25);
    EXPECT_EQ(plain, shut);
    EXPECT_LT(edgeAt(plain, 0.1) - edgeAt(plain, 0.9), 1.5);
}

TEST(Shutter, SequencesCountByTheirRateAndPathsGoOnWithinAMoment) {
    const test::TempDir folder;
    const std::string graph = folder.path("a.field.json");
    test::writeText(graph, graphOf(R"(, "shutter": 180)"));
    // The frame of a sequence of the timeline's rate is the still, byte by byte; of another it is not.
    const auto render = [&](std::vector<std::string> more) {
        std::vector<std::string> words = {"render", graph, "--size", "120x40", "--samples", "8"};
        words.insert(words.end(), more.begin(), more.end());
        const auto result = test::runCommand(words);
        EXPECT_EQ(result.status, 0) << result.errors;
    };
    render({"-o", folder.path("still.png"), "--time", "0.5"});
    render({"-o", folder.path("same"), "--from", "0.5", "--to", "1"});
    render({"-o", folder.path("slower"), "--from", "0.5", "--to", "1", "--fps", "8"});
    const std::string still = test::readText(folder.path("still.png"));
    EXPECT_EQ(test::readText(folder.path("same/000001.png")), still);
    EXPECT_NE(test::readText(folder.path("slower/000004.png")), still);

    // Paths that were kept in the middle of a moment.
    Player player = open(R"(, "shutter": 180)");
    PathSums whole, kept;
    RenderOptions options{.width = kWidth, .height = kHeight, .samples = 40, .reference = true, .bounces = 1};
    options.sums = &whole;
    ASSERT_TRUE(player.frame(options));
    EXPECT_EQ(whole.paths, 40);
    RenderOptions stopped = options;
    stopped.sums = &kept;
    std::atomic<bool> cancel = false;
    stopped.cancel = &cancel;
    stopped.progress = [&](int percent) { cancel = percent > 30; };
    EXPECT_FALSE(player.frame(stopped));
    ASSERT_GT(kept.paths, 0);
    ASSERT_LT(kept.paths, 40);
    cancel = false;
    stopped.progress = {};
    ASSERT_TRUE(player.frame(stopped));
    EXPECT_EQ(kept.sums, whole.sums);
}

TEST(Shutter, PathsAreKeptForTheirCameraAlone) {
    const test::TempDir folder;
    const std::string output = folder.path("a.png");
    const Player player = open("");
    const Camera camera{.position = {3, 0, 4}};
    RenderOptions wish{.width = 8, .height = 4, .samples = 40, .reference = true, .bounces = 1};
    wish.scene.camera = camera;
    const auto goesOnFrom = [&](RenderOptions options) {
        return KeptPaths(output, player, options).goOn(options);
    };
    {
        KeptPaths kept(output, player, wish);
        RenderOptions render = wish;
        EXPECT_EQ(kept.goOn(render), 0);
        *render.sums = {.paths = 3, .sums = std::vector<float>(4 * 8 * 4, 1.0f)};
        render.keepSums();
    }
    EXPECT_EQ(goesOnFrom(wish), 3);
    // Paths that other algorithms made are not used. The version follows 8 bytes of name.
    const std::string whole = test::readText(output + ".paths");
    std::string changed = whole;
    ++changed[8];
    test::writeText(output + ".paths", changed);
    EXPECT_EQ(goesOnFrom(wish), 0);
    test::writeText(output + ".paths", whole);
    EXPECT_EQ(goesOnFrom(wish), 3);
    RenderOptions other = wish;
    other.scene.camera.reset();  // the scene's
    EXPECT_EQ(goesOnFrom(other), 0);
    other.scene.camera = camera, other.scene.camera->position[0] += 1e-9;
    EXPECT_EQ(goesOnFrom(other), 0);
    other.scene.camera = camera, other.scene.camera->aperture = 0.1;
    EXPECT_EQ(goesOnFrom(other), 0);
    // Of an open shutter which paths are of which moment depends on how many there are to be.
    for (const double shutter : {0.0, 90.0}) {
        wish.scene.camera->shutter = shutter;
        KeptPaths kept(output, player, wish);
        RenderOptions render = wish;
        kept.goOn(render);
        *render.sums = {.paths = 3, .sums = std::vector<float>(4 * 8 * 4, 1.0f)};
        render.keepSums();
        other = wish, other.samples = 50;
        EXPECT_EQ(goesOnFrom(other), shutter > 0.0 ? 0 : 3);
    }
}

TEST(Lens, OfTheLiveViewIsOpenWhileItRests) {
    // Focused before the block: its edges are blurred as those of a still are.
    const std::string camera = R"(, "aperture": 0.8, "focus": 3)";
    const auto blur = [](const Picture& picture) {
        std::vector<double> row;
        for (int x = 0; x < kWidth; ++x)
            row.push_back(picture.pixels[4 * std::size_t(kHeight / 2 * kWidth + x) + 1]);
        return edgeAt(row, 0.25) - edgeAt(row, 0.75);
    };
    Player player = open(camera);
    Picture live;
    const RenderOptions options{.width = kWidth, .height = kHeight, .samples = 64};
    const Result<Picture> still = player.frame(options);
    ASSERT_TRUE(still);
    ASSERT_TRUE(player.show(options, live));
    const double first = blur(live);
    int frames = 1;
    for (Result<bool> more = true; more && *more; ++frames) {
        more = player.show(options, live);
        ASSERT_TRUE(more);
        ASSERT_LT(frames, 200);
    }
    EXPECT_GT(blur(*still), 3.0);
    EXPECT_LT(first, 1.5);
    EXPECT_NEAR(blur(live), blur(*still), 0.15 * blur(*still));
    for (const std::string& message : player.device().record->messages) ADD_FAILURE() << message;
}

}  // namespace fw::shutter_test
