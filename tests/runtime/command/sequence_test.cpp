// `fieldwright render` of a sequence and `play --headless`, as a user calls them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "runtime/pictures/sequence.h"
#include "tests/support/command.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::sequence_test {

using test::CommandResult;
using test::expectRefusal;
using test::namesIn;
using test::readText;
using test::runCommand;
using test::TempDir;

const std::string kGraph = R"({"fieldwright": 1, "nodes": [
  {"id": "ball", "type": "sphere", "inputs": {"radius": 0.5}},
  {"id": "lift", "type": "translate", "inputs": {"surface": {"from": "ball"}}},
  {"id": "out", "type": "output", "inputs": {"surface": {"from": "lift"}, "resolution": 32}}],
 "timeline": {"length": 2, "fps": 4, "tracks": [{"node": "lift", "input": "offset", "keys": [
   {"time": 0, "value": [0, 0, 0]}, {"time": 1, "value": [1, 0, 0]}, {"time": 2, "value": [0, 0, 0]}]}]}})";

struct Sequence : testing::Test {
    TempDir folder;
    std::string graph = folder.path("a.field.json"), frames = folder.path("frames");
    void SetUp() override { test::writeText(graph, kGraph); }

    CommandResult render(const std::string& output, const std::vector<std::string>& more) const {
        std::vector<std::string> words = {"render", graph, "-o", output};
        words.insert(words.end(), more.begin(), more.end());
        if (std::find(more.begin(), more.end(), "--size") == more.end())
            words.insert(words.end(), {"--size", "48x32"});
        return runCommand(words);
    }
    std::string frame(const std::string& path, int number) const {
        return readText(path + "/00000" + std::to_string(number) + ".png");
    }
};

TEST_F(Sequence, NumbersFramesByTheirTime) {
    const CommandResult all = render(frames, {"--from", "0"});  // the timeline's length and rate
    EXPECT_EQ(all.status, 0) << all.errors;
    EXPECT_EQ(all.output + all.errors, "");
    EXPECT_EQ(namesIn(frames),
              (std::vector<std::string>{"000000.png", "000001.png", "000002.png", "000003.png", "000004.png",
                                        "000005.png", "000006.png", "000007.png"}));
    EXPECT_NE(frame(frames, 0), frame(frames, 4));
    const std::string part = folder.path("part");
    EXPECT_EQ(render(part, {"--from", "0.3", "--to", "1.25"}).status, 0);
    EXPECT_EQ(namesIn(part), (std::vector<std::string>{"000002.png", "000003.png", "000004.png"}));
    for (const int number : {2, 3, 4}) EXPECT_EQ(frame(part, number), frame(frames, number));
    // A picture of one moment is that moment's frame, and time beyond the end begins again.
    for (const char* time : {"0.75", "2.75"}) {
        EXPECT_EQ(render(folder.path("still.png"), {"--time", time}).status, 0);
        EXPECT_EQ(readText(folder.path("still.png")), frame(frames, 3));
    }
}

TEST_F(Sequence, IsOfTheRangeOnlyIfAsked) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    expectRefusal(render(frames, {"--range"}), 2, {"the timeline has no range"});
    std::string text = kGraph;
    text.replace(text.find("\"fps\": 4"), 8, "\"fps\": 4, \"range\": [0.5, 1.25]");
    test::writeText(graph, text);
    EXPECT_EQ(render(frames, {"--range"}).status, 0);
    EXPECT_EQ(namesIn(frames), (std::vector<std::string>{"000002.png", "000003.png", "000004.png"}));
    EXPECT_EQ(render(frames, {"--from", "0"}).status, 0);
    EXPECT_EQ(namesIn(frames).size(), 8u);
}

