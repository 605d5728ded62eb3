// Views of the picture that are kept to be gone back to: the camera and its projection.
//
// They belong to a document and are no part of it: `views` of the preferences has them by the document's
// absolute path, for as long as it is among the recent files. Those of a document without a file are kept
// once it has one.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "editor/viewport/orbit.h"
#include "graph/document/graph.h"

namespace fw::editor {

inline constexpr std::size_t kMostKeptViews = 32;  ///< of a document

struct KeptView {
    Orbit orbit;
    bool orthographic = false;
};

struct KeptViews {
    std::vector<KeptView> views;
    std::size_t last = 0;   ///< that was gone to or kept, counted from 1; 0: none
    bool known = false;     ///< they are of the document that is there
    std::string path = {};  ///< where they are kept; empty: nowhere yet
};

Json jsonOf(const std::vector<KeptView>& views);
/// What is no view is left out.
std::vector<KeptView> keptViewsIn(const Json& json);

struct Editor;
/// Those of the document that is there, from the preferences; and into them, where its file is a new one.
void followKeptViews(Editor& editor);
/// What is seen, as the last of them.
void keepView(Editor& editor);
/// The picture is seen so; after the last one the first.
void goToNextView(Editor& editor);
/// In a menu: all of them, to go to or to forget.
void showKeptViews(Editor& editor);

}  // namespace fw::editor
