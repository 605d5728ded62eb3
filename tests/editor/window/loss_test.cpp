// The real program when it is ended from outside: what was not saved is kept, and found again.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>

#include "editor/files/recovery.h"
#include "graph/document/json.h"
#include "tests/support/faults.h"
#include "tests/support/graph/temp_dir.h"
#include "tests/support/virtual_display.h"

namespace fw::editor::loss_test {

using fw::test::readText;
using fw::test::TempDir;
using fw::test::writeText;

constexpr const char* kGraph = R"({"fieldwright": 1, "nodes": [
    {"id": "ball", "type": "sphere"},
    {"id": "out", "type": "output", "inputs": {"surface": {"from": "ball"}, "resolution": 24}}]})";

class Loss : public testing::Test {
  protected:
    void SetUp() override {
        display.emplace(800, 600);
        NEEDS_DISPLAY(*display);
        for (const char* name : {"XDG_CONFIG_HOME", "XDG_STATE_HOME"})
            setenv(name, folder.path(name).c_str(), 1);
        writeText(file, kGraph);
        faults.emplace(fw::test::Fault{.loseWhenThere = lose, .presenting = true});
        process = fork();
        if (process != 0) return;
        const int output = ::open(folder.path("output").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        dup2(output, STDOUT_FILENO), dup2(output, STDERR_FILENO);
        execl(FIELDWRIGHT_BINARY_DIR "/fieldwright-editor", "fieldwright-editor", "--size", "640x480",
              file.c_str(), nullptr);
        _exit(127);
    }
    void TearDown() override {
        if (process > 0) kill(process, SIGKILL), waitpid(process, nullptr, 0);
        faults.reset();
    }
    template <class Until>
    bool wait(Until until, double seconds = 60.0) {
        for (; seconds > 0.0; seconds -= 0.05, fw::test::rest(0.05))
            if (until()) return true;
        return false;
    }
    /// A document whose file is gone is unsaved; nobody needs a mouse for that.
    void change() {
        // The window is there, and the file was looked at, when it has made something of it.
        ASSERT_TRUE(wait([&] { return std::filesystem::exists(folder.path("XDG_CONFIG_HOME")); }));
        fw::test::rest(1.5);
        std::filesystem::remove(file);
        fw::test::rest(2.5);
    }
    /// Loses the window's device so often, in a frame that there is because the file is another.
    void loseDevice(const char* times) {
        writeText(lose, times);
        std::string other = kGraph;
        writeText(file, other.replace(other.find("24"), 2, "25"));
        ASSERT_TRUE(wait([&] { return !std::filesystem::exists(lose); }));
    }
    /// How it ended: the exit status, or 128 + the signal.
    int end() {
        int status = 0;
        if (!wait([&] { return waitpid(process, &status, WNOHANG) == process; })) return -1;
        process = -1;
        return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }
    void expectKept(const std::string& said) {
        const std::vector<LeftCopy> left = leftCopies();
        ASSERT_EQ(left.size(), 1u) << readText(folder.path("output"));
        EXPECT_EQ(left[0].original, file);
        const Result<Graph> graph = readCopy(left[0]);
        ASSERT_TRUE(graph);
        EXPECT_NE(graph->node("ball"), nullptr);
        const std::string output = readText(folder.path("output"));
        EXPECT_NE(output.find(said), std::string::npos) << output;
        if (said.empty()) return;
        EXPECT_NE(output.find(left[0].file), std::string::npos) << output;
    }

    TempDir folder;
    std::string file = folder.path("a.field.json"), lose = folder.path("lose");
    std::optional<fw::test::Faults> faults;
    std::optional<fw::test::VirtualDisplay> display;
    pid_t process = -1;
};

TEST_F(Loss, ASignalKeepsWhatIsUnsaved) {
    change();
    kill(process, SIGTERM);
    EXPECT_EQ(end(), 128 + SIGTERM);
    expectKept("ended by a signal");
}

TEST_F(Loss, ASignalWithNothingUnsavedLeavesNothing) {
    ASSERT_TRUE(wait([&] { return std::filesystem::exists(folder.path("XDG_CONFIG_HOME")); }));
    kill(process, SIGINT);
    EXPECT_EQ(end(), 128 + SIGINT);
    EXPECT_TRUE(leftCopies().empty());
    EXPECT_EQ(readText(folder.path("output")).find("unsaved"), std::string::npos);
    EXPECT_EQ(readText(file), kGraph);
}

TEST_F(Loss, TheDisplaysEndKeepsWhatIsUnsaved) {
    change();
    display->endServer();
    EXPECT_EQ(end(), 3);
    expectKept("the display");
}

TEST_F(Loss, TheWindowsDeviceIsOpenedAnew) {
    change();
    loseDevice("1");
    kill(process, SIGTERM);
    EXPECT_EQ(end(), 128 + SIGTERM);
    expectKept("ended by a signal");
}

TEST_F(Loss, TheWindowsDeviceLostTwiceKeepsWhatIsUnsaved) {
    change();
    loseDevice("2");
    EXPECT_EQ(end(), 3);
    expectKept("and again after it was opened anew");
}

TEST_F(Loss, AKilledEditorsCopyIsFound) {
    change();
    ASSERT_TRUE(wait([&] {
        std::error_code error;
        for (const auto& entry : std::filesystem::directory_iterator(recoveryFolder(), error))
            if (entry.path().string().ends_with(".field.json")) return true;
        return false;
    }));
    kill(process, SIGKILL);
    EXPECT_EQ(end(), 128 + SIGKILL);
    expectKept("");
}

}  // namespace fw::editor::loss_test
