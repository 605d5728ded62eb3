#include "runtime/window/swapchain.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>

namespace fw {

std::string windowSystemComplaint() {
    const char* text = nullptr;
    glfwGetError(&text);
    return text ? text : "no reason given";
}

Swapchain::Swapchain(const Device& device_, GLFWwindow* window_) : device(device_), window(window_) {
    if (glfwCreateWindowSurface(device.instance, window, nullptr, &surface) != VK_SUCCESS)
        throw SystemError("cannot make a Vulkan surface of the window: " + windowSystemComplaint());
    VkBool32 presents = VK_FALSE;
    check(vkGetPhysicalDeviceSurfaceSupportKHR(device.physical, device.queueFamily, surface, &presents),
          "asking whether the device presents");
    const auto refuse = [&](const char* of) {
        vkDestroySurfaceKHR(device.instance, surface, nullptr);
        throw SystemError("device '" + device.name() + "' cannot show pictures" + of +
                          " in a window: pick another with --device");
    };
    if (!presents) refuse("");  // and is not asked for formats then
    uint32_t count = 0;
    check(vkGetPhysicalDeviceSurfaceFormatsKHR(device.physical, surface, &count, nullptr), "listing formats");
    std::vector<VkSurfaceFormatKHR> formats(count);
    check(vkGetPhysicalDeviceSurfaceFormatsKHR(device.physical, surface, &count, formats.data()),
          "listing formats");
    const auto plain = std::ranges::find_if(formats, [](const VkSurfaceFormatKHR& format) {
        return format.format == VK_FORMAT_B8G8R8A8_UNORM || format.format == VK_FORMAT_R8G8B8A8_UNORM;
    });
    if (plain == formats.end()) refuse(" of 8 bits a colour");
    chosen = *plain;
    const auto info = zeroed<VkFenceCreateInfo>(VK_STRUCTURE_TYPE_FENCE_CREATE_INFO);
    check(vkCreateFence(device.handle, &info, nullptr, &acquired), "making a fence");
}

Swapchain::~Swapchain() {
    destroy();
    vkDestroyFence(device.handle, acquired, nullptr);
    vkDestroySurfaceKHR(device.instance, surface, nullptr);
}

void Swapchain::destroy() {
    vkDeviceWaitIdle(device.handle);  // the last picture was only sent
    for (VkImageView view : views) vkDestroyImageView(device.handle, view, nullptr);
    for (VkSemaphore semaphore : drawn) vkDestroySemaphore(device.handle, semaphore, nullptr);
    views.clear(), drawn.clear();
    images.clear();
    if (handle) vkDestroySwapchainKHR(device.handle, handle, nullptr);
    handle = VK_NULL_HANDLE;
}

void Swapchain::make() {
    destroy();
    VkSurfaceCapabilitiesKHR can{};
    check(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device.physical, surface, &can),
          "asking what the surface can do");
    extent = can.currentExtent;
    if (extent.width == UINT32_MAX) {
        int width = 0, height = 0;
        glfwGetFramebufferSize(window, &width, &height);
        extent.width = std::clamp(uint32_t(width), can.minImageExtent.width, can.maxImageExtent.width);
        extent.height = std::clamp(uint32_t(height), can.minImageExtent.height, can.maxImageExtent.height);
    }
    if (extent.width == 0 || extent.height == 0) return;  // minimised
    if (!(can.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_DST_BIT))
        throw SystemError("the window takes no copies of pictures on device '" + device.name() + "'");
    auto info = zeroed<VkSwapchainCreateInfoKHR>(VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR);
    info.surface = surface;
    info.minImageCount =
        can.maxImageCount > 0 ? std::min(can.minImageCount + 1, can.maxImageCount) : can.minImageCount + 1;
    info.imageFormat = chosen.format;
    info.imageColorSpace = chosen.colorSpace;
    info.imageExtent = extent;
    info.imageArrayLayers = 1;
    info.imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    info.preTransform = can.currentTransform;
    info.compositeAlpha = can.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                              ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                              : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
    info.presentMode = VK_PRESENT_MODE_FIFO_KHR;
    info.clipped = VK_TRUE;
    check(vkCreateSwapchainKHR(device.handle, &info, nullptr, &handle), "making a swapchain");
    uint32_t count = 0;
    check(vkGetSwapchainImagesKHR(device.handle, handle, &count, nullptr), "listing the swapchain's images");
    images.resize(count);
    check(vkGetSwapchainImagesKHR(device.handle, handle, &count, images.data()),
          "listing the swapchain's images");
    for (VkImage image : images) {
        auto view = zeroed<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
        view.image = image;
        view.viewType = VK_IMAGE_VIEW_TYPE_2D;
        view.format = chosen.format;
        view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        check(vkCreateImageView(device.handle, &view, nullptr, &views.emplace_back()),
              "making a view of the swapchain");
        const auto semaphore = zeroed<VkSemaphoreCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO);
        check(vkCreateSemaphore(device.handle, &semaphore, nullptr, &drawn.emplace_back()),
              "making a semaphore");
    }
}

SwapchainImage Swapchain::acquire() {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window, &width, &height);
    if (width == 0 || height == 0) return {};
    if (!handle || extent.width != uint32_t(width) || extent.height != uint32_t(height)) make();
    if (!handle) return {};
    uint32_t index = 0;
    const VkResult got =
        vkAcquireNextImageKHR(device.handle, handle, UINT64_MAX, VK_NULL_HANDLE, acquired, &index);
    if (got == VK_ERROR_OUT_OF_DATE_KHR) {
        destroy();  // made anew for the next picture
        return {.changed = true};
    }
    if (got != VK_SUBOPTIMAL_KHR) check(got, "taking an image of the swapchain");
    check(vkWaitForFences(device.handle, 1, &acquired, VK_TRUE, UINT64_MAX), "waiting for the window");
    check(vkResetFences(device.handle, 1, &acquired), "resetting a fence");
    return {images[index], views[index], extent, drawn[index], index};
}

bool Swapchain::present(const SwapchainImage& image) {
    auto info = zeroed<VkPresentInfoKHR>(VK_STRUCTURE_TYPE_PRESENT_INFO_KHR);
    info.waitSemaphoreCount = 1;
    info.pWaitSemaphores = &image.drawn;
    info.swapchainCount = 1;
    info.pSwapchains = &handle;
    info.pImageIndices = &image.index;
    const VkResult presented = vkQueuePresentKHR(device.queue, &info);
    if (presented == VK_ERROR_OUT_OF_DATE_KHR || presented == VK_SUBOPTIMAL_KHR) {
        destroy();
        return presented == VK_SUBOPTIMAL_KHR;
    }
    check(presented, "presenting a picture");
    return true;
}

}  // namespace fw
