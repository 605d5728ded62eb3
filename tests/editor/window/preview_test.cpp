// The preview: the last graph's picture whatever came before, findings beside the last good picture, live
// inputs under the hand, pinned nodes.
#include "editor/preview/preview.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdlib>
#include <random>
#include <thread>

#include "editor/preview/pinned.h"
#include "runtime/play/player.h"
#include "tests/support/editor/graphs.h"
#include "tests/support/gpu.h"
#include "tests/support/graph/temp_dir.h"
#include "tests/support/graph/triangle_meshes.h"

namespace fw::editor::preview_test {

std::shared_ptr<const Graph> shared(const std::string& text) {
    return std::make_shared<const Graph>(editor::test::parsed(text));
}

/// A box and a ball, joined; `radius` is the ball's. The structure has another constant for another `width`.
std::shared_ptr<const Graph> joined(double radius, double width = 0.6, const std::string& last = "both") {
    return shared(R"({"fieldwright": 1, "nodes": [
      {"id": "box", "type": "box", "inputs": {"half_extents": [)" +
                  std::to_string(width) + R"(, 0.5, 0.5]}},
      {"id": "ball", "type": "sphere", "inputs": {"radius": )" +
                  std::to_string(radius) + R"(}},
      {"id": "both", "type": "union", "inputs": {"a": {"from": "box"}, "b": {"from": "ball"}}},
      {"id": "out", "type": "output", "inputs": {"surface": {"from": ")" +
                  last + R"("}, "resolution": 40}}]})");
}

/// A preview and a thread that waits for what it makes.
class Previewed {
  public:
    explicit Previewed(std::string device = {})
        : preview({.pick = std::move(device), .validation = true}, [this] {
              std::lock_guard lock(mutex);
              woken = true;
              wake.notify_all();
          }) {}

    void ask(PreviewWish wish) {
        wish.revision = wish.revision ? wish.revision : revision + 1;
        revision = wish.revision;
        wish.width = 160, wish.height = 120;
        preview.ask(std::move(wish));
    }
    /// Takes results until nothing is under way; the last one.
    PreviewResult settled() {
        return until([&](const PreviewResult&) { return !preview.busy(); });
    }
    /// Takes results until the picture of the newest wish is no draft; it may become finer still.
    PreviewResult full() {
        return until([&](const PreviewResult& result) {
            return result.revision == revision && result.current && !result.draft;
        });
    }
    /// Takes results until one is as wanted, or none has come for long.
    PreviewResult until(const std::function<bool(const PreviewResult&)>& wanted) {
        for (int i = 0; i < 12000; ++i) {
            if (std::optional<PreviewResult> result = preview.take()) latest = std::move(*result);
            if (wanted(latest) || !latest.failure.empty()) {
                if (std::optional<PreviewResult> result = preview.take()) latest = std::move(*result);
                return latest;
            }
            std::unique_lock lock(mutex);
            wake.wait_for(lock, std::chrono::milliseconds(10), [&] { return woken; });
            woken = false;
        }
        ADD_FAILURE() << "the preview made nothing of the kind that was waited for";
        return latest;
    }

    std::mutex mutex;
    std::condition_variable wake;
    bool woken = false;
    uint64_t revision = 0;
    PreviewResult latest;
    Preview preview;
};

/// The mean difference of two pictures' bytes.
double difference(const Picture& a, const Picture& b) {
    if (a.pixels.size() != b.pixels.size() || a.pixels.empty()) return 255.0;
    double sum = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) sum += std::abs(a.pixels[i] - b.pixels[i]);
    return sum / double(a.pixels.size());
}

/// The picture that a player makes of the graph at once.
Picture pictureOf(const Graph& graph, const std::optional<Camera>& camera = {}, int width = 160,
                  int height = 120) {
    Result<Device> device = createDevice({.validation = true});
    EXPECT_TRUE(device);
    Result<Player> player = Player::create(graph, std::move(*device));
    EXPECT_TRUE(player) << (player ? "" : format(player.error()));
    RenderOptions options{.width = width, .height = height, .samples = 32};
    options.scene.camera = camera;
    const Result<Picture> picture = player->frame(options);
    EXPECT_TRUE(picture) << (picture ? "" : format(picture.error()));
    return *picture;
}

TEST(Preview, AnotherViewOrSliceIsDrawnThoughThePictureRests) {
    Previewed previewed;
    PreviewWish wish{.graph = joined(0.8)};
    previewed.ask(wish);
    const Picture lit = previewed.settled().picture;
    const auto with = [&](uint32_t view, Slice slice) {
        wish.view = view, wish.slice = slice, wish.revision = 1;
        previewed.ask(wish);
        return previewed.settled().picture;
    };
    const Picture middle = with(RENDER_SLICE, {}), level = with(RENDER_SLICE, {.axis = 1}),
                  higher = with(RENDER_SLICE, {.axis = 1, .at = 0.4f});
    EXPECT_GT(difference(lit, middle), 2.0);
    EXPECT_GT(difference(middle, level), 2.0);
    EXPECT_GT(difference(level, higher), 1.0);
    wish.leastWidth = 0.01f;
    const Picture thick = with(RENDER_THICKNESS, {});
    wish.leastWidth = 10.0f;
    EXPECT_GT(difference(thick, with(RENDER_THICKNESS, {})), 2.0);
}

TEST(Preview, ThePictureIsThatOfThePlayer) {
    Previewed previewed;
    const auto graph = joined(0.7);
    previewed.ask({.graph = graph});
    const PreviewResult result = previewed.settled();
    EXPECT_TRUE(result.current);
    EXPECT_TRUE(result.failure.empty()) << result.failure;
    EXPECT_TRUE(result.findings.empty());
    EXPECT_EQ(result.picture.width, 160);
    EXPECT_EQ(result.statistics.resolution, 40);
    EXPECT_GT(result.statistics.triangles, 1000u);
    EXPECT_LT(difference(result.picture, pictureOf(*graph)), 2.0);
    // Nothing is asked: nothing is made.
    previewed.ask({.graph = graph, .revision = result.revision});
    EXPECT_FALSE(previewed.preview.busy());
}

TEST(Preview, FurtherEyesSeeTheSameSolid) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    Previewed previewed;
    Camera front, right;
    front.position = {0, 0, 6}, right.position = {6, 0, 0};
    PreviewWish wish{.graph = joined(0.55, 1.2)};
    wish.others = {{front, 80, 60}, {right, 80, 60}, {}};
    previewed.ask(wish);
    const PreviewResult all = previewed.settled();
    ASSERT_EQ(all.others.size(), 3u);
    ASSERT_TRUE(all.others[0].picture && all.others[1].picture);
    EXPECT_FALSE(all.others[2].picture) << "none is wanted";
    EXPECT_LT(difference(all.picture, pictureOf(*wish.graph)), 2.0);
    EXPECT_LT(difference(*all.others[0].picture, pictureOf(*wish.graph, front, 80, 60)), 2.0);
    EXPECT_LT(difference(*all.others[1].picture, pictureOf(*wish.graph, right, 80, 60)), 2.0);
    EXPECT_GT(difference(*all.others[0].picture, *all.others[1].picture), 4.0) << "it is no cube";
    EXPECT_EQ(all.others[0].seen, front);

