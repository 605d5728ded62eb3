// Keys and mouse, from GLFW to Dear ImGui without loss.
//
// ImGui 1.86 looks once a frame at what is pressed. What happens between two frames would be lost (a key that
// went down and up) or happen at the wrong place (a press, then a move). So the events wait in a queue, and
// each frame takes of them as many as it can tell apart. A press may send the keyboard elsewhere (a menu
// opens, a field ends), which takes some frames; keys wait for that, so that who types ahead is understood
// however slow the frames. Letters are named by what stands on the key, as shortcuts mean them, not by where
// the key is.
//
// Lifetime: as the window; one a window. ImGui's GLFW backend is installed without callbacks of its own.
#pragma once

#include <array>
#include <deque>
#include <string>
#include <utility>
#include <vector>

struct GLFWwindow;

namespace fw::editor {

class Input {
  public:
    explicit Input(GLFWwindow* window);
    Input(const Input&) = delete;
    Input& operator=(const Input&) = delete;

    /// Between ImGui_ImplGlfw_NewFrame() and ImGui::NewFrame(): what this frame hears of.
    void feed();
    /// Whether there is something that the last frame could not hear of yet.
    bool pending() const { return !events.empty(); }
    /// Whether anything happened since the last call: input, another size, a part of the window uncovered.
    bool happened() { return std::exchange(anything, false); }
    bool mouseHeld() const;
    /// Paths of files that were dropped on the window since the last call, in their turn among all input.
    std::vector<std::string> takeDropped() { return std::exchange(dropped, {}); }

  private:
    struct Event {
        enum class Kind : unsigned char { move, leave, button, wheel, key, character, focus, drop } kind;
        int code = 0;         ///< button, key, character, 1 for a focus gained
        bool down = false;    ///< of button and key
        double x = 0, y = 0;  ///< of move and wheel
        int scancode = 0, modifiers = 0;
        std::vector<std::string> paths = {};  ///< of drop
    };
    /// Where keys go.
    struct Keyboard {
        unsigned field = 0;  ///< ImGui's id of the one that is active
        int popups = 0;
        bool asked = false;  ///< something is to get it in the next frame
        bool operator==(const Keyboard&) const = default;
    };
    static Input& of(GLFWwindow* window);
    void add(const Event& event);
    bool keyboardRests();

    GLFWwindow* window;
    std::deque<Event> events;
    std::vector<std::string> dropped;
    std::array<bool, 5> buttons = {};
    double x = 0, y = 0;  ///< of the mouse, in pixels
    Keyboard keyboard;
    int sinceButton = 0, keysWaited = 0;  ///< frames
    bool inside = false, anything = true;
};

}  // namespace fw::editor
