// Pictures: what they show, that they are the same every time, and what `fieldwright render` says when there
// can be none. Images are judged by where the solid is and how light falls, not pixel by pixel.
#include <gtest/gtest.h>
#include <stb/stb_image.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <numbers>

#include "graph/assets/image.h"
#include "graph/document/json.h"
#include "graph/emit/glsl.h"
#include "runtime/play/session.h"
#include "runtime/render/renderer.h"
#include "runtime/render/view.h"
#include "tests/support/gpu.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::render_test {

using test::TempDir;

constexpr int kWidth = 160, kHeight = 120;

std::string graphText(const std::string& nodes) { return R"({"fieldwright": 1, "nodes": [)" + nodes + "]}"; }

/// A red ball; the backdrop is grey, so that redness tells the two apart.
const std::string kBall = graphText(R"(
    {"id": "ball", "type": "sphere", "inputs": {"radius": 0.7}},
    {"id": "red", "type": "material", "inputs": {"surface": {"from": "ball"}, "base_color": [0.8, 0.02, 0.02]}},
    {"id": "out", "type": "output", "inputs": {"surface": {"from": "red"}}})");

Result<Picture> draw(const std::string& text, MeshRequest request = {{}, 48},
                     RenderOptions options = {.width = kWidth, .height = kHeight}) {
    const Result<Graph> graph = parseGraph(text, "", nullptr);
    EXPECT_TRUE(graph) << format(graph.error());
    Result<Program> program = compile(*graph);
    EXPECT_TRUE(program) << format(program.error());
    Result<Device> device = createDevice({.validation = true});
    EXPECT_TRUE(device);
    const auto record = device->record;
    Result<Picture> picture = [&] {
        Session session(std::move(*device));
        session.setProgram(std::move(*program));
        const Result<MesherResult> mesh = session.polygonise(request);
        EXPECT_TRUE(mesh) << format(mesh.error());
        return session.render(*mesh, options);
    }();
    for (const std::string& message : record->messages) ADD_FAILURE() << "validation layer: " << message;
    return picture;
}

glm::ivec3 pixel(const Picture& picture, int x, int y) {
    const uint8_t* at =
        picture.pixels.data() + 4 * (std::size_t(y) * std::size_t(picture.width) + std::size_t(x));
    return {at[0], at[1], at[2]};
}
bool red(const Picture& picture, int x, int y) {
    const glm::ivec3 p = pixel(picture, x, y);
    return p.r > p.g + 25 && p.r > p.b + 25;
}
int brightness(glm::ivec3 p) { return p.r + p.g + p.b; }

TEST(Render, ABallIsARoundDiscInTheMiddle) {
    const Result<Picture> picture = draw(kBall);
    ASSERT_TRUE(picture) << format(picture.error());
    ASSERT_EQ(picture->pixels.size(), 4u * kWidth * kHeight);
    double count = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
    for (int j = 0; j < kHeight; ++j)
        for (int i = 0; i < kWidth; ++i)
            if (red(*picture, i, j)) {
                const double u = i + 0.5 - 0.5 * kWidth, v = j + 0.5 - 0.5 * kHeight;
                count += 1, x += u, y += v, xx += u * u, yy += v * v, xy += u * v;
            }
    // It fills its share of the picture's height, is centred, and as wide as high: a disc's second moment is
    // r^2 / 4.
    const double radius = std::sqrt(count / 3.14159265);
    EXPECT_NEAR(radius, 0.5 * kHeight * 0.81, 2.0);
    EXPECT_NEAR(x / count, 0.0, 0.75);
    EXPECT_NEAR(y / count, 0.0, 0.75);
    EXPECT_NEAR(xx / count, radius * radius / 4, 0.03 * radius * radius);
    EXPECT_NEAR(yy / count, radius * radius / 4, 0.03 * radius * radius);
    EXPECT_NEAR(xy / count, 0.0, 0.01 * radius * radius);
    // Its outline is the same to the left and to the right, to within the edge's own pixel.
    int unequal = 0;
    for (int j = 0; j < kHeight; ++j)
        for (int i = 0; i < kWidth / 2; ++i)
            unequal += red(*picture, i, j) != red(*picture, kWidth - 1 - i, j);
    EXPECT_LT(unequal, kHeight);
}

