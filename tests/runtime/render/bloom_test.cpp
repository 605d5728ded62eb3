// Light that spills: none is lost or won, it looks the same at any resolution, and reaches as far as it is
// told to.
#include <gtest/gtest.h>

#include <cmath>

#include "graph/document/json.h"
#include "runtime/play/player.h"
#include "runtime/render/bloom.h"
#include "tests/support/drawn.h"
#include "tests/support/gpu.h"

namespace fw::bloom_test {

/// A small ball that glows before black.
std::string graphOf(const std::string& scene) {
    return R"({"fieldwright": 1, "nodes": [
  {"id": "ball", "type": "sphere", "inputs": {"radius": 0.1}},
  {"id": "glow", "type": "material", "inputs": {"surface": {"from": "ball"},
    "base_color": [0, 0, 0], "emission": [50, 50, 50]}},
  {"id": "out", "type": "output", "inputs": {"surface": {"from": "glow"}, "resolution": 24}}],
 "scene": {"camera": {"position": [0, 0, 5], "target": [0, 0, 0], "fov": 30}, "ground": false, "sun": false,
  "sky": {"zenith": [0, 0, 0], "horizon": [0, 0, 0], "ground": [0, 0, 0]}, "ao": false)" +
           scene + "}}";
}

struct Drawn {
    Picture picture;
    LightPicture light;
    double green(int x, int y) const {
        return light.color[4 * (std::size_t(y) * std::size_t(light.width) + std::size_t(x)) + 1];
    }
    double sum() const {
        double all = 0;
        for (std::size_t i = 1; i < light.color.size(); i += 4) all += light.color[i];
        return all;
    }
};
Drawn draw(const std::string& scene, int width, int height, RenderOptions options = {.samples = 4},
           bool withLight = true) {
    Drawn drawn;
    options.width = width, options.height = height;
    if (withLight) options.light = &drawn.light;
    drawn.picture = test::drawnBy(graphOf(scene), options);
    return drawn;
}

TEST(Bloom, SharesAreAllOfTheLight) {
    for (const double strength : {0.0, 0.15, 1.0})
        for (const double radius : {0.0, 1e-4, 0.1, 1.0})
            for (const auto& [width, height] : {std::pair{16, 16}, {8192, 16}, {640, 480}}) {
                const std::vector<BloomLevel> levels = bloomLevels({strength, radius}, width, height);
                EXPECT_GE(levels.size(), 2u);
                double shares = 0;
                for (const BloomLevel& level : levels) shares += level.plain + level.blurred;
                EXPECT_NEAR(shares, 1.0, 1e-5);
                EXPECT_GE(levels[0].plain, 1.0 - strength - 1e-6);
                EXPECT_EQ(levels[0].blurred, 0.0f);
            }
}

TEST(Bloom, LosesAndWinsNoLight) {
    for (const auto& [width, height] : {std::pair{160, 120}, {161, 119}})
        for (const bool paths : {false, true}) {
            const RenderOptions options{.samples = 4, .reference = paths, .bounces = paths ? 1 : 0};
            const Drawn plain = draw("", width, height, options),
                        bloomed =
                            draw(R"(, "bloom": {"strength": 0.5, "radius": 0.05})", width, height, options);
            EXPECT_NEAR(bloomed.sum(), plain.sum(), 0.01 * plain.sum());
            EXPECT_LT(bloomed.green(width / 2, height / 2), 0.95 * plain.green(width / 2, height / 2));
            EXPECT_EQ(plain.green(width / 2 + 14, height / 2), 0.0);
            EXPECT_GT(bloomed.green(width / 2 + 14, height / 2), 0.01);
        }
}

TEST(Bloom, SpreadsAsFarAsItIsToldAtAnyResolution) {
    // The second moment of what spills is that of its Gaussians.
    constexpr double kRadius = 0.05;
    for (const int height : {90, 240}) {
        const Drawn plain = draw("", height * 4 / 3, height);
        const Drawn bloomed = draw(R"(, "bloom": {"strength": 1, "radius": 0.05})", height * 4 / 3, height);
        const auto moment = [&](const Drawn& of) {
            double sum = 0;
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < height * 4 / 3; ++x) {
                    const double u = (x + 0.5 - height * 2.0 / 3) / height,
                                 v = (y + 0.5 - height / 2.0) / height;
                    sum += 0.5 * (u * u + v * v) * of.green(x, y);
                }
            return sum / of.sum();
        };
        double wanted = 0;
        for (int i = 0; i < 5; ++i) wanted += kRadius * kRadius / std::pow(4.0, i) / 5;
        EXPECT_NEAR(moment(bloomed) - moment(plain), wanted, 0.15 * wanted) << height;
    }
    const std::string scene = R"(, "bloom": {"strength": 0.5, "radius": 0.1})";
    const Drawn small = draw(scene, 160, 120), large = draw(scene, 480, 360);
    for (const int away : {12, 20, 30, 40})
        EXPECT_NEAR(small.green(80 + away, 60), large.green(240 + 3 * away + 1, 180),
                    0.25 * large.green(240 + 3 * away + 1, 180))
            << away;
}

TEST(Bloom, OfNothingIsThePictureItself) {
    const RenderOptions options{.samples = 4};
    const Drawn plain = draw("", 80, 60, options, false),
                off = draw(R"(, "bloom": false)", 80, 60, options, false),
                none = draw(R"(, "bloom": {"strength": 0})", 80, 60, options, false);
    EXPECT_EQ(plain.picture.pixels, off.picture.pixels);
    EXPECT_EQ(plain.picture.pixels, none.picture.pixels);
}

}  // namespace fw::bloom_test
