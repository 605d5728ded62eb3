// Pictures of the solid alone: how much of each pixel it takes, and that its edges hold nothing of what would
// be behind.
#include <gtest/gtest.h>

#include <stb/stb_image.h>
#include <cstdlib>

#include <cmath>
#include <memory>
#include <numbers>

#include "graph/document/json.h"
#include "runtime/play/player.h"
#include "tests/support/command.h"
#include "tests/support/drawn.h"
#include "tests/support/gpu.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::cutout_test {

constexpr int kSide = 64;

/// A ball of radius 1, seen from 5 m away: a disc whose radius is that of its outline, in half pictures.
std::string graphOf(const std::string& scene) {
    return R"({"fieldwright": 1, "nodes": [
  {"id": "ball", "type": "sphere", "inputs": {"radius": 1}},
  {"id": "red", "type": "material", "inputs": {"surface": {"from": "ball"}, "base_color": [0.9, 0.3, 0.2]}},
  {"id": "out", "type": "output", "inputs": {"surface": {"from": "red"}, "resolution": 48}}],
 "scene": {"camera": {"position": [0, 0, 5], "target": [0, 0, 0], "fov": 30}, )" +
           scene + "}}";
}
const double kRadius = std::tan(std::asin(1.0 / 5)) / std::tan(15 * std::numbers::pi / 180) * kSide / 2;
const std::string kNight =
    R"("ground": false, "sky": {"zenith": [0, 0, 0], "horizon": [0, 0, 0], "ground": [0, 0, 0]})";

struct Drawn {
    Picture picture;
    LightPicture light;
};
Drawn draw(const std::string& scene, RenderOptions options, bool withLight = false) {
    Drawn drawn;
    options.width = options.height = kSide;
    if (withLight) options.light = &drawn.light;
    drawn.picture = test::drawnBy(graphOf(scene), options);
    return drawn;
}

double fromMiddle(std::size_t i) {
    return std::hypot(double(i % kSide) + 0.5 - kSide / 2.0, double(i / kSide) + 0.5 - kSide / 2.0);
}

TEST(Cutout, AlphaIsTheShareOfEachPixelThatTheSolidTakes) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    // In the studio, on its ground, in fog, by paths, and with rays whose noise is taken out of linear light.
    const struct {
        const char* scene;
        bool paths;
    } ways[] = {{R"("exposure": 0)", false},
                {R"("sky": true, "fog": {"density": 0.1})", false},
                {R"("sky": true, "bounce": true)", false},
                {R"("sky": true)", true},
                {R"("exposure": 0)", true}};
    for (const auto& [scene, paths] : ways) {
        SCOPED_TRACE(std::string(scene) + (paths ? " by paths" : ""));
        const Drawn drawn =
            draw(scene, {.samples = 64, .reference = paths, .bounces = paths ? 2 : 0, .cutout = true});
        double area = 0;
        int edges = 0;
        for (std::size_t i = 0; i < kSide * kSide; ++i) {
            const int alpha = drawn.picture.pixels[4 * i + 3];
            const double away = fromMiddle(i) - kRadius;
            area += alpha / 255.0;
            edges += alpha > 0 && alpha < 255;
            if (std::abs(away) > 0.8) { ASSERT_EQ(alpha, away > 0 ? 0 : 255) << i; }
        }
        EXPECT_NEAR(area, std::numbers::pi * kRadius * kRadius, 0.005 * area);
        EXPECT_GT(edges, 4 * kRadius);
    }
}

TEST(Cutout, EdgesHaveTheSolidsColourAndNotThatBehindIt) {
    // In even light every pixel of it has about one colour, brighter towards the edge, where it mirrors more:
    // so have those on its edge, however little of them it takes.
    for (const char* bounce : {"false", "true"}) {
        SCOPED_TRACE(bounce);
        const Drawn drawn =
            draw(R"("sky": {"zenith": [1, 1, 1], "horizon": [1, 1, 1], "ground": [1, 1, 1]}, "ground": false,
                    "ao": false, "sun": false, "bounce": )" +
                     std::string(bounce),
                 {.samples = 16, .cutout = true});
        const auto red = [&](std::size_t i) { return int(drawn.picture.pixels[4 * i]); };
        const int middle = red(kSide * kSide / 2 + kSide / 2);
        for (std::size_t i = 0; i < kSide * kSide; ++i)
            if (drawn.picture.pixels[4 * i + 3] > 0) { ASSERT_NEAR(red(i), middle, 26) << i; }
    }
}

TEST(Cutout, LightTimesAlphaIsThatOfAPictureBeforeBlack) {
    for (const bool paths : {false, true}) {
        RenderOptions options{.samples = 8, .reference = paths, .bounces = paths ? 3 : 0};
        const Drawn whole = draw(kNight, options, true);
        options.cutout = true;
        const Drawn alone = draw(kNight, options, true);
        for (std::size_t i = 0; i < kSide * kSide; ++i) {
            for (std::size_t k = 0; k < 3; ++k)
                ASSERT_NEAR(alone.light.color[4 * i + k], whole.light.color[4 * i + k],
                            1e-5f + 0.001f * whole.light.color[4 * i + k]);
            ASSERT_NEAR(alone.light.color[4 * i + 3], alone.picture.pixels[4 * i + 3] / 255.0, 0.003);
            ASSERT_EQ(whole.light.color[4 * i + 3], 1.0f);
            ASSERT_EQ(whole.picture.pixels[4 * i + 3], 255);
        }
    }
}

TEST(Cutout, FilesHaveAlphaOnlyIfItIsAskedFor) {
    const test::TempDir folder;
    const std::string graph = folder.path("a.field.json"), png = folder.path("a.png");
    test::writeText(graph, graphOf(R"("exposure": 0)"));
    for (const bool transparent : {false, true}) {
        std::vector<std::string> words = {"render", graph, "-o", png, "--size", "64x64", "--samples", "4"};
        if (transparent) words.push_back("--transparent");
        const auto made = test::runCommand(words);
        ASSERT_EQ(made.status, 0) << made.errors;
        int width = 0, height = 0, channels = 0;
        const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
            stbi_load(png.c_str(), &width, &height, &channels, 0), stbi_image_free);
        ASSERT_TRUE(pixels);
        EXPECT_EQ(channels, transparent ? 4 : 3);
        if (transparent) {
            EXPECT_EQ(pixels.get()[3], 0);
            EXPECT_EQ(pixels.get()[4 * (kSide * kSide / 2 + kSide / 2) + 3], 255);
        }
    }
    test::expectRefusal(test::runCommand({"render", graph, "-o", png, "--transparent", "--view", "ao"}), 2,
                        {"--transparent", "--view"});
}

}  // namespace fw::cutout_test
