// Choosing a file to open, a name to save under, or a folder, in a window of the interface.
//
// Lifetime: one FileBrowser a program; what it shows is read anew when its folder changes or it opens.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "graph/document/json.h"

namespace fw::editor {

struct FolderEntry {
    std::string name;
    bool folder = false;
    bool operator==(const FolderEntry&) const = default;
};

/// The folders and the files with one of these endings in a folder, folders first, by name whatever its case;
/// hidden ones are left out. `problem` says why a folder cannot be read.
std::vector<FolderEntry> listFolder(const std::string& folder, std::span<const std::string> endings,
                                    std::string& problem);

struct FileBrowser {
    enum class Kind { open, save, folder } kind = Kind::open;
    std::string folder;  ///< absolute
    /// Of the files shown; the first is that of a name without one. None: no files are.
    std::vector<std::string> endings{std::string(kGraphEnding)};
    std::string name;                       ///< typed or chosen
    std::vector<FolderEntry> entries = {};  ///< of the folder
    std::string problem = {};               ///< why it cannot be read, or the name not be taken
    bool asking = false;                    ///< whether to replace a file
    bool opening = false, fresh = false;
};

/// Opens it on the file's folder with the file's name, on the folder, or where it was for an empty path.
void open(FileBrowser& browser, FileBrowser::Kind kind, const std::string& path);

/// Goes into the folder: a name in the present one, "..", or an absolute path.
void enter(FileBrowser& browser, const std::string& folder);

/// The only entry whose name begins with what was typed, whatever the case; nullptr if there are none or
/// several.
const FolderEntry* onlyBegunSo(const FileBrowser& browser);

/// What pressing the button means: enters a folder, asks about a file that exists, says what is wrong, or
/// returns the absolute path chosen. To open one, the beginning of a name is enough if no other begins so. A
/// name to save under gets the ending if it has none; a folder is the one shown where none is named, and need
/// not be there.
std::optional<std::string> choose(FileBrowser& browser);

/// One frame of it, if it is open. The path, once, when it was chosen; the window is closed then.
std::optional<std::string> show(FileBrowser& browser, float scale);

}  // namespace fw::editor
