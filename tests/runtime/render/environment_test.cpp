// Environment maps: what is seen of them and how they light, against closed forms and the same light as a
// sun; and files that are none.
#include <gtest/gtest.h>

#include <stb/stb_image_write.h>
#include <cstdlib>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "graph/assets/environment.h"
#include "graph/check/check.h"
#include "graph/document/json.h"
#include "graph/document/named_files.h"
#include "runtime/play/player.h"
#include "tests/support/command.h"
#include "tests/support/gpu.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::environment_test {

constexpr int kSide = 48;
constexpr double kPi = std::numbers::pi;

/// Writes light that is a function of azimuth and elevation, radians as the sun's are, as an .hdr file.
template <class Light>
void writeMap(const std::string& path, int width, int height, const Light& light) {
    std::vector<float> texels;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double azimuth = std::remainder(2 * kPi * (1.0 - (x + 0.5) / width), 2 * kPi);
            const float value = float(light(azimuth, kPi * (0.5 - (y + 0.5) / height)));
            texels.insert(texels.end(), {value, value, value});
        }
    ASSERT_TRUE(stbi_write_hdr(path.c_str(), width, height, 3, texels.data()));
}

std::string graphOf(const std::string& shape, const std::string& material, const std::string& scene) {
    return R"({"fieldwright": 1, "nodes": [{"id": "shape", )" + shape +
           R"(}, {"id": "paint", "type": "material", "inputs": {"surface": {"from": "shape"}, )" + material +
           R"(}}, {"id": "out", "type": "output", "inputs": {"surface": {"from": "paint"},
  "resolution": 24}}],
 "scene": {"ground": false, )" +
           scene + "}}";
}
const std::string kBall = R"("type": "sphere")";
const std::string kBlock = R"("type": "box", "inputs": {"half_extents": [4, 1, 4]})";
const std::string kWhite = R"("base_color": [1, 1, 1], "roughness": 1)";
const std::string kFromFront = R"("camera": {"position": [0, 0, 5], "target": [0, 0, 0], "fov": 26}, )";

struct Environment : testing::Test {
    test::TempDir folder;
    std::string map = folder.path("map.hdr");

    Graph graph(const std::string& text) const {
        test::writeText(folder.path("a.field.json"), text);
        Result<Graph> read = readGraph(folder.path("a.field.json"), nullptr);
        EXPECT_TRUE(read) << format(read.error());
        return *read;
    }
    LightPicture draw(const std::string& text, RenderOptions options) const {
        LightPicture light;
        options.width = options.height = kSide, options.light = &light;
        Result<Device> device = createDevice({.validation = true});
        EXPECT_TRUE(device);
        const auto record = device->record;
        {
            Result<Player> player = Player::create(graph(text), std::move(*device), {});
            EXPECT_TRUE(player) << format(player.error());
            if (!player) return light;
            const Result<Picture> picture = player->frame(options);
            EXPECT_TRUE(picture) << format(picture.error());
        }
        for (const std::string& message : record->messages) ADD_FAILURE() << "validation: " << message;
        return light;
    }
    static double green(const LightPicture& light, int x, int y) {
        return light.color[4 * std::size_t(y * kSide + x) + 1];
    }
    /// The mean of the pixels within 6 of this one.
    static double about(const LightPicture& light, int x, int y) {
        double sum = 0;
        for (int j = -6; j < 6; ++j)
            for (int i = -6; i < 6; ++i) sum += green(light, x + i, y + j) / 144;
        return sum;
    }
};

TEST_F(Environment, InAnEvenOneAWhiteBallVanishes) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    for (const int width : {1, 64}) {
        writeMap(map, width, std::max(width / 2, 1), [](double, double) { return 1.0; });
        for (const char* material :
             {R"("metallic": 0, "roughness": 0.5)", R"("metallic": 1, "roughness": 0.2)",
              R"("metallic": 0, "roughness": 1)"}) {
            SCOPED_TRACE(material);
            const LightPicture light =
                draw(graphOf(kBall, std::string(R"("base_color": [1, 1, 1], )") + material,
                             kFromFront + R"("sun": false, "sky": {"image": "map.hdr"})"),
                     {.samples = 24, .reference = true, .bounces = 64});
            double sum = 0;
            for (int y = 0; y < kSide; ++y)
                for (int x = 0; x < kSide; ++x) {
                    ASSERT_NEAR(green(light, x, y), 1.0, 0.4) << x << ' ' << y;
                    sum += green(light, x, y) / (kSide * kSide);
                }
            EXPECT_NEAR(sum, 1.0, 0.01);
        }
    }
}

