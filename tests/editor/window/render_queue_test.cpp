// Pictures and sequences from the editor: the same bytes as the command's, one after the other, cancelled and
// gone on with, and what is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <thread>
#include <utility>

#include "editor/files/render_queue.h"
#include "graph/document/json.h"
#include "tests/support/command.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::editor::render_queue_test {

namespace fs = std::filesystem;
using Phase = RenderState::Phase;
using fw::test::readText;
using fw::test::runCommand;
using fw::test::TempDir;
using fw::test::writeText;

const std::string kMoving = R"({"fieldwright": 1, "nodes": [
  {"id": "box", "type": "box", "inputs": {"half_extents": [0.5, 0.3, 0.2]}},
  {"id": "lift", "type": "translate", "inputs": {"surface": {"from": "box"}}},
  {"id": "out", "type": "output", "inputs": {"surface": {"from": "lift"}, "resolution": 24}}],
 "timeline": {"length": 2, "fps": 2, "tracks": [{"node": "lift", "input": "offset", "keys": [
   {"time": 0, "value": [0, 0, 0]}, {"time": 2, "value": [0.5, 0, 0]}]}]}})";

/// A queue whose every change is heard, and waited for.
struct Pictures : testing::Test {
    TempDir folder;
    std::string file = folder.path("a.field.json");
    std::shared_ptr<const Graph> graph;
    std::mutex mutex;
    std::condition_variable changed;
    uint64_t changes = 0;
    std::function<void()> hook;  ///< called at each change
    std::optional<RenderQueue> queue;

    void SetUp() override {
        writeText(file, kMoving);
        graph = std::make_shared<const Graph>(*readGraph(file, nullptr));
        queue.emplace([this] {
            if (hook) hook();
            std::lock_guard lock(mutex);
            ++changes;
            changed.notify_all();
        });
    }
    void TearDown() override { queue.reset(); }

    RenderWish wish(const std::string& path, int samples = 2) const {
        return {.graph = graph, .path = path, .picture = {.width = 48, .height = 32, .samples = samples}};
    }
    RenderWish frames(const std::string& path) const {
        RenderWish wanted = wish(path, 1);
        wanted.frames = *framesBetween(0.0, 2.0, 2.0);
        return wanted;
    }
    RenderState stateOf(uint64_t id) const {
        for (const RenderItem& item : queue->items())
            if (item.id == id) return item.state;
        ADD_FAILURE() << "no item " << id;
        return {};
    }
    /// Waits until it has ended.
    RenderState finish(uint64_t id) {
        const auto ended = [&] {
            const Phase phase = stateOf(id).phase;
            return phase != Phase::waiting && phase != Phase::running;
        };
        std::unique_lock lock(mutex);
        changed.wait(lock, ended);
        lock.unlock();
        return stateOf(id);
    }
    std::string refusal(RenderWish wanted) {
        const RenderState state = finish(queue->add(std::move(wanted)));
        EXPECT_EQ(state.phase, Phase::failed);
        return state.problems.empty() ? "" : state.problems.front().message;
    }
    std::string byCommand(const std::string& name, const std::vector<std::string>& options) const {
        std::vector<std::string> words = {"render", file, "-o", folder.path(name), "--size", "48x32"};
        words.insert(words.end(), options.begin(), options.end());
        const fw::test::CommandResult result = runCommand(words);
        EXPECT_EQ(result.status, 0) << result.errors;
        return folder.path(name);
    }
};

