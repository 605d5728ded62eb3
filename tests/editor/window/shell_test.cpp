// The editor's window on a virtual display: what is drawn, its colours and places, at every size.
#include "editor/shell/shell.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cstdio>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <thread>

#include "editor/shell/theme.h"
#include "runtime/system/clock.h"
#include "tests/support/graph/temp_dir.h"
#include "tests/support/virtual_display.h"

namespace fw::editor::shell_test {

using fw::test::rest;
using fw::test::VirtualDisplay;

double processorSeconds() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    const auto seconds = [](const timeval& time) {
        return double(time.tv_sec) + 1e-6 * double(time.tv_usec);
    };
    return seconds(used.ru_utime) + seconds(used.ru_stime);
}

glm::ivec3 at(const Picture& picture, int x, int y) {
    const std::size_t i = 4 * (std::size_t(y) * std::size_t(picture.width) + std::size_t(x));
    return {picture.pixels.at(i), picture.pixels.at(i + 1), picture.pixels.at(i + 2)};
}

glm::ivec3 components(ImU32 color) { return {color & 255u, (color >> 8) & 255u, (color >> 16) & 255u}; }

/// A picture of which every pixel is another colour.
Picture ramp(int width, int height) {
    Picture picture{width, height, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (const int c : {4 * x, 5 * y, 200 - x - y, 255}) picture.pixels.push_back(uint8_t(c));
    return picture;
}

class ShellTest : public testing::Test {
  protected:
    void SetUp() override {
        NEEDS_DISPLAY(display);
        setenv("FIELDWRIGHT_VALIDATION", "1", 1);
        shell.emplace(ShellOptions{.width = 640, .height = 480, .scale = 1.0f});
        record = shell->device().record;
    }
    void TearDown() override {
        shell.reset();
        if (!record) return;
        for (const std::string& message : record->messages) ADD_FAILURE() << "validation layer: " << message;
    }
    /// Frames until nothing asks for more.
    void settle(const std::function<void()>& show) {
        for (int i = 0; i < 50 && (shell->waitEvents(0.0) || i < 3); ++i) shell->frame(show);
    }

    VirtualDisplay display{1280, 800};
    std::optional<Shell> shell;
    std::shared_ptr<DeviceRecord> record;
};

TEST_F(ShellTest, DrawsWhatWasAskedFor) {
    const Picture picture = ramp(40, 30);
    const ImTextureID id = shell->show(nullptr, picture);
    const auto show = [&] {
        ImDrawList& list = *ImGui::GetBackgroundDrawList();
        list.AddRectFilled({10, 10}, {110, 60}, IM_COL32(200, 30, 60, 255));
        list.AddRectFilled({200, 10}, {300, 60}, IM_COL32(1, 128, 254, 255));
        list.AddRectFilled({250, 30}, {300, 60}, IM_COL32(255, 255, 255, 51));   // one part in five
        list.AddRectFilled({200, 100}, {340, 180}, IM_COL32(1, 128, 254, 255));  // large: without a picture
        list.AddRectFilled({220, 110}, {320, 170}, IM_COL32(255, 255, 255, 51));
        list.PushClipRect({400, 10}, {450, 30});
        list.AddRectFilled({350, 0}, {600, 200}, IM_COL32(0, 158, 115, 255));
        list.PopClipRect();
        list.AddImage(id, {100, 200}, {140, 230});
        list.AddText(shell->fonts().of(28), 28, {100, 300}, IM_COL32(255, 255, 255, 255), "Tower");
    };
    shell->frame(show);
    const Picture seen = shell->capture();
    ASSERT_EQ(std::pair(seen.width, seen.height), std::pair(640, 480));
    const glm::ivec3 canvas = components(themeColor(ThemeColor::canvas)), red = {200, 30, 60},
                     blue = {1, 128, 254}, green = {0, 158, 115};
    EXPECT_EQ(at(seen, 0, 0), canvas);
    EXPECT_EQ(at(seen, 10, 10), red);
    EXPECT_EQ(at(seen, 109, 59), red);
    EXPECT_EQ(at(seen, 110, 59), canvas);
    EXPECT_EQ(at(seen, 109, 60), canvas);
    EXPECT_EQ(at(seen, 210, 20), blue);
    EXPECT_EQ(at(seen, 275, 45), glm::ivec3(52, 153, 254));  // blended in sRGB
    EXPECT_EQ(at(seen, 210, 105), blue);
    EXPECT_EQ(at(seen, 270, 140), glm::ivec3(52, 153, 254));
    EXPECT_EQ(at(seen, 400, 10), green);
    EXPECT_EQ(at(seen, 449, 29), green);
    for (const auto& [x, y] : {std::pair{399, 20}, {450, 20}, {420, 9}, {420, 30}})
        EXPECT_EQ(at(seen, x, y), canvas) << x << ' ' << y;
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x)
            ASSERT_EQ(at(seen, 100 + x, 200 + y), at(picture, x, y)) << x << ' ' << y;
    int ink = 0, lowest = 0;
    for (int y = 300; y < 340; ++y)
        for (int x = 100; x < 200; ++x)
            if (at(seen, x, y).r > 200) ++ink, lowest = y;
    EXPECT_GT(ink, 150);
    EXPECT_LT(ink, 1000);
    EXPECT_NEAR(lowest, 325, 4);  // the baseline of 28 pixels of DejaVu

    EXPECT_EQ(shell->capture().pixels, seen.pixels);
    shell->frame(show);
    EXPECT_EQ(shell->capture().pixels, seen.pixels);
    for (int i = 0; i < 3; ++i) shell->frame(show);
    rest(0.2);
    EXPECT_EQ(display.pixel(50, 30), red);
    EXPECT_EQ(display.pixel(110, 210), at(picture, 10, 10));
    if (const char* path = std::getenv("FIELDWRIGHT_SHOTS"))
        (void)savePicture(seen, std::string(path) + "/shell.png");
}

