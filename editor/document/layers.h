// Layered drawing of a directed graph (Sugiyama, Tagawa, Toda 1981: "Methods for visual understanding of
// hierarchical system structures"): columns by longest path, order in the columns by barycentres, heights by
// least squares. What is new against the paper: a source has one chain of bends for all that it feeds far
// away, and a column's heights are solved exactly (pool adjacent violators), not by priorities.
#pragma once

#include <cstdint>
#include <vector>

namespace fw::editor {

/// A wire between two boxes, and where on them it begins and ends, down from their tops.
struct LayerEdge {
    uint32_t from, to;
    double fromY = 0.0, toY = 0.0;
};

struct LayerBox {
    double width, height;
};

struct LayerPlace {
    uint32_t column = 0;
    double x = 0.0, y = 0.0;  ///< of the left upper corner
};

/// Places of the boxes, wires leading to the right wherever they form no cycle. `order` lists all boxes in
/// the order that they are to have from top to bottom if no other has fewer crossings.
std::vector<LayerPlace> layered(const std::vector<LayerBox>& boxes, const std::vector<LayerEdge>& edges,
                                const std::vector<uint32_t>& order);

}  // namespace fw::editor
