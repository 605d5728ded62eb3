// The Player: a frame depends on its time alone, a seek never compiles, what is wrong is said and changes
// nothing.
#include "runtime/play/player.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <glm/common.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "graph/document/json.h"
#include "runtime/measure/mesh_report.h"
#include "tests/support/graph/picture_file.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::player_test {

using test::TempDir;

std::string sample(const std::string& name) {
    return std::string(FIELDWRIGHT_SOURCE_DIR) + "/samples/" + name + ".field.json";
}

/// A ball of live radius that rises from 0 to 2 m and back; `more` comes after its nodes.
std::string risingBall(const std::string& more = "") {
    return R"({"fieldwright": 1, "nodes": [
      {"id": "ball", "type": "sphere", "inputs": {"radius": 0.5}},
      {"id": "lift", "type": "translate", "inputs": {"surface": {"from": "ball"}, "offset": [0, 0, 0]}},
      {"id": "out", "type": "output", "inputs": {"surface": {"from": "lift"}, "resolution": 48}}],
      "parameters": [{"name": "radius", "node": "ball", "input": "radius", "min": 0.1, "max": 0.8}],
      "timeline": {"length": 4, "tracks": [{"node": "lift", "input": "offset.y", "keys": [
        {"time": 0, "value": 0}, {"time": 2, "value": 2}, {"time": 4, "value": 0}]}]})" +
           more + "}";
}

/// A player on a device with the validation layer, whose messages fail the test at the end.
struct Played {
    explicit Played(const std::string& text, const PlayerOptions& options = {}) {
        const Result<Graph> graph = parseGraph(text, "a.field.json", nullptr);
        EXPECT_TRUE(graph) << (graph ? "" : format(graph.error()));
        Result<Device> device = createDevice({.validation = true});
        EXPECT_TRUE(device);
        record = device->record;
        Result<Player> made = Player::create(*graph, std::move(*device), options);
        if (made)
            player.emplace(std::move(*made));
        else
            error = format(made.error());
    }
    ~Played() {
        player.reset();
        for (const std::string& message : record->messages) ADD_FAILURE() << "validation layer: " << message;
    }
    Player* operator->() {
        EXPECT_TRUE(player) << error;
        return &*player;
    }
    std::shared_ptr<DeviceRecord> record;
    std::optional<Player> player;
    std::string error;
};

/// The box around a mesh.
std::pair<glm::vec3, glm::vec3> boundsOf(const Mesh& mesh) {
    glm::vec3 lo(INFINITY), hi(-INFINITY);
    for (const glm::vec3& p : mesh.positions) lo = glm::min(lo, p), hi = glm::max(hi, p);
    return {lo, hi};
}
Mesh meshOf(Player& player) {
    Result<Mesh> mesh = player.mesh();
    EXPECT_TRUE(mesh) << (mesh ? "" : format(mesh.error()));
    return mesh ? std::move(*mesh) : Mesh{};
}

uint64_t shells(const Mesh& mesh) { return reportOnMesh(mesh.positions, mesh.indices).shells; }

TEST(Player, ASeekMovesTheSolid) {
    Played played(risingBall());
    for (const auto& [time, height] :
         {std::pair{0.0, 0.0}, {1.0, 1.0}, {2.0, 2.0}, {3.5, 0.5}, {5.0, 1.0}, {-1.0, 1.0}}) {
        played->seek(time);
        const auto [lo, hi] = boundsOf(meshOf(*played.player));
        EXPECT_NEAR(lo.y, height - 0.5, 0.01) << time;
        EXPECT_NEAR(hi.y, height + 0.5, 0.01) << time;
    }
    played->seek(3.5);
    played->advance(1.0);
    EXPECT_EQ(played->time(), 4.5);
    EXPECT_EQ(played->timelineTime(), 0.5);
}