TEST_F(ShellTest, ReplacesAndForgetsPictures) {
    ImTextureID id = shell->show(nullptr, ramp(40, 30));
    const auto show = [&] {
        if (id) ImGui::GetBackgroundDrawList()->AddImage(id, {0, 0}, {50, 20});
    };
    shell->frame(show);
    EXPECT_EQ(shell->show(id, ramp(50, 20)), id);
    shell->frame(show);
    EXPECT_EQ(at(shell->capture(), 49, 19), at(ramp(50, 20), 49, 19));
    shell->forget(id);
    EXPECT_EQ(at(shell->capture(), 49, 19), at(ramp(50, 20), 49, 19));  // the last frame still shows it
    id = nullptr;
    shell->frame(show);
    EXPECT_EQ(at(shell->capture(), 49, 19), components(themeColor(ThemeColor::canvas)));
    shell->forget(nullptr);
}

TEST_F(ShellTest, FollowsTheWindowsSize) {
    const auto show = [&] {
        const ImVec2 size = ImGui::GetIO().DisplaySize;
        ImGui::GetBackgroundDrawList()->AddRectFilled({size.x - 1, size.y - 1}, size,
                                                      IM_COL32(213, 94, 0, 255));
    };
    for (const auto& [width, height] : {std::pair{1, 1}, {300, 2}, {900, 700}, {1, 1}, {640, 480}}) {
        glfwSetWindowSize(shell->window(), width, height);
        for (int i = 0; i < 20; ++i) {
            rest(0.02);
            if (shell->waitEvents(0.0)) shell->frame(show);
        }
        const Picture seen = shell->capture();
        EXPECT_EQ(std::pair(seen.width, seen.height), std::pair(width, height));
        EXPECT_EQ(at(seen, width - 1, height - 1), glm::ivec3(213, 94, 0));
    }
    glfwHideWindow(shell->window());
    for (int i = 0; i < 3; ++i) shell->waitEvents(0.0), shell->frame(show);
    glfwShowWindow(shell->window());
    settle(show);
}

