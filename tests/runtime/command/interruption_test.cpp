// Signals end a command wherever it is, and leave nothing behind; what a killed one left goes when the
// command runs again.
#include "runtime/system/interruption.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

#include "runtime/system/output_file.h"
#include "tests/support/command.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::interruption_test {

using test::CommandOptions;
using test::CommandResult;
using test::runCommand;
using test::TempDir;
namespace fs = std::filesystem;

constexpr const char* kBall = R"({"fieldwright": 1, "nodes": [{"id": "ball", "type": "sphere"},
    {"id": "out", "type": "output", "inputs": {"surface": {"from": "ball"}, "resolution": 32}}]})";

struct Interruption : testing::Test {
    TempDir input, folder;
    std::string graph = input.path("a.field.json");
    void SetUp() override { test::writeText(graph, kBall); }
    /// A field that takes minutes to measure: sums of noise, each of which moves the surface a little.
    void makeSlow() const {
        test::writeText(graph, R"({"fieldwright": 1, "nodes": [{"id": "a", "type": "expression", "code":
            "d = length(p) - 1; for (int i = 0; i < 150; i++) d += 0.0001 * perlin(p * (1 + i), i); return d;"},
            {"id": "out", "type": "output", "inputs": {"surface": {"from": "a"}, "resolution": 48}}]})");
    }
};

TEST_F(Interruption, CtrlCEndsTheReportAndLeavesNothing) {
    makeSlow();
    for (const char* name : {"a.stl", "a.gltf"}) {
        test::writeText(folder.path(name), "before");
        CommandOptions options;
        options.interruptAt = "report";
        const CommandResult result = runCommand(
            {"export", graph, "-o", folder.path(name), "--report", folder.path("report.json")}, options);
        EXPECT_EQ(result.status, 130) << result.errors;
        EXPECT_FALSE(result.killed);
        EXPECT_NE(result.errors.find("fieldwright: interrupted; nothing was written"), std::string::npos)
            << result.errors;
        EXPECT_EQ(folder.names(), std::vector<std::string>{name});
        EXPECT_EQ(test::readText(folder.path(name)), "before");
        fs::remove(folder.path(name));
    }
}

TEST_F(Interruption, BothSignalsEndEveryCommandThatReadsAGraph) {
    // A pipe that is open at its other end and stays empty: what reads it waits.
    const std::string pipe = input.path("pipe");
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    for (const std::vector<std::string>& words : {std::vector<std::string>{"eval", graph, "--points", pipe},
                                                  {"check", pipe},
                                                  {"compile", pipe},
                                                  {"export", pipe, "-o", folder.path("a.stl")},
                                                  {"render", pipe, "-o", folder.path("a.png")},
                                                  {"play", pipe, "--headless"}})
        for (const auto& [signal, status] : {std::pair(SIGINT, 130), std::pair(SIGTERM, 143)}) {
            SCOPED_TRACE(words[0] + " " + std::to_string(signal));
            const int held = open(pipe.c_str(), O_RDWR | O_CLOEXEC);
            CommandOptions options;
            options.signal = signal;
            // It has begun to read when the pipe is emptied.
            options.meanwhile = [&] {
                ASSERT_EQ(write(held, " ", 1), 1);
                for (int left = 1; left > 0;) ASSERT_EQ(ioctl(held, FIONREAD, &left), 0);
            };
            const CommandResult result = runCommand(words, options);
            EXPECT_EQ(result.status, status) << result.errors;
            EXPECT_FALSE(result.killed);
            EXPECT_TRUE(result.errors.starts_with(signal == SIGINT ? "fieldwright: interrupted"
                                                                   : "fieldwright: ended"))
                << result.errors;
            close(held);
        }
    EXPECT_TRUE(folder.names().empty());
}

