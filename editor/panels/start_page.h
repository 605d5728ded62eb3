// What the empty canvas shows when the program starts without a file: first steps, samples as pictures, and
// the files that were open last. It is gone with the first node, and with the first file.
//
// Lifetime: part of the Editor; the destructor waits for the picture that is being read.
#pragma once

#include <imgui.h>

#include <string>
#include <vector>

#include "editor/files/samples.h"
#include "editor/shell/made_aside.h"

namespace fw::editor {

struct Editor;

struct StartPage {
    bool open = false;
    bool looked = false;                     ///< for the samples
    std::vector<Sample> samples = {};        ///< the few that are shown
    std::vector<ImTextureID> textures = {};  ///< of each; null as long as it has none
    MadeAside<std::vector<Picture>> reading = {};
};

/// One frame of it, if it is open, over the canvas. After the canvas was shown.
void showStartPage(Editor& editor);

}  // namespace fw::editor
