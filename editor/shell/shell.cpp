#include "editor/shell/shell.h"

#define GLFW_INCLUDE_NONE
#include <backends/imgui_impl_glfw.h>
#include <GLFW/glfw3.h>
#include <imgui_internal.h>

#include <algorithm>
#include <atomic>
#include <future>
#include <optional>

#include "editor/shell/draw_lists.h"
#include "editor/shell/input.h"
#include "editor/shell/letters.h"
#include "editor/shell/theme.h"
#include "runtime/window/swapchain.h"
#include "runtime/window/window.h"

namespace fw::editor {

namespace {

constexpr int kSettling = 2;         // frames after the one that heard of input
constexpr double kHeldWait = 0.033;  // seconds between frames while a mouse button is held
constexpr float kLeastScale = 0.5f, kMostScale = 4.0f;

std::atomic<bool> woken = false;

Device openDevice(const Desktop& desktop, const std::string& pick) {
    DeviceOptions options = desktop.deviceOptions();
    options.pick = pick;
    Result<Device> device = createDevice(options);
    if (!device) throw SystemError(format(device.error()));
    return std::move(*device);
}

struct CloseWindow {
    void operator()(GLFWwindow* window) const { glfwDestroyWindow(window); }
};
using WindowHandle = std::unique_ptr<GLFWwindow, CloseWindow>;

WindowHandle openWindow(int width, int height) {
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    for (const int desktopEntry : {GLFW_X11_CLASS_NAME, GLFW_X11_INSTANCE_NAME})
        glfwWindowHintString(desktopEntry, "fieldwright-editor");
    WindowHandle window(glfwCreateWindow(width, height, "Fieldwright", nullptr, nullptr));
    if (!window) throw SystemError("cannot open a window: " + windowSystemComplaint());
    return window;
}

/// As asked for, or the display's.
float scaleOf(GLFWwindow* window, float asked) {
    float scale = asked;
    if (scale <= 0.0f) glfwGetWindowContentScale(window, &scale, nullptr);
    return std::clamp(scale, kLeastScale, kMostScale);
}

/// ImGui's context, without a file of its own: preferences.h keeps the layout.
struct Interface {
    explicit Interface(GLFWwindow* window) {
        IMGUI_CHECKVERSION();
        ImGui::CreateContext();
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = io.LogFilename = nullptr;
        io.ConfigFlags = ImGuiConfigFlags_NavEnableKeyboard;
        io.ConfigInputTextCursorBlink = false;  // a caret that blinks draws ten frames a second for ever
        io.BackendRendererName = "fieldwright";
        io.BackendFlags = ImGuiBackendFlags_RendererHasVtxOffset;
        ImGui_ImplGlfw_InitForVulkan(window, false);
    }
    Interface(const Interface&) = delete;
    Interface& operator=(const Interface&) = delete;
    ~Interface() {
        ImGui_ImplGlfw_Shutdown();
        ImGui::DestroyContext();
    }
};

}  // namespace

struct Shell::State {
    explicit State(const ShellOptions& options)
        : device(openDevice(desktop, options.device)),
          window(openWindow(options.width, options.height)),
          interface(window.get()),
          input(window.get()),
          askedScale(options.scale) {
        show();
        followScale();
    }

    /// Makes what is the device's own.
    void show() {
        swapchain.emplace(device, window.get());
        lists = createDrawLists(device, swapchain->format());
    }

    void renewDevice() {
        const auto drop = [](Texture& texture) {
            texture.filled = false;
            texture.image = Image();
        };
        drop(glyphs);
        for (const auto& texture : textures) drop(*texture);
        forgotten.clear();
        lists = DrawLists();
        swapchain.reset();
        const DeviceOptions asked = device.asked;
        device = Device();  // the lost one goes before another comes
        device = reopenDevice(asked);
        show();
        unsettled = kSettling;
    }

    void fillTextures() {
        if (!glyphs.filled) fillTexture(device, lists, glyphs);
        for (const auto* all : {&textures, &forgotten})
            for (const auto& texture : *all)
                if (!texture->filled) fillTexture(device, lists, *texture);
    }

    /// Style and fonts for the theme and for the scale asked for, or the display's, which changes as the
    /// window is moved to another. Not within a frame. The fonts are there after finishFonts().
    void followScale() {
        const float before = std::exchange(scale, scaleOf(window.get(), askedScale));
        if (scale != before || styled != theme()) applyTheme(scale);
        styled = theme();
        if (scale == before && !glyphsAreWanted()) return;
        finishFonts();
        ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
        atlas.Clear();
        fonts = readFonts(atlas, scale);
        baking = std::async(std::launch::async, [&atlas] { bakeFonts(atlas); });
    }

    void finishFonts() {
        if (!baking.valid()) return;
        baking.get();
        ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
        ImGui::GetIO().FontDefault = fonts.of(kFontSize * scale);
        unsigned char* pixels = nullptr;
        int width = 0, height = 0;
        atlas.GetTexDataAsRGBA32(&pixels, &width, &height);
        glyphs.picture = {width, height, {pixels, pixels + std::size_t(width) * std::size_t(height) * 4}};
        glyphs.filled = false;
        atlas.SetTexID(&glyphs);
        atlas.ClearTexData();
    }

    std::pair<uint32_t, uint32_t> size() const {
        int width = 0, height = 0;
        glfwGetFramebufferSize(window.get(), &width, &height);
        return {uint32_t(width), uint32_t(height)};
    }