TEST(Render, TheSunStandsLeftAndTheShadowLiesRight) {
    const Result<Picture> picture = draw(kBall);
    ASSERT_TRUE(picture);
    const int middle = kHeight / 2, inside = int(0.3 * kHeight);
    EXPECT_GT(brightness(pixel(*picture, kWidth / 2 - inside, middle)),
              1.3 * brightness(pixel(*picture, kWidth / 2 + inside, middle)));
    // The ground right of the ball is darker than left of it, and both are grey.
    const int ground = int(0.7 * kHeight), outside = int(0.47 * kHeight);
    const glm::ivec3 lit = pixel(*picture, kWidth / 2 - outside, ground),
                     dark = pixel(*picture, kWidth / 2 + outside, ground);
    EXPECT_GT(brightness(lit), 1.15 * brightness(dark));
    EXPECT_LT(std::abs(lit.r - lit.b), 30);
    // No light is lost and none is burnt out on the backdrop.
    for (int i = 0; i < kWidth; ++i) {
        EXPECT_GT(brightness(pixel(*picture, i, 0)), 3 * 90);
        EXPECT_LT(brightness(pixel(*picture, i, kHeight - 1)), 3 * 250);
    }
}

TEST(Render, ShadesSmoothlyWithoutAcne) {
    const Result<Picture> picture = draw(kBall);
    ASSERT_TRUE(picture);
    // Well within the disc neighbours differ little: no speckles, no bands. The highlight is the steepest
    // part.
    const int inner = int(0.3 * kHeight);
    for (int v = -inner; v < inner; ++v)
        for (int u = -inner; u < inner; ++u) {
            if (u * u + v * v > inner * inner) continue;
            const glm::ivec3 here = pixel(*picture, kWidth / 2 + u, kHeight / 2 + v);
            const glm::ivec3 next = pixel(*picture, kWidth / 2 + u + 1, kHeight / 2 + v);
            const glm::ivec3 below = pixel(*picture, kWidth / 2 + u, kHeight / 2 + v + 1);
            ASSERT_LT(std::abs(here.r - next.r), 22) << u << ' ' << v;
            ASSERT_LT(std::abs(here.r - below.r), 22) << u << ' ' << v;
        }
}

TEST(Render, OcclusionAboutARestingBallIsAsItsClosedFormSays) {
    // On the ground, d from where a ball of radius R rests: open is 1 - (1 + (d/R)^2)^(-3/2).
    constexpr double kRadius = 0.7;
    RenderOptions options{.width = kWidth, .height = kHeight, .show = RENDER_AMBIENT};
    options.scene.camera = Camera{.position = {0.5, 5.0, 2.0}, .target = {0, -0.7, 0}, .fov = 36};
    options.scene.ao = AmbientOcclusion{.radius = 6.0};
    const gpu::View view = cameraView(*options.scene.camera, SeenBounds{}, float(kWidth) / kHeight);
    for (const bool reference : {false, true}) {
        options.reference = reference;
        const Result<Picture> picture = draw(kBall, {{}, 48}, options);
        ASSERT_TRUE(picture) << format(picture.error());
        double sum = 0, most = 0;
        int count = 0;
        for (int j = 0; j < kHeight; ++j)
            for (int i = 0; i < kWidth; ++i) {
                const glm::vec2 place = (glm::vec2(i, j) + 0.5f) / glm::vec2(kWidth, kHeight) * 2.0f - 1.0f;
                const glm::vec3 ray = view.forward + place.x * view.right - place.y * view.up;
                const glm::vec3 p = view.eye + ray * ((float(-kRadius) - view.eye.y) / ray.y);
                const double d = std::hypot(p.x, p.z) / kRadius;
                // Neither behind the ball nor where the ground has faded.
                if (glm::length(glm::cross(glm::normalize(ray), -view.eye)) < 1.05 * kRadius || d > 2.5)
                    continue;
                const double open = decodeSrgb(pixel(*picture, i, j).r / 255.0);
                const double off = std::abs(open - (1.0 - std::pow(1.0 + d * d, -1.5)));
                sum += off, most = std::max(most, off), ++count;
            }
        ASSERT_GT(count, 1000);
        std::printf("about a resting ball, %s: mean difference %.4f, greatest %.4f over %d pixels\n",
                    reference ? "reference" : "still", sum / count, most, count);
        EXPECT_LT(sum / count, 0.015);
        EXPECT_LT(most, 0.1);
    }
}

TEST(Render, TheWireframeIsDrawnHoweverThePictureIsMade) {
    // Its edges are dark, and the same for every way of finding depth.
    const MeshRequest coarse{{}, 12};
    RenderOptions options{.width = kWidth, .height = kHeight, .samples = 2};
    options.primary = Primary::drawn;
    const Result<Picture> plain = draw(kBall, coarse, options);
    options.show = RENDER_WIREFRAME;
    const Result<Picture> drawn = draw(kBall, coarse, options);
    options.primary = Primary::traced;
    const Result<Picture> traced = draw(kBall, coarse, options);
    options.reference = true;
    const Result<Picture> reference = draw(kBall, coarse, options);
    ASSERT_TRUE(plain && drawn && traced && reference);
    EXPECT_EQ(traced->pixels, drawn->pixels);
    int edges = 0, missing = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const bool edge = red(*plain, x, y) && pixel(*drawn, x, y) != pixel(*plain, x, y);
            edges += edge;
            // Beside its more exact ambient occlusion the reference has the same edges.
            missing += edge && std::abs(pixel(*reference, x, y).r - pixel(*drawn, x, y).r) > 8;
        }
    EXPECT_GT(edges, 500);
    EXPECT_LT(missing, edges / 100);
}

