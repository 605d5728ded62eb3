// A window that shows pictures: GLFW, and the swapchain of the window.
//
// A picture stays on the device: a kernel scales it to the window's size and puts the overlay over it, so a
// renderer may work at another resolution than the window's. Nothing is awaited but the image of the
// swapchain and, by the next picture, the last.
// A window without area (minimised) shows nothing and is no error; a swapchain that went out of date is made
// anew.
//
// Lifetime: a Desktop before the device (it says what instance extensions a window needs), the Window after
// it; the Window dies before the device, or leaves it before and uses another. One Window at a time; all
// calls come from the main thread.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "runtime/gpu/resources.h"
#include "runtime/gpu/shader.h"
#include "runtime/render/picture.h"
#include "runtime/window/swapchain.h"
#include "runtime/window/viewer.h"

struct GLFWwindow;

namespace fw {

/// The connection to the window system. Throws SystemError where there is none.
struct Desktop {
    Desktop();
    Desktop(const Desktop&) = delete;
    Desktop& operator=(const Desktop&) = delete;
    ~Desktop();

    /// What createDevice() is to be asked for.
    DeviceOptions deviceOptions() const;
};

class Window {
  public:
    /// Opens a window of this size, in pixels. `viewer` hears of keys and of the mouse and outlives the
    /// window. Throws SystemError where the device cannot present to it.
    Window(const Device& device, const std::string& title, int width, int height, Viewer& viewer);
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;
    ~Window();

    /// Gives up what it has of the device, which may have been lost, so that it can be destroyed. The window
    /// stays as it is, and is to show nothing before useDevice().
    void leaveDevice();
    /// Throws SystemError where the device cannot present to the window.
    void useDevice(const Device& device);

    /// Width and height in pixels now; zeros while it is minimised.
    std::pair<int, int> size() const;
    /// Handles what has happened; waits for something to happen, but at most so many seconds.
    void poll(double wait);
    /// Shows the picture, R32_UINT with red in the lowest byte and in VK_IMAGE_LAYOUT_GENERAL, at the
    /// window's size under the overlay, which is of that size and whose colours are times their alpha;
    /// whether it could. It cannot while the window has no area.
    bool show(const Image& picture, const Picture& overlay);
    void setTitle(const std::string& title);
    void resize(int width, int height);
    void setFullScreen(bool full);

  private:
    const Device* device = nullptr;
    Viewer& viewer;
    GLFWwindow* handle = nullptr;
    std::optional<Swapchain> swapchain;
    Pipeline compose;
    Buffer over, composed;
    Image shown;
    bool full = false;
    std::array<int, 4> windowed = {};  ///< place and size before full screen
};

}  // namespace fw