    // The hand alone, and another camera of one of them, leave the rest as they are.
    wish.revision = 1, wish.first = 2;
    previewed.ask(wish);
    EXPECT_EQ(previewed.settled().others[0].picture, all.others[0].picture);
    front.position = {0, 6, 0.1};
    wish.others[0].camera = front;
    previewed.ask(wish);
    const auto turned = [&](const PreviewResult& result) {
        return result.others.size() == 3 && result.others[0].seen == front;
    };
    const PreviewResult after = previewed.until(turned);
    EXPECT_NE(after.others[0].picture, all.others[0].picture);
    EXPECT_EQ(after.others[1].picture, all.others[1].picture);
    EXPECT_EQ(after.picture.pixels, all.picture.pixels);

    // Under a hand all of them follow.
    wish.revision = 0, wish.graph = joined(0.9, 1.2), wish.held = {"ball.radius"};
    previewed.ask(wish);
    const PreviewResult held = previewed.settled();
    EXPECT_TRUE(held.current);
    EXPECT_GT(difference(held.picture, all.picture), 1.0);
    EXPECT_GT(difference(*held.others[0].picture, *after.others[0].picture), 1.0);
    EXPECT_GT(difference(*held.others[1].picture, *after.others[1].picture), 1.0);
}

TEST(Preview, TheFirstPictureOfAStructureIsADraftOfTheSameView) {
    fw::test::TemporaryCache cache;
    Previewed previewed;
    previewed.ask({.graph = joined(0.7, 0.61)});
    const PreviewResult draft =
        previewed.until([](const PreviewResult& result) { return !result.picture.pixels.empty(); });
    EXPECT_TRUE(draft.current);
    const Picture early = draft.picture;
    const PreviewResult full = previewed.full();
    EXPECT_EQ(draft.seen, full.seen);
    const double off = difference(early, full.picture);
    EXPECT_LT(off, 12.0) << "the draft shows something else";
}