TEST(Render, FromBelowThereIsNoGround) {
    RenderOptions options{.width = kWidth, .height = kHeight, .samples = 2};
    options.scene.sky = Sky{};
    for (const double height : {-3.0, 3.0}) {
        options.scene.camera = Camera{.position = {1, height, 4}, .target = {0, 0, 0}, .fov = 40};
        options.scene.ground = Ground{};
        const Result<Picture> with = draw(kBall, {{}, 24}, options);
        options.scene.ground.reset();
        const Result<Picture> without = draw(kBall, {{}, 24}, options);
        ASSERT_TRUE(with && without);
        EXPECT_EQ(with->pixels == without->pixels, height < 0) << height;
    }
}

TEST(Render, WhatIsOutOfFocusIsBlurredAsTheLensSays) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    // The edge of a plate four metres away. Of a disc's blur, half as wide as the disc is far from the focus,
    // nine tenths less a tenth of the change lie within 0.687 of its width.
    RenderOptions options{.width = 320, .height = 40, .samples = 128, .show = RENDER_BASE};
    Scene& scene = options.scene;
    scene.ao.reset(), scene.sun.reset(), scene.ground.reset();
    const auto width = [&](double aperture, double focus) {
        scene.camera = Camera{
            .position = {0, 0, 4}, .target = {0, 0, 0}, .fov = 8, .aperture = aperture, .focus = focus};
        const Result<Picture> picture = draw(R"({"fieldwright": 1, "nodes": [
          {"id": "box", "type": "box", "inputs": {"half_extents": [3, 1, 0.4]}},
          {"id": "half", "type": "translate", "inputs": {"surface": {"from": "box"}, "offset": [3, 0, -0.4]}},
          {"id": "red", "type": "material", "inputs": {"surface": {"from": "half"}, "base_color": [0.9, 0, 0]}},
          {"id": "out", "type": "output", "inputs": {"surface": {"from": "red"}}}]})",
                                             {{}, 32}, options);
        EXPECT_TRUE(picture) << format(picture.error());
        int within = 0;
        for (int x = 0; picture && x < options.width; ++x) {
            const double share = (decodeSrgb(pixel(*picture, x, 20).r / 255.0) - 0.1) / 0.8;
            within += share > 0.1 && share < 0.9;
        }
        return within * (2.0 * 4.0 * std::tan(4.0 * std::numbers::pi / 180.0) / options.height);  // metres
    };
    EXPECT_LT(width(0.4, 0.0), 0.03);  // in focus, as far as the target
    EXPECT_LT(width(0.0, 2.0), 0.03);
    EXPECT_NEAR(width(0.4, 2.0), 0.687 * 0.4, 0.05);
    EXPECT_NEAR(width(0.4, 8.0), 0.687 * 0.2, 0.04);
    EXPECT_NEAR(width(0.8, 8.0), 0.687 * 0.4, 0.05);
}

/// What is seen of a sky of one colour, beside the solid.
glm::ivec3 skyOf(const Triple& color, Tone tone) {
    RenderOptions options{.width = kWidth, .height = kHeight, .samples = 1};
    Scene& scene = options.scene;
    scene.camera = Camera{.position = {0, 0, 9}, .target = {0, 0, 0}, .fov = 40};
    scene.ground.reset();
    scene.sky = Sky{color, color, color, 1.0};
    scene.exposure = -std::log2(0.66);  // a factor of 1
    scene.tone = tone;
    const Result<Picture> picture = draw(kBall, {{}, 16}, options);
    return picture ? pixel(*picture, 3, 3) : glm::ivec3(-1);
}

TEST(Render, NeutralToneIsItsFormulaAndKeepsHues) {
    // Below 0.8 what is chosen less a highlight's 4 %; of what is darker, as its least colour tells.
    const auto expectBytes = [](const glm::ivec3& seen, const glm::dvec3& linear) {
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], 255.0 * encodeSrgb(linear[c]), 1.5) << c;
    };
    expectBytes(skyOf({0.5, 0.3, 0.1}, Tone::neutral), {0.46, 0.26, 0.06});
    expectBytes(skyOf({0.5, 0.3, 0.04}, Tone::neutral), {0.47, 0.27, 0.01});
    // Of a bright one what is left is 1 - 0.24^2 / (1.96 + 0.24 - 0.76) = 0.96, and 0.13043 of it bleaches.
    const double left = 0.96, white = 1.0 - 1.0 / (0.15 * (1.96 - left) + 1.0);
    expectBytes(skyOf({2.0, 1.0, 0.1}, Tone::neutral),
                glm::mix(glm::dvec3(1.96, 0.96, 0.06) * (left / 1.96), glm::dvec3(left), white));
    // Hue: how far green stands between blue and red.
    const auto hue = [](const glm::ivec3& seen) {
        const glm::dvec3 linear(decodeSrgb(seen.r / 255.0), decodeSrgb(seen.g / 255.0),
                                decodeSrgb(seen.b / 255.0));
        return (linear.g - linear.b) / (linear.r - linear.b);
    };
    const Triple orange = {16.0, 4.0, 0.4};
    const double wanted = (4.0 - 0.4) / (16.0 - 0.4);
    EXPECT_NEAR(hue(skyOf(orange, Tone::neutral)), wanted, 0.03);
    EXPECT_GT(hue(skyOf(orange, Tone::aces)), wanted + 0.3);
}

