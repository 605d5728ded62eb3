// Drivers that translate kernels into code of the processor do so once for each kernel: lavapipe does it at
// each dispatch where what a kernel branches on, or ends a loop at, is a number of a uniform buffer or a push
// constant (shaders/lib/unfolded.glsl). What it has translated lies in memory that the process may execute.
#include <gtest/gtest.h>

#include <fstream>

#include "graph/document/json.h"
#include "runtime/play/player.h"

namespace fw::compiled_once_test {

/// Bytes that may be executed and are of no file.
std::size_t translated() {
    std::size_t bytes = 0;
    std::ifstream maps("/proc/self/maps");
    for (std::string line; std::getline(maps, line);) {
        unsigned long long from = 0, to = 0, inode = 0;
        char rights[5] = {};
        if (std::sscanf(line.c_str(), "%llx-%llx %4s %*s %*s %llu", &from, &to, rights, &inode) == 4 &&
            rights[2] == 'x' && inode == 0)
            bytes += std::size_t(to - from);
    }
    return bytes;
}

struct CompiledOnce : testing::TestWithParam<const char*> {};

TEST_P(CompiledOnce, WhateverIsShown) {
    Result<Player> player =
        Player::open(FIELDWRIGHT_SOURCE_DIR "/samples/" + std::string(GetParam()) + ".field.json",
                     {.resolution = 32, .fieldBy = FieldBy::kernels});
    ASSERT_TRUE(player) << format(player.error());
    Result<Scene> scene = player->scene();
    ASSERT_TRUE(scene);
    Camera camera = scene->camera.value_or(Camera{.position = {3, 2, 4}});
    Picture picture;
    const auto expectNoMore = [&](const char* what, const std::function<void()>& frame) {
        for (int i = 0; i < 4; ++i) frame();
        const std::size_t before = translated();
        for (int i = 0; i < 4; ++i) frame();
        EXPECT_EQ(translated(), before) << what;
    };
    RenderOptions options{.width = 64, .height = 48, .samples = 2, .antialias = true};
    const auto show = [&] {
        const Result<bool> shown = player->show(options, picture);
        EXPECT_TRUE(shown) << format(shown.error());
    };
    const auto draw = [&] {
        const Result<Picture> drawn = player->frame(options);
        EXPECT_TRUE(drawn) << format(drawn.error());
    };
    expectNoMore("a view that moves", [&] {
        camera.position[1] += 0.001;
        options.scene = *scene;
        options.scene.camera = camera;
        show();
    });
    expectNoMore("a view that rests", show);
    expectNoMore("playing", [&] {
        player->advance(1.0 / 60.0);
        show();
    });
    expectNoMore("stills", draw);
    options.reference = true;
    expectNoMore("references", draw);
    options.bounces = 2;
    expectNoMore("whole paths", draw);
}

INSTANTIATE_TEST_SUITE_P(
    Samples, CompiledOnce,
    testing::ValuesIn([] {  // of those that take the longest with FIELDWRIGHT_LONG
        std::vector<const char*> names = {"moving_booleans"};
        if (std::getenv("FIELDWRIGHT_LONG"))
            names.insert(names.end(), {"dusk_city", "glass_of_water", "breaker", "tap", "wet_city"});
        return names;
    }()),
    [](const auto& about) { return std::string(about.param); });

TEST(CompiledOnce, TheViewsOfAField) {
    Result<Player> player =
        Player::open(FIELDWRIGHT_SOURCE_DIR "/samples/csg_part.field.json",
                     {.resolution = 32, .fieldBy = FieldBy::kernels, .view = RENDER_SLICE});
    ASSERT_TRUE(player) << format(player.error());
    Picture picture;
    std::size_t before = 0;
    for (int turn = 0; turn < 6; ++turn) {
        if (turn == 3) before = translated();
        for (uint32_t show = 0; show <= RENDER_WIREFRAME; ++show) {
            const Result<bool> shown = player->show({.width = 64, .height = 48, .show = show}, picture);
            EXPECT_TRUE(shown) << format(shown.error());
        }
    }
    EXPECT_EQ(translated(), before);
}

}  // namespace fw::compiled_once_test