TEST(Preview, AHundredEditsEndOnTheLast) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    Previewed previewed;
    std::mt19937 random(7);
    const auto number = [&](double low, double high) {
        return low + (high - low) * double(random() >> 8) / double(1 << 24);
    };
    std::shared_ptr<const Graph> last;
    for (int i = 0; i < 100; ++i) {
        const uint32_t kind = random() % 4;
        last = joined(number(0.3, 0.9), number(0.3, 0.9), kind == 0 ? "box" : kind == 1 ? "nothing" : "both");
        PreviewWish wish{.graph = last};
        if (random() % 3 == 0) wish.held = {"ball.radius"};
        previewed.ask(std::move(wish));
        if (random() % 4 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(random() % 20));
    }
    last = joined(0.8, 0.3);
    previewed.ask({.graph = last});
    const PreviewResult result = previewed.full();
    EXPECT_TRUE(result.current);
    EXPECT_EQ(result.revision, 101u);
    EXPECT_LT(difference(result.picture, pictureOf(*last)), 2.0);
}

TEST(Preview, ABrokenGraphKeepsThePictureAndListsItsFindings) {
    Previewed previewed;
    previewed.ask({.graph = joined(0.7)});
    const PreviewResult good = previewed.settled();
    previewed.ask({.graph = joined(0.7, 0.6, "nothing")});
    const PreviewResult broken = previewed.settled();
    EXPECT_FALSE(broken.current);
    EXPECT_EQ(broken.revision, 2u);
    ASSERT_FALSE(broken.findings.empty());
    EXPECT_EQ(broken.findings[0].node, "out");
    EXPECT_EQ(broken.picture.pixels, good.picture.pixels);
    // It can be looked at from elsewhere, and mended.
    previewed.ask({.graph = joined(0.7, 0.6, "nothing"), .camera = Camera{}});
    const PreviewResult turned = previewed.settled();
    EXPECT_FALSE(turned.current);
    EXPECT_GT(difference(turned.picture, good.picture), 2.0);
    previewed.ask({.graph = joined(0.7)});
    const PreviewResult mended = previewed.full();
    EXPECT_TRUE(mended.current);
    EXPECT_TRUE(mended.findings.empty());
}

