// Devices of the editor that are lost: the preview draws again, an export begins again, the window stays.
#include <gtest/gtest.h>

#include <filesystem>

#include "editor/files/export_job.h"
#include "editor/preview/preview.h"
#include "editor/shell/shell.h"
#include "graph/document/json.h"
#include "tests/support/faults.h"
#include "tests/support/graph/temp_dir.h"
#include "tests/support/virtual_display.h"

namespace fw::editor::lost_device_test {

using fw::test::Faults;
using fw::test::readText;
using fw::test::TempDir;
using fw::test::writeText;

std::shared_ptr<const Graph> ball(double radius) {
    const Result<Graph> graph =
        parseGraph(R"({"fieldwright": 1, "nodes": [{"id": "ball", "type": "sphere", "inputs": {"radius": )" +
                       std::to_string(radius) +
                       R"(}}, {"id": "out", "type": "output",
                   "inputs": {"surface": {"from": "ball"}, "resolution": 24}}]})",
                   "", nullptr);
    EXPECT_TRUE(graph);
    return std::make_shared<const Graph>(*graph);
}

struct EditorsLostDevice : testing::Test {
    TempDir folder;
    const std::string told = folder.path("lose");
    const Faults faults{{.loseWhenThere = told}};
};

TEST_F(EditorsLostDevice, ThePreviewDrawsAgain) {
    Preview preview({.validation = true}, {});
    uint64_t revision = 0;
    const auto shown = [&](double radius) {
        preview.ask({.graph = ball(radius), .revision = ++revision, .width = 80, .height = 60});
        for (PreviewResult latest;; fw::test::rest(0.002))
            if (std::optional<PreviewResult> result = preview.take()) {
                latest = std::move(*result);
                if (!latest.failure.empty() ||
                    (latest.revision == revision && latest.current && !latest.draft))
                    return latest;
            }
    };
    const Picture before = shown(0.5).picture;
    for (const double radius : {0.4, 0.3}) {
        writeText(told, "1");
        const PreviewResult result = shown(radius);
        EXPECT_EQ(result.failure, "");
        EXPECT_FALSE(std::filesystem::exists(told));
        EXPECT_FALSE(result.picture.pixels.empty());
    }
    writeText(told, "2");
    EXPECT_NE(shown(0.35).failure.find("and again after it was opened anew"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(told));
    EXPECT_EQ(shown(0.45).failure, "");
}

TEST_F(EditorsLostDevice, AnExportBeginsAgainAndSaysSo) {
    const auto exported = [&](const std::string& path) {
        const ExportJob job({.graph = ball(0.5), .path = path, .device = {.validation = true}}, {});
        while (job.state().phase == ExportState::Phase::running) fw::test::rest(0.002);
        return job.state();
    };
    const std::string mesh = folder.path("a.ply");
    EXPECT_FALSE(exported(mesh).again);
    const std::string whole = readText(mesh);
    std::filesystem::remove(mesh);
    writeText(told, "1");
    const ExportState state = exported(mesh);
    EXPECT_EQ(state.phase, ExportState::Phase::done);
    EXPECT_TRUE(state.again);
    EXPECT_TRUE(readText(mesh) == whole);
    writeText(told, "2");
    const ExportState failed = exported(folder.path("b.ply"));
    ASSERT_EQ(failed.phase, ExportState::Phase::failed);
    EXPECT_NE(failed.problems.front().message.find("and again after"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(folder.path("b.ply")));
}

TEST_F(EditorsLostDevice, TheWindowShowsTheSameWithAnother) {
    const fw::test::VirtualDisplay display;
    NEEDS_DISPLAY(display);
    Shell shell({.width = 320, .height = 240, .scale = 1.0f});
    Picture picture{8, 8, {}};
    for (int i = 0; i < 64; ++i)
        for (const int c : {4 * i, 200 - i, 90, 255}) picture.pixels.push_back(uint8_t(c));
    const ImTextureID texture = shell.show(nullptr, picture);
    const auto frame = [&] {
        shell.frame([&] {
            ImGui::SetNextWindowPos({0, 0});
            ImGui::Begin("words");
            ImGui::Image(texture, {64, 64});
            ImGui::End();
        });
    };
    for (int i = 0; i < 3; ++i) frame();
    const Picture before = shell.capture();
    for (const int times : {1, 1}) {
        writeText(told, std::to_string(times));
        EXPECT_THROW(frame(), DeviceLost);
        shell.renewDevice();
        frame();
        EXPECT_EQ(shell.capture().pixels, before.pixels);
    }
    for (const std::string& message : shell.device().validationMessages()) ADD_FAILURE() << message;
}

}  // namespace fw::editor::lost_device_test
