// What stands beside the panels for a while: preferences, lists to choose from, pages of help. What they
// remember, and what shows them.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "editor/document/connections.h"
#include "editor/panels/start_page.h"
#include "editor/shortcuts.h"

namespace fw::editor {

struct Command;
struct Editor;

/// A list that is searched by typing, and chosen from by arrows and Enter or the mouse.
struct Chooser {
    bool opened = false;  ///< to be opened in this frame
    char search[64] = {};
    int chosen = 0;
};
struct Choice {
    std::string label;
    std::string detail = {};  ///< on the right
    bool enabled = true;
};
/// One frame of it, in a popup of this name. The index of what was chosen, once.
std::optional<std::size_t> choose(Chooser& chooser, const char* popup, std::span<const Choice> choices,
                                  float scale);
/// Those that have every word of `search`, whatever its case; labels that begin with it first.
std::vector<std::size_t> findChoices(std::string_view search, std::span<const Choice> choices);

struct PreferencesWindow {
    bool opened = false;
    char search[64] = {};
    const Command* command = nullptr;  ///< whose key is about to be pressed
    std::size_t key = 0;               ///< which of its keys; as many as it has: one more
    std::optional<Shortcut> taken;     ///< what was pressed, while another command has it
};

/// The node reference: a list of types and the page of one.
struct Reference {
    bool open = false, opened = false;  ///< to be brought to the front in this frame
    char search[64] = {};
    std::string type = "box";  ///< whose page is shown
};

struct Windows {
    PreferencesWindow preferences;
    Chooser palette, connect;
    std::vector<Connection> connections;  ///< that `connect` offers
    const Command* chosen = nullptr;      ///< in the palette: runs in the next frame
    bool renames = false;                 ///< the inspector gives the keyboard to the node's label
    Reference reference;
    StartPage start;
    bool tour = false;       ///< whether it is shown
    bool shortcuts = false;  ///< to be opened in this frame
    bool about = false;      ///< to be opened in this frame
};

/// One frame of all that is open.
void showWindows(Editor& editor);
/// Opens the list of wires that the active node can have.
void offerConnections(Editor& editor);

/// The page of the node under the mouse, or of the active one.
void openReference(Editor& editor);
/// A file of the documents that came with the program in what the desktop reads it with; where that is not to
/// be, its place is put into the clipboard.
void openDocument(Editor& editor, const std::string& link);

// a file each
void showReference(Editor& editor);
void showShortcuts(Editor& editor);
void showPreferences(Editor& editor);
void showPalette(Editor& editor);

}  // namespace fw::editor
