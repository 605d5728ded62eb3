#include "runtime/window/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "runtime/gpu/commands.h"
#include "shaders/shared.h"

#include "shaders/window/window.h"

namespace fw {

namespace {

Viewer& viewerOf(GLFWwindow* window) { return *static_cast<Viewer*>(glfwGetWindowUserPointer(window)); }

void onKey(GLFWwindow* window, int key, int, int action, int) {
    if (action == GLFW_RELEASE) return;
    Viewer& viewer = viewerOf(window);
    // Held down, only the steps repeat.
    if (key == GLFW_KEY_LEFT) return viewer.key(ViewerKey::back);
    if (key == GLFW_KEY_RIGHT) return viewer.key(ViewerKey::forward);
    if (action == GLFW_REPEAT) return;
    switch (key) {
        case GLFW_KEY_SPACE: return viewer.key(ViewerKey::pause);
        case GLFW_KEY_HOME: return viewer.key(ViewerKey::start);
        case GLFW_KEY_END: return viewer.key(ViewerKey::end);
        case GLFW_KEY_F11:
        case GLFW_KEY_F: return viewer.key(ViewerKey::fullScreen);
        case GLFW_KEY_F1:
        case GLFW_KEY_H: return viewer.key(ViewerKey::help);
        case GLFW_KEY_R: return viewer.key(ViewerKey::resetCamera);
        case GLFW_KEY_ESCAPE: return viewer.key(ViewerKey::leave);
        case GLFW_KEY_Q: return viewer.key(ViewerKey::quit);
        default: return;
    }
}

/// From the window's coordinates to pixels, which differ on some screens.
double pixelsPerUnit(GLFWwindow* window) {
    int units = 0, pixels = 0;
    glfwGetWindowSize(window, &units, nullptr);
    glfwGetFramebufferSize(window, &pixels, nullptr);
    return units > 0 ? double(pixels) / units : 1.0;
}

void onButton(GLFWwindow* window, int button, int action, int) {
    const MouseButton which = button == GLFW_MOUSE_BUTTON_LEFT    ? MouseButton::left
                              : button == GLFW_MOUSE_BUTTON_RIGHT ? MouseButton::right
                                                                  : MouseButton::middle;
    // Where the mouse is now may be far from where it was when the button went down: the viewer follows it.
    if (action == GLFW_PRESS)
        viewerOf(window).press(which);
    else
        viewerOf(window).release(which);
}

void onMove(GLFWwindow* window, double x, double y) {
    const double scale = pixelsPerUnit(window);
    viewerOf(window).move(x * scale, y * scale);
}

void onScroll(GLFWwindow* window, double, double y) { viewerOf(window).scroll(y); }
void onResize(GLFWwindow* window, int width, int height) { viewerOf(window).resize(width, height); }
void onClose(GLFWwindow* window) { viewerOf(window).closed = true; }
void onRefresh(GLFWwindow* window) { viewerOf(window).dirty = true; }

}  // namespace

Desktop::Desktop() {
    if (!glfwInit())
        throw SystemError("there is no window system here (" + windowSystemComplaint() +
                          "): use --headless, or render to pictures");
    if (!glfwVulkanSupported()) {
        glfwTerminate();
        throw SystemError("the window system has no Vulkan: use --headless, or render to pictures");
    }
}

Desktop::~Desktop() { glfwTerminate(); }

DeviceOptions Desktop::deviceOptions() const {
    uint32_t count = 0;
    const char** names = glfwGetRequiredInstanceExtensions(&count);
    DeviceOptions options;
    options.presentation = true;
    options.instanceExtensions.assign(names, names + count);
    return options;
}

Window::Window(const Device& device_, const std::string& title, int width, int height, Viewer& viewer_)
    : viewer(viewer_) {
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    handle = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
    if (!handle) throw SystemError("cannot open a window: " + windowSystemComplaint());
    glfwSetWindowUserPointer(handle, &viewer);
    glfwSetKeyCallback(handle, onKey);
    glfwSetMouseButtonCallback(handle, onButton);
    glfwSetCursorPosCallback(handle, onMove);
    glfwSetScrollCallback(handle, onScroll);
    glfwSetFramebufferSizeCallback(handle, onResize);
    glfwSetWindowCloseCallback(handle, onClose);
    glfwSetWindowRefreshCallback(handle, onRefresh);
    const auto [wide, high] = size();
    viewer.resize(wide, high);
    useDevice(device_);
}

Window::~Window() {
    leaveDevice();
    if (handle) glfwDestroyWindow(handle);
}

void Window::leaveDevice() {
    swapchain.reset();
    over = Buffer(), composed = Buffer();
    shown = Image();
    compose = Pipeline();
}

void Window::useDevice(const Device& device_) {
    device = &device_;
    swapchain.emplace(*device, handle);
    compose = createComputePipeline(*device, {.name = "window/compose.comp"});
}

std::pair<int, int> Window::size() const {
    int width = 0, height = 0;
    glfwGetFramebufferSize(handle, &width, &height);
    return {width, height};
}

void Window::poll(double wait) {
    if (wait > 0.0)
        glfwWaitEventsTimeout(wait);
    else
        glfwPollEvents();
    setFullScreen(viewer.fullScreen);
}

void Window::setTitle(const std::string& title) { glfwSetWindowTitle(handle, title.c_str()); }

void Window::resize(int width, int height) { glfwSetWindowSize(handle, width, height); }

void Window::setFullScreen(bool wanted) {
    if (wanted == full) return;
    GLFWmonitor* monitor = glfwGetPrimaryMonitor();
    if (wanted && !monitor) {
        viewer.fullScreen = false;
        return;
    }
    full = wanted;
    if (full) {
        glfwGetWindowPos(handle, &windowed[0], &windowed[1]);
        glfwGetWindowSize(handle, &windowed[2], &windowed[3]);
        const GLFWvidmode* mode = glfwGetVideoMode(monitor);
        glfwSetWindowMonitor(handle, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
    } else {
        glfwSetWindowMonitor(handle, nullptr, windowed[0], windowed[1], windowed[2], windowed[3],
                             GLFW_DONT_CARE);
    }
}

bool Window::show(const Image& picture, const Picture& overlay) {
    if (!picture) return false;
    const SwapchainImage target = swapchain->acquire();
    if (!target) {
        viewer.dirty = viewer.dirty || target.changed;
        return false;
    }
    const VkExtent3D extent = {uint32_t(overlay.width), uint32_t(overlay.height), 1};
    if (!shown || shown.extent.width != extent.width || shown.extent.height != extent.height)
        shown = createImage(*device,
                            {.extent = extent,
                             .format = VK_FORMAT_R8G8B8A8_UNORM,
                             .usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT});
    reserve(*device, over, overlay.pixels.size(), Memory::upload);
    reserve(*device, composed, overlay.pixels.size());
    upload(*device, over, overlay.pixels);
    Commands commands(*device);
    const gpu::WindowPush push{{picture.extent.width, picture.extent.height}, {extent.width, extent.height}};
    const Descriptor bound[] = {{0, picture.view, VK_IMAGE_LAYOUT_GENERAL}, {1, over}, {2, composed}};
    dispatch(commands, compose,
             {groupsFor(extent.width, WINDOW_GROUP), groupsFor(extent.height, WINDOW_GROUP), 1}, push, bound);
    barrier(commands);
    imageBarrier(commands, shown, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    VkBufferImageCopy copy{};
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.imageExtent = extent;
    vkCmdCopyBufferToImage(commands.handle, composed.handle, shown.handle,
                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
    imageBarrier(commands, shown, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    imageBarrier(commands, target.image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                 VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    VkImageBlit blit{};  // from one order of colours to another
    blit.srcSubresource = blit.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    blit.srcOffsets[1] = {overlay.width, overlay.height, 1};
    blit.dstOffsets[1] = {int32_t(target.extent.width), int32_t(target.extent.height), 1};
    vkCmdBlitImage(commands.handle, shown.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, target.image,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &blit, VK_FILTER_NEAREST);
    imageBarrier(commands, target.image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                 VK_IMAGE_LAYOUT_PRESENT_SRC_KHR);
    send(commands, target.drawn);
    const bool presented = swapchain->present(target);
    viewer.dirty = viewer.dirty || !presented;
    return presented;
}

}  // namespace fw