TEST(Player, AWholePlaybackBuildsNoPipeline) {
    for (const char* name : {"cube_morph", "moving_booleans"}) {
        Result<Player> player = Player::open(sample(name), {.resolution = 40});
        ASSERT_TRUE(player) << format(player.error());
        EXPECT_TRUE(player->moves());
        ASSERT_TRUE(player->frame({.width = 64, .height = 48, .samples = 1}));
        const uint64_t built = player->pipelinesBuilt();
        EXPECT_GT(built, 0u);
        const double length = player->timeline().length;
        std::size_t least = SIZE_MAX, most = 0;
        for (int frame = 0; frame <= 10; ++frame) {
            player->seek(length * frame / 10);
            const Mesh mesh = meshOf(*player);
            least = std::min(least, mesh.triangleCount()), most = std::max(most, mesh.triangleCount());
            ASSERT_TRUE(player->frame({.width = 64, .height = 48, .samples = 1}));
        }
        EXPECT_EQ(player->pipelinesBuilt(), built) << name;
        EXPECT_LT(least, most) << name;
    }
}

TEST(Player, AFrameDependsOnItsTimeAlone) {
    const std::vector<double> times = {0.0, 0.7, 1.9, 2.0, 3.3};
    std::vector<Mesh> meshes;
    std::vector<std::vector<uint8_t>> pictures;
    const RenderOptions small{.width = 64, .height = 48, .samples = 2};
    Played first(risingBall());
    for (const double time : times) {
        first->seek(time);
        meshes.push_back(meshOf(*first.player));
        pictures.push_back(first->frame(small)->pixels);
    }
    for (std::size_t i = times.size(); i-- > 0;) {  // backwards, and each in a player of its own
        first->seek(times[i]);
        EXPECT_EQ(first->frame(small)->pixels, pictures[i]);
        EXPECT_EQ(meshOf(*first.player).positions, meshes[i].positions);
        Played other(risingBall());
        other->seek(times[i]);
        EXPECT_EQ(other->frame(small)->pixels, pictures[i]);
        EXPECT_EQ(meshOf(*other.player).indices, meshes[i].indices);
    }
}

TEST(Player, LiveAndFoldedTimesGiveTheSameSolid) {
    const Result<Graph> graph = readGraph(sample("moving_booleans"), nullptr);
    ASSERT_TRUE(graph);
    const Timeline timeline = *readTimeline(*graph);
    Result<Player> moving = Player::open(sample("moving_booleans"), {.resolution = 48});
    ASSERT_TRUE(moving);
    for (const double time : {0.0, 3.1, 6.5}) {
        Graph still = atTime(*graph, timeline, time);
        still.timeline = nullptr;
        Result<Device> device = createDevice();
        Result<Player> rested = Player::create(still, std::move(*device), {.resolution = 96});
        ASSERT_TRUE(rested) << format(rested.error());
        EXPECT_FALSE(rested->moves());
        moving->seek(time);
        const auto [lo, hi] = boundsOf(meshOf(*moving));
        const auto [restedLo, restedHi] = boundsOf(meshOf(*rested));
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_NEAR(lo[axis], restedLo[axis], 0.05);
            EXPECT_NEAR(hi[axis], restedHi[axis], 0.05);
        }
    }
}

TEST(Player, SetsParametersByName) {
    Played played(risingBall());
    const std::vector<PlayerParameter> list = played->parameters();
    ASSERT_EQ(list.size(), 1u);
    EXPECT_EQ(list[0].name, "radius");
    EXPECT_EQ(list[0].value, std::vector<double>{0.5});
    EXPECT_EQ(list[0].max, 0.8);
    EXPECT_FALSE(list[0].animated);
    meshOf(*played.player);
    const uint64_t built = played->pipelinesBuilt();
    ASSERT_TRUE(played->set("radius", 0.8));
    EXPECT_EQ(played->parameters()[0].value, std::vector<double>{0.8});
    played->seek(2.0);
    const auto [lo, hi] = boundsOf(meshOf(*played.player));
    EXPECT_NEAR(hi.y, 2.8, 0.01);
    EXPECT_NEAR(lo.y, 1.2, 0.01);
    EXPECT_FALSE(played->meshOnDevice()->capped);
    EXPECT_EQ(played->pipelinesBuilt(), built);
}

