// Pictures as light: what their channels hold, against closed forms and the picture that a display shows, and
// their files, read by another program.
#include <gtest/gtest.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <stb/stb_image.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <set>

#include "graph/assets/image.h"
#include "graph/document/json.h"
#include "runtime/play/player.h"
#include "tests/support/command.h"
#include "tests/support/drawn.h"
#include "tests/support/gpu.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::light_picture_test {

using test::expectRefusal;
using test::runCommand;
using test::TempDir;

constexpr int kWidth = 64, kHeight = 48;

/// A red block whose front is at z = 1, and a blue ball to its right, seen from z = 9.
std::string graphOf(const std::string& scene) {
    return R"({"fieldwright": 1, "nodes": [
  {"id": "block", "type": "box", "inputs": {"half_extents": [1, 1, 1]}},
  {"id": "red", "type": "material", "inputs": {"surface": {"from": "block"}, "base_color": [0.8, 0.1, 0.05]}},
  {"id": "ball", "type": "sphere", "inputs": {"radius": 0.6}},
  {"id": "right", "type": "translate", "inputs": {"surface": {"from": "ball"}, "offset": [1.9, 0, 0]}},
  {"id": "blue", "type": "material", "inputs": {"surface": {"from": "right"}, "base_color": [0.1, 0.2, 0.8]}},
  {"id": "both", "type": "union", "inputs": {"a": {"from": "red"}, "b": {"from": "blue"}}},
  {"id": "out", "type": "output", "inputs": {"surface": {"from": "both"}, "resolution": 48}}],
 "scene": {"camera": {"position": [0, 0, 9], "target": [0, 0, 0], "fov": 40}, )" +
           scene + "}}";
}
const std::string kSky = R"("sky": {"zenith": [0.2, 0.4, 0.9]}, "exposure": 0.7)";

struct Drawn {
    Picture picture;
    LightPicture light;
    std::size_t at(int x, int y) const { return std::size_t(y) * kWidth + std::size_t(x); }
};

Drawn draw(const std::string& scene, RenderOptions options) {
    Drawn drawn;
    options.width = kWidth, options.height = kHeight, options.light = &drawn.light;
    drawn.picture = test::drawnBy(graphOf(scene), options);
    return drawn;
}

/// What a display shows of radiance, 0 to 255: after shaders/render/tone.glsl.
double shown(double radiance, double stops) {
    const double x = radiance * 0.66 * std::exp2(stops);
    return 255 * encodeSrgb(std::clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0));
}

TEST(LightPicture, IsWhatThePictureShowsBeforeItsToneMap) {
    for (const char* more : {"", R"(, "bounce": true)"})
        for (const bool paths : {false, true}) {
            SCOPED_TRACE(std::string(more) + (paths ? " paths" : ""));
            const Drawn drawn =
                draw(kSky + more, {.samples = 1, .reference = paths, .bounces = paths ? 4 : 0});
            ASSERT_EQ(drawn.light.color.size(), 4u * kWidth * kHeight);
            for (std::size_t i = 0; i < drawn.light.color.size(); ++i) {
                const double wanted = i % 4 == 3 ? 255.0 : shown(drawn.light.color[i], 0.7);
                ASSERT_NEAR(wanted, drawn.picture.pixels[i], 1.2) << i;
            }
        }
}

TEST(LightPicture, KnowsHowFarWhatIsSeenLiesAndWhereItFaces) {
    for (const bool reference : {false, true}) {
        const Drawn drawn = draw(kSky, {.samples = 2, .reference = reference});
        const LightPicture& light = drawn.light;
        // The block's front: a plane across the view, so that every pixel has one depth.
        for (int y = kHeight / 2 - 5; y < kHeight / 2 + 5; ++y)
            for (int x = kWidth / 2 - 5; x < kWidth / 2 + 5; ++x) {
                const std::size_t at = drawn.at(x, y);
                ASSERT_NEAR(light.depth[at], 8.0, 2e-3);
                ASSERT_NEAR(glm::distance(light.normal[at], glm::vec3(0, 0, 1)), 0.0, 1e-3);
            }
        // Above nothing is, and below the ground, as far as the ray to it is long along the view.
        EXPECT_EQ(light.depth[drawn.at(kWidth / 2, 0)], kNoDepth);
        EXPECT_EQ(light.normal[drawn.at(kWidth / 2, 0)], glm::vec3(0));
        const double down = std::tan(20 * 3.14159265 / 180) * (kHeight - 1.0) / kHeight;
        const std::size_t floor = drawn.at(kWidth / 2, kHeight - 1);
        EXPECT_NEAR(light.depth[floor], 1.0 / down, 0.02);
        EXPECT_EQ(light.normal[floor], glm::vec3(0, 1, 0));
        EXPECT_EQ(light.id[floor], kGroundId);
        EXPECT_EQ(light.id[drawn.at(kWidth / 2, 0)], kNothingId);
        // Two materials, each with a number of its own.
        EXPECT_EQ(std::set<uint32_t>(light.id.begin(), light.id.end()).size(), 4u);
        const int right = kWidth / 2 + int(kHeight / 2 * (1.9 / 9) / std::tan(20 * 3.14159265 / 180));
        EXPECT_NE(light.id[drawn.at(right, kHeight / 2)], light.id[drawn.at(kWidth / 2, kHeight / 2)]);
        EXPECT_GT(light.id[drawn.at(right, kHeight / 2)], kGroundId);
    }
}

