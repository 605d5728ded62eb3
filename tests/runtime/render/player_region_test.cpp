// The region that a Player shares over its timeline, on random moving scenes: it contains the solid at random
// times, between the times at which the search looks too.
//
// FIELDWRIGHT_LONG=1 tests 300 scenes. FIELDWRIGHT_SCENE_SEED=N tests only scene N, and prints its JSON.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>

#include "graph/document/json.h"
#include "runtime/play/player.h"
#include "tests/support/graph/random_scene.h"
#include "tests/support/graph/solid_bounds.h"

namespace fw::player_region_test {

/// Scenes whose bounds the search may fail to prove at some time. The aim is 1 %.
constexpr uint32_t kMaxRefusedPercent = 10;

using test::RandomScene;
using test::SceneAnchor;
using test::SolidBounds;

constexpr int kTimes = 100;

/// The anchors where the timeline has moved them.
std::vector<SceneAnchor> anchorsAt(const RandomScene& scene, const Timeline& timeline, double time) {
    std::vector<SceneAnchor> anchors = scene.anchors;
    for (const Track& track : timeline.tracks)
        for (SceneAnchor& anchor : anchors)
            if (track.node == anchor.placement && track.name.starts_with("offset."))
                anchor.centre[std::size_t(track.name.back() - 'x')] = evaluate(track, time)[0];
    return anchors;
}

SolidBounds boundsAt(Player& player, const RandomScene& scene, double time,
                     const test::SolidBoundsOptions& options) {
    player.seek(time);
    const Program program = player.programOnHost();
    return test::sampleSolid(program.ir, program.distance(), program.parameters(),
                             anchorsAt(scene, player.timeline(), time), std::nullopt, options);
}

/// The inside point farthest outside the shared region, over random times.
struct Worst {
    double outside = -INFINITY, time = 0.0;
    Point point{};
};

Worst farthestOutside(Player& player, const RandomScene& scene) {
    const Box region = player.region();
    test::SceneRandom random(scene.seed);
    Worst worst;
    const auto take = [&](const SolidBounds& solid, double time) {
        if (!solid.found) return;
        for (const Point& point : solid.extremes) {
            const double outside = test::distanceOutside(region, point);
            if (outside > worst.outside) worst = {outside, time, point};
        }
    };
    // A coarse look at each time, and a close one at the time when the solid is farthest on each side.
    std::array<double, 6> farthest;
    farthest.fill(-INFINITY);
    std::array<double, 6> times{};
    for (int i = 0; i < kTimes; ++i) {
        const double time = random.between(0, player.timeline().length);
        const SolidBounds solid =
            boundsAt(player, scene, time,
                     {.gridCells = 8, .farSamples = 50, .climbRounds = 0, .seed = scene.seed + uint32_t(i)});
        take(solid, time);
        for (std::size_t side = 0; solid.found && side < 6; ++side) {
            const double along = (side % 2 ? 1.0 : -1.0) * solid.extremes[side][side / 2];
            if (along > farthest[side]) farthest[side] = along, times[side] = time;
        }
    }
    for (std::size_t side = 0; side < 6; ++side) take(boundsAt(player, scene, times[side], {}), times[side]);
    return worst;
}

TEST(PlayerRegion, ContainsMovingScenesAtAllTimes) {
    const char* only = std::getenv("FIELDWRIGHT_SCENE_SEED");
    const uint32_t first = only ? uint32_t(std::strtoul(only, nullptr, 10)) : 1;
    const uint32_t scenes = only ? 1 : std::getenv("FIELDWRIGHT_LONG") ? 300 : 5;
    std::optional<Player> player;
    std::size_t kept = 0, lost = 0, refused = 0, empty = 0, tooFar = 0;
    for (uint32_t seed = first; seed < first + scenes; ++seed) {
        const RandomScene scene = test::randomMovingScene(seed);
        if (only) std::fputs(scene.json.c_str(), stderr);
        const Result<Graph> graph = parseGraph(scene.json, "scene " + std::to_string(seed), nullptr);
        ASSERT_TRUE(graph) << format(graph.error());
        std::optional<Error> error;
        if (player) {
            if (const Done reloaded = player->reload(*graph); !reloaded) error = reloaded.error();
        } else {
            Result<Device> device = createDevice({});
            ASSERT_TRUE(device) << format(device.error());
            Result<Player> created = Player::create(*graph, std::move(*device), {.fieldBy = FieldBy::tapes});
            if (created)
                player.emplace(std::move(*created));
            else
                error = created.error();
        }
        if (error) {
            // A track can move a solid beyond the search in a document in millimetres.
            bool far = false;
            for (const SceneAnchor& anchor : scene.anchors)
                for (const double x : anchor.centre) far |= std::abs(x) + 8.0 * scene.unit > kFarthest;
            ++(far ? tooFar : refused);
            std::fprintf(stderr, "moving scene %u: refused: %s\n", seed, format(*error).c_str());
            continue;
        }
        const Worst worst = farthestOutside(*player, scene);
        if (!std::isfinite(worst.outside)) {
            ++empty;
        } else if (worst.outside > 0.0) {
            ++lost;
            const Box region = player->region();
            std::fprintf(
                stderr,
                "moving scene %u: LOST at %.9g s: inside at (%.9g %.9g %.9g), %.9g outside the region "
                "(%.9g %.9g %.9g) to (%.9g %.9g %.9g). Run it with FIELDWRIGHT_SCENE_SEED=%u\n",
                seed, worst.time, worst.point[0], worst.point[1], worst.point[2], worst.outside, region.lo[0],
                region.lo[1], region.lo[2], region.hi[0], region.hi[1], region.hi[2], seed);
            if (lost <= 5 && !only) std::fputs(scene.json.c_str(), stderr);
        } else {
            ++kept;
        }
    }
    std::fprintf(stderr,
                 "%u moving scenes: %zu kept, %zu lost, %zu refused, %zu beyond the search, %zu empty\n",
                 scenes, kept, lost, refused, tooFar, empty);
    EXPECT_EQ(lost, 0u);
    EXPECT_LE(refused * 100, kMaxRefusedPercent * scenes);
    EXPECT_TRUE(only || empty * 10 <= scenes) << empty;
}

}  // namespace fw::player_region_test
