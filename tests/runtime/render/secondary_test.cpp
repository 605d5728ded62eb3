// Indirect light, reflections and transmission as every picture has them, against closed forms and against
// whole paths of light.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "graph/document/json.h"
#include "runtime/play/player.h"
#include "tests/support/gpu.h"

namespace fw::secondary_test {

constexpr int kWidth = 128, kHeight = 96;

struct Secondary : testing::Test {
    static Result<Graph> parsed(const std::string& nodes, const std::string& scene) {
        return parseGraph(R"({"fieldwright": 1, "nodes": [)" + nodes + R"(], "scene": {)" + scene + "}}", "",
                          nullptr);
    }
    static Player playerOf(Result<Graph> graph) {
        EXPECT_TRUE(graph) << format(graph.error());
        Result<Device> device = createDevice({.validation = true});
        EXPECT_TRUE(device);
        Result<Player> player =
            Player::create(std::move(*graph), std::move(*device), {.fieldBy = FieldBy::kernels});
        EXPECT_TRUE(player) << format(player.error());
        return std::move(*player);
    }
    static Picture drawn(Player& player, const RenderOptions& options) {
        const auto record = player.device().record;
        Result<Picture> picture = player.frame(options);
        EXPECT_TRUE(picture) << format(picture.error());
        for (const std::string& message : record->messages) ADD_FAILURE() << "validation layer: " << message;
        return picture ? std::move(*picture) : Picture{};
    }
    static Picture drawn(const std::string& nodes, const std::string& scene, int samples = 8) {
        Player player = playerOf(parsed(nodes, scene));
        return drawn(player, {.width = kWidth, .height = kHeight, .samples = samples});
    }
};

int at(const Picture& picture, int x, int y, int channel) {
    return picture.pixels[4 * std::size_t(y * picture.width + x) + std::size_t(channel)];
}

/// Mean difference of two pictures, 0 to 1: of the means of 2 x 2 pixels, for whole paths have noise.
double difference(const Picture& a, const Picture& b) {
    double sum = 0;
    for (int y = 0; y < a.height; y += 2)
        for (int x = 0; x < a.width; x += 2)
            for (int channel = 0; channel < 3; ++channel) {
                int off = 0;
                for (int i = 0; i < 4; ++i)
                    off += at(a, x + i % 2, y + i / 2, channel) - at(b, x + i % 2, y + i / 2, channel);
                sum += std::abs(off) / 4.0;
            }
    return sum / (3.0 * a.width / 2 * a.height / 2) / 255;
}

TEST_F(Secondary, AWhiteBallInAWhiteSkyVanishes) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    // 0.5 is grey in the picture, so that more and less light show.
    const std::string furnace =
        R"("sun": false, "ground": false, "bounce": true, "reflections": true,
           "sky": {"zenith": [0.5, 0.5, 0.5], "horizon": [0.5, 0.5, 0.5], "ground": [0.5, 0.5, 0.5]})";
    for (const char* metallic : {"0", "1"})
        for (const char* roughness : {"0", "0.3", "0.6", "1"}) {
            SCOPED_TRACE(std::string("metallic ") + metallic + ", roughness " + roughness);
            const Picture picture = drawn(
                std::string(
                    R"({"id": "ball", "type": "sphere"}, {"id": "paint", "type": "material", "inputs": {"surface": {"from": "ball"},
                    "base_color": [1, 1, 1], "metallic": )") +
                    metallic + R"(, "roughness": )" + roughness + R"(}},
                    {"id": "out", "type": "output", "inputs": {"surface": {"from": "paint"}}})",
                furnace);
            for (int y = 0; y < kHeight; ++y)
                for (int x = 0; x < kWidth; ++x)
                    ASSERT_NEAR(at(picture, x, y, 1), at(picture, 0, 0, 1), 2.6) << x << " " << y;  // 1 %
        }
}