TEST(Player, RefusesWhatCannotBeSetAndStaysAsItWas) {
    Played played(risingBall());
    const Mesh before = meshOf(*played.player);
    const auto refused = [&](const Done& result, const std::string& part) {
        EXPECT_FALSE(result);
        if (result) return;
        EXPECT_NE(result.error().message.find(part), std::string::npos) << result.error().message;
    };
    refused(played->set("radios", 0.5), "did you mean 'radius'?");
    refused(played->set("radius", 0.9), "from 0.1 to 0.8");
    refused(played->set("radius", NAN), "not NaN");
    refused(played->set("radius", std::vector<double>{1, 2, 3}), "takes 1 number, not 3");
    EXPECT_EQ(meshOf(*played.player).positions, before.positions);
}

TEST(Player, AParameterThatCodeCountsWithIsSetByCompiling) {
    const std::string text = R"({"fieldwright": 1, "nodes": [
      {"id": "row", "type": "expression", "inputs": {"count": 1, "gap": 1},
       "code": "d = 1e9; for (int i = 0; i < count; i++) d = min(d, length(p - vec3(i * gap, 0, 0)) - 0.3); return d;"},
      {"id": "out", "type": "output", "inputs": {"surface": {"from": "row"}, "resolution": 48}}],
      "parameters": [{"name": "count", "node": "row", "input": "count"}, {"name": "gap", "node": "row", "input": "gap"}]})";
    Played played(text);
    EXPECT_FALSE(played->moves());
    EXPECT_EQ(shells(meshOf(*played.player)), 1u);
    ASSERT_TRUE(played->set("count", 3));
    EXPECT_EQ(shells(meshOf(*played.player)), 3u);
    ASSERT_TRUE(played->set("gap", 0.4));
    EXPECT_EQ(shells(meshOf(*played.player)), 1u);
}

TEST(Player, TimeNodesPlayWithoutATimeline) {
    Played played(R"({"fieldwright": 1, "nodes": [
      {"id": "now", "type": "time"},
      {"id": "ball", "type": "sphere", "inputs": {"radius": 0.5}},
      {"id": "at", "type": "combine_xyz", "inputs": {"x": {"from": "now"}}},
      {"id": "moved", "type": "translate", "inputs": {"surface": {"from": "ball"}, "offset": {"from": "at"}}},
      {"id": "out", "type": "output", "inputs": {"surface": {"from": "moved"}, "resolution": 64}}]})");
    EXPECT_TRUE(played->moves());
    for (const double time :
         {0.0, 7.5, 40.0}) {  // the last is beyond the times that the region was found for
        played->seek(time);
        const auto [lo, hi] = boundsOf(meshOf(*played.player));
        EXPECT_NEAR(lo.x, time - 0.5, 0.4);
        EXPECT_NEAR(hi.x, time + 0.5, 0.4);
        EXPECT_FALSE(played->meshOnDevice()->capped);
    }
}