TEST_F(Pictures, HaveTheBytesOfTheCommand) {
    RenderWish still = wish(folder.path("still.png"));
    still.seconds = 1.5;
    RenderWish light = wish(folder.path("light.exr"));
    light.picture.format = PictureFormat::exr;
    RenderWish normals = wish(folder.path("normals.png"));
    normals.picture.view = RENDER_NORMALS;
    RenderWish paths = wish(folder.path("paths.png"));
    paths.picture.reference = true;
    paths.picture.bounces = 2;
    uint64_t last = 0;
    for (const RenderWish& each : {still, light, normals, paths}) last = queue->add(each);
    finish(last);
    for (const RenderItem& item : queue->items())
        EXPECT_EQ(item.state.phase, Phase::done)
            << item.wish.path << (item.state.problems.empty() ? "" : item.state.problems[0].message);
    const std::vector<std::string> two = {"--samples", "2"};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.end(), two.begin(), two.end());
        return more;
    };
    EXPECT_EQ(readText(still.path), readText(byCommand("c.png", with({"--time", "1.5"}))));
    EXPECT_EQ(readText(light.path), readText(byCommand("c.exr", two)));
    EXPECT_EQ(readText(normals.path), readText(byCommand("n.png", with({"--view", "normals"}))));
    EXPECT_EQ(readText(paths.path), readText(byCommand("p.png", with({"--reference", "--bounces", "2"}))));
}

TEST_F(Pictures, FramesAndTurntablesHaveTheBytesOfTheCommand) {
    RenderWish turn = frames(folder.path("turn"));
    turn.turntable = true;
    turn.seconds = 1.0;
    const uint64_t first = queue->add(frames(folder.path("mine"))), second = queue->add(turn);
    finish(second);
    EXPECT_EQ(stateOf(first).phase, Phase::done);
    EXPECT_EQ(stateOf(first).made, 4);
    const std::string theirs = byCommand("theirs", {"--from", "0", "--samples", "1"});
    const std::string turned =
        byCommand("turned", {"--turntable", "2", "--fps", "2", "--time", "1", "--samples", "1"});
    for (const char* name : {"000000.png", "000001.png", "000002.png", "000003.png"}) {
        EXPECT_EQ(readText(folder.path("mine") + "/" + name), readText(theirs + "/" + name)) << name;
        const std::string of4 = std::string(name).insert(6, "_of_4");
        EXPECT_EQ(readText(folder.path("turn") + "/" + of4), readText(turned + "/" + of4)) << name;
    }
    EXPECT_NE(readText(turned + "/000000_of_4.png"), readText(turned + "/000001_of_4.png"));
}

TEST_F(Pictures, ASequenceGoesOnWhereItWasCancelled) {
    uint64_t id = 0;
    bool once = false;
    std::mutex adding;
    std::unique_lock holds(adding);
    hook = [&] {
        std::lock_guard waits(adding);
        if (stateOf(id).ready == 2 && !std::exchange(once, true)) queue->cancel(id);
    };
    id = queue->add(frames(folder.path("mine")));
    holds.unlock();
    RenderState state = finish(id);
    EXPECT_EQ(state.phase, Phase::cancelled);
    EXPECT_EQ(state.ready, 2);
    EXPECT_TRUE(fs::exists(folder.path("mine") + "/000001.png"));
    EXPECT_FALSE(fs::exists(folder.path("mine") + "/000002.png"));
    queue->goOn(id);
    state = finish(id);
    queue.reset();  // which may still tell of the end
    EXPECT_EQ(state.phase, Phase::done);
    EXPECT_EQ(state.passed, 2);
    EXPECT_EQ(state.made, 2);
    const std::string theirs = byCommand("theirs", {"--from", "0", "--samples", "1"});
    EXPECT_EQ(readText(folder.path("mine") + "/000003.png"), readText(theirs + "/000003.png"));
}

TEST_F(Pictures, ACancelledStillLeavesNoFile) {
    uint64_t id = 0;
    std::mutex adding;
    std::unique_lock holds(adding);
    hook = [&] {
        std::lock_guard waits(adding);
        if (stateOf(id).picture) queue->cancel(id);
    };
    id = queue->add(wish(folder.path("still.png"), 4096));
    holds.unlock();
    EXPECT_EQ(finish(id).phase, Phase::cancelled);
    queue.reset();
    EXPECT_EQ(folder.names(), std::vector<std::string>{"a.field.json"});
}

