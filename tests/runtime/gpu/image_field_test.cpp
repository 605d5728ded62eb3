// Images on the device: a sample equals the CPU reference, and so do the colours of a solid that wears a
// picture.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "graph/document/json.h"
#include "runtime/play/session.h"
#include "tests/support/device_field.h"
#include "tests/support/gpu.h"

namespace fw::image_field_test {

const std::string kSamples = std::string(FIELDWRIGHT_SOURCE_DIR) + "/samples/";

Program programOf(const Result<Graph>& graph) {
    EXPECT_TRUE(graph) << format(graph.error());
    const Result<Program> program = compile(*graph);
    EXPECT_TRUE(program) << format(program.error());
    return *program;
}
Program brickBlock() { return programOf(readGraph(kSamples + "brick_block.field.json", nullptr)); }

std::vector<std::array<float, 3>> randomPoints(int count, float reach) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(-reach, reach);
    std::vector<std::array<float, 3>> points(static_cast<std::size_t>(count));
    for (auto& point : points)
        for (float& c : point) c = unit(random);
    return points;
}
Point wide(const std::array<float, 3>& p) { return {p[0], p[1], p[2]}; }

TEST(ImageField, SamplesEqualTheReference) {
    // Two images in one buffer; the second call samples the one behind the first.
    const Program program = programOf(parseGraph(
        R"({"fieldwright": 1, "nodes": [{"id": "e", "type": "expression",
            "code": "return image_color(\"textures/brick.png\", p.x, p.y * 0.7).y + 2.0 * image_grey(\"\", p.zx * 0.3) + 0.5 * image_grey(\"textures/brick.png\", p.yz);"},
            {"id": "out", "type": "output", "inputs": {"surface": {"from": "e"}}}]})",
        kSamples + "test.field.json", nullptr));
    ASSERT_EQ(program.ir.images().size(), 2u);
    const auto points = randomPoints(50'000, 3.0f);
    const float halfSize = 0.002f;
    const auto samples = test::evaluateOnDevice(program, points, halfSize);
    double least = 1e9, most = -1e9, narrowest = 1e9;
    int oblique = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Point p = wide(points[i]);
        ValueGradient wanted;
        evaluateGradient(program.ir, program.distance(), {}, std::span(&p, 1), std::span(&wanted, 1));
        least = std::min(least, wanted.value), most = std::max(most, wanted.value);
        ASSERT_NEAR(samples[i].value, wanted.value, 1e-4);
        ASSERT_NEAR(samples[i].rowValue, wanted.value, 1e-4);
        ASSERT_LE(samples[i].interval[0], wanted.value + 1e-6);
        ASSERT_GE(samples[i].interval[1], wanted.value - 1e-6);
        narrowest = std::min(narrowest, double(samples[i].interval[1] - samples[i].interval[0]));
        for (int axis = 0; axis < 3; ++axis)  // which changes from pixel to pixel: at a border either may be
            oblique +=
                std::abs(samples[i].gradient[std::size_t(axis)] - wanted.gradient[std::size_t(axis)]) > 1e-2;
    }
    EXPECT_GT(most - least, 1.0);
    EXPECT_LT(narrowest, 0.8);
    EXPECT_LT(oblique, 150);
}

TEST(ImageField, ColorsOfATexturedSolidEqualTheReference) {
    const Program program = brickBlock();
    const auto points = randomPoints(20'000, 1.2f);
    const auto samples = test::evaluateOnDevice(program, points, 0.01f);
    int far = 0;
    double least = 1.0, most = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t channel = 0; channel < 3; ++channel) {
            const double wanted =
                evaluate(program.ir, program.surface[baseColorComponent + channel], {}, wide(points[i]));
            least = std::min(least, wanted), most = std::max(most, wanted);
            far += !(std::abs(samples[i].baseColor[channel] - wanted) <= 1e-3);
        }
    EXPECT_LE(far, 60);  // where a side gives way to its mirror image
    EXPECT_GT(most - least, 0.4);
}

TEST(ImageField, MeshesAndPicturesShowTheTexture) {
    Result<Device> device = createDevice({});
    ASSERT_TRUE(device);
    Session session(std::move(*device));
    session.setProgram(brickBlock());
    const Result<MesherResult> result = session.polygonise({std::nullopt, 48});
    ASSERT_TRUE(result) << format(result.error());
    const Mesh mesh = session.download(*result);
    ASSERT_EQ(mesh.colors.size(), mesh.positions.size());
    const Program& program = session.program();
    int far = 0;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const Point p{mesh.positions[i].x, mesh.positions[i].y, mesh.positions[i].z};
        for (int channel = 0; channel < 3; ++channel)
            far += !(std::abs(mesh.colors[i][channel] -
                              evaluate(program.ir, program.surface[std::size_t(baseColorComponent + channel)],
                                       {}, p)) <= 2e-3);
    }
    EXPECT_LE(far, int(mesh.positions.size() / 100));

    const Result<Picture> picture = session.render(*result, {.width = 160, .height = 90});
    ASSERT_TRUE(picture) << format(picture.error());
    int red = 0, other = 0;
    for (std::size_t i = 0; i < picture->pixels.size(); i += 4) {
        const uint8_t* pixel = &picture->pixels[i];
        (pixel[0] > 1.7 * pixel[2] ? red : other) += 1;
    }
    EXPECT_GT(red, 160 * 90 / 10);
    EXPECT_GT(other, 160 * 90 / 3);

    // Another program of the session samples other pictures, or none.
    session.setProgram(programOf(parseGraph(
        R"({"fieldwright": 1, "nodes": [{"id": "s", "type": "sphere"}, {"id": "c", "type": "triplanar"},
            {"id": "m", "type": "material", "inputs": {"surface": {"from": "s"}, "base_color": {"from": "c"}}},
            {"id": "out", "type": "output", "inputs": {"surface": {"from": "m"}}}]})",
        "checker.field.json", nullptr)));
    const Result<MesherResult> again = session.polygonise({std::nullopt, 24});
    ASSERT_TRUE(again) << format(again.error());
    const Mesh grey = session.download(*again);
    ASSERT_FALSE(grey.colors.empty());
    for (const glm::vec3& color : grey.colors) {
        ASSERT_NEAR(color.x, color.z, 1e-6);
        ASSERT_GT(color.x, 0.3);
    }
}

}  // namespace fw::image_field_test