TEST_F(Environment, ABrightPatchIsASun) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    // A disc of 12 degrees at an azimuth of 30 and an elevation of 50 degrees; the map is turned by 10 of
    // them.
    const double half = 6 * kPi / 180, azimuth = 20 * kPi / 180, elevation = 50 * kPi / 180;
    const double strength = 3.0, spread = 2 * kPi * (1 - std::cos(half));
    writeMap(map, 1024, 512, [&](double a, double e) {
        const double cosine =
            std::sin(e) * std::sin(elevation) + std::cos(e) * std::cos(elevation) * std::cos(a - azimuth);
        return cosine > std::cos(half) ? strength / spread : 0.0;
    });
    const std::string above = R"("camera": {"position": [0, 9, 6], "target": [0, 1, 0], "fov": 8}, )";
    const std::string sun =
        R"("sun": {"azimuth": 30, "elevation": 50, "color": [1, 1, 1], "strength": 3, "size": 12},
           "sky": {"zenith": [0, 0, 0], "horizon": [0, 0, 0], "ground": [0, 0, 0]})";
    const std::string sky = R"("sun": false, "sky": {"image": "map.hdr", "rotation": 10})";
    for (const char* material :
         {R"("base_color": [1, 1, 1], "roughness": 1)", R"("base_color": [1, 1, 1], "roughness": 0.4)",
          R"("base_color": [1, 1, 1], "metallic": 1, "roughness": 0.5)"}) {
        SCOPED_TRACE(material);
        const RenderOptions options{.samples = 64, .reference = true, .bounces = 3};
        const LightPicture by = draw(graphOf(kBlock, material, above + sun), options),
                           as = draw(graphOf(kBlock, material, above + sky), options);
        const double wanted = about(by, kSide / 2, kSide / 2);
        EXPECT_GT(wanted, 0.1);
        EXPECT_NEAR(about(as, kSide / 2, kSide / 2), wanted, 0.02 * wanted);
        // What looks for the patch finds it: no pixel is far from the others.
        for (int i = kSide / 2 - 6; i < kSide / 2 + 6; ++i)
            ASSERT_NEAR(green(as, i, i), wanted, 0.5 * wanted);
    }
}

TEST_F(Environment, IsSeenWhereItLies) {
    // White where x, y and z are positive.
    writeMap(map, 512, 256, [](double a, double e) { return a > 0 && a < kPi / 2 && e > 0 ? 1.0 : 0.0; });
    const std::string tiny = R"("type": "sphere", "inputs": {"radius": 0.01})";
    for (const bool paths : {false, true})
        for (const double turn : {0.0, 90.0}) {
            SCOPED_TRACE(turn);
            // Looks along +x, so that +z is on the right.
            const LightPicture light =
                draw(graphOf(tiny, kWhite,
                             R"("camera": {"position": [-5, 0, 0], "target": [0, 0, 0], "fov": 60},
                                "sun": false, "sky": {"image": "map.hdr", "rotation": )" +
                                 std::to_string(turn) + "}"),
                     {.samples = 4, .reference = paths, .bounces = paths ? 2 : 0});
            const int left = kSide / 4, right = 3 * kSide / 4;
            EXPECT_NEAR(green(light, right, left), turn == 0 ? 1 : 0, 0.01);
            EXPECT_NEAR(green(light, left, left), turn == 0 ? 0 : 1, 0.01);
            EXPECT_NEAR(green(light, left, right), 0, 0.01);
            EXPECT_NEAR(green(light, right, right), 0, 0.01);
        }
}

TEST_F(Environment, LightsByTheCosineAndMirrorsByRoughness) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    // Bright above the horizon, dark below: what faces a level gets half of it.
    writeMap(map, 256, 128, [](double, double e) { return e > 0 ? 1.0 : 0.0; });
    const std::string scene = kFromFront + R"("sun": false, "ao": false, "sky": {"image": "map.hdr"})";
    const std::string bounce = scene + R"(, "bounce": true, "reflections": true)";
    for (const std::string& look : {scene, bounce}) {
        SCOPED_TRACE(look);
        const LightPicture matt = draw(graphOf(kBall, kWhite, look), {.samples = 32});
        const double side = about(matt, kSide / 2, kSide / 2);
        // A place that leans by an angle a sees (1 + sin a) / 2 of it.
        const int up = kSide / 2 - 10;
        const double slope = 10.0 / 24 * std::tan(13 * kPi / 180), square = 1 + slope * slope;
        const double lean = slope * (5 - std::sqrt(25 - 24 * square)) / square;
        EXPECT_NEAR(about(matt, kSide / 2, up) / side, 1 + lean, 0.08);
        // A mirror shows the edge between the two sharp, a rough one as a ramp.
        const auto ramp = [&](const char* roughness) {
            const LightPicture metal = draw(
                graphOf(kBall,
                        std::string(R"("base_color": [1, 1, 1], "metallic": 1, "roughness": )") + roughness,
                        look),
                {.samples = 32});
            return green(metal, kSide / 2, kSide / 2 - 4) - green(metal, kSide / 2, kSide / 2 + 3);
        };
        EXPECT_GT(ramp("0.08"), 0.9);
        EXPECT_LT(ramp("0.8"), 0.6);
        EXPECT_GT(ramp("0.8"), 0.05);
    }
}

