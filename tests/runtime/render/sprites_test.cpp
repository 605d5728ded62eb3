// Particles drawn one by one: as large as they should be, where they should be, and beside all else.
#include "runtime/render/sprites.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "graph/document/json.h"
#include "runtime/play/player.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::sprites_test {

constexpr int kSide = 200;                                     // pixels
constexpr double kDistance = 4.0, kHalf = 0.3639702342662024;  // of the camera; tan 20 degrees

/// A graph of the particles in `places`, seen from the front, and `more` nodes; `shown` is what the output
/// shows.
class Drawn {
  public:
    explicit Drawn(const std::string& places, const std::string& more = "",
                   const std::string& shown = R"("surface": {"from": "field"})") {
        test::writeText(dir.path("some.xyz"), places);
        test::writeText(dir.path("a.field.json"),
                        R"({"fieldwright": 1, "nodes": [
          {"id": "file", "type": "particle_file", "inputs": {"path": "some.xyz"}},
          {"id": "field", "type": "particles_to_field", "inputs": {"particles": {"from": "file"}, "radius": 0.4,
            "threshold": 0.125, "resolution": 48, "region_min": [-1, -1, -1], "region_max": [1, 1, 1]}},
          )" + more + R"({"id": "out", "type": "output", "inputs": {"resolution": 48, )" +
                            shown + R"(}}],
          "scene": {"camera": {"position": [0, 0, 4], "target": [0, 0, 0], "fov": 40}}})");
        Result<Player> made = Player::open(dir.path("a.field.json"), {.deviceOptions = {.validation = true}});
        EXPECT_TRUE(made) << (made ? "" : format(made.error()));
        if (made) player.emplace(std::move(*made));
    }
    ~Drawn() {
        if (!player) return;
        const std::shared_ptr<DeviceRecord> record = player->device().record;
        player.reset();
        for (const std::string& message : record->messages) ADD_FAILURE() << "validation layer: " << message;
    }

    Picture picture(uint32_t show) {
        if (!player) return {};
        const Result<Picture> drawn = player->frame({.width = kSide, .height = kSide, .show = show});
        EXPECT_TRUE(drawn) << (drawn ? "" : format(drawn.error()));
        return drawn ? *drawn : Picture{};
    }

    test::TempDir dir;
    std::optional<Player> player;
};

/// The pixels that show particles, which are blue while they rest; and their middle.
struct Blue {
    double count = 0, x = 0, y = 0;
};
Blue blueOf(const Picture& picture) {
    Blue blue;
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) {
            const uint8_t* p =
                &picture.pixels[4 * (std::size_t(y) * std::size_t(picture.width) + std::size_t(x))];
            if (p[2] < p[0] + 40) continue;
            ++blue.count, blue.x += x + 0.5, blue.y += y + 0.5;
        }
    blue.x /= blue.count, blue.y /= blue.count;
    return blue;
}

TEST(Sprites, SpheresAreAsLargeAsTheSurfaceAboutOneParticle) {
    Drawn drawn("0.5 0.25 0\n");
    const Blue blue = blueOf(drawn.picture(RENDER_SPHERES));
    const double perMetre = 0.5 * kSide / (kDistance * kHalf);
    const double radius = 0.4 * std::sqrt(1.0 - std::cbrt(0.125)) * perMetre;
    EXPECT_NEAR(blue.count, 3.14159265 * radius * radius, 0.05 * 3.14159265 * radius * radius);
    EXPECT_NEAR(blue.x, 0.5 * kSide + 0.5 * perMetre, 1.0);
    EXPECT_NEAR(blue.y, 0.5 * kSide - 0.25 * perMetre, 1.0);
}