TEST(Render, LightBeyondAllMeasureIsWhite) {
    RenderOptions options{.width = kWidth, .height = kHeight, .samples = 2};
    Scene& scene = options.scene;
    scene.exposure = kMostExposure;
    scene.ao.reset();  // no light at all reaches what sees none of the sky
    scene.camera = Camera{.position = {0, 0, 4}, .target = {0, 0, 0}, .fov = 30};
    constexpr Triple kBrightest = {kMostSceneNumber, kMostSceneNumber, kMostSceneNumber};
    scene.sun = Sun{.azimuth = 0, .elevation = 20, .color = kBrightest, .strength = kMostSceneNumber};
    scene.sky = Sky{kBrightest, kBrightest, kBrightest, kMostSceneNumber};
    for (const bool lamps : {false, true}) {
        if (lamps) {
            scene.lights = {Lamp{.position = {0, 0, 3}, .color = kBrightest, .strength = kMostSceneNumber}};
            scene.fog = Fog{.density = 0.1, .color = kBrightest};
        }
        const Result<Picture> picture = draw(kBall, {{}, 24}, options);
        ASSERT_TRUE(picture);
        EXPECT_TRUE(std::all_of(picture->pixels.begin(), picture->pixels.end(),
                                [](uint8_t byte) { return byte >= 254; }));
    }
}

TEST(Render, TheReachOfOcclusionIsKeptToTheSolidsSize) {
    // Farther than its rays can end, and nearer than single precision can tell from none.
    RenderOptions options{.width = kWidth, .height = kHeight, .samples = 2, .show = RENDER_AMBIENT};
    const auto within = [&](double radius) {
        options.scene.ao = AmbientOcclusion{.radius = radius};
        const Result<Picture> picture = draw(kBall, {{}, 24}, options);
        EXPECT_TRUE(picture);
        return picture ? *picture : Picture{};
    };
    const Picture least = within(1e-5), far = within(kMostSceneNumber);
    for (const double tiny : {1e-30, 1e-200}) EXPECT_TRUE(within(tiny).pixels == least.pixels) << tiny;
    EXPECT_TRUE(far.pixels == within(1e5).pixels);
    // What sees no farther than a thousandth of the solid sees next to none of it.
    double open = 0, openFar = 0;
    for (const uint8_t byte : least.pixels) open += byte;
    for (const uint8_t byte : far.pixels) openFar += byte;
    EXPECT_GT(open, 0.98 * 255 * double(least.pixels.size()));
    EXPECT_LT(openFar, 0.97 * open);
}

TEST(Render, IsTheSameBytesEachTime) {
    const Result<Picture> a = draw(kBall), b = draw(kBall);
    ASSERT_TRUE(a && b);
    EXPECT_EQ(a->pixels, b->pixels);
}

TEST(Render, FramesEveryPointOfAnyMeshInAnyFormat) {
    const glm::vec3 sizes[] = {
        {1, 1, 1}, {8, 0.1f, 0.1f}, {0.1f, 30, 0.1f}, {5, 0.01f, 9}, {1e-3f, 1e-3f, 2e-3f}};
    for (const glm::vec3 size : sizes)
        for (const float aspect : {0.25f, 1.0f, 16.0f / 9, 5.0f}) {
            std::vector<gpu::MeshVertex> corners;
            for (int i = 0; i < 8; ++i)
                corners.push_back({glm::vec3(i & 1, i >> 1 & 1, i >> 2) * size + glm::vec3(3, -2, 1), 0});
            const gpu::View view = framingView(corners, aspect);
            float reached = 0;
            for (const gpu::MeshVertex& corner : corners) {
                const glm::vec3 v = corner.position - view.eye;
                const float along = glm::dot(v, view.forward);
                EXPECT_GT(along, view.near);
                const auto place = [&](glm::vec3 axis) {
                    return std::abs(glm::dot(v, axis)) / (glm::dot(axis, axis) * along);
                };
                reached = std::max({reached, place(view.right), place(view.up)});
            }
            EXPECT_LT(reached, 0.9f);
            EXPECT_GT(reached, 0.7f);
            EXPECT_EQ(boundsOf(corners).foot, -2.0f);
        }
}