TEST(Preview, AGraphThatIsBrokenFromTheStartHasNoPicture) {
    Previewed previewed;
    previewed.ask({.graph = joined(0.7, 0.6, "nothing")});
    const PreviewResult broken = previewed.settled();
    EXPECT_FALSE(broken.current);
    EXPECT_FALSE(broken.findings.empty());
    EXPECT_TRUE(broken.picture.pixels.empty());
    previewed.ask({.graph = joined(0.7)});
    EXPECT_TRUE(previewed.full().current);
}

TEST(Preview, ASolidWithoutBoundsIsAFinding) {
    Previewed previewed;
    previewed.ask({.graph = shared(R"({"fieldwright": 1, "nodes": [
      {"id": "floor", "type": "plane"},
      {"id": "out", "type": "output", "inputs": {"surface": {"from": "floor"}}}]})")});
    const PreviewResult result = previewed.settled();
    EXPECT_FALSE(result.current);
    ASSERT_FALSE(result.findings.empty());
    EXPECT_NE(result.findings[0].message.find("is unbounded"), std::string::npos)
        << result.findings[0].message;
}

TEST(Preview, WhatIsHeldMovesAndBuildsNoPipeline) {
    Previewed previewed;
    previewed.ask({.graph = joined(0.7), .held = {"ball.radius"}});
    const PreviewResult first = previewed.full();
    // A second round has all that is built at a first use.
    previewed.ask({.graph = joined(0.71), .held = {"ball.radius"}});
    const PreviewResult second = previewed.full();
    const uint64_t built = second.statistics.pipelines;
    Picture before = second.picture;
    for (const double radius : {0.75, 0.8, 0.85, 0.9}) {
        previewed.ask({.graph = joined(radius), .held = {"ball.radius"}});
        const PreviewResult moved = previewed.full();
        EXPECT_TRUE(moved.current);
        EXPECT_EQ(moved.statistics.pipelines, built) << "at " << radius;
        EXPECT_EQ(moved.seen, first.seen) << "the eye rests";
        EXPECT_GT(difference(moved.picture, before), 0.1) << "at " << radius;
        before = moved.picture;
    }
    // Letting go compiles nothing either.
    previewed.ask({.graph = joined(0.9)});
    const PreviewResult rest = previewed.settled();  // has all that refining needs
    EXPECT_EQ(rest.statistics.resolution, 40);
    previewed.ask({.graph = joined(0.6)});
    EXPECT_EQ(previewed.full().statistics.pipelines, rest.statistics.pipelines);
}

/// So many boxes that tapes may take long for all cells of them. Another structure for another size of the
/// first.
std::shared_ptr<const Graph> manyBoxes(double first) {
    constexpr int kBoxes = 110;
    Graph graph;
    const auto add = [&](std::string id, std::string type) -> Node& {
        Node& node = graph.nodes.emplace_back();
        node.id = std::move(id), node.type = std::move(type);
        return node;
    };
    const auto holding = [](auto value) {
        InputValue input;
        input.value = std::move(value);
        return input;
    };
    std::string all;
    for (int i = 0; i < kBoxes; ++i) {
        const std::string number = std::to_string(i);
        const double size = i == 0 ? first : 0.3 + 0.003 * i;  // unlike each other: no family
        add("box" + number, "box_max")
            .set("half_extents", holding(std::vector<double>{size, 0.9 * size, 0.3}));
        Node& moved = add("moved" + number, "translate");
        moved.set("surface", holding(Link{"box" + number, ""}));
        moved.set("offset", holding(std::vector<double>{0.35 * (i % 8), 0.35 * (i / 8), 0.01 * (i % 7)}));
        if (i == 0) {
            all = "moved0";
            continue;
        }
        Node& joined = add("joined" + number, i % 3 ? "union" : "difference");
        joined.set("a", holding(Link{all, ""}));
        joined.set("b", holding(Link{"moved" + number, ""}));
        all = joined.id;
    }
    Node& out = add("out", "output");
    out.set("surface", holding(Link{all, ""}));
    out.set("resolution", holding(256.0));
    return std::make_shared<const Graph>(std::move(graph));
}

