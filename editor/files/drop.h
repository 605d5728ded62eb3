// What is dropped on the window from the desktop: a graph is opened, a mesh becomes nodes.
//
// A graph reads meshes from its own folder and those below it alone. So a mesh that lies elsewhere is copied
// beside the graph, and one that is dropped on a document without a file waits until it is saved.
#pragma once

#include <string>
#include <vector>

#include "editor/document/edits.h"

namespace fw::editor {

struct Editor;

/// Meshes that wait for the document to have a file.
struct DroppedMeshes {
    std::vector<std::string> files;
    Position at = {};  ///< of the first one's nodes, canvas units
};

/// Files that were dropped where the mouse is. What cannot be done is said in the status line.
void drop(Editor& editor, const std::vector<std::string>& files);
/// The nodes of meshes, in one step of undo. The document has a file.
void addDropped(Editor& editor, const DroppedMeshes& meshes);

}  // namespace fw::editor