TEST_F(Sequence, OfATurntableGoesOnceAroundAtOneTime) {
    EXPECT_EQ(render(frames, {"--turntable", "1", "--fps", "6", "--time", "0.5", "--samples", "1"}).status,
              0);
    const auto of6 = [](const std::string& path, int n) {
        return readText(path + "/00000" + std::to_string(n) + "_of_6.png");
    };
    EXPECT_EQ(namesIn(frames).size(), 6u);
    EXPECT_NE(of6(frames, 0), of6(frames, 3)) << "the light is behind it";
    const std::string other = folder.path("other");
    EXPECT_EQ(render(other, {"--turntable", "1", "--fps", "6", "--time", "1", "--samples", "1"}).status, 0);
    EXPECT_NE(of6(frames, 0), of6(other, 0)) << "another time";
    EXPECT_EQ(
        render(other, {"--turntable", "1", "--fps", "6", "--time", "0.5", "--samples", "1", "--overwrite"})
            .status,
        0);
    for (int n = 0; n < 6; ++n) EXPECT_EQ(of6(frames, n), of6(other, n)) << n;
    // Frames of the timeline, and of a turntable of another length, are not taken for its own.
    const CommandResult mixed = render(frames, {"--turntable", "0.5", "--fps", "6", "--samples", "1"});
    EXPECT_EQ(mixed.status, 0);
    EXPECT_EQ(mixed.errors.find("there already"), std::string::npos) << mixed.errors;
    EXPECT_EQ(namesIn(frames).size(), 9u);
    const Camera camera = turned({.position = {1, 2, 5}, .target = {1, 1, 1}}, 0.25);
    EXPECT_NEAR(camera.position[0], 5.0, 1e-12) << "from +z towards +x";
    EXPECT_EQ(camera.position[1], 2.0);
    EXPECT_NEAR(camera.position[2], 1.0, 1e-12);
    for (const std::vector<std::string>& wrong : {std::vector<std::string>{"--turntable", "1", "--from", "1"},
                                                  {"--turntable", "0"},
                                                  {"--turntable", "x"},
                                                  {"--time", "1", "--fps", "5"}})
        expectRefusal(render(folder.path("none"), wrong), 2, {wrong[0]});
    EXPECT_FALSE(std::filesystem::exists(folder.path("none")));
}

TEST_F(Sequence, GoesOnWhereItStopped) {
    EXPECT_EQ(render(frames, {"--to", "1"}).status, 0);
    const std::string second = frame(frames, 1), third = frame(frames, 2);
    std::filesystem::remove(frames + "/000002.png");
    // A whole picture still, as far as one can tell without decoding it: before its last chunk.
    const std::string marked = std::string(second).insert(second.size() - 12, "mark");
    test::writeText(frames + "/000001.png", marked);
    const CommandResult more = render(frames, {"--to", "1.5"});
    EXPECT_EQ(more.status, 0);
    EXPECT_NE(more.errors.find("3 of 6 frames were there already (--overwrite makes them anew)"),
              std::string::npos)
        << more.errors;
    EXPECT_EQ(namesIn(frames).size(), 6u);
    EXPECT_EQ(frame(frames, 1), marked);
    EXPECT_EQ(frame(frames, 2), third);
    EXPECT_EQ(render(frames, {"--to", "1.5", "--overwrite"}).status, 0);
    EXPECT_EQ(frame(frames, 1), second);
}

TEST_F(Sequence, MakesBrokenFramesAnew) {
    EXPECT_EQ(render(frames, {"--to", "1"}).status, 0);
    const std::string whole[] = {frame(frames, 0), frame(frames, 1), frame(frames, 2), frame(frames, 3)};
    const auto breakFrame = [&](int number, const std::string& text) {
        test::writeText(frames + "/00000" + std::to_string(number) + ".png", text);
    };
    breakFrame(0, "");
    breakFrame(1, whole[1].substr(0, whole[1].size() - 1));
    breakFrame(2, whole[2].substr(0, whole[2].size() / 2));
    const CommandResult more = render(frames, {"--to", "1"});
    EXPECT_EQ(more.status, 0) << more.errors;
    EXPECT_NE(more.errors.find("1 of 4 frames were there already"), std::string::npos) << more.errors;
    for (int i = 0; i < 4; ++i) EXPECT_TRUE(frame(frames, i) == whole[i]) << i;
    breakFrame(3, "text" + std::string(100, ' '));
    EXPECT_EQ(render(frames, {"--to", "1"}).status, 0);
    EXPECT_TRUE(frame(frames, 3) == whole[3]);
}

