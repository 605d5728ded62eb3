// What is dropped on the window from the desktop: a graph is opened, another file becomes the nodes that read
// it.
//
// A graph reads files from its own folder and those below it alone. So one that lies elsewhere is copied
// beside the graph (assets.h), and one that is dropped on a document without a file waits until it is saved.
#pragma once

#include <string>
#include <vector>

#include "editor/document/edits.h"
#include "graph/base/file_kind.h"

namespace fw::editor {

struct Editor;

/// Files that wait for the document to have a file.
struct DroppedFiles {
    std::vector<std::string> files;
    Position at = {};  ///< of the first one's nodes, canvas units
};

/// Files that were dropped where the mouse is. What cannot be done is said in the status line.
void drop(Editor& editor, const std::vector<std::string>& files);
/// The path of the file from the document's folder on, the file brought there if need be. What was done goes
/// to `told`.
Result<std::string> bringToDocument(const Editor& editor, const std::string& file, const FileKind& kind,
                                    std::vector<std::string>& told);
/// The nodes of files, in one step of undo. The document has a file.
void addDropped(Editor& editor, const DroppedFiles& dropped);

}  // namespace fw::editor