TEST(Render, LiveParametersReachTheShading) {
    // The material's colour is live: another value, another colour, no new pipeline.
    const Result<Graph> graph = parseGraph(kBall, "", nullptr);
    ASSERT_TRUE(graph);
    CompileOptions options;
    options.live = {"red.base_color"};
    Result<Program> program = compile(*graph, options);
    ASSERT_TRUE(program) << format(program.error());
    Result<Device> device = createDevice({.validation = true});
    ASSERT_TRUE(device);
    Session session(std::move(*device));
    session.setProgram(std::move(*program));
    const Result<MesherResult> mesh = session.polygonise({{}, 24});
    ASSERT_TRUE(mesh);
    const RenderOptions small{.width = 64, .height = 64};
    EXPECT_TRUE(red(*session.render(*mesh, small), 32, 32));
    session.setParameter(0, 0.02);
    session.setParameter(1, 0.8);
    const Result<Picture> green = session.render(*mesh, small);
    ASSERT_TRUE(green);
    EXPECT_GT(pixel(*green, 32, 32).g, 2 * pixel(*green, 32, 32).r);
    EXPECT_EQ(session.device().validationMessages(), std::vector<std::string>());
}

TEST(Render, StepsThatAreTooLongEndAtTheSurface) {
    // A field twice as steep as a distance, traced in whole steps: what the live view does once it has seen
    // that this shows from some side what the mesh does.
    const Result<Graph> graph = parseGraph(graphText(R"(
        {"id": "wave", "type": "expression", "code": "return length(p) - 0.5 + 0.1 * sin(10 * p.x);"},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "wave"}}})"),
                                           "", nullptr);
    ASSERT_TRUE(graph) << format(graph.error());
    const Result<Program> program = compile(*graph);
    ASSERT_TRUE(program) << format(program.error());
    EXPECT_TRUE(std::isinf(program->exactness.lipschitz));
    Result<Device> device = createDevice({.validation = true});
    ASSERT_TRUE(device);
    Session session(std::move(*device));
    session.setProgram(*program);
    const Result<MesherResult> mesh = session.polygonise({Box{{-1, -1, -1}, {1, 1, 1}}, 128});
    ASSERT_TRUE(mesh) << format(mesh.error());
    const MesherBuffers& buffers = session.meshBuffers();
    Renderer renderer = createRenderer(session.device(), emitField(*program));
    const RenderScene scene{
        .mesh = buffers,
        .vertices = mesh->vertices,
        .triangles = mesh->triangles,
        .grid = {{-1, -1, -1}, {1, 1, 1}, 2.0f / 128},
        .lipschitz = INFINITY,
        .bounds = boundsOf(download<gpu::MeshVertex>(session.device(), buffers.vertices, mesh->vertices))};
    RenderOptions options{.width = kWidth, .height = kHeight, .samples = 8, .show = RENDER_SHADOW};
    options.scene.camera = Camera{.position = {-1.7, 1.35, -1.45}};
    options.primary = Primary::drawn;
    const Result<Picture> still = renderPicture(renderer, scene, options);
    ASSERT_TRUE(still) << format(still.error());
    options.primary = Primary::measured;
    renderer.tracing = true;
    renderer.trust = 1.0f;
    Picture live;
    while (*renderLive(renderer, scene, options, &live)) {}
    double sum = 0;
    int unlike = 0;
    for (std::size_t i = 0; i < live.pixels.size(); i += 4) {
        const int difference = std::abs(live.pixels[i] - still->pixels[i]);
        sum += difference, unlike += difference > 64;
    }
    EXPECT_LT(sum / (kWidth * kHeight), 3.0);
    EXPECT_LT(unlike, 0.015 * kWidth * kHeight);
    EXPECT_EQ(session.device().validationMessages(), std::vector<std::string>());
}

TEST(Render, ASolidThatWasCutIsShadedAtTheCut) {
    // A ball cut at z = 0: the cut faces the camera and is flat, so it has one brightness.
    const Result<Picture> picture = draw(kBall, {Box{{-1, -1, -1}, {1, 1, 0}}, 48});
    ASSERT_TRUE(picture);
    const int reference = pixel(*picture, kWidth / 2, kHeight / 2).r;
    EXPECT_GT(reference, 100);
    for (int u = -8; u <= 8; ++u)
        EXPECT_NEAR(pixel(*picture, kWidth / 2 + u, kHeight / 2).r, reference, 12) << u;
}

