// What a person does to a graph, as functions from a graph to a graph.
//
// All work in one scope: the nodes of the document, or those of the group with the id `scope`. Each result is
// structurally as sound as its argument: ids stay unique, links lead to nodes that exist, no wire closes a
// cycle or joins types that do not convert. Positions are canvas units: a node is about 180 wide, a row 24.
#pragma once

#include <array>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "graph/base/result.h"
#include "graph/document/graph.h"
#include "graph/document/sockets.h"

namespace fw::editor {

using Position = std::array<double, 2>;
using NodeIds = std::vector<std::string>;

/// One end of a wire. An empty name is the first output.
struct Plug {
    std::string node, name;
    auto operator<=>(const Plug&) const = default;
};

/// What an edit made: the graph, and the nodes to select.
struct Edited {
    Graph graph;
    NodeIds nodes;
};

/// The nodes of a scope; those of the document for an empty one. Of a group that is gone: none, and what is
/// done to them changes nothing.
const std::vector<Node>& nodesOf(const Graph& graph, std::string_view scope);
std::vector<Node>& nodesOf(Graph& graph, std::string_view scope);

/// An id that no node of the scope has: `base` made fit for one, with a number if it is taken.
std::string freshId(const std::vector<Node>& nodes, std::string_view base);

/// Fresh ids for many nodes: each that next() gives is taken from then on.
class FreshIds {
  public:
    explicit FreshIds(const std::vector<Node>& nodes);
    explicit FreshIds(const std::vector<Group>& groups);
    std::string next(std::string_view base);

  private:
    std::unordered_set<std::string> taken;
    std::unordered_map<std::string, int> numbers;  ///< the last given to a base
};

/// A node of this type. An expression comes with code that works, a group node with `group`. The graph as it
/// is, and no node, where such a node cannot stand (canAdd() of wiring.h; a group in itself; beyond the
/// limits of graph.h).
Edited addNode(const Graph& graph, std::string_view scope, std::string_view type, Position at,
               std::string_view group = {});

/// Why no wire may lead from this output to this input: "a cycle: a -> b -> a", "text is no surface". Empty
/// if it may.
std::string refusal(const Graph& graph, std::string_view scope, const Plug& output, const Plug& input);

/// The first input of the node that a wire from this output may lead to, free ones first; and the first
/// output that may lead to this input.
std::optional<Plug> fittingInput(const Graph& graph, std::string_view scope, const Plug& output,
                                 std::string_view node);
std::optional<Plug> fittingOutput(const Graph& graph, std::string_view scope, std::string_view node,
                                  const Plug& input);

/// The node types that have an input for this output (or an output for this input), in the library's order.
std::vector<const NodeType*> typesThatFit(const Graph& graph, std::string_view scope, const Plug& plug,
                                          bool plugIsOutput);

/// A wire; it takes the place of what fed the input. It has no refusal.
Graph connect(const Graph& graph, std::string_view scope, const Plug& output, const Plug& input);
/// Without what feeds this input; it has its default again, that of an expression zeros.
Graph disconnect(const Graph& graph, std::string_view scope, const Plug& input);

/// A node of this type where the wire into `input` was, with that wire through it; the same for a node that
/// is there (dropped on the wire). The graph itself if the node does not fit.
Edited insertOnWire(const Graph& graph, std::string_view scope, const Plug& input, std::string_view type,
                    Position at);
Graph dropOnWire(const Graph& graph, std::string_view scope, const Plug& input, std::string_view node);

/// Without the nodes, and the parameters and tracks that set their inputs. With `heal`, each input that they
/// fed is fed by the first of the node's own sources that fits, which is what muting passes on.
Graph removeNodes(const Graph& graph, std::string_view scope, std::span<const std::string> nodes, bool heal);

/// The nodes again, beside themselves, wired among each other; with `keepInputs` also to what feeds the
/// originals from outside. Without those that can stand only once. What moves their inputs moves the copies'.
Edited duplicate(const Graph& graph, std::string_view scope, std::span<const std::string> nodes,
                 bool keepInputs);

Graph moveNodes(const Graph& graph, std::string_view scope, std::span<const std::string> nodes, Position by);
/// Mutes all, or unmutes them if all are muted; the same for collapsing.
Graph toggleMuted(const Graph& graph, std::string_view scope, std::span<const std::string> nodes);
Graph toggleCollapsed(const Graph& graph, std::string_view scope, std::span<const std::string> nodes);

/// An input's value, or none: its default. The graph as it is if the node has no such input or the value does
/// not fit it. An expression gets the input if it has none of that name, and loses it without a value.
Graph setInput(const Graph& graph, std::string_view scope, const Plug& input,
               std::optional<InputValue> value);
/// One of the numbers of an input, which may stand for its default so far.
Graph setNumber(const Graph& graph, std::string_view scope, const Plug& input, int component, double number);
Graph setLabel(const Graph& graph, std::string_view scope, std::string_view node, std::string label);
Graph setCode(const Graph& graph, std::string_view scope, std::string_view node, std::string code);
/// Another id for a node; links, parameters and tracks follow. Error: no id, or taken.
Result<Graph> renameNode(const Graph& graph, std::string_view scope, std::string_view node,
                         std::string_view id);
/// What the first two inputs of equal type hold changes places, where both fit.
Graph swapInputs(const Graph& graph, std::string_view scope, std::string_view node);

/// A reroute in the wire into `input`.
Edited addReroute(const Graph& graph, std::string_view scope, const Plug& input, Position at);

/// The nodes as a group of their own with one node in their place: what fed them from outside are its inputs,
/// what they fed its outputs. Error: an output node among them, or a way out of the group and back into it.
Result<Edited> groupNodes(const Graph& graph, std::string_view scope, std::span<const std::string> nodes);
/// The nodes of the group in place of the group node; the group itself goes with its last instance.
Edited ungroup(const Graph& graph, std::string_view scope, std::string_view node);

/// Nodes that lead to these, or that these lead to, themselves included.
std::set<std::string> upstream(const std::vector<Node>& nodes, std::span<const std::string> of);
std::set<std::string> downstream(const std::vector<Node>& nodes, std::span<const std::string> of);

}  // namespace fw::editor