TEST_F(Interruption, WhatAKilledProcessLeftGoesWhenTheFileIsWrittenAgain) {
    const std::string left = folder.path(".a.stl.0.tmp"), held = folder.path(".a.stl.1.tmp"),
                      other = folder.path(".b.stl.0.tmp");
    for (const std::string& file : {left, held, other}) test::writeText(file, "unfinished");
    const int running = open(held.c_str(), O_RDWR | O_CLOEXEC);
    ASSERT_EQ(flock(running, LOCK_EX), 0);
    EXPECT_EQ(runCommand({"export", graph, "-o", folder.path("a.stl")}).status, 0);
    EXPECT_EQ(folder.names(), (std::vector<std::string>{".a.stl.1.tmp", ".b.stl.0.tmp", "a.stl"}));
    close(running);
}

TEST_F(Interruption, PathsOfLightGoOnWhereTheyWereLeft) {
    const auto render = [&](const std::string& name, const char* samples,
                            const CommandOptions& options = {}) {
        return runCommand({"render", graph, "-o", folder.path(name), "--size", "64x48", "--reference",
                           "--bounces", "2", "--samples", samples},
                          options);
    };
    EXPECT_EQ(render("whole.png", "24").status, 0);
    // What an ended command leaves behind, by hand, for when it does is a matter of time: none of another
    // picture is taken, and none that is not whole.
    for (const char* left :
         {"", "FWPATHS3", "of something else, and long enough to be a head of such a file"}) {
        test::writeText(folder.path("again.png.paths"), left);
        const CommandResult result = render("again.png", "24");
        EXPECT_EQ(result.status, 0) << result.errors;
        EXPECT_EQ(test::readText(folder.path("again.png")), test::readText(folder.path("whole.png")));
        EXPECT_EQ(folder.names(), (std::vector<std::string>{"again.png", "whole.png"}));
        fs::remove(folder.path("again.png"));
    }
}

TEST_F(Interruption, TwoWritersOfOneFileDoNotMeet) {
    Result<OutputFile> one = OutputFile::open(folder.path("a"), nullptr),
                       two = OutputFile::open(folder.path("a"), nullptr);
    ASSERT_TRUE(one && two);
    EXPECT_NE(one->place(), two->place());
    one->write("one");
    two->write("two");
    ASSERT_TRUE(one->finish());
    // Finished, not yet renamed: still somebody's.
    Result<OutputFile> three = OutputFile::open(folder.path("a"), nullptr);
    ASSERT_TRUE(three);
    EXPECT_NE(three->place(), one->place());
    ASSERT_TRUE(one->commit());
    EXPECT_EQ(test::readText(folder.path("a")), "one");
    ASSERT_TRUE(two->commit());
    EXPECT_EQ(test::readText(folder.path("a")), "two");
}

TEST_F(Interruption, ASignalWaitsForWhatMustNotBeParted) {
    const auto ended = [&] {
        endOnSignals({.said = "; held", .folder = folder.path("none")});
        {
            const Uninterrupted outer;
            const Uninterrupted inner;
            raise(SIGTERM);
            test::writeText(folder.path("after"), "the signal");
        }
        test::writeText(folder.path("too late"), "");
        _exit(0);
    };
    EXPECT_EXIT(ended(), testing::ExitedWithCode(143), "fieldwright: ended; held");
    EXPECT_EQ(folder.names(), std::vector<std::string>{"after"});
}

TEST_F(Interruption, ASignalBehindARenameSaysThatTheFileIsThere) {
    const auto ended = [&] {
        endOnSignals({.said = "; nothing was written"});
        Result<OutputFile> file = OutputFile::open(folder.path("a"), nullptr);
        (void)file->commit([&] {
            raise(SIGINT);
            whenEnded({.said = "; it was written"});
        });
        _exit(0);
    };
    EXPECT_EXIT(ended(), testing::ExitedWithCode(130), "fieldwright: interrupted; it was written");
    EXPECT_EQ(folder.names(), std::vector<std::string>{"a"});
}

}  // namespace fw::interruption_test
