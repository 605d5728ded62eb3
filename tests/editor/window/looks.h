// Every panel and dialog of the editor, one after the other, as tests look at them.
//
// A document that has something for each of them is opened in a window of this process; each is brought up by
// the command that a person would give, and nothing is drawn unless a picture is asked for. No picture of the
// solid is ever made, so that what is seen is of the interface alone.
#pragma once

#include <string>
#include <vector>

#include "tests/support/editor/driven_editor.h"

namespace fw::editor::test {

/// A panel or dialog.
struct Look {
    const char* name;
    /// ImGui's name of its window; "": the whole window.
    const char* window;
    void (*open)(Editor& editor);
};
std::vector<Look> looks();

/// The document, with a file that is missing.
Graph graphOfLooks();

/// Brings it up, at rest. Nothing else is open.
void show(DrivenEditor& driven, const Look& look);
/// Another size of the window, and scale of the interface.
void resize(DrivenEditor& driven, int width, int height, float scale);
/// Where its window is.
Area placeOf(const Look& look);

/// Text of the last frame that is cut at its sides, as "window: text", with what was drawn of it, and windows
/// of which a part is out of the screen or out of reach.
std::vector<std::string> cutTexts(const Look& look);
std::vector<std::string> lostWindows(const Look& look);

}  // namespace fw::editor::test
