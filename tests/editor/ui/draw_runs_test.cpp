// Which triangles of a draw command are opaque.
#include <gtest/gtest.h>
#include <imgui_internal.h>

#include "editor/shell/draw_runs.h"

namespace fw::editor::draw_runs_test {

const ImVec2 kWhite{0.5f, 0.25f};
constexpr ImU32 kOpaque = IM_COL32(40, 50, 60, 255), kThin = IM_COL32(40, 50, 60, 128);

struct Command {
    ImDrawListSharedData shared;
    ImDrawList list{&shared};
    ImDrawCmd command;

    Command() { command.ClipRect = {0, 0, 1000, 800}; }
    /// Two triangles.
    void rectangle(float width, float height, ImU32 color, ImVec2 texel = kWhite) {
        const auto first = ImDrawIdx(list.VtxBuffer.Size);
        for (const ImVec2 at : {ImVec2(0, 0), ImVec2(width, 0), ImVec2(width, height), ImVec2(0, height)})
            list.VtxBuffer.push_back({at, texel, color});
        for (const int i : {0, 1, 2, 0, 2, 3}) list.IdxBuffer.push_back(ImDrawIdx(first + i));
        command.ElemCount += 6;
    }
    std::vector<DrawRun> runs(const ImVec2* white = &kWhite) {
        std::vector<DrawRun> all;
        cutIntoRuns(list, command, white, all);
        unsigned next = 0;
        for (const DrawRun& run : all) {
            EXPECT_EQ(run.first, next) << "each triangle once, in order";
            EXPECT_GT(run.count, 0u);
            next += run.count;
        }
        EXPECT_EQ(next, command.ElemCount);
        return all;
    }
};

TEST(DrawRuns, AreOpaqueWhereThatIsLarge) {
    Command command;
    command.rectangle(20, 20, kOpaque);
    EXPECT_EQ(command.runs(), (std::vector<DrawRun>{{0, 6, false}})) << "small";
    command.rectangle(500, 400, kOpaque);
    EXPECT_EQ(command.runs(), (std::vector<DrawRun>{{0, 12, true}}));
    command.rectangle(500, 400, kThin);
    command.rectangle(500, 400, kOpaque, {0.1f, 0.1f});
    command.rectangle(500, 400, kOpaque);
    EXPECT_EQ(command.runs(), (std::vector<DrawRun>{{0, 12, true}, {12, 12, false}, {24, 6, true}}));
    command.rectangle(10, 10, kThin);
    command.rectangle(10, 10, kOpaque);
    command.rectangle(10, 10, kThin);
    EXPECT_EQ(command.runs(),
              (std::vector<DrawRun>{{0, 12, true}, {12, 12, false}, {24, 6, true}, {30, 18, false}}));
}

TEST(DrawRuns, OfManySmallOnesAreOpaqueTogether) {
    Command command;
    for (int i = 0; i < 200; ++i) command.rectangle(1, 60, kOpaque);
    EXPECT_EQ(command.runs(), (std::vector<DrawRun>{{0, 1200, true}}));
    command.command.ClipRect = {0, 0, 10, 3};
    EXPECT_EQ(command.runs(), (std::vector<DrawRun>{{0, 1200, true}})) << "30 pixels each, 400 triangles";
    command.command.ClipRect = {0, 0, 1, 3};
    EXPECT_EQ(command.runs(), (std::vector<DrawRun>{{0, 1200, false}})) << "little of it is seen";
}

TEST(DrawRuns, OfAPictureGoByItsColourAlone) {
    Command command;
    command.rectangle(300, 300, IM_COL32_WHITE, {0.1f, 0.7f});
    EXPECT_EQ(command.runs(nullptr), (std::vector<DrawRun>{{0, 6, true}}));
    command.rectangle(300, 300, IM_COL32(255, 255, 255, 254), {0.1f, 0.7f});
    EXPECT_EQ(command.runs(nullptr), (std::vector<DrawRun>{{0, 6, true}, {6, 6, false}}));
    EXPECT_EQ(command.runs(), (std::vector<DrawRun>{{0, 12, false}})) << "of glyphs it is text";
}

}  // namespace fw::editor::draw_runs_test
