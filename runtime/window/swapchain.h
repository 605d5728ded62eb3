// The images of a window: its Vulkan surface and the swapchain on it.
//
// Whoever draws takes an image, draws or copies into it, awaits that, and presents it. The swapchain is made
// at the first image and anew whenever the window's size changes. Its colours are taken as they are: a format
// that does not encode to sRGB once more.
//
// Lifetime: between the window and the device on one side and all that is drawn on the other; one thread.
#pragma once

#include "runtime/gpu/commands.h"

struct GLFWwindow;

namespace fw {

/// An image of the swapchain, from acquire() to present().
struct SwapchainImage {
    VkImage image = VK_NULL_HANDLE;  ///< its content and layout are undefined
    VkImageView view = VK_NULL_HANDLE;
    VkExtent2D extent = {};
    VkSemaphore drawn = VK_NULL_HANDLE;  ///< for send(), with the recording that draws it
    uint32_t index = 0;
    bool changed = false;  ///< without an image: the window changed meanwhile, ask again
    explicit operator bool() const { return image != VK_NULL_HANDLE; }
};

class Swapchain {
  public:
    /// Throws SystemError where the device cannot present to the window.
    Swapchain(const Device& device, GLFWwindow* window);
    Swapchain(const Swapchain&) = delete;
    Swapchain& operator=(const Swapchain&) = delete;
    ~Swapchain();

    /// B8G8R8A8_UNORM or R8G8B8A8_UNORM, the same for the window's life.
    VkFormat format() const { return chosen.format; }
    /// An image to draw into now, or none: while the window has no area.
    SwapchainImage acquire();
    /// Shows the image, which is in VK_IMAGE_LAYOUT_PRESENT_SRC_KHR, once it is drawn. False if the window
    /// changed meanwhile: draw again.
    bool present(const SwapchainImage& image);

  private:
    void make();
    void destroy();

    const Device& device;
    GLFWwindow* window;
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    VkSurfaceFormatKHR chosen = {};
    VkSwapchainKHR handle = VK_NULL_HANDLE;
    VkFence acquired = VK_NULL_HANDLE;
    VkExtent2D extent = {};
    std::vector<VkImage> images;
    std::vector<VkImageView> views;
    std::vector<VkSemaphore> drawn;
};

/// What GLFW last had to say.
std::string windowSystemComplaint();

}  // namespace fw