TEST(Player, ASolidThatVanishesLeavesTheBackdrop) {
    std::string text = risingBall();
    text.replace(text.find("\"lift\", \"input\": \"offset.y\""), 27, "\"ball\", \"input\": \"radius\"");
    text.replace(text.find("\"value\": 2}"), 11, "\"value\": 0.5}");
    text.replace(text.find("\"parameters\""), text.find("\"timeline\"") - text.find("\"parameters\""), "");
    Played played(text);
    /// The greatest step of brightness between neighbours in the picture's middle row.
    const auto contrast = [&] {
        const Result<Picture> picture = played->frame({.width = 64, .height = 64});
        EXPECT_TRUE(picture) << format(picture.error());
        int most = 0;
        for (std::size_t x = 0; x + 1 < 64; ++x) {
            const std::size_t at = 4 * (32 * 64 + x);
            most = std::max(most, std::abs(picture->pixels[at] - picture->pixels[at + 4]));
        }
        return most;
    };
    for (int round = 0; round < 2; ++round) {
        played->seek(0.0);
        EXPECT_EQ(meshOf(*played.player).triangleCount(), 0u);
        EXPECT_LT(contrast(), 6);
        played->seek(2.0);
        EXPECT_GT(meshOf(*played.player).triangleCount(), 100u);
        EXPECT_GT(contrast(), 20);
    }
    text.replace(text.find("\"value\": 0.5}"), 13, "\"value\": 0}");
    Played never(text);
    EXPECT_FALSE(never.player);
    EXPECT_NE(never.error.find("a.field.json: error: the solid is empty at every time"), std::string::npos)
        << never.error;
}

TEST(Player, ALiveViewThatIsCancelledGoesOnAsIfItHadNotBegun) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    // All that a frame traces through the field: occlusion, a lamp's shadow.
    const std::string lit = R"(, "scene": {"camera": {"position": [2, 1.5, 3], "target": [0, 0.3, 0]},
        "sun": {}, "ao": {}, "ground": {}, "lights": [{"type": "point", "position": [1, 2, 2]}]})";
    const auto rested = [&](bool cancelling) {
        Played play(risingBall(lit));
        Picture picture;
        std::atomic<bool> cancel = false, done = false;
        std::thread canceller([&] {
            std::mt19937 random(7);
            while (!done) {
                std::this_thread::sleep_for(std::chrono::microseconds(random() % 20000));
                cancel = true;
            }
        });
        int cancellations = 0;
        for (int i = 0;; ++i) {
            const bool may = cancelling && i % 2 == 0;  // so that it ends
            cancel = i == 0;
            const Result<bool> drawn =
                play->show({.width = 240, .height = 180, .cancel = may ? &cancel : nullptr}, picture);
            EXPECT_TRUE(drawn);
            if (!*drawn && !may) break;
            cancellations += !*drawn;
        }
        done = true;
        canceller.join();
        EXPECT_EQ(cancellations > 3, cancelling);
        return picture;
    };
    EXPECT_EQ(rested(true).pixels, rested(false).pixels);
}

TEST(Player, SaysWhatCannotBePlayed) {
    const auto expectError = [](const std::string& text, const std::string& part) {
        Played played(text);
        EXPECT_FALSE(played.player);
        EXPECT_NE(played.error.find(part), std::string::npos) << played.error;
    };
    expectError(R"({"fieldwright": 1, "nodes": []})", "no node of type 'output'");
    std::string text = risingBall();
    text.replace(text.find("\"lift\", \"input\""), 6, "\"left\"");
    expectError(text, "a.field.json:6:44: error: node 'left', input 'offset.y'");
    text = risingBall();
    text.replace(text.find("{\"time\": 2"), 10, "{\"time\": 9");
    expectError(text, "not in the order of their times");
    expectError(R"({"fieldwright": 1, "nodes": [{"id": "a", "type": "plane"},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "a"}}}]})",
                "is unbounded");
    EXPECT_NE(format(Player::open("/nowhere/a.field.json").error()).find("there is no such file"),
              std::string::npos);
    EXPECT_NE(format(Player::open(sample("cube_morph"), {.device = "no such"}).error()).find("no such"),
              std::string::npos);
}

