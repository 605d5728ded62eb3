// The window that the interface lives in: GLFW for window and input, Dear ImGui for the interface, and its
// draw lists drawn with the runtime's own Vulkan layer, because the interface shows pictures.
//
// Nothing is drawn unless something happened: waitEvents() sleeps until there is input, wake() was called, or
// a frame was asked for. Lifetime: one Shell in a process, on the thread that made it; the device dies last.
#pragma once

#include <imgui.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "runtime/gpu/resources.h"
#include "runtime/render/picture.h"

struct GLFWwindow;

namespace fw::editor {

/// Text at any size between the smallest and largest baked one stays crisp: the nearest baked size is taken.
struct Fonts {
    std::vector<ImFont*> text;  ///< by rising size
    std::vector<ImFont*> code;  ///< the same, of fixed width
    /// The font whose pixels are nearest to this size.
    ImFont* of(float pixels) const;
    ImFont* codeOf(float pixels) const;
};

struct ShellOptions {
    std::string device = {};
    int width = 1280, height = 800;
    float scale = 0.0f;  ///< of the interface; 0: the display's
};

class Shell {
  public:
    explicit Shell(const ShellOptions& options);
    ~Shell();

    /// Sleeps until something happened, or so many seconds; 0: only takes what is there.
    void waitEvents(double seconds);
    /// From any thread: ends the sleep.
    static void wake();
    /// One frame: show() builds the interface, which is then drawn and presented. A minimised window draws
    /// nothing.
    void frame(const std::function<void()>& show);
    bool closed() const;
    void keepOpen();  ///< after closed(): the user was asked and stays

    /// A picture for ImGui::Image: uploaded, or replaced if its size is the same. `id` null: a new one.
    ImTextureID show(ImTextureID id, const Picture& picture);
    void forget(ImTextureID id);

    const Fonts& fonts() const;
    float scale() const;
    const Device& device() const;
    GLFWwindow* window() const;
    void setTitle(const std::string& title);
    /// The last frame as it was shown, for tests and the pictures of the tutorial.
    Picture capture();

  private:
    struct State;
    std::unique_ptr<State> state;
};

}  // namespace fw::editor
