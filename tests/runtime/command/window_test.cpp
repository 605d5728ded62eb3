// The window, on a virtual X display: a real GLFW window and swapchain, with the validation layer on, and
// `fieldwright play` under real keys and a real mouse. What is seen is read from the display's own memory.
#include "runtime/window/window.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "runtime/gpu/commands.h"
#include "tests/support/graph/temp_dir.h"
#include "tests/support/virtual_display.h"

namespace fw::window_test {

using test::rest;
using test::TempDir;
using test::VirtualDisplay;

/// Waits until something is as it should be; whether it became so within a minute.
template <class Condition>
bool eventually(Condition holds) {
    for (int i = 0; i < 600; ++i, rest(0.1))
        if (holds()) return true;
    return false;
}

/// Of one colour and alpha.
Picture filled(int width, int height, glm::ivec4 color) {
    Picture picture{width, height, {}};
    for (int i = 0; i < width * height; ++i)
        for (const int c : {color.r, color.g, color.b, color.a}) picture.pixels.push_back(uint8_t(c));
    return picture;
}

/// As the renderer leaves it.
Image onDevice(const Device& device, const Picture& picture) {
    Image image = createImage(device, {.extent = {uint32_t(picture.width), uint32_t(picture.height), 1},
                                       .format = VK_FORMAT_R32_UINT});
    Buffer staging = createBuffer(device, picture.pixels.size(), Memory::upload);
    upload(device, staging, picture.pixels);
    Commands commands(device);
    imageBarrier(commands, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    VkBufferImageCopy copy{};
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.imageExtent = image.extent;
    vkCmdCopyBufferToImage(commands.handle, staging.handle, image.handle,
                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
    imageBarrier(commands, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL);
    submit(commands);
    return image;
}

TEST(Window, ShowsPicturesAtEverySize) {
    const VirtualDisplay display;
    NEEDS_DISPLAY(display);
    const Desktop desktop;
    DeviceOptions options = desktop.deviceOptions();
    options.validation = true;
    Result<Device> device = createDevice(options);
    ASSERT_TRUE(device) << format(device.error());
    const auto record = device->record;
    {
        Viewer viewer;
        Window window(*device, "test", 320, 200, viewer);
        EXPECT_EQ(window.size(), std::pair(320, 200));
        EXPECT_EQ(viewer.width, 320);
        const auto shows = [&](int x, int y, glm::ivec3 color) {
            return eventually([&] { return display.pixel(x, y) == color; });
        };
        const Image large = onDevice(*device, filled(320, 200, {200, 30, 60, 255})),
                    small = onDevice(*device, filled(16, 16, {10, 220, 40, 255}));
        const Picture nothing = filled(320, 200, glm::ivec4(0));
        for (int i = 0; i < 3; ++i) {
            window.poll(0.05);
            EXPECT_TRUE(window.show(large, nothing));
        }
        EXPECT_TRUE(shows(160, 100, {200, 30, 60}));
        // A small picture fills the window too, and is seen through what lies over it.
        for (int i = 0; i < 3; ++i) EXPECT_TRUE(window.show(small, nothing));
        EXPECT_TRUE(shows(300, 190, {10, 220, 40}));
        EXPECT_TRUE(window.show(small, filled(320, 200, {100, 0, 51, 102})));
        EXPECT_TRUE(shows(5, 5, {106, 132, 75}));
        EXPECT_FALSE(window.show(Image(), nothing));
        // Between two colours lie those between.
        Picture two = filled(2, 1, {0, 0, 0, 255});
        for (std::size_t c = 4; c < 7; ++c) two.pixels[c] = 255;
        const Image halves = onDevice(*device, two);
        EXPECT_TRUE(window.show(halves, nothing));
        EXPECT_TRUE(shows(10, 100, {0, 0, 0}));
        EXPECT_EQ(display.pixel(310, 100), glm::ivec3(255));
        for (int x = 80; x < 230; x += 10)
            EXPECT_LT(display.pixel(x, 50).g, display.pixel(x + 10, 50).g) << x;

        for (const auto& [width, height] : {std::pair{1, 1}, {2, 300}, {640, 480}, {1, 1}, {200, 100}}) {
            window.resize(width, height);
            for (int i = 0; i < 20 && viewer.width != width; ++i) window.poll(0.05);
            EXPECT_EQ(viewer.width, width);
            bool shown = false;
            for (int i = 0; i < 5; ++i) {
                window.poll(0.02);
                shown = window.show(small, filled(width, height, glm::ivec4(0))) || shown;
            }
            EXPECT_TRUE(shown) << width << " x " << height;
        }
        viewer.fullScreen = true;
        window.poll(0.1);
        window.poll(0.1);
        EXPECT_EQ(window.size(), std::pair(640, 480));
        const Picture over = filled(640, 480, glm::ivec4(0));
        EXPECT_TRUE(window.show(small, over) || window.show(small, over));
        viewer.fullScreen = false;
        window.poll(0.1);
        window.poll(0.1);
        EXPECT_EQ(window.size(), std::pair(200, 100));
    }
    for (const std::string& message : record->messages) ADD_FAILURE() << "validation layer: " << message;
}

/// `fieldwright play` beside the test.
class Playing {
  public:
    explicit Playing(const std::string& graph) {
        process = fork();
        if (process != 0) return;
        if (!std::freopen(errors.c_str(), "w", stderr)) _exit(126);
        execl(FIELDWRIGHT_BINARY_DIR "/fieldwright", "fieldwright", "play", graph.c_str(), "--size",
              "320x200", nullptr);
        _exit(127);
    }
    ~Playing() {
        if (process > 0) kill(process, SIGKILL), waitpid(process, nullptr, 0);
    }
    /// The exit status once it has ended; -1 if it has not within some seconds.
    int status() {
        for (int i = 0; i < 200; ++i, rest(0.1)) {
            int state = 0;
            if (waitpid(process, &state, WNOHANG) != process) continue;
            process = -1;
            return WIFEXITED(state) ? WEXITSTATUS(state) : 128 + WTERMSIG(state);
        }
        return -1;
    }
    std::string said() const { return test::readText(errors); }
    void interrupt() const { kill(process, SIGINT); }

  private:
    TempDir folder;
    std::string errors = folder.path("errors");
    pid_t process = -1;
};

std::string ball(const std::string& color, const std::string& type = "sphere") {
    return R"({"fieldwright": 1, "nodes": [{"id": "ball", "type": ")" + type + R"("},
      {"id": "paint", "type": "material", "inputs": {"surface": {"from": "ball"}, "base_color": )" +
           color + R"(}},
      {"id": "turn", "type": "rotate", "inputs": {"surface": {"from": "paint"}}},
      {"id": "out", "type": "output", "inputs": {"surface": {"from": "turn"}, "resolution": 32}}],
      "timeline": {"length": 4, "tracks": [{"node": "turn", "input": "angles.y",
        "keys": [{"time": 0, "value": 0}, {"time": 4, "value": 360}]}]}})";
}
constexpr const char *kRed = "[0.8, 0.02, 0.02]", *kGreen = "[0.02, 0.6, 0.02]";

bool xdotool(const std::string& what) { return test::runProgram("xdotool " + what).status == 0; }

TEST(PlayWindow, KeysMouseSizesAndAChangingFile) {
    const VirtualDisplay display;
    NEEDS_DISPLAY(display);
    ASSERT_TRUE(xdotool("version")) << "run ./.install test";
    const TempDir folder;
    const std::string graph = folder.path("a.field.json");
    test::writeText(graph, ball(kRed));
    Playing playing(graph);
    const auto middle = [&] { return display.pixel(160, 100); };
    const auto isRed = [&] { return middle().r > middle().g + 40; };
    const auto isGreen = [&] { return middle().g > middle().r + 40; };
    ASSERT_TRUE(eventually(isRed)) << playing.said();

    ASSERT_TRUE(xdotool("mousemove 160 100 key space"));
    EXPECT_FALSE(display.pixel(12, 12).r < 90);
    xdotool("key F1");  // a dark panel in the corner
    EXPECT_TRUE(eventually([&] { return display.pixel(12, 12).r < 90; }));
    xdotool("key F1");
    EXPECT_TRUE(eventually([&] { return display.pixel(12, 12).r > 90; }));

    xdotool("mousemove 160 100 mousedown 1 mousemove 200 90 mouseup 1 key Right key Left click 4 click 5");
    xdotool("mousemove 160 20 mousedown 3 mousemove 160 300 mouseup 3");  // the ball leaves the middle
    EXPECT_TRUE(eventually([&] { return !isRed(); }));
    xdotool("key r");
    EXPECT_TRUE(eventually(isRed));

    test::writeText(graph, ball(kGreen));
    EXPECT_TRUE(eventually(isGreen));
    test::writeText(graph, ball(kRed, "sphree"));  // the last good picture stays, and the error is said
    EXPECT_TRUE(
        eventually([&] { return playing.said().find("did you mean 'sphere'?") != std::string::npos; }));
    EXPECT_TRUE(isGreen());
    test::writeText(graph, ball(kRed).substr(0, 100));
    EXPECT_TRUE(eventually([&] { return playing.said().find("a.field.json:1:") != std::string::npos; }))
        << playing.said();
    EXPECT_TRUE(isGreen());
    test::writeText(graph, ball(kRed, "box"));
    EXPECT_TRUE(eventually(isRed));
    // Another structure, and nothing to see of it: what is wrong is said over the last picture.
    EXPECT_TRUE(eventually([&] { return display.pixel(12, 12).r > 90; }));
    test::writeText(graph, R"({"fieldwright": 1, "nodes": [
      {"id": "a", "type": "expression", "code": "return length(p) + 1;"},
      {"id": "out", "type": "output", "inputs": {"surface": {"from": "a"}}}]})");
    EXPECT_TRUE(eventually([&] { return display.pixel(12, 12).r < 90; })) << playing.said();
    EXPECT_TRUE(isRed());
    test::writeText(graph, ball(kRed, "box"));
    EXPECT_TRUE(eventually([&] { return display.pixel(12, 12).r > 90; }));
    EXPECT_TRUE(eventually(isRed));

    const std::string window = "$(xdotool search --name Fieldwright | head -n 1) ";
    for (const char* size : {"1 1", "400 3", "3 400", "1 1", "320 200"}) {
        xdotool("windowsize " + window + size);
        rest(0.3);
    }
    EXPECT_TRUE(eventually(isRed));
    xdotool("windowunmap " + window);
    rest(0.3);
    xdotool("windowmap " + window);
    EXPECT_TRUE(eventually(isRed));
    xdotool("mousemove 160 100 key F11");
    rest(0.5);
    xdotool("key Escape");
    rest(0.5);
    xdotool("key Escape");
    EXPECT_EQ(playing.status(), 0) << playing.said();
}

TEST(PlayWindow, CtrlCEndsIt) {
    const VirtualDisplay display;
    NEEDS_DISPLAY(display);
    const TempDir folder;
    const std::string graph = folder.path("a.field.json");
    test::writeText(graph, ball(kRed));
    Playing playing(graph);
    ASSERT_TRUE(eventually([&] { return display.pixel(160, 100).r > display.pixel(160, 100).g + 40; }))
        << playing.said();
    playing.interrupt();
    EXPECT_EQ(playing.status(), 130);
}

}  // namespace fw::window_test
