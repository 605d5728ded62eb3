// The editor in a window of its own display, driven by real keys and mouse events while the test looks
// inside.
//
// Where program.h knows only what is seen from outside, a test here knows the document and the places of
// everything at once, and pictures come from the editor itself. Input is sent by xdotool; the test's own
// thread then makes frames until nothing asks for more.
//
// Lifetime: one at a time in a process. Preferences and copies are in a folder of its own.
#pragma once

#include <optional>
#include <string>

#include "editor/editor.h"
#include "tests/support/graph/temp_dir.h"
#include "tests/support/virtual_display.h"

namespace fw::editor::test {

class DrivenEditor {
  public:
    explicit DrivenEditor(Graph graph = {}, int width = 1280, int height = 800);
    ~DrivenEditor();
    /// Whether there are an X server and xdotool.
    bool works() const { return it.has_value(); }
    Editor& operator*() { return *it; }
    Editor* operator->() { return &*it; }
    std::string path(const std::string& name) const { return folder.path(name); }

    /// Words of xdotool, then frames until the interface rests.
    void send(const std::string& words);
    /// The same with some frames, where a button that is held never lets it rest.
    void during(const std::string& words);
    /// Keys as xdotool has them, one press after the other: "shift+a Return".
    void keys(const std::string& presses) { send("key --delay 0 " + presses); }
    void type(const std::string& text) { send("type --delay 0 --args 1 '" + text + "'"); }
    void moveTo(ImVec2 pixels);
    /// To the window's lower edge, where there is nothing to point at; keys still go to the window.
    void moveAway();
    void click(ImVec2 pixels);
    /// With the button held from the first to the second.
    void drag(ImVec2 from, ImVec2 to);
    void settle();
    /// Waits until what is shown is of the document as it is: what was found out, and a first picture, which
    /// may be a draft.
    void waitForPicture();
    /// The same, and until that picture gets no better.
    void waitForBestPicture();
    Picture capture() { return shell->capture(); }

    // Places on the canvas, in pixels.
    ImVec2 title(const std::string& node) const;
    ImVec2 socket(const std::string& node, const std::string& name, bool output) const;
    ImVec2 field(const std::string& node, const std::string& name, int component) const;

  private:
    void waitForPicture(bool best);

    fw::test::TempDir folder;
    fw::test::VirtualDisplay display;
    std::optional<Shell> shell;
    std::optional<Editor> it;
};

#define NEEDS_EDITOR(editor) \
    ASSERT_TRUE((editor).works()) << "Xvfb or xdotool is missing: run ./.install test"

}  // namespace fw::editor::test
