// Views besides the picture: that they show what surfaces are where they are, the mean of their samples, and
// how wide walls and gaps are.
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "tests/support/drawn.h"
#include "tests/support/graph/expression_graph.h"

namespace fw::views_test {

using test::drawnBy;

/// A wall that stands on a step, looked at along the step's top.
std::string step(const std::string& scene) {
    return R"({"fieldwright": 1, "nodes": [
      {"id": "step", "type": "box", "inputs": {"half_extents": [2, 0.3, 2]}},
      {"id": "wall", "type": "box", "inputs": {"half_extents": [1.3, 1, 0.4]}},
      {"id": "back", "type": "translate", "inputs": {"surface": {"from": "wall"}, "offset": [0.1, 0.5, -1]}},
      {"id": "both", "type": "union", "inputs": {"a": {"from": "step"}, "b": {"from": "back"}}},
      {"id": "out", "type": "output", "inputs": {"surface": {"from": "both"}, "resolution": 24}}],
     "scene": {"camera": {"position": [1.2, 0.5, 0.6], "target": [-0.1, 0.3, -0.6], "fov": 50}, "ao": {"radius": 0.5})" +
           scene + "}}";
}

TEST(Views, OfASeamShowNeitherSideThroughTheOther) {
    RenderOptions options{
        .width = 240, .height = 160, .samples = 4, .primary = Primary::drawn, .show = RENDER_AMBIENT};
    const Picture open = drawnBy(step(""), options);
    // The bevel of the mesh lies before both sides. A point that was taken for one behind it would see
    // nothing.
    const auto dark = [](const Picture& picture) {
        int count = 0;
        for (std::size_t i = 0; i < picture.pixels.size(); i += 4) count += picture.pixels[i] < 90;
        return count;
    };
    EXPECT_LE(dark(open), 5) << "of " << open.width * open.height;
}

TEST(Views, WithoutLightAreTheMeanOfTheirSamplesWhateverLightTheSceneAsksFor) {
    RenderOptions options{.width = 64, .height = 48, .samples = 4, .reference = true, .show = RENDER_AMBIENT};
    const Picture plain = drawnBy(step(""), options);
    EXPECT_EQ(drawnBy(step(R"(, "reflections": true)"), options).pixels, plain.pixels);
    EXPECT_EQ(drawnBy(step(R"(, "bounce": true)"), options).pixels, plain.pixels);
    options.show = RENDER_NORMALS;
    EXPECT_EQ(drawnBy(step(R"(, "bounce": true, "reflections": true)"), options).pixels,
              drawnBy(step(""), options).pixels);
}

/// What views of widths show in the middle of a picture.
struct Widths {
    static constexpr float kLeast = 0.2f;

    explicit Widths(const std::string& code) {
        Result<Device> device = createDevice({.validation = true});
        EXPECT_TRUE(device);
        record = device->record;
        Result<Player> made =
            Player::create(test::expressionGraph(code), std::move(*device), {.resolution = 128});
        EXPECT_TRUE(made) << format(made.error());
        player.emplace(std::move(*made));
    }
    ~Widths() {
        player.reset();
        for (const std::string& message : record->messages) ADD_FAILURE() << "validation layer: " << message;
    }

    /// At `place`, whose normal is n, seen from `away` of it: what the colour is before it is shaded.
    glm::vec3 color(uint32_t view, Triple place, glm::vec3 n, Triple away) {
        RenderOptions options{.width = 33, .height = 33, .samples = 1, .show = view, .leastWidth = kLeast};
        Camera camera;
        camera.target = place;
        for (std::size_t i = 0; i < 3; ++i) camera.position[i] = place[i] + away[i];
        options.scene.camera = camera;
        const Result<Picture> drawn = player->frame(options);
        EXPECT_TRUE(drawn) << format(drawn.error());
        const uint8_t* middle = &drawn->pixels[4 * (16 * 33 + 16)];
        const float shade = 0.6f + 0.4f * glm::dot(n, glm::normalize(vector(away)));
        return glm::vec3(middle[0], middle[1], middle[2]) / (255.0f * shade);
    }

    std::optional<Player> player;
    std::shared_ptr<DeviceRecord> record;
};

void expectWidth(glm::vec3 color, float width) {
    EXPECT_LT(glm::length(color - gpu::widthColor(width / Widths::kLeast)), 0.02f)
        << width << " is shown as " << 255.0f * color.x << " " << 255.0f * color.y << " " << 255.0f * color.z;
}

constexpr glm::vec3 kUnfaced(0.75f);

TEST(Views, OfThicknessShowHowThickEachWallIs) {
    // Plates of several widths beside each other, the last of two that touch.
    std::string code = "d = 1e3;";
    const float halves[] = {0.05f, 0.09f, 0.13f, 0.28f, 0.5f};
    for (int i = 0; i < 5; ++i)
        code += " d = min(d, distance(box(p - vec3(" + std::to_string(i) + ", 0, 0), vec3(0.4, 1, " +
                std::to_string(halves[i]) + "))));";
    code +=
        " d = min(d, distance(box(p - vec3(5, 0, 0.1), vec3(0.4, 1, 0.1))));"
        " d = min(d, distance(box(p - vec3(5, 0, -0.05), vec3(0.4, 1, 0.05))));"
        " return d;";
    Widths widths(code);
    for (int i = 0; i < 5; ++i)
        expectWidth(
            widths.color(RENDER_THICKNESS, {double(i), 0.3, double(halves[i])}, {0, 0, 1}, {0.3, 0.2, 3}),
            2.0f * halves[i]);
    expectWidth(widths.color(RENDER_THICKNESS, {5, 0.3, 0.2}, {0, 0, 1}, {0, 0.2, 3}), 0.3f);
}

TEST(Views, OfGapsShowHowFarTheNextWallIs) {
    Widths widths(
        "d = distance(box(p - vec3(-0.35, 0, 0), vec3(0.2, 1, 1)));"
        "d = min(d, distance(box(p - vec3(0.35, 0, 0), vec3(0.2, 1, 1))));"
        "d = min(d, distance(box(p - vec3(0, -0.9, 0), vec3(0.5, 0.1, 1)))); return d;");
    expectWidth(widths.color(RENDER_GAP, {-0.15, 0.8, 0}, {1, 0, 0}, {2, 4, 0}), 0.3f);
    expectWidth(widths.color(RENDER_GAP, {-0.55, 0.8, 0}, {-1, 0, 0}, {-3, 1, 0}),
                10.0f);  // nothing is there
}

TEST(Views, OfWidthsLeaveOutWhatDoesNotFaceTheSurface) {
    // A wedge of 20 degrees is as thin as its tip; one of 70 is none.
    const auto wedge = [](float degrees) {
        const float angle = glm::radians(degrees);
        return "d = max(-p.y, p.y * " + std::to_string(std::cos(angle)) + " - p.x * " +
               std::to_string(std::sin(angle)) + ", p.x - 1, abs(p.z) - 1); return d;";
    };
    Widths sharp(wedge(20.0f)), blunt(wedge(70.0f));
    const float within = 0.4f * std::tan(glm::radians(20.0f));
    expectWidth(sharp.color(RENDER_THICKNESS, {0.4, 0, 0}, {0, -1, 0}, {0, -3, 0.1}), within);
    const glm::vec3 grey = blunt.color(RENDER_THICKNESS, {0.2, 0, 0}, {0, -1, 0}, {0, -3, 0.1});
    EXPECT_LT(glm::length(grey - kUnfaced), 0.02f) << grey.x << " " << grey.y << " " << grey.z;
}

}  // namespace fw::views_test
