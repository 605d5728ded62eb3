// A document as parts that rest in themselves and move as wholes, for formats that have such: a gate that
// turns on its hinge is a mesh and a node with keys, and no mesh a frame.
//
// What moves a part is found by asking the nodes (asked_graph.h): one that carries what is behind it is a
// node with keys, a plain union parts what is behind it, and a node that leaves places and distances as they
// are, such as a material, goes to each part that is behind it. The rest must be the same at all times.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "graph/compile/asked_graph.h"
#include "graph/document/graph.h"

namespace fw {

/// A node that carries others, or a part.
struct PartNode {
    std::string name;                   ///< the label of its node in the document, or else its id
    std::optional<std::size_t> parent;  ///< an earlier one, if something carries it
    std::vector<Pose> poses = {};       ///< at each of the times; of a part none, for it rests
    Graph part = {};  ///< a document whose output shows the part alone; of what carries, none
};

/// The document as parts at these times, seconds since the start. None where something else moves than parts
/// as wholes, or nothing does. Whether parts overlap on their way is not looked at.
std::optional<std::vector<PartNode>> movingParts(const Graph& graph, std::span<const double> times);

}  // namespace fw