TEST_F(Environment, TexelsThatAreNoLightAreNone) {
    const float infinity = std::numeric_limits<float>::infinity();
    LightPicture odd{4, 2, {}, std::vector<float>(8), std::vector<glm::vec3>(8), std::vector<uint32_t>(8)};
    for (const float value : {NAN, -1.0f, infinity, 0.5f, -infinity, 1e30f, 0.0f, 2.0f})
        odd.color.insert(odd.color.end(), {value, value, value, 1.0f});
    ASSERT_TRUE(saveLight(odd, folder.path("odd.exr")));
    const Result<EnvironmentMapPtr> read = readEnvironment(folder.path("a.field.json"), "odd.exr");
    ASSERT_TRUE(read) << read.error().message;
    std::vector<float> got;
    for (const Radiance& texel : (*read)->texels) got.push_back(texel[1]);
    EXPECT_EQ(got, (std::vector<float>{0, 0, kMostRadiance, 0.5f, 0, kMostRadiance, 0, 2}));
    const LightPicture light =
        draw(graphOf(kBall, kWhite, R"("bounce": true, "sky": {"image": "odd.exr"})"), {.samples = 4});
    for (const float value : light.color) ASSERT_TRUE(std::isfinite(value));
    const LightPicture paths = draw(graphOf(kBall, kWhite, R"("sky": {"image": "odd.exr"})"),
                                    {.samples = 4, .reference = true, .bounces = 3});
    for (const float value : paths.color) ASSERT_TRUE(std::isfinite(value));
}

TEST_F(Environment, OfAPictureWhiteIsOne) {
    const uint8_t pixels[] = {255, 255, 255, 188, 188, 188, 0, 0, 0, 255, 0, 0};
    ASSERT_TRUE(stbi_write_png(folder.path("a.png").c_str(), 2, 2, 3, pixels, 6));
    const Result<EnvironmentMapPtr> read = readEnvironment(folder.path("a.field.json"), "a.png");
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_NEAR((*read)->texels[0][0], 1.0, 1e-6);
    EXPECT_NEAR((*read)->texels[1][0], 0.5, 0.01);
    EXPECT_EQ((*read)->texels[3][1], 0.0f);
}

TEST_F(Environment, ProblemsNameTheKey) {
    test::writeText(folder.path("empty.hdr"), "");
    test::writeText(folder.path("text.hdr"), "no picture");
    test::writeText(folder.path("cut.exr"), std::string("\x76\x2f\x31\x01\x02\x00\x00\x00", 8) + "channels");
    const struct {
        const char* value;
        const char* said;
    } bad[] = {{R"("empty.hdr")", "is an empty file"},
               {R"("text.hdr")", ".hdr"},
               {R"("cut.exr")", "damaged"},
               {R"("none.hdr")", "none.hdr"},
               {"3", "must be the path of"},
               {R"("")", "must be the path of"}};
    for (const auto& [value, said] : bad) {
        SCOPED_TRACE(value);
        const std::vector<Error> findings =
            check(graph(graphOf(kBall, kWhite, std::string(R"("sky": {"image": )") + value + "}")));
        ASSERT_EQ(findings.size(), 1u);
        EXPECT_NE(findings[0].message.find("the scene's sky.image"), std::string::npos)
            << findings[0].message;
        EXPECT_NE(findings[0].message.find(said), std::string::npos) << findings[0].message;
        EXPECT_GT(findings[0].line, 0);
    }
}

TEST_F(Environment, TravelsWithTheGraph) {
    Graph moved = graph(graphOf(kBall, kWhite, R"("sky": {"image": "map.hdr", "strength": 2})"));
    const std::vector<NamedFile> files = namedFiles(moved);
    ASSERT_EQ(files.size(), 1u);
    EXPECT_EQ(files[0].path, "map.hdr");
    renameFiles(moved, [](const NamedFile& file) { return "maps/" + file.path; });
    const Result<Scene> scene = readScene(moved.scene);
    ASSERT_TRUE(scene);
    EXPECT_EQ(scene->sky->image, "maps/map.hdr");
    EXPECT_EQ(scene->sky->strength, 2);
}

}  // namespace fw::environment_test