TEST(Render, ATracedSunIsSharpInALargeScene) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    // The shadow of a post 0.2 m wide on a plate of 100 m, of which a map has one texel for several posts.
    const std::string post = graphText(R"(
        {"id": "bar", "type": "box", "inputs": {"half_extents": [0.1, 2, 0.1]}},
        {"id": "plate", "type": "box", "inputs": {"half_extents": [50, 1, 50]}},
        {"id": "low", "type": "translate", "inputs": {"surface": {"from": "plate"}, "offset": [0, -1, 0]}},
        {"id": "both", "type": "union", "inputs": {"a": {"from": "bar"}, "b": {"from": "low"}}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "both"}}})");
    RenderOptions options{.width = kWidth, .height = kHeight, .show = RENDER_SHADOW};
    options.scene.camera = {.position = {-1, 6, 1e-3}, .target = {-1, 0, 0}, .fov = 30};
    const double perPixel = 2 * 6 * std::tan(15 * std::numbers::pi / 180) / kHeight;
    for (const auto& [size, traced] : {std::pair(0.0, true), {4.0, true}, {0.0, false}}) {
        options.scene.sun = {.azimuth = 90, .elevation = 45, .size = size, .traced = traced};
        const Result<Picture> picture = draw(post, {{}, 48}, options);
        ASSERT_TRUE(picture) << format(picture.error());
        double dark = 0, half = 0;
        for (int y = 0; y < kHeight; ++y) {
            const double lit = std::pow(pixel(*picture, kWidth / 2, y).r / 255.0, 2.2);
            dark += 1 - lit;
            half += lit > 0.1 && lit < 0.9;
        }
        if (!traced) {
            EXPECT_GT(std::abs(dark * perPixel - 0.2), 0.05) << "a map would do";
            continue;
        }
        // How much light is missing does not depend on how soft the edges are.
        EXPECT_NEAR(dark * perPixel, 0.2, 0.03) << size;
        // Both edges, of a shadow cast from 1 m above.
        const double penumbra = std::sqrt(2.0) * 2 * std::tan(size / 2 * std::numbers::pi / 180);
        EXPECT_NEAR(half * perPixel, 2 * 0.75 * penumbra, 0.09) << size;
    }
}

TEST(Render, LampsLightAllOfTheGround) {
    // Beside the solid the ground has no edge between tiles that a lamp's light ends at.
    RenderOptions options{.width = 480, .height = 270, .samples = 2};
    options.scene.lights = {{.position = {1.5, 1.5, 1.5}, .strength = 20}};
    const Result<Picture> picture = draw(kBall, {{}, 48}, options);
    ASSERT_TRUE(picture) << format(picture.error());
    for (int y = 120; y < options.height; ++y)
        for (int x = 0; x < 64; ++x) {
            const int here = brightness(pixel(*picture, x, y));
            ASSERT_NEAR(brightness(pixel(*picture, x + 1, y)), here, 12) << x << " " << y;
            ASSERT_NEAR(brightness(pixel(*picture, x, y - 1)), here, 12) << x << " " << y;
        }
}

/// Live frames through these cameras, and where the last one comes to rest.
std::vector<Picture> liveFrames(const std::string& nodes, RenderOptions options,
                                std::span<const Camera> cameras) {
    const Result<Graph> graph = parseGraph(graphText(nodes), "", nullptr);
    EXPECT_TRUE(graph) << format(graph.error());
    Result<Device> device = createDevice({.validation = true});
    EXPECT_TRUE(device);
    const auto record = device->record;
    std::vector<Picture> pictures;
    {
        Session session(std::move(*device));
        session.setProgram(*compile(*graph));
        const Result<MesherResult> mesh = session.polygonise({{}, 64});
        EXPECT_TRUE(mesh) << format(mesh.error());
        for (const Camera& camera : cameras) {
            options.scene.camera = camera;
            EXPECT_TRUE(session.renderLive(*mesh, options, &pictures.emplace_back()));
        }
        Picture rested;
        for (int i = 0; i < 40; ++i) EXPECT_TRUE(session.renderLive(*mesh, options, &rested));
        pictures.push_back(rested);
    }
    for (const std::string& message : record->messages) ADD_FAILURE() << "validation layer: " << message;
    return pictures;
}

/// Mean difference, 0 to 1.
double difference(const Picture& a, const Picture& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) sum += std::abs(a.pixels[i] - b.pixels[i]) / 255.0;
    return sum / double(a.pixels.size());
}

/// From the side by so many metres a frame, to 0.
std::vector<Camera> comingFrom(double step, int frames) {
    std::vector<Camera> cameras;
    for (int i = frames - 1; i >= 0; --i)
        cameras.push_back({.position = {step * i, 0.3, 4}, .target = {step * i, 0, 0}, .fov = 30});
    return cameras;
}

