#include "runtime/window/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>

#include "runtime/gpu/commands.h"

namespace fw {

namespace {

/// What GLFW last had to say.
std::string complaint() {
    const char* text = nullptr;
    glfwGetError(&text);
    return text ? text : "no reason given";
}

/// A layout transition of an image that no Image owns.
void transition(Commands& commands, VkImage image, VkImageLayout from, VkImageLayout to) {
    auto barrier = zeroed<VkImageMemoryBarrier2>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2);
    barrier.srcStageMask = barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT | VK_ACCESS_2_MEMORY_READ_BIT;
    barrier.oldLayout = from;
    barrier.newLayout = to;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image;
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    auto info = zeroed<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
    info.imageMemoryBarrierCount = 1;
    info.pImageMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands.handle, &info);
}

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
        throw SystemError("there is no window system here (" + complaint() +
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
    : device(device_), viewer(viewer_) {
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    handle = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
    if (!handle) throw SystemError("cannot open a window: " + complaint());
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

    check(glfwCreateWindowSurface(device.instance, handle, nullptr, &surface),
          "making a surface of the window");
    VkBool32 presents = VK_FALSE;
    check(vkGetPhysicalDeviceSurfaceSupportKHR(device.physical, device.queueFamily, surface, &presents),
          "asking whether the device presents");
    if (!presents)
        throw SystemError("device '" + device.name() +
                          "' cannot show pictures in a window: pick another with --device");
    const auto info = zeroed<VkFenceCreateInfo>(VK_STRUCTURE_TYPE_FENCE_CREATE_INFO);
    check(vkCreateFence(device.handle, &info, nullptr, &acquired), "making a fence");
}

Window::~Window() {
    vkDeviceWaitIdle(device.handle);
    destroySwapchain();
    if (acquired) vkDestroyFence(device.handle, acquired, nullptr);
    if (surface) vkDestroySurfaceKHR(device.instance, surface, nullptr);
    if (handle) glfwDestroyWindow(handle);
}

void Window::destroySwapchain() {
    if (swapchain) vkDestroySwapchainKHR(device.handle, swapchain, nullptr);
    swapchain = VK_NULL_HANDLE;
    images.clear();
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

void Window::makeSwapchain() {
    vkDeviceWaitIdle(device.handle);
    destroySwapchain();
    VkSurfaceCapabilitiesKHR can{};
    check(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device.physical, surface, &can),
          "asking what the surface can do");
    extent = can.currentExtent;
    if (extent.width == UINT32_MAX) {
        const auto [width, height] = size();
        extent.width = std::clamp(uint32_t(width), can.minImageExtent.width, can.maxImageExtent.width);
        extent.height = std::clamp(uint32_t(height), can.minImageExtent.height, can.maxImageExtent.height);
    }
    if (extent.width == 0 || extent.height == 0) return;  // minimised
    uint32_t count = 0;
    check(vkGetPhysicalDeviceSurfaceFormatsKHR(device.physical, surface, &count, nullptr), "listing formats");
    std::vector<VkSurfaceFormatKHR> formats(count);
    check(vkGetPhysicalDeviceSurfaceFormatsKHR(device.physical, surface, &count, formats.data()),
          "listing formats");
    // Pictures are sRGB already: a format that does not encode once more.
    const auto plain = std::find_if(formats.begin(), formats.end(), [](const VkSurfaceFormatKHR& format) {
        return format.format == VK_FORMAT_B8G8R8A8_UNORM || format.format == VK_FORMAT_R8G8B8A8_UNORM;
    });
    if (plain == formats.end() || !(can.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_DST_BIT))
        throw SystemError("the window takes no pictures of 8 bits a colour on device '" + device.name() +
                          "'");
    auto info = zeroed<VkSwapchainCreateInfoKHR>(VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR);
    info.surface = surface;
    info.minImageCount =
        can.maxImageCount > 0 ? std::min(can.minImageCount + 1, can.maxImageCount) : can.minImageCount + 1;
    info.imageFormat = plain->format;
    info.imageColorSpace = plain->colorSpace;
    info.imageExtent = extent;
    info.imageArrayLayers = 1;
    info.imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    info.preTransform = can.currentTransform;
    info.compositeAlpha = can.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                              ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                              : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
    info.presentMode = VK_PRESENT_MODE_FIFO_KHR;
    info.clipped = VK_TRUE;
    check(vkCreateSwapchainKHR(device.handle, &info, nullptr, &swapchain), "making a swapchain");
    check(vkGetSwapchainImagesKHR(device.handle, swapchain, &count, nullptr),
          "listing the swapchain's images");
    images.resize(count);
    check(vkGetSwapchainImagesKHR(device.handle, swapchain, &count, images.data()),
          "listing the swapchain's images");
}

bool Window::show(const Picture& picture) {
    const auto [width, height] = size();
    if (width == 0 || height == 0 || picture.pixels.empty()) return false;
    if (!swapchain || extent.width != uint32_t(width) || extent.height != uint32_t(height)) makeSwapchain();
    if (!swapchain) return false;
    uint32_t index = 0;
    const VkResult got =
        vkAcquireNextImageKHR(device.handle, swapchain, UINT64_MAX, VK_NULL_HANDLE, acquired, &index);
    if (got == VK_ERROR_OUT_OF_DATE_KHR) {
        destroySwapchain();  // made anew for the next picture
        viewer.dirty = true;
        return false;
    }
    if (got != VK_SUBOPTIMAL_KHR) check(got, "taking an image of the swapchain");
    check(vkWaitForFences(device.handle, 1, &acquired, VK_TRUE, UINT64_MAX), "waiting for the window");
    check(vkResetFences(device.handle, 1, &acquired), "resetting a fence");

    const VkExtent3D drawn = {uint32_t(picture.width), uint32_t(picture.height), 1};
    if (!shown || shown.extent.width != drawn.width || shown.extent.height != drawn.height)
        shown =
            createImage(device, {.extent = drawn,
                                 .format = VK_FORMAT_R8G8B8A8_UNORM,
                                 .usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT});
    reserve(device, staging, picture.pixels.size(), Memory::upload);
    upload(device, staging, picture.pixels);
    {
        Commands commands(device);
        imageBarrier(commands, shown, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        VkBufferImageCopy copy{};
        copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        copy.imageExtent = drawn;
        vkCmdCopyBufferToImage(commands.handle, staging.handle, shown.handle,
                               VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
        imageBarrier(commands, shown, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                     VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        transition(commands, images[index], VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        VkImageBlit blit{};
        blit.srcSubresource = blit.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        blit.srcOffsets[1] = {picture.width, picture.height, 1};
        blit.dstOffsets[1] = {int32_t(extent.width), int32_t(extent.height), 1};
        vkCmdBlitImage(commands.handle, shown.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, images[index],
                       VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &blit, VK_FILTER_LINEAR);
        transition(commands, images[index], VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                   VK_IMAGE_LAYOUT_PRESENT_SRC_KHR);
        submit(commands);
    }
    auto info = zeroed<VkPresentInfoKHR>(VK_STRUCTURE_TYPE_PRESENT_INFO_KHR);
    info.swapchainCount = 1;
    info.pSwapchains = &swapchain;
    info.pImageIndices = &index;
    const VkResult presented = vkQueuePresentKHR(device.queue, &info);
    if (presented == VK_ERROR_OUT_OF_DATE_KHR || presented == VK_SUBOPTIMAL_KHR) {
        vkDeviceWaitIdle(device.handle);
        destroySwapchain();
        viewer.dirty = viewer.dirty || presented == VK_ERROR_OUT_OF_DATE_KHR;
        return presented == VK_SUBOPTIMAL_KHR;
    }
    check(presented, "presenting a picture");
    return true;
}

}  // namespace fw
