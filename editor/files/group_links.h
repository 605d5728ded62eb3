// Groups of the document that are copies of a group in a file: how the two stand, and what is done about it.
//
// The files are looked at as assets are (assets.h), so that a difference is seen soon after another program,
// or another document, has written one. Nothing is taken from a file, or written to it, unasked; what a file
// held is kept beside it as a version (versions.h).
//
// Lifetime: part of Files; what is known is of the graph that was last looked at.
#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "editor/document/linked_groups.h"
#include "runtime/system/file_watch.h"

namespace fw::editor {

struct Editor;

class GroupLinks {
  public:
    using Clock = std::chrono::steady_clock;

    struct Link {
        std::string group;
        std::string path;     ///< of the file, absolute
        std::string problem;  ///< why the file's group cannot be had; empty: it can
        LinkState state = LinkState::same;
    };

    /// Looks at the groups, if the graph is another, and at their files, if that was not done within
    /// kWatchSeconds. Whether any of it changed.
    bool look(const std::shared_ptr<const Graph>& graph, Clock::time_point now = Clock::now());
    /// Those of the graph that was looked at.
    const std::vector<Link>& all() const { return links; }
    /// Null: the group is linked to no file.
    const Link* of(std::string_view group) const;
    /// What is to be said of them: a warning for each that is not the same as its file.
    const std::vector<Error>& findings() const { return found; }
    /// Looks at all again the next time.
    void forget() { seen.reset(), files.clear(), looked = {}; }

  private:
    struct File {
        fw::FileWatch watch;
        std::string digest, problem;  ///< of its group; or why there is none
    };
    void read(const std::string& path, File& file) const;

    std::shared_ptr<const Graph> seen;
    std::map<std::string, File> files;  ///< by absolute path
    std::vector<Link> links;
    std::vector<Error> found;
    Clock::time_point looked = {};
};

/// "The file was changed since." of a link; empty where it is the same.
std::string wordsOf(const GroupLinks::Link& link);

/// The path of a file as documents in this folder have it: from the folder on. Both are absolute; without a
/// folder it stays as it is.
std::string pathFrom(const std::string& folder, const std::string& file);
/// The graph with the files that its groups are copies of named from the folder `to` on.
Graph withLinksFrom(Graph graph, const std::string& from, const std::string& to);

// Each is one step of undo, or says in the status line why it cannot be.

/// The group as its file has it.
void updateGroup(Editor& editor, const std::string& group);
/// Writes the group into its file.
void writeGroup(Editor& editor, const std::string& group);
/// Writes it into this file, of which it is a copy from then on.
void linkGroup(Editor& editor, const std::string& group, const std::string& path);
/// It is a copy of no file any more.
void unlinkGroup(Editor& editor, const std::string& group);
/// Asks where the group is to be written, and links it.
void askToLink(Editor& editor, const std::string& group);

}  // namespace fw::editor