TEST_F(Secondary, AMirrorShowsWhatStandsBeforeIt) {
    // A red ball above a level mirror, seen from the side: its image is as far below as it is above.
    const std::string nodes =
        R"({"id": "ball", "type": "sphere", "inputs": {"radius": 0.5}},
           {"id": "high", "type": "translate", "inputs": {"surface": {"from": "ball"}, "offset": [0, 1, 0]}},
           {"id": "red", "type": "material", "inputs": {"surface": {"from": "high"}, "base_color": [1, 0, 0], "roughness": 1, "emission": [0.3, 0, 0]}},
           {"id": "plate", "type": "box", "inputs": {"half_extents": [3, 0.1, 3]}},
           {"id": "low", "type": "translate", "inputs": {"surface": {"from": "plate"}, "offset": [0, -0.1, 0]}},
           {"id": "mirror", "type": "material", "inputs": {"surface": {"from": "low"}, "base_color": [1, 1, 1], "roughness": 0, "metallic": 1}},
           {"id": "both", "type": "union", "inputs": {"a": {"from": "red"}, "b": {"from": "mirror"}}},
           {"id": "out", "type": "output", "inputs": {"surface": {"from": "both"}}})";
    const std::string look =
        R"("sky": {}, "sun": false, "ground": false, "camera": {"position": [0, 1.5, 6], "target": [0, 0, 0], "fov": 36})";
    // Where the image's middle, at (0, -1, 0), is seen.
    const double along = 6 * 6 / std::hypot(6, 1.5) + 1.5 * 2.5 / std::hypot(6, 1.5),
                 across = (-1 * 6) / std::hypot(6, 1.5);
    const int y = int(kHeight * (0.5 - 0.5 * across / along / std::tan(18 * 3.14159265 / 180)));
    const auto redness = [&](const Picture& picture) {
        return at(picture, kWidth / 2, y, 0) - at(picture, kWidth / 2, y, 1);
    };
    EXPECT_GT(redness(drawn(nodes, look + R"(, "reflections": true)")), 60);
    EXPECT_LT(redness(drawn(nodes, look)), 20);
}

TEST_F(Secondary, AWallLendsItsColour) {
    const std::string nodes =
        R"({"id": "wall", "type": "box", "inputs": {"half_extents": [0.1, 2, 2]}},
           {"id": "left", "type": "translate", "inputs": {"surface": {"from": "wall"}, "offset": [-1.2, 1, 0]}},
           {"id": "red", "type": "material", "inputs": {"surface": {"from": "left"}, "base_color": [0.9, 0.02, 0.02], "roughness": 1}},
           {"id": "plate", "type": "box", "inputs": {"half_extents": [2, 0.1, 2]}},
           {"id": "white", "type": "material", "inputs": {"surface": {"from": "plate"}, "base_color": [0.8, 0.8, 0.8], "roughness": 1}},
           {"id": "both", "type": "union", "inputs": {"a": {"from": "red"}, "b": {"from": "white"}}},
           {"id": "out", "type": "output", "inputs": {"surface": {"from": "both"}}})";
    const std::string look =
        R"("sky": {"strength": 0.3}, "sun": {"azimuth": 90, "elevation": 40, "color": [1, 1, 1]}, "ground": false, "ao": false,
        "camera": {"position": [2, 4, 7], "target": [0, 0, 0], "fov": 30})";
    const auto redness = [&](const Picture& picture) {
        double sum = 0;
        for (int y = 46; y < 52; ++y)
            for (int x = 54; x < 60; ++x) sum += at(picture, x, y, 0) - at(picture, x, y, 2);
        return sum / 36;
    };
    EXPECT_GT(redness(drawn(nodes, look + R"(, "bounce": true)", 16)), redness(drawn(nodes, look, 16)) + 8);
}

/// What differs: the penumbras of lamps, which are a formula's; in the glass the light that it gathers on the
/// table, and what goes to and fro within it.
TEST_F(Secondary, IsNearWholePaths) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "half a minute: with FIELDWRIGHT_LONG";
    for (const auto& [name, most] : {std::pair("cornell_box", 0.035), std::pair("glass_of_water", 0.04)}) {
        if (name == std::string("cornell_box") && !std::getenv("FIELDWRIGHT_LONG")) continue;
        SCOPED_TRACE(name);
        Player player = playerOf(
            readGraph(std::string(FIELDWRIGHT_SOURCE_DIR) + "/samples/" + name + ".field.json", nullptr));
        const Picture quick = drawn(player, {.width = kWidth, .height = kHeight, .samples = 16});
        const Picture paths = drawn(
            player, {.width = kWidth, .height = kHeight, .samples = 256, .reference = true, .bounces = 8});
        const double off = difference(quick, paths);
        std::printf("%s: %.4f from whole paths\n", name, off);
        EXPECT_LT(off, most);
    }
}

