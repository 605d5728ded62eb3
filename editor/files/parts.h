// The library: parts that are kept for later, as graph files in a folder of the user's.
//
// A part is nodes: a shape that is used again and again, a group, one node with the values that one likes.
// Any graph file in the folder or below it is one, so a folder can be shared as it is; folders are its
// headings. Files that a part reads lie beside it, and are brought to the document that it is put in
// (assets.h).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "editor/document/edits.h"

namespace fw::editor {

struct Editor;
struct Preferences;

struct LibraryPart {
    std::string path;    ///< absolute
    std::string folder;  ///< from the library on, "screws/metric"; empty: in it
    std::string label;   ///< "Hex bolt"
    bool operator==(const LibraryPart&) const = default;
};

inline constexpr std::size_t kMostParts = 5'000;

/// As the preferences have it, else $XDG_DATA_HOME/fieldwright/library; empty where neither is known.
std::string libraryFolder(const Preferences& preferences);

/// All in the folder and below, by folder and name, at most kMostParts; hidden ones are left out. `problem`
/// says why there are none, if that is another reason than that nothing was kept yet.
std::vector<LibraryPart> listParts(const std::string& folder, std::string& problem);

/// A name for a part's file: "Hex bolt!" as "hex_bolt"; "part" of what has no letters.
std::string partName(const std::string& words);

/// What a part of these nodes may be called, in words: as the node `active` is labelled, or the group that it
/// shows, or as its id was chosen, else as the document's file; with a number behind it if a part has that
/// name.
std::string proposedName(const Graph& graph, std::string_view scope, std::string_view active,
                         std::span<const LibraryPart> parts);

/// These nodes of the scope that is shown as a part of this name, in place of one that is there. Errors: it
/// cannot be written.
Done keepPart(const Editor& editor, const NodeIds& nodes, const std::string& name);

/// The part's nodes in the document, as one step of undo, their middle at `at`. `linked`: a part that shows a
/// group stays a copy of its file (linked_groups.h). What it makes is wired to the node `to`, if there is one
/// and it fits (joining.h). What cannot be done is said in the status line.
void addPart(Editor& editor, const LibraryPart& part, Position at, bool linked, const std::string& to = {});

/// The node that a picture of the graph shows: what its output does, else the last that makes a surface;
/// empty if there is none.
std::string shownNode(const Graph& graph);

}  // namespace fw::editor
