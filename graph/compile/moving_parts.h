// A document as parts that rest in themselves and move as wholes, for formats that have such: a gate that
// turns on its hinge is a mesh and a node with keys, and no mesh a frame.
//
// What moves a part is found by asking the field, and not by what a node is called. A node with one surface
// is tried on four others in its place, the coordinates and 1: what it gives of them is the map from a place
// to the place that it looks at, times what it does to distances. Where that map is a similarity (turned,
// moved, of another size, as a whole), the node carries what is behind it. A node with two surfaces that
// gives the lesser of any two numbers is a plain union, and parts them. A node that leaves places and
// distances as they are, such as a material, goes to each part that is behind it. The rest must be the same
// at all times.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "graph/document/graph.h"

namespace fw {

/// Where a part is in what carries it: of its own size first, then turned, then moved.
struct Pose {
    std::array<double, 3> move{};
    std::array<double, 4> turn{0, 0, 0, 1};  ///< a unit quaternion x, y, z, w; each near the one before
    double size = 1.0;
    bool operator==(const Pose&) const = default;
};

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