TEST(Player, AReloadKeepsTimeAndParametersOrEverything) {
    Played played(risingBall());
    ASSERT_TRUE(played->set("radius", 0.7));
    played->seek(2.0);
    const Mesh before = meshOf(*played.player);

    Graph broken = played->graph();
    broken.nodes[0].type = "sphree";
    const Done refused = played->reload(broken);
    ASSERT_FALSE(refused);
    EXPECT_NE(format(refused.error()).find("did you mean 'sphere'?"), std::string::npos);
    EXPECT_EQ(meshOf(*played.player).positions, before.positions);

    Graph endless = played->graph();  // compiles, but has no bounds
    endless.nodes[0].type = "infinite_cylinder";
    EXPECT_FALSE(played->reload(endless));
    EXPECT_EQ(meshOf(*played.player).positions, before.positions);

    Result<Graph> box = parseGraph(risingBall(), "a.field.json", nullptr);
    (*box->timeline)["tracks"][0]["keys"][1]["value"] = 3;
    ASSERT_TRUE(played->reload(*box));
    const auto [lo, hi] = boundsOf(meshOf(*played.player));
    EXPECT_NEAR(hi.y, 3.7, 0.02);
    EXPECT_NEAR(lo.y, 2.3, 0.02);
}

TEST(Player, AReloadWithAnotherMethodMeshesAnew) {
    const auto boxBy = [](const std::string& method) {
        return R"({"fieldwright": 1, "nodes": [{"id": "box", "type": "box", "inputs": {"half_extents": [0.51, 0.73, 0.6]}},
            {"id": "out", "type": "output", "inputs": {"surface": {"from": "box"}, "resolution": 40, "method": ")" +
               method + R"("}}]})";
    };
    for (const bool behind : {false, true}) {
        Played played(boxBy("marching-cubes"), {.compileBehind = behind});
        const auto volume = [&] {
            const Result<Mesh> mesh = played->mesh();
            EXPECT_TRUE(mesh);
            return reportOnMesh(mesh->positions, mesh->indices).volume;
        };
        const double exact = 8 * 0.51 * 0.73 * 0.6;
        EXPECT_LT(volume(), 0.9995 * exact);  // its edges are bevelled
        const Result<Graph> sharp = parseGraph(boxBy("dual-contouring"), "a.field.json", nullptr);
        ASSERT_TRUE(sharp);
        ASSERT_TRUE(played->reload(*sharp));
        EXPECT_NEAR(volume(), exact, 1e-5);
    }
}

TEST(Player, AReloadShowsAPictureAsItIsNow) {
    const TempDir folder;
    const auto paint = [&](uint8_t grey) {
        test::writePictureFile(folder.path("grey.png"), 2, 2, std::vector<uint8_t>(12, grey));
        std::filesystem::last_write_time(
            folder.path("grey.png"),
            std::filesystem::file_time_type::clock::now() + std::chrono::seconds(grey));
    };
    paint(255);
    test::writeText(folder.path("a.field.json"), R"({"fieldwright": 1, "nodes": [
        {"id": "ball", "type": "sphere"}, {"id": "paint", "type": "triplanar", "inputs": {"image": "grey.png"}},
        {"id": "made", "type": "material", "inputs": {"surface": {"from": "ball"}, "base_color": {"from": "paint"}}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "made"}, "resolution": 16}}]})");
    Result<Player> player = Player::open(folder.path("a.field.json"));
    ASSERT_TRUE(player) << format(player.error());
    const std::vector<std::string> files = player->files();
    ASSERT_EQ(files.size(), 2u);
    EXPECT_EQ(files[0], folder.path("a.field.json"));
    EXPECT_TRUE(std::filesystem::equivalent(files[1], folder.path("grey.png")));
    const auto shade = [&] {
        const Result<Mesh> mesh = player->mesh();
        return mesh && !mesh->colors.empty() ? mesh->colors[0].y : -1.0f;
    };
    EXPECT_NEAR(shade(), 1.0f, 1e-4f);
    paint(128);
    ASSERT_TRUE(player->reload(player->graph()));
    EXPECT_NEAR(shade(), 0.2158605f, 1e-4f);
}

