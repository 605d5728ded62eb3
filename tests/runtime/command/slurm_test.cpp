// Jobs that a real Slurm runs, with FIELDWRIGHT_LONG: an array and what depends on it, a task that is killed
// and requeued, one that fails.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "tests/support/shared_out.h"
#include "tests/support/slurm_machine.h"

namespace fw::slurm_test {

namespace fs = std::filesystem;

using test::comesTrue;
using test::ProgramResult;
using test::readText;
using test::runCommand;
using test::SlurmMachine;

struct Slurm : test::SharedOut {
    void SetUp() override {
        SharedOut::SetUp();
        if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "with FIELDWRIGHT_LONG";
        ASSERT_EQ(SlurmMachine::whyNot(), "");
        setenv("XDG_CACHE_HOME", folder.path("caches").c_str(), 1);
        machine.emplace();
    }
    ProgramResult handIn() const {
        ProgramResult result = test::runProgram(machine->environment() + " " + job + "/submit");
        EXPECT_EQ(result.status, 0) << result.output;
        return result;
    }
    /// Of the job's array, 1: this machine is new.
    bool says(const std::string& id, const std::string& what) const {
        return machine->run("scontrol show job " + id).output.find(what) != std::string::npos;
    }

    std::optional<SlurmMachine> machine;
    std::vector<std::string> tiled(const std::string& to) const {
        return {"export", graph, "-o", to, "--resolution", "260", "--tiles", "4"};
    }
};

TEST_F(Slurm, RunsAnArrayOfTilesAndMergesThemBehindIt) {
    const std::string mesh = folder.path("mesh.ply"), whole = folder.path("whole.ply");
    ASSERT_EQ(shareOut("slurm", {"--tasks", "4"}, tiled(mesh)).status, 0);
    handIn();
    EXPECT_EQ(runCommand(tiled(whole)).status, 0);
    machine->waitForAll();
    EXPECT_FALSE(fs::exists(job + "/failed"));
    ASSERT_TRUE(fs::exists(mesh)) << readText(job + "/log/slurm.merge");
    EXPECT_TRUE(readText(mesh) == readText(whole));
}

TEST_F(Slurm, RequeuesATaskThatMakesTheSameBytes) {
    const std::string frames = folder.path("frames"), whole = folder.path("whole");
    const auto rendered = [&](const std::string& to) -> std::vector<std::string> {
        return {"render", graph, "-o", to, "--from", "0", "--size", "160x120", "--samples", "64"};
    };
    ASSERT_EQ(shareOut("slurm", {"--chunk", "4"}, rendered(frames)).status, 0);
    handIn();
    ASSERT_TRUE(comesTrue([&] { return fs::exists(frames + "/000000.png"); }));
    EXPECT_EQ(machine->run("scontrol requeue 1_0").status, 0);
    ASSERT_TRUE(comesTrue([&] { return says("1_0", "JobState=PENDING"); }));  // for two minutes, unless told
    EXPECT_EQ(machine->run("scontrol update jobid=1_0 starttime=now").status, 0);
    EXPECT_EQ(runCommand(rendered(whole)).status, 0);
    machine->waitForAll();
    EXPECT_TRUE(says("1_0", "Restarts=1"));
    EXPECT_FALSE(fs::exists(job + "/failed")) << readText(job + "/failed");
    expectSameFiles(frames, whole);
}

TEST_F(Slurm, TellsWhichTaskFailedAndWhyAndDoesNotMerge) {
    const std::string mesh = folder.path("mesh.ply");
    ASSERT_EQ(shareOut("slurm", {"--tasks", "4"}, tiled(mesh)).status, 0);
    fs::create_directory(job + "/parts/3.part");  // where that part is to go
    handIn();
    machine->waitForAll();
    const std::string failed = readText(job + "/failed");
    EXPECT_NE(failed.find("part 3/4 of the tiles: exit status 3\n"), std::string::npos) << failed;
    EXPECT_NE(failed.find("3.part: error: "), std::string::npos) << failed;
    EXPECT_EQ(failed.find("part 2/4"), std::string::npos) << failed;
    EXPECT_FALSE(fs::exists(mesh));
    EXPECT_FALSE(fs::exists(job + "/log/merge.0")) << "it has run";
}

}  // namespace fw::slurm_test
