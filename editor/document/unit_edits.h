// Another unit for a document that keeps its sizes: every number that is a length is reckoned into it.
//
// What is a length, the table of nodes says (library/units.h): inputs and their defaults, the ranges of
// parameters, keys of the timeline, camera and lamps of the scene. A number that is whatever its node is
// wired to (a value, a vector, a parameter; what an instance of a group is given) is what all those inputs
// are that it reaches. Nothing is known of code, of nodes that calculate, and of files: they stay as they
// are, and are named.
//
// (To keep the numbers instead, and have them mean other sizes, is setUnit() alone.)
#pragma once

#include <string>
#include <vector>

#include "graph/document/graph.h"
#include "graph/library/units.h"

namespace fw::editor {

struct OtherUnit {
    Graph graph;
    std::vector<std::string> left;  ///< nodes, "group/node", whose numbers may be lengths and stay
};
OtherUnit keepSizes(const Graph& graph, const LengthUnit& to);

}  // namespace fw::editor
