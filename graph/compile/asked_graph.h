// What a node makes of the surfaces behind it, found by asking the field, and not by what the node is called.
//
// A node with one surface is tried on others in its place, the coordinates, 1 and -1: what it gives of them
// is the map from a place to the place that it looks at, times what it does to distances. Where that map is
// a similarity (turned, moved, of another size, as a whole), the node carries what is behind it. A node with
// two surfaces that gives the lesser of any two numbers is a plain union.
//
// Lifetime: refers to the graph, which outlives it.
#pragma once

#include <array>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "graph/compile/live_program.h"

namespace fw {

/// Where a part is in what carries it: of its own size first, then turned, then moved.
struct Pose {
    std::array<double, 3> move{};
    std::array<double, 4> turn{0, 0, 0, 1};  ///< a unit quaternion x, y, z, w
    double size = 1.0;
    bool operator==(const Pose&) const = default;
};

/// A node on the way from the output to a surface, and its input that leads there.
struct Step {
    std::string node, input;
};

class AskedGraph {
  public:
    /// None of a document without an output that shows a surface, or with a timeline that cannot be read.
    /// Nodes are asked for each of these times, seconds since the start.
    static std::optional<AskedGraph> of(const Graph& graph, std::span<const double> times,
                                        CompileOptions options = {});

    const Graph& graph() const { return *document; }
    const Timeline& timeline() const { return read; }
    /// What the output shows; where it shows a mesh, what that is made of.
    const Link& shown() const { return link; }
    bool showsMesh() const { return mesh; }
    /// The document with its output showing this, and no mesh.
    Graph showing(const Link& surface) const;
    /// The same behind these nodes, of which the first is nearest to the output; others are left out.
    Graph showing(const Link& surface, std::span<const Step> through) const;

    /// The node's label, or else its id.
    static const std::string& nameOf(const Node& node) { return node.label.empty() ? node.id : node.label; }
    static const Link* linkOf(const Node& node, std::string_view input);
    /// The node that the link leads to, if that has no other output.
    const Node* onlyOutputOf(const Link& to) const;
    /// Its inputs to which surfaces are linked.
    std::vector<std::string> surfacesOf(const Node& node) const;

    /// How the node carries what is behind it, at each of the times; each turn near the one before. Empty if
    /// it does something else.
    std::vector<Pose> posesOf(const Node& node, const std::string& input) const;
    /// Whether it gives the lesser of two surfaces.
    bool isUnion(const Node& node, const std::string& a, const std::string& b) const;

    /// Adds a surface of this code to a document, with `inputs`; its id.
    static std::string addField(Graph& to, const std::string& code,
                                std::vector<std::pair<std::string, InputValue>> inputs = {});
    static InputValue linkTo(Link to);

  private:
    AskedGraph(const Graph& graph, std::span<const double> times, CompileOptions options)
        : document(&graph), moments(times.begin(), times.end()), how(std::move(options)) {}
    std::vector<std::vector<double>> seenThrough(const Node& node,
                                                 std::span<const std::pair<std::string, std::string>> fields,
                                                 std::span<const Point> places) const;

    const Graph* document;
    std::vector<double> moments;
    CompileOptions how;
    Timeline read;
    Link link;
    bool mesh = false;
    std::string output;
};

}  // namespace fw
