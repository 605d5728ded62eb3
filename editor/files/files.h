// The document's file: new, open, save, and the question what becomes of changes that were not saved.
//
// What would lose changes waits for an answer. A copy of the changes is kept meanwhile (recovery.h); copies
// that a crash left are offered at the start. Lifetime: part of the Editor.
#pragma once

#include "editor/files/browser.h"
#include "editor/files/preferences.h"
#include "editor/files/recovery.h"

namespace fw::editor {

struct Editor;

struct Files {
    /// What is to happen once the changes are saved or given up.
    enum class Next : unsigned char { none, fresh, browse, open, quit } next = Next::none;
    std::string nextPath;  ///< of Next::open
    bool asks = false;     ///< the question about changes is to be opened
    FileBrowser browser;
    Recovery recovery;
    Preferences preferences;
    std::vector<LeftCopy> left;  ///< of crashes, not yet decided on
    std::string title;           ///< that the window has
};

/// Reads preferences and looks for copies that were left.
void startFiles(Editor& editor);
/// One frame: browser, question, offer; the window's title.
void showFiles(Editor& editor);

/// Does it, after a question if changes would be lost.
void proceed(Editor& editor, Files::Next next, std::string path = {});
/// To the document's file; asks for one if it has none. Whether the file was written.
bool save(Editor& editor);
void saveAs(Editor& editor);

}  // namespace fw::editor