TEST(Preview, ALargeGraphIsShownWithFewCellsFirstAndWithAllOnceNothingIsAskedFor) {
    Previewed previewed;
    std::random_device seed;
    previewed.ask({.graph = manyBoxes(0.3 + double(seed()) * 1e-11)});
    const PreviewResult first = previewed.until([](const PreviewResult& result) { return result.current; });
    ASSERT_TRUE(first.findings.empty()) << first.findings[0].message;
    const PreviewResult all = previewed.until(
        [](const PreviewResult& result) { return result.current && result.statistics.resolution == 256; });
    if (!first.draft) GTEST_SKIP() << "the kernels were there sooner than a picture";
    EXPECT_LT(first.statistics.resolution, 200);
    EXPECT_GT(all.statistics.triangles, 1.5 * first.statistics.triangles);
    EXPECT_EQ(all.region, first.region);
    // The same solid: only edges are elsewhere, by a cell.
    EXPECT_LT(difference(all.picture, first.picture), 8.0);
}

TEST(Preview, AnEditWithoutEffectIsToldOf) {
    Previewed previewed;
    previewed.ask({.graph = joined(0.7)});
    const PreviewResult before = previewed.settled();
    Graph moved = *joined(0.7);
    moved.nodes[0].at = {100, 200};
    previewed.ask({.graph = std::make_shared<const Graph>(moved)});
    const PreviewResult after = previewed.settled();
    EXPECT_EQ(after.revision, 2u);
    EXPECT_TRUE(after.current);
    EXPECT_EQ(after.picture.pixels, before.picture.pixels);
}

TEST(Preview, APinnedNodeIsShown) {
    Previewed previewed;
    const auto graph = joined(0.8);
    previewed.ask({.graph = graph, .revision = 1, .pinned = "box"});
    const PreviewResult box = previewed.full();
    EXPECT_TRUE(box.current);
    EXPECT_LT(difference(box.picture, pictureOf(*joined(0.8, 0.6, "box"))), 2.0);
    previewed.ask({.graph = graph});
    EXPECT_LT(difference(previewed.full().picture, pictureOf(*graph)), 2.0);
}

TEST(Preview, APinnedNodeWithoutBoundsIsShownNearTheSolid) {
    Previewed previewed;
    previewed.ask({.graph = shared(R"({"fieldwright": 1, "nodes": [
      {"id": "ball", "type": "sphere"}, {"id": "floor", "type": "plane"},
      {"id": "cut", "type": "intersect", "inputs": {"a": {"from": "ball"}, "b": {"from": "floor"}}},
      {"id": "out", "type": "output", "inputs": {"surface": {"from": "cut"}, "resolution": 24}}]})"),
                   .pinned = "floor"});
    const PreviewResult result = previewed.full();
    EXPECT_TRUE(result.current);
    EXPECT_GT(result.statistics.triangles, 0u);
}

TEST(Preview, WhatTheOutputDoesNotNeedMayBeBroken) {
    Previewed previewed;
    previewed.ask({.graph = shared(R"({"fieldwright": 1, "nodes": [
      {"id": "ball", "type": "sphere"}, {"id": "stray", "type": "expression", "code": "return length("},
      {"id": "out", "type": "output", "inputs": {"surface": {"from": "ball"}, "resolution": 24}}]})")});
    const PreviewResult result = previewed.full();
    EXPECT_TRUE(result.current);
    ASSERT_EQ(result.findings.size(), 1u);
    EXPECT_EQ(result.findings[0].node, "stray");
}

TEST(Preview, AMissingDeviceIsAFailure) {
    Previewed previewed("no device is called this");
    previewed.ask({.graph = joined(0.7)});
    const PreviewResult result =
        previewed.until([](const PreviewResult& made) { return !made.failure.empty(); });
    EXPECT_NE(result.failure.find("no device is called this"), std::string::npos) << result.failure;
}