TEST(Sprites, FollowWhatMovesTurnsAndScalesTheirField) {
    const double perMetre = 0.5 * kSide / (kDistance * kHalf);
    const auto discOf = [&](double radius) { return 3.14159265 * std::pow(radius * perMetre, 2.0); };
    const double radius = 0.4 * std::sqrt(1.0 - std::cbrt(0.125));
    // Half as large, turned from x to y, then moved.
    const std::string nodes =
        R"({"id": "placed", "type": "transform", "inputs": {"surface": {"from": "field"},
        "scale": 0.5, "rotation": [0, 0, 90], "translation": [-0.5, 0.25, 0]}},)";
    const Blue once =
        blueOf(Drawn("0.5 0 0\n", nodes, R"("surface": {"from": "placed"})").picture(RENDER_SPHERES));
    EXPECT_NEAR(once.count, discOf(0.5 * radius), 0.06 * discOf(0.5 * radius));
    EXPECT_NEAR(once.x, 0.5 * kSide - 0.5 * perMetre, 1.0);
    EXPECT_NEAR(once.y, 0.5 * kSide - 0.5 * perMetre, 1.0);
    // And at both places that it is shown at.
    const std::string both = nodes + R"({"id": "both", "type": "union", "inputs": {"a": {"from": "field"},
        "b": {"from": "placed"}}},)";
    const Blue twice =
        blueOf(Drawn("0.5 0 0\n", both, R"("surface": {"from": "both"})").picture(RENDER_SPHERES));
    EXPECT_NEAR(twice.count, once.count + discOf(radius), 0.05 * twice.count);
    // What is stretched along x is an ellipsoid.
    const std::string stretched =
        R"({"id": "half", "type": "expression", "code": "return p * vec3(0.5, 1, 1);"},
        {"id": "wide", "type": "warp", "inputs": {"surface": {"from": "field"}, "p": {"from": "half"}}},)";
    const Blue wide =
        blueOf(Drawn("0.2 0 0\n", stretched, R"("surface": {"from": "wide"})").picture(RENDER_SPHERES));
    EXPECT_NEAR(wide.count, 2.0 * discOf(radius), 0.06 * wide.count);
    EXPECT_NEAR(wide.x, 0.5 * kSide + 0.4 * perMetre, 1.0);
}

TEST(Sprites, BeyondTheGridAreLitAndBelowTheGroundHidden) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    const double inside = blueOf(Drawn("0.7 0 0\n").picture(RENDER_SPHERES)).count;
    EXPECT_NEAR(blueOf(Drawn("1.1 0 0\n").picture(RENDER_SPHERES)).count, inside, 0.08 * inside);
    const Picture none = Drawn("0 -9 0\n").picture(RENDER_SPHERES),
                  below = Drawn("0 -1.5 0\n").picture(RENDER_SPHERES);
    ASSERT_EQ(none.pixels.size(), below.pixels.size());
    int unlike = 0;
    for (std::size_t i = 0; i < none.pixels.size(); ++i)
        unlike += std::abs(int(none.pixels[i]) - int(below.pixels[i])) > 12;
    EXPECT_EQ(unlike, 0);
}

TEST(Sprites, PointsAreSmallHoweverNear) {
    const Blue far = blueOf(Drawn("0 0 -1\n").picture(RENDER_POINTS));
    const Blue near = blueOf(Drawn("0 0 1\n").picture(RENDER_POINTS));
    EXPECT_GE(far.count, 1);
    EXPECT_LE(near.count, 9);
    EXPECT_NEAR(far.x, 0.5 * kSide, 1.0);
    EXPECT_NEAR(near.y, 0.5 * kSide, 1.0);
}