TEST(Render, AViewThatMovesIsAntialiased) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    // A leaning black fence before the sky that moves by less than a pixel a frame: its edges are grey.
    const char* nodes = R"(
        {"id": "bar", "type": "box", "inputs": {"half_extents": [0.1, 1, 0.1]}},
        {"id": "row", "type": "repeat", "inputs": {"surface": {"from": "bar"}, "period": [0.4, 0, 0], "count": [5, 1, 1]}},
        {"id": "leaning", "type": "rotate", "inputs": {"surface": {"from": "row"}, "angles": [0, 0, 7]}},
        {"id": "black", "type": "material", "inputs": {"surface": {"from": "leaning"}, "base_color": [0, 0, 0], "roughness": 1}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "black"}}})";
    RenderOptions options{.width = kWidth, .height = kHeight, .primary = Primary::drawn};
    options.scene.sky = Sky{};
    options.scene.ground.reset();
    const auto greys = [](const Picture& picture) {
        int count = 0;
        for (std::size_t i = 0; i < picture.pixels.size(); i += 4)
            count += picture.pixels[i] > 60 && picture.pixels[i] < 170;
        return count;
    };
    const std::vector<Camera> slowly = comingFrom(0.007, 24);
    options.antialias = false;
    const std::vector<Picture> jagged = liveFrames(nodes, options, slowly);
    options.antialias = true;
    const std::vector<Picture> smooth = liveFrames(nodes, options, slowly);
    EXPECT_LT(greys(jagged[23]), 0.2 * greys(jagged[24]));
    EXPECT_GT(greys(smooth[23]), 0.7 * greys(smooth[24]));
    EXPECT_LT(difference(smooth[23], smooth[24]), 1.3 * difference(jagged[23], jagged[24]));
    // From elsewhere at once: what was there before is not seen any more.
    std::vector<Camera> jump(23, Camera{.position = {0.53, 0.3, 4}, .target = {0.5, 0, 0}, .fov = 30});
    for (int i = 0; i < 23; ++i) jump[std::size_t(i)].position[0] += 1e-5 * i;
    jump.push_back(slowly.back());
    const std::vector<Picture> jumped = liveFrames(nodes, options, jump);
    EXPECT_LT(difference(jumped[23], jumped[24]), 1.6 * difference(jagged[23], jagged[24]));
}

TEST(Render, FogIsRememberedWhileTheViewMoves) {
    // Posts before a low sun, seen from nearly the same place: rays of light flicker less and less.
    const char* nodes = R"(
        {"id": "post", "type": "box", "inputs": {"half_extents": [0.15, 1, 0.15]}},
        {"id": "row", "type": "repeat", "inputs": {"surface": {"from": "post"}, "period": [0.6, 0, 0], "count": [5, 1, 1]}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "row"}}})";
    RenderOptions options{.width = kWidth, .height = kHeight, .primary = Primary::drawn, .antialias = false};
    options.scene.sky = Sky{.strength = 0.1};
    options.scene.sun = {.azimuth = 180, .elevation = 12, .strength = 8};
    options.scene.fog = Fog{.density = 0.25};
    options.scene.ao.reset();
    options.scene.ground.reset();
    const std::vector<Picture> frames = liveFrames(nodes, options, comingFrom(1e-5, 16));
    EXPECT_LT(difference(frames[14], frames[15]), 0.5 * difference(frames[0], frames[1]));
    EXPECT_GT(difference(frames[0], frames[1]), 0.001);
}

TEST(Render, SizesOutOfRangeAndCancelling) {
    EXPECT_TRUE(checkPictureSize(16, 16));
    EXPECT_TRUE(checkPictureSize(7680, 4320));
    for (const auto& [width, height] : {std::pair{15, 100}, {100, 0}, {-5, 20}, {8193, 100}, {8192, 8192}})
        EXPECT_FALSE(checkPictureSize(width, height)) << width << 'x' << height;
    const std::atomic<bool> cancel = true;
    const Result<Picture> picture = draw(kBall, {{}, 16}, {.width = 32, .height = 32, .cancel = &cancel});
    ASSERT_FALSE(picture);
    EXPECT_NE(picture.error().message.find("cancelled"), std::string::npos);
}

TEST(Render, AStillIsCancelledWithinASample) {
    std::atomic<bool> cancel = false;
    int told = 0;
    const Result<Picture> picture = draw(
        kBall, {{}, 16}, {.width = 256, .height = 256, .samples = 1, .cancel = &cancel, .progress = [&](int) {
                              ++told;  // before the sample
                              cancel = true;
                          }});
    EXPECT_EQ(told, 1);
    ASSERT_FALSE(picture);
    EXPECT_EQ(picture.error().message, "cancelled");
}