/// Drops that fall on a floor from the start on.
std::string rain(const std::string& emitter = "") {
    return R"({"fieldwright": 1, "nodes": [
      {"id": "cloud", "type": "emitter", "inputs": {"rate": 200, "position": [0, 1, 0], "size": [0.4, 0.1, 0.4],
          "velocity": [0, -1, 0], "lifetime": 2)" +
           emitter + R"(}},
      {"id": "slab", "type": "box", "inputs": {"half_extents": [1, 0.1, 1]}},
      {"id": "fall", "type": "particle_dynamics", "inputs": {"particles": {"from": "cloud"}, "collide": {"from": "slab"}}},
      {"id": "field", "type": "particles_to_field", "inputs": {"particles": {"from": "fall"}, "radius": 0.15,
          "region_min": [-1, -0.2, -1], "region_max": [1, 1.4, 1], "resolution": 48}},
      {"id": "wet", "type": "union", "inputs": {"a": {"from": "field"}, "b": {"from": "slab"}}},
      {"id": "out", "type": "output", "inputs": {"surface": {"from": "wet"}, "resolution": 48}}],
      "parameters": [{"name": "drops", "node": "field", "input": "radius", "min": 0.1, "max": 0.3},
                     {"name": "rate", "node": "cloud", "input": "rate"}],
      "timeline": {"length": 3}})";
}

TEST(Player, ParticlesAreTheSameHoweverTheirTimeIsReached) {
    Played played(rain());
    EXPECT_TRUE(played->moves());
    const Box region = played->region();
    std::map<double, Mesh> seen;
    for (const double time : {0.0, 0.5, 1.5, 0.5, 2.5, 1.5}) {
        played->seek(time);
        Mesh mesh = meshOf(*played.player);
        const Report report = reportOnMesh(mesh.positions, mesh.indices);
        EXPECT_EQ(report.boundaryEdges + report.nonManifoldEdges + report.flippedEdges, 0u) << time;
        if (const auto [at, fresh] = seen.try_emplace(time, mesh); !fresh) {
            EXPECT_EQ(at->second.positions, mesh.positions) << time;
            EXPECT_EQ(at->second.indices, mesh.indices) << time;
        }
        EXPECT_EQ(played->region(), region);  // the grid stays
    }
    EXPECT_EQ(shells(seen.at(0.0)), 1u);
    EXPECT_NE(seen.at(0.5).positions, seen.at(1.5).positions);
    played->seek(1.5);
    ASSERT_TRUE(played->frame({.width = 64, .height = 48, .samples = 1}));
    const uint64_t built = played->pipelinesBuilt();
    for (int i = 0; i < 5; ++i) {
        played->advance(0.1);
        ASSERT_TRUE(played->frame({.width = 64, .height = 48, .samples = 1}));
    }
    EXPECT_EQ(played->pipelinesBuilt(), built);
}

TEST(Player, AFrameOfAFluidIsAwaitedTwice) {
    // Of steps, samples, mesh and picture, the mesh for its triangles, and the picture.
    Played played(R"({"fieldwright": 1, "nodes": [
      {"id": "drop", "type": "sphere", "inputs": {"radius": 0.3}},
      {"id": "post", "type": "cylinder", "inputs": {"radius": 0.1, "half_height": 1}},
      {"id": "water", "type": "sph_fluid", "inputs": {"source": {"from": "drop"}, "spacing": 0.08,
        "tank_min": [-0.5, -0.8, -0.5], "tank_max": [0.5, 0.5, 0.5], "collide": {"from": "post"}}},
      {"id": "field", "type": "particles_to_field", "inputs": {"particles": {"from": "water"}, "resolution": 32}},
      {"id": "out", "type": "output", "inputs": {"surface": {"from": "field"}, "resolution": 32}}],
      "timeline": {"length": 2}})");
    const RenderOptions options{.width = 64, .height = 48};
    Picture picture;
    for (const double seconds : {0.0, 0.1, 0.2, 0.3}) {  // buffers come to their sizes
        played->seek(seconds);
        ASSERT_TRUE(played->show(options, picture));
    }
    const DeviceRecord& device = *played->device().record;
    // Behind a picture that took long, as on a busy machine, one is drawn in parts, each awaited.
    uint64_t least = 100;
    for (int i = 0; i < 30 && least > 2; ++i) {
        const uint64_t submitted = device.submissions, awaited = device.waits;
        played->advance(0.05);  // three steps
        ASSERT_TRUE(played->show(options, picture));
        EXPECT_GE(device.submissions - submitted, 6u);
        least = std::min(least, device.waits - awaited);
    }
    EXPECT_EQ(least, 2u);
}

