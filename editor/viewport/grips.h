// What can be dragged in the picture when a node is selected.
//
// The node's own values, or, where it has none for the tool, those of the next node behind it that moves it
// alone: who clicks a shape takes hold of where it stands. If there is none either, those of a node that is
// added when they are dragged. No type of node has code here.
#pragma once

#include <set>

#include "editor/splines/shown.h"
#include "editor/viewport/gizmo.h"

namespace fw::editor {

/// What dragging does; `scale` is for lengths, boxes and the angles of a shape too.
enum class Tool : unsigned char { move, turn, scale };

struct Grips {
    std::set<Tool> tools;                  ///< that there is something for
    std::vector<Handle> handles;           ///< of the tool; those of a node that is to be added name none
    std::string why;                       ///< they are not where they should be: how they are, for a person
    std::optional<Plug> ahead;             ///< the input whose wire the added node is put in
    std::optional<splines::Shown> spline;  ///< of which the handles are knots
};

/// For a node of the scope, as it is when `seconds` have passed; nothing if it is not in the picture of
/// `pinned` (empty: of the output).
Grips gripsOf(const Graph& graph, const std::string& scope, const std::string& node,
              const std::string& pinned, double seconds, Tool tool);

/// A graph as it is when some seconds of the timeline have passed. The graph must outlive it.
struct Moment {
    Moment(const Graph& graph, const std::string& scope, double seconds);
    const Graph& graph() const { return moved ? *moved : *still; }

    std::set<std::string> animated;  ///< inputs of the scope that the timeline moves, as "node.input"
    const Graph* still;
    std::optional<Graph> moved = {};
};

/// Whether what comes before the node goes on as one, at a place that is known.
bool passesAlone(const Node& node);
/// The input that the wire from `node` leads to in `next`, if it carries a surface.
std::optional<Plug> wireAhead(const std::vector<Node>& nodes, const std::string& node,
                              const std::string& next);

/// The node type that does what the tool does and nothing else; scaling is the same along all axes.
const NodeType& typeFor(Tool tool);

}  // namespace fw::editor