TEST(Preview, AnEmptyTimeIsSaidOnceAndOverWhenItIsOver) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    Previewed previewed;
    PreviewWish wish{.graph = shared(R"({"fieldwright": 1, "nodes": [
      {"id": "now", "type": "time"}, {"id": "ball", "type": "expression", "code": "return length(p) - 1 + 2 * abs(now);",
       "inputs": {"now": {"from": "now"}}},
      {"id": "out", "type": "output", "inputs": {"surface": {"from": "ball"}, "resolution": 24}}],
      "timeline": {"length": 4}})")};
    for (const double seconds : {0.0, 1.0, 1.5, 2.0}) {
        wish.seconds = seconds, wish.revision = 1;
        previewed.ask(wish);
        previewed.settled();
    }
    EXPECT_LE(previewed.latest.findings.size(), 1u);
    wish.seconds = 0.1;
    previewed.ask(wish);
    const PreviewResult result = previewed.settled();
    EXPECT_TRUE(result.findings.empty()) << format(result.findings[0]);
    EXPECT_TRUE(result.current);
}

TEST(Preview, NothingOfAnotherDocumentIsShown) {
    Previewed previewed;
    previewed.ask({.graph = joined(0.7), .document = 1});
    EXPECT_FALSE(previewed.settled().picture.pixels.empty());
    const auto broken = joined(0.7, 0.6, "nowhere");
    previewed.ask({.graph = broken, .document = 1});
    EXPECT_FALSE(previewed.settled().picture.pixels.empty()) << "the last that was valid";
    previewed.ask({.graph = broken, .document = 2});
    const PreviewResult other = previewed.settled();
    EXPECT_EQ(other.document, 2u);
    EXPECT_TRUE(other.picture.pixels.empty());
    EXPECT_FALSE(other.findings.empty());
    // Nor when it is looked at from elsewhere, or comes with a place of its own on the timeline.
    previewed.ask({.graph = joined(0.7), .document = 1});
    EXPECT_FALSE(previewed.settled().picture.pixels.empty());
    for (const double seconds : {0.5, 0.75}) {
        previewed.ask({.graph = broken, .document = 3, .seconds = seconds, .camera = Camera{}});
        const PreviewResult elsewhere = previewed.settled();
        EXPECT_EQ(elsewhere.document, 3u);
        EXPECT_TRUE(elsewhere.picture.pixels.empty());
    }
    previewed.ask({.graph = joined(0.7), .document = 3});
    EXPECT_FALSE(previewed.full().picture.pixels.empty());
}

/// What a preview tells of its work until the picture is there: shares, 1 where it tells none.
std::vector<double> toldBy(std::optional<double> (Preview::*share)() const, const Graph& graph,
                           double seconds) {
    std::mutex mutex;
    std::vector<double> shares;
    std::optional<Preview> preview;
    preview.emplace(DeviceOptions{.validation = true}, [&] {
        std::lock_guard lock(mutex);
        shares.push_back(((*preview).*share)().value_or(1.0));
    });
    EXPECT_FALSE(((*preview).*share)());
    preview->ask({.graph = std::make_shared<const Graph>(graph),
                  .revision = 1,
                  .seconds = seconds,
                  .width = 160,
                  .height = 120});
    std::optional<PreviewResult> result;
    for (int i = 0; i < 6000 && !(result && result->current); ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        if (auto newer = preview->take()) result = std::move(newer);
    }
    EXPECT_TRUE(result && result->current && result->findings.empty());
    EXPECT_FALSE(((*preview).*share)());
    std::lock_guard lock(mutex);
    return shares;
}

