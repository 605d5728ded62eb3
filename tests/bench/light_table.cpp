// The slide "Ambient occlusion": what rays cost, and what reprojection and sharing them save.
#include <cmath>

#include "graph/glsl.h"
#include "runtime/render/primary.h"
#include "tests/bench/tables.h"

namespace fw::bench {
namespace {

constexpr VkExtent3D kPicture = {1280, 720, 1};
constexpr float kDegreesAFrame = 1.0f;
constexpr double kMostOfAllRays = 0.2, kMostOfUnshared = 0.7;

struct Way {
    const char* name;
    const char* slide;
    AmbientOptions options;
};

AmbientOptions with(int raysNew, bool reproject, bool balance) {
    AmbientOptions options{.radius = 0.5f, .bias = 0.02f, .samples = 8, .raysNew = raysNew};
    options.reproject = reproject;
    options.balance = balance;
    return options;
}

Image newImage(const Device& device, VkFormat format) {
    Image image = createImage(device, {.extent = kPicture, .format = format});
    Commands commands(device);
    imageBarrier(commands, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    submit(commands);
    return image;
}

/// Once around the tower, a degree a frame.
PrimaryCamera cameraAt(int frame) {
    const float angle = float(frame) * kDegreesAFrame * 3.14159265f / 180;
    return {.eye = 7.0f * glm::vec3(std::sin(angle), 0.5f, std::cos(angle)), .target = glm::vec3(0)};
}

}  // namespace

void lightTable(Bench& bench) {
    const Device& device = bench.device();
    const std::optional<Program> program = benchProgram(bench, Field::tower);
    if (!program) return;
    const std::string field = emitField(*program);
    const Pipeline primary = createPrimary(device, field);
    const Image depth = newImage(device, VK_FORMAT_R32_SFLOAT), normal = newImage(device, VK_FORMAT_R32_UINT);
    const Way ways[] = {{"16 rays a pixel", "30", with(16, false, false)},
                        {"1 ray, reprojected", "2", with(1, true, false)},
                        {"1 ray, reprojected, 16 in holes", "12", with(16, true, false)},
                        {"the same, shared by the lanes of a tile", "4", with(16, true, true)}};
    Table table{.title = "Ambient occlusion, 1280 x 720, tower, the camera moving (ms)",
                .header = {"way", "the slide", "of 16 rays, slide", "primary rays", "ambient", "of 16 rays"}};
    double all = 0, unshared = 0, shared = 0;
    for (const Way& way : ways) {
        Ambient ambient = createAmbient(device, field, way.options);
        int frame = 0;
        Figure traced;
        const Figure figure = measure(bench.options.repeats, [&] {
            const PrimaryCamera camera = cameraAt(frame++);
            Commands commands(device, true);
            drawPrimary(commands, primary, camera, 1.0f, depth, normal);
            drawAmbient(commands, ambient,
                        {.depth = depth,
                         .normal = normal,
                         .view = viewOf(camera, float(kPicture.width) / float(kPicture.height))});
            submit(commands);
            traced.runs.push_back(commands.stages[0].milliseconds);
            return commands.stages[1].milliseconds;
        });
        std::ranges::sort(traced.runs);
        if (&way == &ways[0]) all = figure.median();
        if (&way == &ways[2]) unshared = figure.median();
        if (&way == &ways[3]) shared = figure.median();
        table.rows.push_back({way.name, way.slide, number(std::stod(way.slide) / 30), number(traced.median()),
                              text(figure), number(figure.median() / all)});
    }
    const auto verdict = [](double ratio, double most) { return ratio <= most ? "met" : "missed"; };
    table.notes = {
        "The slide: a GeForce 570, its own scene. Rays of half a metre, at most 8 samples each; the camera "
        "turns by " +
            number(kDegreesAFrame) + " degree a frame.",
        "Shared, of 16 rays everywhere: at most " + number(kMostOfAllRays) + " wanted, " +
            verdict(shared / all, kMostOfAllRays) + " (" + number(shared / all) + ").",
        "Shared, of the same unshared: at most " + number(kMostOfUnshared) + " wanted, " +
            verdict(shared / unshared, kMostOfUnshared) + " (" + number(shared / unshared) + ")."};
    print(table, bench.options.markdown);
}

}  // namespace fw::bench