TEST(Player, ParametersOfParticlesAreSetWhileTheyFly) {
    Played played(rain());
    const auto volume = [&] {
        const Mesh mesh = meshOf(*played.player);
        return reportOnMesh(mesh.positions, mesh.indices).volume;
    };
    const double slab = volume();
    played->seek(1.0);
    const double before = volume();
    ASSERT_TRUE(played->set("drops", 0.2));
    EXPECT_GT(volume(), 1.1 * before);
    ASSERT_TRUE(played->set("drops", 0.15));
    EXPECT_NEAR(volume(), before, 1e-9);
    // Those that are there stay; no more are born.
    ASSERT_TRUE(played->set("rate", 0));
    EXPECT_NEAR(volume(), before, 1e-9);
    played->seek(2.9);
    EXPECT_GT(volume(), 1.01 * slab);
    played->seek(0.9);  // from the start, it never rains
    EXPECT_EQ(volume(), slab);
}

TEST(Player, OneParticleIsABallWithoutFurtherWords) {
    Played played(R"({"fieldwright": 1, "nodes": [
        {"id": "drop", "type": "emitter", "inputs": {"shape": "point", "burst": 1, "rate": 0, "velocity": [0, 0, 0],
            "spread": 0}},
        {"id": "field", "type": "particles_to_field", "inputs": {"particles": {"from": "drop"}}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "field"}, "resolution": 48}}]})");
    const Mesh mesh = meshOf(*played.player);
    const Report report = reportOnMesh(mesh.positions, mesh.indices);
    EXPECT_EQ(report.boundaryEdges + report.nonManifoldEdges + report.flippedEdges, 0u);
    const double radius = 0.15 * std::sqrt(1.0 - std::cbrt(0.3)),
                 ball = 4.0 / 3.0 * 3.14159265 * radius * radius * radius;
    EXPECT_NEAR(report.volume, ball, 0.1 * ball);  // the blur is some per cent off
}

TEST(Player, ParticlesThatCannotBeAreRefusedAndLongWorkEnds) {
    Played many(rain(R"(, "burst": 1000000)"));
    ASSERT_TRUE(many->set("rate", 90e6));
    many->seek(1.0);
    const Result<Mesh> mesh = many->mesh();
    ASSERT_FALSE(mesh);
    EXPECT_NE(format(mesh.error()).find("node 'cloud'"), std::string::npos) << format(mesh.error());
    EXPECT_NE(format(mesh.error()).find("lower the rate"), std::string::npos) << format(mesh.error());

    int steps = 0;
    PlayerOptions options;
    options.simulating = [&](int, int all) {
        EXPECT_GT(all, 0);
        return ++steps % 50 != 0;
    };
    Played played(rain(), options);
    played->seek(2.0);
    EXPECT_FALSE(played->mesh());
    EXPECT_EQ(steps, 50);
    played->seek(50.0 / 60);  // where it was stopped
    Played straight(rain());
    straight->seek(50.0 / 60);
    EXPECT_EQ(meshOf(*played.player).positions, meshOf(*straight.player).positions);
    played->seek(2.0);
    EXPECT_FALSE(played->mesh());  // it goes on where it was
    EXPECT_TRUE(played->mesh());
    EXPECT_EQ(steps, 120);
}

}  // namespace fw::player_test