TEST(Preview, TellsHowMuchOfAMeshsFieldIsMade) {
    const fw::test::TempDir folder;
    const TriangleMesh cube = fw::test::cubeFile();
    // Another one at every run: none is kept on the disk.
    std::random_device seed;
    const double size = std::uniform_real_distribution(0.8, 1.0)(seed);
    std::string text;
    for (const glm::vec3& p : cube.positions)
        text +=
            "v " + std::to_string(size * p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) + "\n";
    for (std::size_t i = 0; i < cube.indices.size(); i += 3) {
        text += "f";
        for (std::size_t k = 0; k < 3; ++k) text += " " + std::to_string(cube.indices[i + k] + 1);
        text += "\n";
    }
    fw::test::writeText(folder.path("cube.obj"), text);
    Graph graph =
        editor::test::graphOf(R"({"id": "file", "type": "mesh_file", "inputs": {"path": "cube.obj"}},
        {"id": "field", "type": "mesh_to_field", "inputs": {"mesh": {"from": "file"}, "resolution": 24}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "field"}, "resolution": 24}})");
    graph.path = folder.path("g.field.json");

    const std::vector<double> shares = toldBy(&Preview::baking, graph, 0.0);
    ASSERT_GT(shares.size(), 3u);
    EXPECT_EQ(shares.front(), 0.0);
    EXPECT_TRUE(std::ranges::is_sorted(shares));
    EXPECT_GT(std::ranges::count_if(shares, [](double share) { return share > 0.0 && share < 1.0; }), 0);
}

TEST(Preview, TheNextWishAfterAFailureBeginsAnew) {
    ASSERT_EQ(setenv("VK_ICD_FILENAMES", "/nowhere.json", 1), 0);
    Previewed previewed;
    previewed.ask({.graph = joined(0.7)});
    // It may have failed before the wish came, which then begins it anew in vain.
    do EXPECT_FALSE(previewed.settled().failure.empty());
    while (previewed.preview.busy() && !HasFailure());
    ASSERT_EQ(unsetenv("VK_ICD_FILENAMES"), 0);
    (void)previewed.preview.take();  // of the last one in vain
    previewed.latest = {};
    previewed.ask({.graph = joined(0.8)});
    const PreviewResult result = previewed.full();
    EXPECT_TRUE(result.failure.empty()) << result.failure;
    EXPECT_TRUE(result.current);
}

TEST(Preview, ItCanEndAtAnyTime) {
    for (int i = 0; i < 4; ++i) {
        Previewed previewed;
        for (int j = 0; j < i; ++j) previewed.ask({.graph = joined(0.5 + 0.01 * j, 0.4 + 0.001 * i)});
        std::this_thread::sleep_for(std::chrono::milliseconds(60 * i));
    }
}

Graph jet() {
    return editor::test::graphOf(R"({"id": "jet", "type": "emitter", "inputs": {"rate": 500}},
        {"id": "field", "type": "particles_to_field", "inputs": {"particles": {"from": "jet"}, "resolution": 24, "radius": 1}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "field"}, "resolution": 24}})");
}

TEST(Preview, ParticlesOfAnEarlierTimeDoNotWaitForThoseOfALater) {
    const auto graph = std::make_shared<const Graph>(jet());
    Previewed previewed;
    previewed.ask({.graph = graph, .revision = 1, .seconds = 30'000.0});  // would take an hour
    previewed.until([&](const PreviewResult&) { return previewed.preview.simulating().has_value(); });
    previewed.ask({.graph = graph, .revision = 1, .seconds = 1.0});
    EXPECT_TRUE(previewed.full().findings.empty());
    EXPECT_FALSE(previewed.preview.simulating());
}

TEST(Preview, TellsHowFarParticlesAre) {
    const std::vector<double> shares = toldBy(&Preview::simulating, jet(), 3.0);
    const auto told = std::ranges::count_if(shares, [](double share) { return share < 1.0; });
    EXPECT_GT(told, 5);
    EXPECT_LT(*std::ranges::min_element(shares), 0.2);
}

}  // namespace fw::editor::preview_test
