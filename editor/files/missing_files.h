// Files that the document names and that are not there: found again, all in one window.
//
// A document that was moved or sent without its pictures names files that lie elsewhere now. The window lists
// them; one is chosen by hand, or a folder is named in which all are looked for, by their names. What is
// found is brought to the document as what is dropped on it (assets.h).
#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "editor/files/browser.h"
#include "graph/document/named_files.h"

namespace fw::editor {

struct Editor;

struct MissingFilesDialog {
    using Clock = std::chrono::steady_clock;

    bool opening = false;               ///< in this frame
    FileBrowser browser = {};           ///< of the folder to look in
    std::vector<NamedFile> known = {};  ///< what is missing, as of the last look

    /// Looks if the graph is another, or files were `changed`; at most once in kWatchSeconds.
    void look(const std::shared_ptr<const Graph>& graph, bool changed, Clock::time_point now);

  private:
    std::shared_ptr<const Graph> seen = {};
    Clock::time_point looked = {};
};

/// Those of the graph's files that are no ordinary files, in the order in which it names them.
std::vector<NamedFile> missingFiles(const Graph& graph, const std::string& folder);

inline constexpr std::size_t kMostLookedAt = 100'000;  ///< entries of folders

/// Where in the folder and those below it there are files of these names, whatever the case: by the path that
/// the graph has. Of several the one whose folders are alike most, then the first by name. Hidden folders and
/// links are not followed; it ends at kMostLookedAt.
std::map<std::string, std::string> lookFor(const std::vector<NamedFile>& files, const std::string& folder);

/// Takes what lies below the document's folder, else opens the window; says so if nothing is missing.
void openMissingFiles(Editor& editor);
/// One frame of it.
void showMissingFiles(Editor& editor);

}  // namespace fw::editor