TEST_F(Secondary, TheSameBytesEachTime) {
    const std::string nodes =
        R"({"id": "ball", "type": "sphere"}, {"id": "glass", "type": "material", "inputs": {"surface": {"from": "ball"}, "transmission": 0.7, "roughness": 0.2}},
           {"id": "out", "type": "output", "inputs": {"surface": {"from": "glass"}}})";
    EXPECT_EQ(drawn(nodes, R"("bounce": true, "reflections": true)", 3).pixels,
              drawn(nodes, R"("bounce": true, "reflections": true)", 3).pixels);
}

/// The view of the sample's camera, turned about its target.
Camera turned(const Player& player, double degrees) {
    Camera camera = *player.scene()->camera;
    const double angle = degrees * 3.14159265 / 180, x = camera.position[0] - camera.target[0],
                 z = camera.position[2] - camera.target[2];
    camera.position[0] = camera.target[0] + x * std::cos(angle) + z * std::sin(angle);
    camera.position[2] = camera.target[2] - x * std::sin(angle) + z * std::cos(angle);
    return camera;
}

TEST_F(Secondary, AfterFiveDegreesThereAreNoGhosts) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    for (const char* name : {"cornell_box", "wet_city"}) {
        if (name == std::string("wet_city") && !std::getenv("FIELDWRIGHT_LONG")) continue;
        SCOPED_TRACE(name);
        Player player = playerOf(
            readGraph(std::string(FIELDWRIGHT_SOURCE_DIR) + "/samples/" + name + ".field.json", nullptr));
        RenderOptions options{.width = kWidth, .height = kHeight};
        Picture moved, rested;
        for (int i = 0; i <= 5; ++i) {
            options.scene.camera = turned(player, i);
            ASSERT_TRUE(player.show(options, moved));
        }
        while (*player.show(options, rested)) {}
        // From the other side, as far again: what it remembers is wrong in other places.
        Picture other;
        for (int i = 0; i <= 5; ++i) {
            options.scene.camera = turned(player, 10 - i);
            ASSERT_TRUE(player.show(options, other));
        }
        std::printf("%s: after 5 degrees %.4f and %.4f from where it comes to rest\n", name,
                    difference(moved, rested), difference(other, rested));
        EXPECT_LT(difference(moved, rested), 0.03);
        EXPECT_LT(difference(other, rested), 0.03);
        for (const std::string& message : player.device().record->messages)
            ADD_FAILURE() << "validation layer: " << message;
    }
}

TEST_F(Secondary, MirrorsThatFaceEachOtherStayBounded) {
    // Rough and smooth, white, a metre apart, in a sky of radiance 0.5: neither can be brighter than it.
    for (const char* roughness : {"0", "0.4"}) {
        SCOPED_TRACE(roughness);
        const std::string nodes =
            std::string(R"({"id": "plate", "type": "box", "inputs": {"half_extents": [0.1, 1.5, 1.5]}},
           {"id": "left", "type": "translate", "inputs": {"surface": {"from": "plate"}, "offset": [-0.6, 0, 0]}},
           {"id": "right", "type": "translate", "inputs": {"surface": {"from": "plate"}, "offset": [0.6, 0, 0]}},
           {"id": "both", "type": "union", "inputs": {"a": {"from": "left"}, "b": {"from": "right"}}},
           {"id": "mirror", "type": "material", "inputs": {"surface": {"from": "both"}, "base_color": [1, 1, 1], "metallic": 1, "roughness": )") +
            roughness + R"(}}, {"id": "out", "type": "output", "inputs": {"surface": {"from": "mirror"}}})";
        const Picture picture = drawn(nodes,
                                      R"("sun": false, "ground": false, "bounce": true, "reflections": true,
                     "sky": {"zenith": [0.5, 0.5, 0.5], "horizon": [0.5, 0.5, 0.5], "ground": [0.5, 0.5, 0.5]},
                     "camera": {"position": [0.5, 0.8, 4], "target": [-0.1, 0, 0], "fov": 40})");
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x)
                ASSERT_LE(at(picture, x, y, 1), at(picture, 0, 0, 1) + 2) << x << " " << y;
    }
}

TEST_F(Secondary, GlassWithoutEndHasAPicture) {
    const std::string nodes =
        R"({"id": "water", "type": "plane"},
           {"id": "clear", "type": "material", "inputs": {"surface": {"from": "water"}, "base_color": [1, 1, 1], "roughness": 0, "transmission": 1, "ior": 1.33, "absorption": [0.9, 0.3, 0.1]}},
           {"id": "mesh", "type": "polygonize", "inputs": {"surface": {"from": "clear"}, "region_min": [-2, -1, -2], "region_max": [2, 1, 2], "resolution": 32}},
           {"id": "out", "type": "output", "inputs": {"mesh": {"from": "mesh"}}})";
    Player player = playerOf(parsed(nodes, R"("sky": {}, "reflections": true)"));
    const Picture quick = drawn(player, {.width = kWidth, .height = kHeight, .samples = 4});
    const Picture paths =
        drawn(player, {.width = kWidth, .height = kHeight, .samples = 64, .reference = true, .bounces = 4});
    EXPECT_LT(difference(quick, paths), 0.05);
}

