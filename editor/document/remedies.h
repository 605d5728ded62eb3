// What can be done at once about a finding: edits that make it go away. Which they are is told from the graph
// where the finding points, and each was tried on it.
#pragma once

#include <functional>

#include "editor/document/edits.h"

namespace fw::editor {

struct Remedy {
    std::string label;  ///< of a button: "Take off the wire"
    std::function<Graph(const Graph&)> mend = {};
};

/// The remedies of a finding of checkStructure(), the one that keeps most first; none for others. Some ms for
/// a thousand nodes.
std::vector<Remedy> remediesOf(const Graph& graph, const Error& finding);

}  // namespace fw::editor