/// The channels of an OpenEXR file.
struct ReadBack {
    int width = 0, height = 0;
    std::set<std::string> names;
    std::vector<float> green, depth;
};
ReadBack read(const std::string& path) {
    Imf::InputFile file(path.c_str());
    const Imath::Box2i window = file.header().dataWindow();
    ReadBack got{window.max.x + 1, window.max.y + 1, {}, {}, {}};
    for (auto i = file.header().channels().begin(); i != file.header().channels().end(); ++i)
        got.names.insert(i.name());
    Imf::FrameBuffer pixels;
    for (const auto& [name, values] : {std::pair{"G", &got.green}, {"Z", &got.depth}}) {
        values->resize(std::size_t(got.width * got.height));
        pixels.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values->data()), 4,
                                       4 * std::size_t(got.width)));
    }
    file.setFrameBuffer(pixels);
    file.readPixels(0, got.height - 1);
    return got;
}

TEST(LightPicture, FilesHoldItAndOtherProgramsReadThem) {
    const TempDir folder;
    const std::string graph = folder.path("a.field.json"), exr = folder.path("a.exr");
    test::writeText(graph, graphOf(kSky));
    const auto made = runCommand({"render", graph, "-o", exr, "--size", "64x48", "--samples", "2"});
    ASSERT_EQ(made.status, 0) << made.errors;
    const ReadBack got = read(exr);
    EXPECT_EQ(got.names, (std::set<std::string>{"A", "B", "G", "N.X", "N.Y", "N.Z", "R", "Z", "id"}));
    const Drawn drawn = draw(kSky, {.samples = 2});
    ASSERT_EQ(got.width * got.height, kWidth * kHeight);
    for (std::size_t i = 0; i < got.green.size(); ++i) {
        ASSERT_EQ(got.green[i], drawn.light.color[4 * i + 1]);
        ASSERT_EQ(got.depth[i], drawn.light.depth[i]);
    }
    const auto header = test::runProgram("exrheader " + exr);
    ASSERT_EQ(header.status, 0) << header.output;
    for (const char* line : {"id, 32-bit unsigned integer", "N.X, 32-bit floating-point", "(63 47)"})
        EXPECT_NE(header.output.find(line), std::string::npos) << line << "\n" << header.output;
}

TEST(LightPicture, SequencesGoOnAndTheFormatMustFitTheName) {
    const TempDir folder;
    const std::string graph = folder.path("a.field.json"), frames = folder.path("frames");
    test::writeText(graph, graphOf(kSky));
    const std::vector<std::string> sequence = {"render", graph,    "-o",    frames,      "--format",
                                               "exr",    "--size", "64x48", "--samples", "1",
                                               "--to",   "0.5",    "--fps", "4"};
    const auto first = runCommand(sequence);
    ASSERT_EQ(first.status, 0) << first.errors;
    ASSERT_EQ(read(frames + "/000001.exr").width, kWidth);
    std::filesystem::resize_file(frames + "/000001.exr", 900);  // cut off
    const auto second = runCommand(sequence);
    EXPECT_NE(second.errors.find("1 of 2 frames were there already"), std::string::npos) << second.errors;
    EXPECT_EQ(read(frames + "/000001.exr").green, read(frames + "/000000.exr").green);

    expectRefusal(runCommand({"render", graph, "-o", folder.path("a.png"), "--format", "exr"}), 2, {".exr"});
    expectRefusal(runCommand({"render", graph, "-o", folder.path("a.exr"), "--format", "png"}), 2, {".png"});
    expectRefusal(runCommand({"render", graph, "-o", folder.path("a.jpg")}), 2, {".png or .exr"});
    expectRefusal(runCommand({"render", graph, "-o", folder.path("a.exr"), "--view", "ao"}), 2, {"--view"});
    expectRefusal(runCommand({"render", graph, "-o", folder.path("a.exr"), "--to", "1"}), 2,
                  {"--format exr"});
}

}  // namespace fw::light_picture_test
