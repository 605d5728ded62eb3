// The window that the interface lives in: GLFW for window and input, Dear ImGui for the interface, and its
// draw lists drawn with the runtime's own Vulkan layer, because the interface shows pictures.
//
// Nothing is drawn unless something happened: waitEvents() sleeps until there is input, wake() was called, or
// a frame was asked for. Lifetime: one Shell in a process, on the thread that made it; the device dies last.
// Pictures stay on the host too, so that the device can be made anew: frame() alone hands them to it.
#pragma once

#include <imgui.h>

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "editor/shell/fonts.h"
#include "runtime/gpu/resources.h"
#include "runtime/render/picture.h"

struct GLFWwindow;

namespace fw::editor {

struct ShellOptions {
    std::string device = {};
    int width = 1280, height = 800;
    float scale = 0.0f;  ///< of the interface; 0: the display's
};

class Shell {
  public:
    /// Opens the window. Throws SystemError where there is no window system, no such device, or none that
    /// can show pictures.
    explicit Shell(const ShellOptions& options);
    ~Shell();

    /// Sleeps until something happened, or so many seconds; 0: only takes what is there. Whether there is a
    /// reason to draw: input, a wake(), a window of another size. ImGui needs some frames to come to rest
    /// after input; those are reasons too.
    bool waitEvents(double seconds);
    /// From any thread: ends the sleep, and gives a reason to draw.
    static void wake();
    /// One frame: show() builds the interface, which is then drawn over ThemeColor::canvas and presented. A
    /// minimised window draws nothing, and show() is not called.
    void frame(const std::function<void()>& show);
    /// The first half of a frame: what happened is heard and answered, and nothing drawn. Whether it could
    /// be.
    bool answer(const std::function<void()>& show);
    /// After frame() has thrown DeviceLost: opens another device for the same window and the same pictures.
    /// Throws SystemError where none opens, or none that can show pictures.
    void renewDevice();
    bool closed() const;
    void keepOpen();  ///< after closed(): the user was asked and stays

    /// A picture for ImGui::Image, in place of what `id` showed; null: a new one. Returns the id.
    ImTextureID show(ImTextureID id, const Picture& picture);
    /// Its last frame may still show it. Null: nothing.
    void forget(ImTextureID id);

    /// Paths of files that were dropped on the window since the last call.
    std::vector<std::string> takeDropped();

    const Fonts& fonts() const;
    float scale() const;
    /// Of the interface, as ShellOptions::scale: fonts are made anew before the next frame.
    void setScale(float asked);
    /// In the units of the window system.
    std::pair<int, int> windowSize() const;
    void resize(int width, int height);
    const Device& device() const;
    GLFWwindow* window() const;
    void setTitle(const std::string& title);
    /// The last frame, drawn once more, for tests and the pictures of the tutorial. There was one.
    Picture capture();

  private:
    struct State;
    std::unique_ptr<State> state;
};

}  // namespace fw::editor
