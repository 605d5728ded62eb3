// Views besides the picture: that they show what surfaces are where they are, and the mean of their samples.
#include "tests/support/drawn.h"

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

}  // namespace fw::views_test