TEST_F(ShellTest, RestsUntilSomethingHappens) {
    int frames = 0;
    const auto show = [&] {
        ++frames;
        ImGui::ShowDemoWindow();
    };
    settle(show);
    EXPECT_FALSE(shell->waitEvents(0.0));
    frames = 0;
    const double before = processorSeconds();
    const Clock::time_point start = Clock::now();
    while (millisecondsSince(start) < 2000)
        if (shell->waitEvents(0.5)) shell->frame(show);
    std::printf("at rest: %d frames and %.1f ms of processor time in 2 s\n", frames,
                1e3 * (processorSeconds() - before));
    EXPECT_EQ(frames, 0);

    std::thread other([] { Shell::wake(); });
    EXPECT_TRUE(shell->waitEvents(60.0));
    other.join();
    EXPECT_FALSE(shell->waitEvents(0.0));
    EXPECT_FALSE(shell->closed());
    glfwSetWindowShouldClose(shell->window(), GLFW_TRUE);
    EXPECT_TRUE(shell->closed());
    shell->keepOpen();
    EXPECT_FALSE(shell->closed());
}

TEST_F(ShellTest, HearsEveryKeyAndClickOfOneMoment) {
    ASSERT_EQ(fw::test::runProgram("xdotool version").status, 0) << "run ./.install test";
    std::string pressed;
    std::vector<glm::ivec2> clicks;
    const auto show = [&] {
        for (const int key : {GLFW_KEY_A, GLFW_KEY_B, GLFW_KEY_D})
            if (ImGui::IsKeyPressed(key, false))
                pressed += std::string(ImGui::GetIO().KeyCtrl ? "^" : "") + char(key);
        const ImVec2 mouse = ImGui::GetIO().MousePos;
        if (ImGui::IsMouseClicked(0)) clicks.push_back({int(mouse.x), int(mouse.y)});
    };
    settle(show);
    // All between two frames.
    const fw::test::ProgramResult sent = fw::test::runProgram(
        "xdotool mousemove 100 90 key --delay 0 a b ctrl+d click --repeat 2 --delay 0 1 "
        "mousemove 300 200 click 1 mousemove 400 50");
    ASSERT_EQ(sent.status, 0) << sent.output;
    rest(0.2);
    settle(show);
    EXPECT_EQ(pressed, "AB^D");
    EXPECT_EQ(clicks, (std::vector<glm::ivec2>{{100, 90}, {100, 90}, {300, 200}}));
    EXPECT_EQ(ImGui::GetIO().MousePos.x, 400);
    EXPECT_FALSE(shell->waitEvents(0.0));
}

TEST_F(ShellTest, TakesAClickWhereTheMouseHasJustCome) {
    ASSERT_EQ(fw::test::runProgram("xdotool version").status, 0) << "run ./.install test";
    std::string open;
    ImVec2 tab{0, 0}, button{0, 0};
    const auto show = [&] {
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize({400, 300});
        ImGui::Begin("tabs");
        ImGui::Button("Over this first");
        button = ImGui::GetItemRectMin();
        ImGui::BeginTabBar("bar");
        for (const char* name : {"First", "Second"}) {
            if (ImGui::BeginTabItem(name)) {
                open = name;
                ImGui::EndTabItem();
            }
            tab = ImGui::GetItemRectMin();
        }
        ImGui::EndTabBar();
        ImGui::End();
    };
    settle(show);
    const auto at = [](ImVec2 p) {
        return "mousemove " + std::to_string(int(p.x) + 5) + " " + std::to_string(int(p.y) + 5) + " ";
    };
    ASSERT_EQ(fw::test::runProgram("xdotool " + at(button)).status, 0);
    rest(0.2);
    settle(show);
    ASSERT_EQ(open, "First");
    ASSERT_EQ(fw::test::runProgram("xdotool " + at(tab) + "click 1").status, 0);
    rest(0.2);
    settle(show);
    EXPECT_EQ(open, "Second");
}