TEST_F(Pictures, GrowBeforeTheyAreDone) {
    std::vector<std::shared_ptr<const Picture>> seen;
    uint64_t id = 0;
    std::mutex adding;
    std::unique_lock holds(adding);
    hook = [&] {
        std::lock_guard waits(adding);
        const auto picture = stateOf(id).picture;
        if (picture && (seen.empty() || seen.back() != picture)) seen.push_back(picture);
    };
    id = queue->add(wish(folder.path("still.png"), 6));
    holds.unlock();
    EXPECT_EQ(finish(id).phase, Phase::done);
    queue.reset();
    ASSERT_EQ(seen.size(), 4u) << "of 1, 2 and 4 samples, and the whole";
    for (const auto& picture : seen) EXPECT_EQ(picture->pixels.size(), 48u * 32u * 4u);
    EXPECT_NE(seen[0]->pixels, seen[3]->pixels);
    const auto away = [&](const Picture& picture) {
        long sum = 0;
        for (std::size_t i = 0; i < picture.pixels.size(); ++i)
            sum += std::abs(int(picture.pixels[i]) - int(seen[3]->pixels[i]));
        return sum;
    };
    EXPECT_LT(away(*seen[2]), away(*seen[0])) << "they come nearer";
}

TEST_F(Pictures, AreMadeOneAfterTheOther) {
    std::mutex first;
    std::unique_lock holds(first);
    hook = [&] { std::lock_guard waits(first); };
    const uint64_t a = queue->add(wish(folder.path("a.png"))), b = queue->add(wish(folder.path("b.png"))),
                   c = queue->add(wish(folder.path("c.png")));
    EXPECT_EQ(stateOf(b).phase, Phase::waiting);
    EXPECT_TRUE(queue->busy());
    queue->cancel(b);
    EXPECT_EQ(stateOf(b).phase, Phase::cancelled);
    queue->remove(b);
    EXPECT_EQ(queue->items().size(), 2u);
    holds.unlock();
    finish(c);
    EXPECT_EQ(stateOf(a).phase, Phase::done);
    EXPECT_FALSE(fs::exists(folder.path("b.png")));
    queue->remove(a);
    queue->goOn(a);
    queue->cancel(77);
    EXPECT_EQ(queue->items().size(), 1u);
    EXPECT_FALSE(queue->busy());
    queue.reset();
}

TEST_F(Pictures, EndInAnotherOrderThanTheyWereAskedFor) {
    std::mutex first;
    std::unique_lock holds(first);
    std::vector<uint64_t> ended;
    hook = [&] {
        std::lock_guard waits(first);
        for (const RenderItem& item : queue->items())
            if (item.state.phase == Phase::done && std::ranges::count(ended, item.id) == 0)
                ended.push_back(item.id);
    };
    const auto add = [&](const char* name) { return queue->add(wish(folder.path(name))); };
    const uint64_t a = add("a.png"), b = add("b.png"), c = add("c.png"), d = add("d.png");
    while (stateOf(a).phase != Phase::running) std::this_thread::yield();
    // The second comes last, and the fourth never: it has ended before any other.
    queue->cancel(b), queue->cancel(d);
    queue->goOn(b);
    std::vector<uint64_t> order;
    for (const RenderItem& item : queue->items()) order.push_back(item.id);
    EXPECT_EQ(order, (std::vector<uint64_t>{a, c, d, b})) << "as they are done";
    EXPECT_EQ(stateOf(d).phase, Phase::cancelled);
    queue->remove(a);
    EXPECT_EQ(queue->items().size(), 4u) << "what runs stays";
    holds.unlock();
    finish(b);
    queue->remove(d);
    const std::vector<RenderItem> left = queue->items();
    queue.reset();  // which may still tell of the end
    EXPECT_EQ(ended, (std::vector<uint64_t>{a, c, b}));
    EXPECT_EQ(left.size(), 3u);
    for (const char* name : {"a.png", "b.png", "c.png"}) EXPECT_TRUE(fs::exists(folder.path(name))) << name;
    EXPECT_FALSE(fs::exists(folder.path("d.png")));
}