TEST(Sprites, TheNearerHidesTheFarther) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    const double one = blueOf(Drawn("0 0 0.5\n").picture(RENDER_SPHERES)).count;
    EXPECT_EQ(blueOf(Drawn("0 0 0.5\n0 0 -0.5\n").picture(RENDER_SPHERES)).count, one);
    EXPECT_EQ(blueOf(Drawn("0 0 -0.5\n0 0 0.5\n").picture(RENDER_SPHERES)).count, one);
    // A wall before them, and a hole in it.
    const auto behindWall = [](const std::string& radius) {
        return Drawn("0 0 0\n",
                     R"({"id": "wall", "type": "box", "inputs": {"half_extents": [0.9, 0.9, 0.05]}},
          {"id": "front", "type": "translate", "inputs": {"surface": {"from": "wall"}, "offset": [0, 0, 0.8]}},
          {"id": "hole", "type": "cylinder", "inputs": {"radius": )" +
                         radius + R"(, "half_height": 3}},
          {"id": "through", "type": "rotate", "inputs": {"surface": {"from": "hole"}, "angles": [90, 0, 0]}},
          {"id": "cut", "type": "subtract", "inputs": {"a": {"from": "front"}, "b": {"from": "through"}}},
          {"id": "both", "type": "union", "inputs": {"a": {"from": "field"}, "b": {"from": "cut"}}},)",
                     R"("surface": {"from": "both"})");
    };
    EXPECT_EQ(blueOf(behindWall("0.001").picture(RENDER_SPHERES)).count, 0);
    EXPECT_GT(blueOf(behindWall("0.6").picture(RENDER_SPHERES)).count, 500);
}

TEST(Sprites, SurfacesComeBackAndMeshesAlwaysHaveThem) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "half a minute: with FIELDWRIGHT_LONG";
    Drawn drawn("0 0 0\n0.4 0.1 0\n");
    const Picture before = drawn.picture(RENDER_PICTURE);
    const std::size_t triangles = drawn.player->mesh()->triangleCount();
    EXPECT_GT(triangles, 500u);
    EXPECT_GT(blueOf(drawn.picture(RENDER_SPHERES)).count, 500);
    EXPECT_EQ(drawn.player->mesh()->triangleCount(), triangles);
    EXPECT_GT(blueOf(drawn.picture(RENDER_POINTS)).count, 2);
    EXPECT_EQ(drawn.picture(RENDER_PICTURE).pixels, before.pixels);
}

TEST(Sprites, AreDrawnBesideDrafts) {
    Drawn smoothed("0 0 0\n",
                   R"({"id": "mesh", "type": "polygonize", "inputs": {"surface": {"from": "field"}}},
        {"id": "smooth", "type": "smooth", "inputs": {"mesh": {"from": "mesh"}, "iterations": 2}},)",
                   R"("mesh": {"from": "smooth"})");
    const double count = blueOf(Drawn("0 0 0\n").picture(RENDER_SPHERES)).count;
    EXPECT_NEAR(blueOf(smoothed.picture(RENDER_SPHERES)).count, count, 0.02 * count);
}

TEST(Sprites, AreDrawnByALiveViewThatMeasuresHow) {
    Drawn drawn("0 0 0\n", R"({"id": "ball", "type": "sphere", "inputs": {"radius": 0.2}},
        {"id": "both", "type": "union", "inputs": {"a": {"from": "field"}, "b": {"from": "ball"}}},)",
                R"("surface": {"from": "both"})");
    ASSERT_TRUE(drawn.player);
    Picture picture;
    const Result<bool> shown = drawn.player->show(
        {.width = kSide, .height = kSide, .primary = Primary::measured, .show = RENDER_SPHERES}, picture);
    ASSERT_TRUE(shown) << format(shown.error());
    EXPECT_GT(blueOf(picture).count, 500);
}

TEST(Sprites, WithoutParticlesThePictureIsThatOfTheSolid) {
    const Result<Graph> graph = parseGraph(R"({"fieldwright": 1, "nodes": [{"id": "ball", "type": "sphere"},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "ball"}, "resolution": 24}}]})",
                                           "a", nullptr);
    ASSERT_TRUE(graph);
    Result<Device> device = createDevice({.validation = true});
    Result<Player> player = Player::create(*graph, std::move(*device));
    ASSERT_TRUE(player);
    EXPECT_EQ(player->frame({.width = 64, .height = 48, .show = RENDER_SPHERES})->pixels,
              player->frame({.width = 64, .height = 48})->pixels);
}

}  // namespace fw::sprites_test
