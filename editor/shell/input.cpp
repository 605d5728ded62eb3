#include "editor/shell/input.h"

#define GLFW_INCLUDE_NONE
#include <backends/imgui_impl_glfw.h>
#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cfloat>
#include <vector>

namespace fw::editor {

namespace {

constexpr int kClickTaken = 2;  // frames until a field that was clicked has asked for the keyboard
constexpr int kMostWait = 10;   // frames that keys wait for the keyboard to rest

bool isModifier(int key) { return key >= GLFW_KEY_LEFT_SHIFT && key <= GLFW_KEY_RIGHT_SUPER; }

/// The key that carries this letter in the user's layout.
int namedKey(int key, int scancode) {
    if (key > GLFW_KEY_GRAVE_ACCENT) return key;  // no printed sign
    const char* name = glfwGetKeyName(key, scancode);
    return name && name[0] >= 'a' && name[0] <= 'z' && name[1] == 0 ? GLFW_KEY_A + (name[0] - 'a') : key;
}

/// From the window's coordinates to pixels, which differ on some screens.
double pixelsPerUnit(GLFWwindow* window) {
    int units = 0, pixels = 0;
    glfwGetWindowSize(window, &units, nullptr);
    glfwGetFramebufferSize(window, &pixels, nullptr);
    return units > 0 ? double(pixels) / units : 1.0;
}

}  // namespace

Input& Input::of(GLFWwindow* window) { return *static_cast<Input*>(glfwGetWindowUserPointer(window)); }

Input::Input(GLFWwindow* window_) : window(window_) {
    using Kind = Event::Kind;
    glfwSetWindowUserPointer(window, this);
    glfwSetCursorPosCallback(window, [](GLFWwindow* w, double px, double py) {
        const double scale = pixelsPerUnit(w);
        of(w).add({.kind = Kind::move, .x = px * scale, .y = py * scale});
    });
    glfwSetCursorEnterCallback(window, [](GLFWwindow* w, int entered) {
        if (entered) return;  // its first move says where
        of(w).add({.kind = Kind::leave});
    });
    glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int) {
        if (button < int(of(w).buttons.size()))
            of(w).add({.kind = Kind::button, .code = button, .down = action == GLFW_PRESS});
    });
    glfwSetScrollCallback(window, [](GLFWwindow* w, double dx, double dy) {
        of(w).add({.kind = Kind::wheel, .x = dx, .y = dy});
    });
    glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int scancode, int action, int modifiers) {
        of(w).anything = true;  // ImGui repeats held keys itself, in frames
        if (action == GLFW_REPEAT) return;
        of(w).add({.kind = Kind::key,
                   .code = namedKey(key, scancode),
                   .down = action == GLFW_PRESS,
                   .scancode = scancode,
                   .modifiers = modifiers});
    });
    glfwSetCharCallback(window, [](GLFWwindow* w, unsigned int character) {
        of(w).add({.kind = Kind::character, .code = int(character)});
    });
    glfwSetWindowFocusCallback(
        window, [](GLFWwindow* w, int focused) { of(w).add({.kind = Kind::focus, .code = focused}); });
    glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** paths) {
        of(w).add({.kind = Kind::drop, .paths = {paths, paths + count}});
    });
    glfwSetFramebufferSizeCallback(window, [](GLFWwindow* w, int, int) { of(w).anything = true; });
    glfwSetWindowContentScaleCallback(window, [](GLFWwindow* w, float, float) { of(w).anything = true; });
    glfwSetWindowRefreshCallback(window, [](GLFWwindow* w) { of(w).anything = true; });
    glfwSetWindowCloseCallback(window, [](GLFWwindow* w) { of(w).anything = true; });
}

void Input::add(const Event& event) {
    anything = true;
    // Of moves in a row the last one counts.
    if (event.kind == Event::Kind::move && !events.empty() && events.back().kind == Event::Kind::move)
        events.back() = event;
    else
        events.push_back(event);
}

bool Input::mouseHeld() const { return std::ranges::count(buttons, true) > 0; }

/// Whether keys go where they went in the last frame.
bool Input::keyboardRests() {
    const ImGuiContext& context = *ImGui::GetCurrentContext();
    const Keyboard before = std::exchange(keyboard, {context.ActiveId, context.OpenPopupStack.Size,
                                                     context.NavMoveSubmitted || context.NavInitRequest});
    const bool rests = keyboard == before && !keyboard.asked && sinceButton >= kClickTaken;
    ++sinceButton;
    keysWaited = rests ? 0 : keysWaited + 1;
    return rests || keysWaited > kMostWait;
}

void Input::feed() {
    // What this frame already reacts to: it does so once, with the state of mouse and modifiers at that time.
    enum class Act { none, wheel, key, button, drop } act = Act::none;
    std::vector<int> released;
    bool moved = false;
    // What a button held has to know where it was let go, be that outside of the window.
    const bool held = mouseHeld();
    const bool rests = keyboardRests();
    const auto fits = [&](const Event& event) {
        switch (event.kind) {
            case Event::Kind::move:
            case Event::Kind::leave: return act == Act::none;
            // What is pressed has to know first that the mouse is over it.
            case Event::Kind::button: return act == Act::none && !moved;
            case Event::Kind::wheel: return act == Act::none || act == Act::wheel;
            case Event::Kind::character: return (act == Act::none && rests) || act == Act::key;
            // What was let go waits for nothing: ImGui would repeat what it takes for held.
            case Event::Kind::key:
                return act == Act::none &&
                       (!event.down || (rests && !std::ranges::count(released, event.code)));
            case Event::Kind::focus:
            case Event::Kind::drop: return act == Act::none;
        }
        return true;
    };
    while (!events.empty() && fits(events.front())) {
        const Event event = events.front();
        events.pop_front();
        switch (event.kind) {
            case Event::Kind::move: inside = moved = true, x = event.x, y = event.y; break;
            case Event::Kind::leave: inside = false; break;
            case Event::Kind::button:
                buttons[std::size_t(event.code)] = event.down;
                act = Act::button;
                break;
            case Event::Kind::drop:
                dropped.insert(dropped.end(), event.paths.begin(), event.paths.end());
                act = Act::drop;
                break;
            case Event::Kind::wheel:
                ImGui_ImplGlfw_ScrollCallback(window, event.x, event.y);
                act = Act::wheel;
                break;
            case Event::Kind::character:
                ImGui_ImplGlfw_CharCallback(window, unsigned(event.code));
                act = Act::key;
                break;
            case Event::Kind::key:
                ImGui_ImplGlfw_KeyCallback(window, event.code, event.scancode,
                                           event.down ? GLFW_PRESS : GLFW_RELEASE, event.modifiers);
                if (!event.down)
                    released.push_back(event.code);
                else if (!isModifier(event.code))
                    act = Act::key;
                break;
            case Event::Kind::focus:
                ImGui_ImplGlfw_WindowFocusCallback(window, event.code);
                if (!event.code) buttons.fill(false);
                break;
        }
    }
    ImGuiIO& io = ImGui::GetIO();
    if (act == Act::button)
        sinceButton = keysWaited = 0;  // what was clicked has its time, however quick the hand
    io.MousePos = inside || held || mouseHeld() ? ImVec2(float(x), float(y)) : ImVec2(-FLT_MAX, -FLT_MAX);
    std::ranges::copy(buttons, io.MouseDown);
}

}  // namespace fw::editor
