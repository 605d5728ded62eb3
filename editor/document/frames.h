// Comment frames: boxes on the canvas that hold nodes and move them along. They stand under `frames` in the
// document, each as {"scope": "group" (absent: the document's nodes), "at": [x, y], "size": [w, h], "text":
// "…", "color": [r, g, b] (absent: grey)}. A frame holds the nodes whose place lies in it.
#pragma once

#include "editor/document/edits.h"

namespace fw::editor {

struct Frame {
    std::string scope;
    Position at{}, size{};
    std::string text;
    std::optional<std::array<double, 3>> color;  ///< sRGB, 0 to 1
    KeptJson extra;                              ///< unknown keys
};

/// The document's frames; what is no frame is left out (and kept by the functions below).
std::vector<Frame> framesOf(const Graph& graph);
/// The frame at this index of framesOf() replaced; removed if there is none; one behind the last adds.
Graph setFrame(const Graph& graph, std::size_t index, const std::optional<Frame>& frame);
/// A frame around the nodes.
Graph frameNodes(const Graph& graph, std::string_view scope, std::span<const std::string> nodes);

}  // namespace fw::editor