TEST_F(Sequence, RefusesWhatMakesNoSequence) {
    const auto refuse = [&](const std::string& output, const std::vector<std::string>& more,
                            const std::string& part) {
        SCOPED_TRACE(part);
        expectRefusal(render(output, more), 2, {part});
    };
    refuse(frames, {"--from", "1", "--to", "1"}, "there is no frame from");
    // Before anything is looked for: a plane has no bounds.
    test::writeText(folder.path("plane.field.json"), R"({"fieldwright": 1, "nodes": [
        {"id": "a", "type": "plane"}, {"id": "out", "type": "output", "inputs": {"surface": {"from": "a"}}}]})");
    expectRefusal(
        runCommand({"render", folder.path("plane.field.json"), "-o", frames, "--from", "3", "--to", "1"}), 2,
        {"there is no frame from"});
    std::filesystem::remove(folder.path("plane.field.json"));
    refuse(frames, {"--from", "-1"}, "begins at 0 s or later");
    refuse(frames, {"--to", "1e9"}, "frames are numbered up to 1000000");
    refuse(frames, {"--fps", "0"}, "--fps");
    refuse(folder.path("a.png"), {"--to", "1"}, "a sequence goes into a folder");
    refuse(graph, {"--to", "1"}, "this is a file");
    refuse(frames, {}, "give a name that ends in .png or .exr, or the times of a sequence");
    refuse(folder.path("a.png"), {"--overwrite"}, "--overwrite is for a sequence");
    EXPECT_EQ(folder.names(), std::vector<std::string>{"a.field.json"});
    EXPECT_EQ(render(frames, {"--to", "0.5"}).status, 0);
    refuse(frames, {"--to", "1", "--size", "64x32"}, "000000.png is there already, with 48x32 pixels");
    expectRefusal(render("/proc/frames", {"--to", "1"}), 3, {"/proc/frames: error: cannot make the folder"});
}

TEST_F(Sequence, CtrlCLeavesWholeFramesAndGoesOn) {
    int stopped = 0;
    // Until it was stopped between two frames: how long the first one takes is the machine's affair.
    for (int delay = 300, runs = 0; runs < 3 || (stopped == 0 && delay < 20'000);
         delay += delay / 2, ++runs) {
        test::CommandOptions options;
        options.interruptAfterMs = delay;
        const CommandResult result =
            runCommand({"render", graph, "-o", frames, "--size", "640x480", "--fps", "60"}, options);
        EXPECT_EQ(result.status, 130) << result.errors;
        if (result.errors.find("the same command goes on") != std::string::npos) ++stopped;
        if (!std::filesystem::exists(frames)) continue;
        for (const std::string& name : namesIn(frames)) {
            EXPECT_EQ(name.size(), 10u) << name;  // nothing temporary
            const std::string png = readText(frames + "/" + name);
            EXPECT_EQ(png.substr(png.size() - 8, 4), "IEND") << name;
        }
    }
    EXPECT_GT(stopped, 0);
}

TEST_F(Sequence, PlaysWithoutAWindow) {
    const CommandResult played =
        runCommand({"play", graph, "--headless", "--frames", "5", "--size", "48x32"});
    EXPECT_EQ(played.status, 0) << played.errors;
    EXPECT_EQ(played.output.substr(0, 12), "5 frames in ");
    EXPECT_NE(played.output.find("; 0 pipelines built after the first frame"), std::string::npos)
        << played.output;
    EXPECT_EQ(runCommand({"play", graph, "--headless", "--size", "48x32"}).output.substr(0, 9), "8 frames ");
    expectRefusal(runCommand({"play", graph, "--headless", "--size", "4x4"}), 2, {"--size 4x4"});
    expectRefusal(runCommand({"play", graph, "--headless", "--frames", "0"}), 2, {"--frames"});
    expectRefusal(runCommand({"play", folder.path("none.field.json"), "--headless"}), 1,
                  {"there is no such file"});
    test::CommandOptions nowhere;
    nowhere.environment = {"DISPLAY=", "WAYLAND_DISPLAY="};
    expectRefusal(runCommand({"play", graph}, nowhere), 3, {"there is no window system here", "--headless"});
}

TEST_F(Sequence, ExportAndEvalFollowTheTimeline) {
    EXPECT_EQ(runCommand({"eval", graph, "--time", "0.5", "--at", "0.5", "0", "0"}).output, "-0.5\n");
    EXPECT_EQ(runCommand({"eval", graph, "--time", "3.5", "--at", "0.5", "0", "0"}).output, "-0.5\n");
    const std::string report = folder.path("report.json");
    EXPECT_EQ(
        runCommand({"export", graph, "-o", folder.path("a.stl"), "--time", "1", "--report", report}).status,
        0);
    const nlohmann::json written = nlohmann::json::parse(readText(report));
    EXPECT_NEAR(written["boundsMin"][0].get<double>(), 0.5, 1e-6) << readText(report);
}

}  // namespace fw::sequence_test