    Desktop desktop;
    Device device;
    WindowHandle window;
    std::optional<Swapchain> swapchain;
    Interface interface;
    Input input;
    float askedScale;
    float scale = 0.0f;
    Theme styled = Theme::dark;
    Fonts fonts;
    /// Beside whatever else a start takes. ImGui's count of allocations, which both threads change, is shown
    /// to nobody.
    std::future<void> baking;
    DrawLists lists;
    Texture glyphs;
    std::vector<std::unique_ptr<Texture>> textures, forgotten;
    int unsettled = kSettling;
};

Shell::Shell(const ShellOptions& options) : state(std::make_unique<State>(options)) {}
Shell::~Shell() = default;

bool Shell::waitEvents(double seconds) {
    Input& input = state->input;
    if (input.pending() || state->unsettled > 0 || seconds <= 0.0)
        glfwPollEvents();
    else
        glfwWaitEventsTimeout(input.mouseHeld() ? std::min(seconds, kHeldWait) : seconds);
    const bool asked = woken.exchange(false);
    if (input.happened() || input.pending()) {
        state->unsettled = kSettling;
        return true;
    }
    if (state->unsettled > 0) {
        --state->unsettled;
        return true;
    }
    return asked || input.mouseHeld();
}

void Shell::wake() {
    woken = true;
    glfwPostEmptyEvent();
}

bool Shell::answer(const std::function<void()>& show) {
    const auto [width, height] = state->size();
    if (width == 0 || height == 0) return false;
    state->forgotten.clear();
    state->followScale();
    state->finishFonts();
    ImGui_ImplGlfw_NewFrame();
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {float(width), float(height)};  // in pixels, wherever the system counts otherwise
    io.DisplayFramebufferScale = {1, 1};
    state->input.feed();
    for (const ImWchar letter : io.InputQueueCharacters) {
        char typed[5] = {};
        ImTextCharToUtf8(typed, letter);
        wantGlyphs(typed);
    }
    ImGui::NewFrame();
    show();
    ImGui::Render();
    if (glyphsAreWanted()) state->unsettled = std::max(state->unsettled, 1);
    return true;
}

void Shell::frame(const std::function<void()>& show) {
    if (!answer(show)) return;
    state->fillTextures();
    const SwapchainImage target = state->swapchain->acquire();
    if (!target) {
        state->unsettled = std::max(state->unsettled, int(target.changed));
        return;
    }
    Commands commands(state->device);
    imageBarrier(commands, target.image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                 VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    draw(commands, state->lists, *ImGui::GetDrawData(), target.view, target.extent,
         themeColor(ThemeColor::canvas));
    imageBarrier(commands, target.image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                 VK_IMAGE_LAYOUT_PRESENT_SRC_KHR);
    send(commands, target.drawn);
    if (!state->swapchain->present(target)) state->unsettled = std::max(state->unsettled, 1);
}

void Shell::renewDevice() { state->renewDevice(); }

bool Shell::closed() const { return glfwWindowShouldClose(state->window.get()); }
void Shell::keepOpen() { glfwSetWindowShouldClose(state->window.get(), GLFW_FALSE); }

ImTextureID Shell::show(ImTextureID id, const Picture& picture) {
    auto* texture = static_cast<Texture*>(id);
    if (!texture) texture = state->textures.emplace_back(std::make_unique<Texture>()).get();
    texture->picture = picture;
    texture->filled = false;
    return texture;
}

void Shell::forget(ImTextureID id) {
    const auto found =
        std::ranges::find_if(state->textures, [&](const auto& texture) { return texture.get() == id; });
    if (found == state->textures.end()) return;
    state->forgotten.push_back(std::move(*found));
    state->textures.erase(found);
}

std::vector<std::string> Shell::takeDropped() { return state->input.takeDropped(); }
const Fonts& Shell::fonts() const {
    state->finishFonts();
    return state->fonts;
}
float Shell::scale() const { return state->scale; }
void Shell::setScale(float asked) {
    state->askedScale = asked;
    state->unsettled = kSettling;
}
void Shell::resize(int width, int height) { glfwSetWindowSize(state->window.get(), width, height); }
std::pair<int, int> Shell::windowSize() const {
    int width = 0, height = 0;
    glfwGetWindowSize(state->window.get(), &width, &height);
    return {width, height};
}
const Device& Shell::device() const { return state->device; }
GLFWwindow* Shell::window() const { return state->window.get(); }
void Shell::setTitle(const std::string& title) {
    glfwSetWindowTitle(state->window.get(), wellFormed(title).c_str());
}

Picture Shell::capture() {
    const ImDrawData* data = ImGui::GetDrawData();
    assert(data && "there was no frame yet");
    const Device& device = state->device;
    const VkExtent3D extent = {uint32_t(data->DisplaySize.x), uint32_t(data->DisplaySize.y), 1};
    const VkFormat format = state->swapchain->format();
    state->fillTextures();
    const Image image =
        createImage(device, {.extent = extent,
                             .format = format,
                             .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT});
    const std::size_t bytes = std::size_t(extent.width) * extent.height * 4;
    const Buffer copied = createBuffer(device, bytes, Memory::readback);
    Commands commands(device);
    imageBarrier(commands, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    draw(commands, state->lists, *data, image.view, {extent.width, extent.height},
         themeColor(ThemeColor::canvas));
    imageBarrier(commands, image, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                 VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = extent;
    vkCmdCopyImageToBuffer(commands.handle, image.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, copied.handle,
                           1, &region);
    barrier(commands);
    submit(commands);
    Picture picture{int(extent.width), int(extent.height), download<uint8_t>(device, copied, bytes)};
    for (std::size_t i = 0; i < bytes; i += 4) {
        if (format == VK_FORMAT_B8G8R8A8_UNORM) std::swap(picture.pixels[i], picture.pixels[i + 2]);
        picture.pixels[i + 3] = 255;
    }
    return picture;
}

}  // namespace fw::editor