TEST_F(ShellTest, KeysWaitForAMenuThatOpens) {
    ASSERT_EQ(fw::test::runProgram("xdotool version").status, 0) << "run ./.install test";
    char typed[32] = {}, after[32] = {};
    int saved = 0;
    const auto show = [&] {
        if (ImGui::GetIO().KeyCtrl && !ImGui::GetIO().WantTextInput && ImGui::IsKeyPressed(GLFW_KEY_S, false))
            ++saved;
        const bool opens = ImGui::GetIO().KeyCtrl && ImGui::IsKeyPressed(GLFW_KEY_A, false);
        if (opens) ImGui::OpenPopup("menu");
        if (!ImGui::BeginPopup("menu")) return;
        if (opens) ImGui::SetKeyboardFocusHere();
        if (ImGui::InputText("##text", typed, sizeof typed, ImGuiInputTextFlags_EnterReturnsTrue)) {
            std::snprintf(after, sizeof after, "%s", typed);
            ImGui::CloseCurrentPopup();
        }
        ImGui::EndPopup();
    };
    settle(show);
    const fw::test::ProgramResult sent =
        fw::test::runProgram("xdotool mousemove 100 90 key ctrl+a type --args 1 'box max' key Return ctrl+s");
    ASSERT_EQ(sent.status, 0) << sent.output;
    rest(0.2);
    for (int i = 0; i < 200 && (shell->waitEvents(0.0) || i < 3); ++i) shell->frame(show);
    EXPECT_STREQ(after, "box max");
    EXPECT_EQ(saved, 1);
}

TEST_F(ShellTest, FontsAreBakedAtManySizes) {
    EXPECT_EQ(shell->fonts().missing, "");
    EXPECT_EQ(shell->fonts().of(14)->FontSize, 14);
    EXPECT_EQ(shell->fonts().of(1)->FontSize, 7);
    EXPECT_EQ(shell->fonts().codeOf(100)->FontSize, 40);
    for (const char* sign :
         {"Å", "ß", "ž", "π", "…", "›", "×", "²", "→", "≥", "▶", "●", "☰", "⚠", "✓", "↺"}) {
        unsigned character = 0;
        const auto* bytes = reinterpret_cast<const unsigned char*>(sign);
        character = bytes[0] < 0xe0 ? (bytes[0] & 31u) << 6 | (bytes[1] & 63u)
                                    : (bytes[0] & 15u) << 12 | (bytes[1] & 63u) << 6 | (bytes[2] & 63u);
        EXPECT_TRUE(shell->fonts().of(14)->FindGlyphNoFallback(ImWchar(character))) << sign;
    }
}

TEST_F(ShellTest, TimeOfAFrame) {
    glfwSetWindowSize(shell->window(), 1280, 800);
    const auto show = [&] {
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize({1280, 800});
        ImGui::ShowDemoWindow();
    };
    for (int i = 0; i < 20; ++i) shell->waitEvents(0.0), shell->frame(show);
    constexpr int kFrames = 50;
    const Clock::time_point start = Clock::now();
    for (int i = 0; i < kFrames; ++i) shell->frame(show);
    std::printf("frame of the demo window at 1280x800 on %s: %.2f ms\n", shell->device().name().c_str(),
                millisecondsSince(start) / kFrames);
    const Picture seen = shell->capture();
    EXPECT_EQ(seen.width, 1280);
    if (const char* path = std::getenv("FIELDWRIGHT_SHOTS"))
        (void)savePicture(seen, std::string(path) + "/demo.png");
}

}  // namespace fw::editor::shell_test
