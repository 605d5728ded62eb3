// What the editor remembers from one time to the next: editor.json in the user's configuration folder.
//
// Preferences are no document: whatever is wrong with the file, the editor starts, with defaults for what
// could not be read. A file that is no JSON is set aside under another name before it is written anew. Keys
// of a newer version are kept.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "graph/base/result.h"
#include "graph/document/graph.h"

namespace fw::editor {

inline constexpr std::size_t kMostRecent = 12;

struct Preferences {
    std::vector<std::string> recent = {};               ///< absolute paths of files, the last opened first
    float scale = 0.0f;                                 ///< of the interface, 0.5 to 4; 0: the display's
    std::map<std::string, std::string> shortcuts = {};  ///< id of a command to keys, "Ctrl+Z"; where changed
    std::vector<std::string> taken = {};                ///< ids of node types, the last added first
    std::vector<std::string> favourites = {};           ///< the same, of those that were marked
    std::string library = {};     ///< the folder of parts; empty: the usual one (parts.h)
    std::string navigation = {};  ///< one of kNavigationNames (viewport.h); empty: the first
    std::string scrolling = {};   ///< one of kScrollingNames (viewport.h); empty: the first
    KeptJson views;               ///< an object: kept views by a document's path (kept_views.h)
    std::string theme = {};       ///< one of kThemeNames (desktop_theme.h); empty: dark
    KeptJson panels;              ///< an object: how window and panels stand (arrangement.h)
    KeptJson extra;               ///< unknown keys
    bool operator==(const Preferences&) const = default;
};

/// $XDG_CONFIG_HOME/fieldwright/editor.json, or under ~/.config; empty where neither variable is set.
std::string preferencesPath();

/// Defaults where there is no file. `problem` says what could not be read, and stays empty otherwise.
Preferences readPreferences(const std::string& path, std::string& problem);
/// Makes the folder if need be. Nothing for an empty path. Errors: as OutputFile.
Done savePreferences(const Preferences& preferences, const std::string& path);

inline constexpr std::size_t kMostTaken = 24;
/// The text as the first of at most `most`.
void toFront(std::vector<std::string>& texts, const std::string& text, std::size_t most);
/// The file as the first of the recent ones.
void addRecent(Preferences& preferences, const std::string& path);

}  // namespace fw::editor