TEST_F(Pictures, SayWhyTheyCannotBe) {
    EXPECT_NE(refusal(wish(folder.path("a.jpg"))).find("has to end in .png"), std::string::npos);
    EXPECT_NE(refusal(wish(file + ".png/x.png")), "") << "there is no such folder";
    EXPECT_NE(refusal(frames(file)).find("is a file"), std::string::npos);
    RenderWish small = wish(folder.path("a.png"));
    small.picture.width = 3;
    EXPECT_NE(refusal(small), "");
    fs::create_directories(folder.path("mine"));
    EXPECT_EQ(finish(queue->add(frames(folder.path("mine")))).phase, Phase::done);
    RenderWish larger = frames(folder.path("mine"));
    larger.picture.width = 64;
    EXPECT_NE(refusal(larger).find("48x32"), std::string::npos);
    larger.overwrite = true;
    EXPECT_EQ(finish(queue->add(larger)).phase, Phase::done);
    RenderWish broken = wish(folder.path("a.png"));
    broken.graph = std::make_shared<const Graph>(
        *parseGraph(R"({"fieldwright": 1, "nodes": [{"id": "out", "type": "output"}]})", "", nullptr));
    EXPECT_NE(refusal(broken), "");
    // What had failed can be gone on with when it is mended, and the queue goes on.
    EXPECT_EQ(finish(queue->add(wish(folder.path("b.png")))).phase, Phase::done);
    EXPECT_FALSE(fs::exists(folder.path("a.png")));
}

TEST_F(Pictures, ThatCannotBeWrittenAreToldBeforeTheyAreMade) {
    bool lit = false;
    hook = [&] {
        for (const RenderItem& item : queue->items()) lit = lit || item.state.picture || item.state.made > 0;
    };
    EXPECT_NE(refusal(wish(folder.path("none/a.png"))).find("cannot create a file"), std::string::npos);
    fs::create_directories(folder.path("a.png"));
    EXPECT_NE(refusal(wish(folder.path("a.png"))).find("is a folder"), std::string::npos);
    writeText(folder.path("file"), "");
    EXPECT_NE(refusal(frames(folder.path("file/mine"))), "");
    EXPECT_FALSE(lit);
    // A folder that was made for frames of which there are none goes.
    RenderWish broken = frames(folder.path("mine"));
    broken.graph = std::make_shared<const Graph>(
        *parseGraph(R"({"fieldwright": 1, "nodes": [{"id": "out", "type": "output"}]})", "", nullptr));
    EXPECT_NE(refusal(broken), "");
    queue.reset();
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.field.json", "a.png", "file"}));
}

TEST_F(Pictures, OfWhatHasEndedAreKeptSmall) {
    RenderWish large = wish(folder.path("a.png"), 1);
    large.picture.width = 2100, large.picture.height = 40;
    large.picture.view = RENDER_NORMALS;
    std::shared_ptr<const Picture> whole;
    hook = [&] {
        for (const RenderItem& item : queue->items())
            if (item.state.phase == Phase::running && item.state.picture) whole = item.state.picture;
    };
    const RenderState state = finish(queue->add(large));
    queue.reset();
    ASSERT_TRUE(whole && state.picture);
    EXPECT_EQ(whole->width, 2100);
    EXPECT_EQ(state.picture->width, 700);
    EXPECT_EQ(state.picture->height, 13);
    const auto mean = [](const Picture& picture) {
        double sum = 0.0;
        for (const uint8_t value : picture.pixels) sum += value;
        return sum / double(picture.pixels.size());
    };
    EXPECT_NEAR(mean(*whole), mean(*state.picture), 2.0);
    EXPECT_EQ(sizeOfPicture(large.path, PictureFormat::png), std::pair(2100, 40));
}

TEST_F(Pictures, AreEndedWithTheProgram) {
    queue->add(wish(folder.path("a.png"), 4096));
    queue->add(wish(folder.path("b.png"), 4096));
    queue.reset();
    EXPECT_EQ(folder.names(), std::vector<std::string>{"a.field.json"});
}

}  // namespace fw::editor::render_queue_test