TEST_F(Secondary, APictureDoesNotDependOnThoseBefore) {
    // A floor that goes beyond what rays reach, from where the ball is near and from afar.
    const std::string nodes =
        R"({"id": "ball", "type": "sphere", "inputs": {"radius": 0.4}},
           {"id": "lamp", "type": "material", "inputs": {"surface": {"from": "ball"}, "base_color": [1, 0.5, 0.2], "emission": [8, 3, 1]}},
           {"id": "out", "type": "output", "inputs": {"surface": {"from": "lamp"}, "resolution": 32}})";
    const std::string scene = R"("sky": {}, "bounce": true, "reflections": true)";
    const auto from = [](Triple position) {
        RenderOptions options{.width = kWidth, .height = kHeight, .samples = 3};
        options.scene.camera = Camera{.position = position, .target = {0, 0, 0}, .fov = 40};
        return options;
    };
    const RenderOptions near = from({1, 0.6, 1.4}), afar = from({-3, 1, 2});
    Player fresh = playerOf(parsed(nodes, scene)), used = playerOf(parsed(nodes, scene));
    drawn(used, near);
    EXPECT_EQ(drawn(fresh, afar).pixels, drawn(used, afar).pixels);
}

/// What people write: a picture, never a crash.
TEST_F(Secondary, AnyMediumHasAPicture) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    int number = 0;
    for (const char* medium :
         {R"("ior": 1)", R"("ior": 0.5)", R"("ior": 3)", R"("absorption": [1e9, 1e9, 1e9])",
          R"("absorption": [0, 0, 0])", R"("roughness": 1)", R"("transmission": 0.3)"}) {
        SCOPED_TRACE(medium);
        if (number++ % 2 != 0 && !std::getenv("FIELDWRIGHT_LONG")) continue;
        const std::string nodes =
            std::string(R"({"id": "ball", "type": "sphere"},
            {"id": "glass", "type": "material", "inputs": {"surface": {"from": "ball"}, "base_color": [1, 1, 1])") +
            (std::string(medium).find("transmission") == std::string::npos ? R"(, "transmission": 1, )"
                                                                           : ", ") +
            medium + R"(}},
            {"id": "shells", "type": "expression", "code": "s = a; for (int i = 0; i < 30; i++) s = with_distance(s, abs(s.distance) - 0.3 * pow(0.8, i)); return s;",
             "inputs": {"a": {"from": "glass"}}},
            {"id": "out", "type": "output", "inputs": {"surface": {"from": "shells"}, "resolution": 48}})";
        Player player = playerOf(parsed(
            nodes,
            R"("bounce": true, "reflections": true, "camera": {"position": [0, 0, 0.1], "target": [0, 0, 5]})"));
        drawn(player, {.width = 64, .height = 48, .samples = 2});
        drawn(player, {.width = 64, .height = 48, .samples = 2, .reference = true, .bounces = 4});
    }
}

}  // namespace fw::secondary_test