TEST(Render, InPartsItLooksTheSame) {
    // A live field's first frame is drawn in parts, in case that it takes long, and the next as one.
    const Result<Graph> graph = parseGraph(kBall, "", nullptr);
    Result<Program> program = compile(*graph);
    Result<Device> device = createDevice({.validation = true});
    ASSERT_TRUE(device);
    const std::shared_ptr<DeviceRecord> record = device->record;
    Session session(std::move(*device));
    session.setProgram(std::move(*program));
    const Result<MesherResult> mesh = session.polygonise({{}, 16});
    ASSERT_TRUE(mesh);
    const auto frame = [&](Picture& picture, int wide) {
        const uint64_t before = record->waits;
        // Antialiasing over time, as hardware has it, sees each frame through other pixels.
        const Result<bool> drawn =
            session.renderLive(*mesh, {.width = wide, .height = 200, .antialias = false}, &picture);
        EXPECT_TRUE(drawn && *drawn);
        return record->waits - before;
    };
    Picture parted, whole, other;
    const uint64_t waits = frame(parted, 300);
    frame(other, 299);
    EXPECT_LT(frame(whole, 300), waits);
    // Rays of occlusion are others in each frame.
    double apart = 0, most = 0;
    for (std::size_t i = 0; i < whole.pixels.size(); ++i) {
        const double each = std::abs(double(parted.pixels[i]) - double(whole.pixels[i]));
        apart += each, most = std::max(most, each);
    }
    EXPECT_LT(apart / double(whole.pixels.size()), 1.0);
    EXPECT_LT(most, 80.0);
    EXPECT_EQ(session.device().validationMessages(), std::vector<std::string>());
}

/// Runs `fieldwright render` on a graph's text.
test::ProgramResult command(const TempDir& folder, const std::string& text, const std::string& rest) {
    test::writeText(folder.path("graph.field.json"), text);
    return test::runProgram("cd '" + folder.folder.string() + "' && FIELDWRIGHT_VALIDATION=1 '" +
                            FIELDWRIGHT_BINARY_DIR "/fieldwright' render graph.field.json " + rest);
}

TEST(RenderCommand, WritesAPngOfTheSizeAskedFor) {
    const TempDir folder;
    const auto result = command(folder, kBall, "-o ball.png --size 80x48 --resolution 24");
    EXPECT_EQ(result.status, 0) << result.output;
    EXPECT_EQ(result.output, "");
    int width = 0, height = 0, channels = 0;
    uint8_t* pixels = stbi_load(folder.path("ball.png").c_str(), &width, &height, &channels, 0);
    ASSERT_NE(pixels, nullptr);
    EXPECT_EQ(width, 80);
    EXPECT_EQ(height, 48);
    EXPECT_EQ(channels, 3);
    const uint8_t* centre = pixels + 3 * (24 * 80 + 40);
    EXPECT_GT(centre[0], 2 * centre[1]);
    stbi_image_free(pixels);
}

TEST(RenderCommand, SaysWhatIsWrong) {
    const struct {
        const char* nodes;  ///< empty: the ball
        const char* arguments;
        int status;
        const char* message;
    } rows[] = {
        {"", "-o a.png --size 100", 2, "--size 100: write width x height"},
        {"", "-o a.png --size 100x", 2, "--size 100x: write width x height"},
        {"", "-o a.png --size 100x50x2", 2, "write width x height"},
        {"", "-o a.png --size 99999999999x9", 2, "write width x height"},
        {"", "-o a.png --size 0x50", 2, "sides are from 16 to 8192 pixels"},
        {"", "-o a.png --size -5x50", 2, "sides are from 16 to 8192 pixels"},
        {"", "-o a.png --size 8192x8192", 2, "at most 33554432 in all"},
        {"", "-o a.jpg", 2, "a name that ends in .png"},
        {"", "--size 64x64", 2, "--output"},
        {"", "-o a.png --device nosuch", 2, "nosuch"},
        {"", "-o missing/a.png --size 32x32", 3,
         "missing/a.png: error: cannot create a file in folder 'missing'"},
        {"", "-o a.png --region 5 5 5 6 6 6", 1, "does not pass through the region"},
        {R"({"id": "floor", "type": "plane"},
            {"id": "out", "type": "output", "inputs": {"surface": {"from": "floor"}}})",
         "-o a.png", 1, "graph.field.json: error: node 'floor' (Plane) is unbounded"},
        {R"({"id": "out", "type": "output", "inputs": {"surface": {"from": "nobody"}}})", "-o a.png", 1,
         "nobody"},
    };
    for (const auto& row : rows) {
        const TempDir folder;
        const auto result = command(folder, *row.nodes ? graphText(row.nodes) : kBall, row.arguments);
        EXPECT_EQ(result.status, row.status) << row.arguments << ": " << result.output;
        EXPECT_NE(result.output.find(row.message), std::string::npos)
            << row.arguments << ": " << result.output;
        EXPECT_EQ(folder.names(), std::vector<std::string>{"graph.field.json"}) << row.arguments;
    }
}

}  // namespace fw::render_test
