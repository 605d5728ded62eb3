// The library's panel: the parts as pictures with their names, searched by typing. A click adds one, it can
// be dragged to the canvas, and its menu has the rest.
//
// Lifetime: part of the Editor; the destructor waits for the picture under way. Pictures are made one at a
// time beside the interface, of those parts alone that were seen, and anew when a file was written.
#pragma once

#include <imgui.h>

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "editor/files/browser.h"
#include "editor/files/parts.h"
#include "editor/preview/thumbnail.h"
#include "editor/shell/made_aside.h"

namespace fw::editor {

struct LibraryPanel {
    std::string search = {};
    std::string name = {};  ///< typed for the part that is to be kept
    bool names = false;     ///< it is to be typed from the next frame on
    bool feeds = true;      ///< what feeds the selected nodes is kept with them
    FileBrowser browser = {};

    std::string folder = {};  ///< that was read
    std::vector<LibraryPart> parts = {};
    std::string problem = {};
    std::chrono::steady_clock::time_point looked = {};
    struct Reading {
        std::vector<LibraryPart> parts = {};
        std::string problem = {};
    };
    MadeAside<Reading> reading = {};  ///< beside the interface, of what others may have changed

    struct Tile {
        int64_t stamp = 0;  ///< of the file, when the picture was made
        ImTextureID texture = nullptr;
        bool made = false;  ///< or found that it cannot be
    };
    std::map<std::string, Tile> tiles = {};  ///< by path
    std::string working = {};                ///< the path of the picture under way
    int64_t workingStamp = 0;
    MadeAside<Picture> picture = {};
};

/// Reads the folder again if that was not done for a while.
void lookAtLibrary(Editor& editor);
/// Shows the panel, where the name is typed under which the selected nodes are kept; one is proposed.
void keepInLibrary(Editor& editor);
/// Takes a part that was dragged from the panel and let go over the canvas. After the canvas was shown.
void takeDraggedPart(Editor& editor);

}  // namespace fw::editor
