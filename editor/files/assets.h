// The files that a document reads: brought to where it can read them, and looked at for changes.
//
// A graph reads what lies in its own folder and in those below it. So what is dropped on it from elsewhere,
// what pasted nodes of another document name, and what a document names that is saved into another folder is
// copied there, with the files that such a file names itself. A file that is there is never replaced: if it
// holds something else, the copy gets another name, and so does the path in the graph.
#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "graph/document/named_files.h"
#include "runtime/system/file_watch.h"

namespace fw::editor {

/// A file in a graph's folder.
struct BroughtFile {
    std::string path;  ///< from the folder
    enum class How : unsigned char {
        lay,
        same,
        copied
    } how;  ///< it lay there, or one that is the same, or now does
};

/// Makes a graph in the folder able to read the file: where it lies, if that is in the folder or below it,
/// else as a copy, called `wanted` from the folder on or nearly so. Errors, with a message only: it cannot be
/// copied, or names files of which there are others.
Result<BroughtFile> bringFile(const std::string& folder, const std::string& file, const std::string& wanted,
                              const FileKind& kind);

/// The graph, whose files lie in the folder `from`, with those that it can read there brought to the folder
/// `to`. What went otherwise than expected goes to `told`; files that are missing stay so.
Graph bringFiles(Graph graph, const std::string& from, const std::string& to, std::vector<std::string>& told);

/// "this; that", for the status line.
std::string joined(const std::vector<std::string>& words);

/// Notices that a file which the graph names was changed, or came to be there.
class AssetWatch {
  public:
    using Clock = std::chrono::steady_clock;
    /// Whether one was since it was last asked; none if that is less than kWatchSeconds ago.
    bool look(const std::shared_ptr<const Graph>& graph, Clock::time_point now = Clock::now());

  private:
    std::shared_ptr<const Graph> seen;
    std::map<std::string, fw::FileWatch> files;  ///< by absolute path
    Clock::time_point looked = {};
};

}  // namespace fw::editor
