// The documents that are open: one is in front, which is all that the editor's parts know of; the others lie
// behind it as they were left, each with its history, selection, view and place on the timeline.
//
// What is opened gets a tab of its own, unless the one in front holds nothing yet. What is unsaved behind is
// kept for the next start as it goes there (recovery.h); a file that another program changes meanwhile is
// noticed when its document comes to the front again.
//
// Lifetime: part of the Editor.
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "editor/canvas/canvas.h"
#include "editor/document/document.h"
#include "editor/files/files.h"
#include "editor/panels/panel_state.h"
#include "editor/viewport/viewport.h"

namespace fw::editor {

/// All that is of a document while it lies behind.
struct DocumentBehind {
    Document document;
    Canvas canvas;
    PanelState panels;
    DocumentLook look;
    std::set<std::string> thumbnails;  ///< the nodes that have them, by path
    DocumentFile file;
};

struct Tabs {
    std::vector<std::unique_ptr<DocumentBehind>> all = std::vector<std::unique_ptr<DocumentBehind>>(1);
    std::size_t front = 0;  ///< of all, the one that is null
};

/// The tabs, where there are several, in the rest of ImGui's current menu bar.
void showTabs(Editor& editor);
/// Brings another document to the front.
void showTab(Editor& editor, std::size_t index);
/// The one so many further on, around the end.
void turnTabs(Editor& editor, int by);
/// Puts the document in front behind, for another; what is in front then is to be replaced.
void openTab(Editor& editor);
/// Closes the document in front unasked, and shows its neighbour, or a new one.
void closeTab(Editor& editor);

/// Whether the document in front holds nothing that a hand has made, and is of no file of one's own.
bool isUntouched(const Editor& editor);
/// Where this file is open.
std::optional<std::size_t> tabOf(const Editor& editor, const std::string& path);
/// A document behind the one in front that has unsaved changes.
std::optional<std::size_t> unsavedTab(const Editor& editor);
/// One of these that the editor has to ask about before it ends.
std::optional<std::size_t> tabToAsk(const Editor& editor);
/// All are to be asked about.
void forgetGivenUp(Editor& editor);
/// Takes away what is kept of all documents for the next start.
void discardKept(Editor& editor);

/// Another document in place of the one in front, with nothing selected.
void replaceDocument(Editor& editor, Document document);

}  // namespace fw::editor
