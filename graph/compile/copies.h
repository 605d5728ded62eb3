// A document as solids of which some are copies, for formats in which a mesh stands once and is shown at many
// places: the trees of a `scatter`, the columns of a `polar_repeat`.
//
// What copies is found by asking the nodes (asked_graph.h), not by what they are called. From the output on,
// plain unions part what is behind them; a node that carries all as a whole, or leaves it where it is, goes
// along. Of any other node with one surface the content is marked: the emission of what is behind it becomes
// the place, so that where a solid made of it is seen its emission says which place of the content is seen
// there, through minima of neighbours too. If that map is a similarity almost everywhere, but another one at
// other places, the node makes copies.
//
// So the first node that copies is taken; what it copies may consist of copies again. Whether copies are
// whole, apart, and alike is known once there are meshes (runtime/play/copied_meshes.h).
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "graph/compile/asked_graph.h"

namespace fw {

/// A map p -> turn * p + move, metres; row by row.
struct AffineMap {
    std::array<Point, 3> turn{};
    Point move{};
};
/// The map that has this gradient and this value at a place.
AffineMap mapAt(const std::array<Point, 3>& gradient, const Point& value, const Point& place);

/// Where something is that looks at its own place by the map.
struct CopyPlace {
    Pose pose;              ///< its turn's w is not negative
    bool mirrored = false;  ///< before all else its x becomes -x
    bool operator==(const CopyPlace&) const = default;
};
/// None of a map that is no similarity.
std::optional<CopyPlace> placeOf(const AffineMap& map);

/// What is copied, and how.
struct CopiedContent {
    Graph content;  ///< a document whose output shows what is copied, alone, in its own space
    Program map;    ///< its distance is the copies', and its emission the place of the content
};

/// A solid; the document's is the union of all.
struct Solid {
    std::string name;                     ///< of the node that makes it: the one that copies, if one does
    Graph shown;                          ///< a document whose output shows it alone
    std::optional<CopiedContent> copied;  ///< what it consists of copies of
};

/// The solids of the document so many seconds after its start; of one that has no copies, or more solids
/// than `most`, none. `region` is where it is: copies are looked for there.
std::vector<Solid> copyingSolids(const Graph& graph, double seconds, const Box& region,
                                 const CompileOptions& options = {}, std::size_t most = 1000);

}  // namespace fw
