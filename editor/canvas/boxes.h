// The canvas' geometry: where each node, row, socket and wire of a scope lies, in canvas units.
//
// Made from the document and the node library alone, so that no node type has code of its own, and made anew
// whenever the document changes. It refers to the graph that it was made of.
#pragma once

#include <string_view>
#include <unordered_map>
#include <vector>

#include "editor/canvas/view.h"
#include "editor/document/frames.h"
#include "editor/document/layout.h"

namespace fw::editor {

inline constexpr float kSocketRadius = 5.0f;
inline constexpr float kTextSize = 14.0f;

struct Row {
    std::string name;
    std::optional<Type> type = {};
    const InputSpec* spec = nullptr;    ///< of inputs of the library
    const InputValue* value = nullptr;  ///< of inputs that the document gives
    bool output = false;
    bool linked = false;  ///< an input with a wire
    float y = 0.0f;       ///< of its middle, from the node's top
    int fields = 0;  ///< numbers that can be edited in the row; they stand in a second line if more than one

    /// Whether its fields are numbers that can be typed.
    bool typed() const { return fields > 0 && !linked && type != Type::string && type != Type::boolean; }
};

struct NodeBox {
    const Node* node = nullptr;
    const NodeType* type = nullptr;  ///< null: unknown
    Area area = {};
    std::vector<Row> rows = {};
    bool reroute = false;

    /// Place of a row's socket.
    ImVec2 socket(const Row& row) const;
    /// Where the n-th number of a row is edited.
    Area field(const Row& row, int component) const;
};
/// Where the picture of the node's own field is, if it is shown: a square above the node.
Area thumbnailArea(const NodeBox& box);

struct Wire {
    uint32_t from = 0, fromRow = 0, to = 0, toRow = 0;
};

struct Boxes {
    /// Of the nodes in `scope`, which exists.
    Boxes(const Graph& graph, std::string_view scope);

    std::vector<NodeBox> nodes;
    std::unordered_map<std::string_view, uint32_t> byId;
    std::vector<Wire> wires;
    std::vector<Frame> frames;  ///< of the whole document, as framesOf() has them
    std::string scope;

    const NodeBox* find(std::string_view id) const;
    const Row* row(const Plug& plug, bool output) const;
    ImVec2 start(const Wire& wire) const {
        return nodes[wire.from].socket(nodes[wire.from].rows[wire.fromRow]);
    }
    ImVec2 end(const Wire& wire) const { return nodes[wire.to].socket(nodes[wire.to].rows[wire.toRow]); }
    Plug output(const Wire& wire) const;
    Plug input(const Wire& wire) const;

    /// Around all nodes, or those of the ids; a small one about the origin if there are none.
    Area around(const std::set<std::string>* only = nullptr) const;
};

/// A wire as a cubic Bézier curve; its four points.
struct Curve {
    ImVec2 points[4];
    ImVec2 at(float t) const;
    Area area() const;
    /// Distance of the nearest point of the curve.
    float distance(ImVec2 p) const;
    /// Where the straight line between the two crosses it first.
    std::optional<ImVec2> crossing(ImVec2 from, ImVec2 to) const;
    bool crosses(ImVec2 from, ImVec2 to) const { return crossing(from, to).has_value(); }
};
Curve curve(ImVec2 from, ImVec2 to);

/// What is at a place.
struct Hit {
    enum class What {
        nothing,
        node,
        title,
        output,
        input,
        field,
        wire,
        frame,
        frameTitle,
        frameCorner
    } what = What::nothing;
    uint32_t index = 0;  ///< of the node, wire or frame
    uint32_t row = 0;
    int component = 0;  ///< of a field
};
/// `p` in canvas units; `reach` is how far off a socket or wire still counts. Later nodes lie above earlier.
Hit hitTest(const Boxes& boxes, ImVec2 p, float reach);

/// By wire, whether it is on a way that leads through this one, from the first node to the last.
std::vector<bool> wayThrough(const Boxes& boxes, uint32_t wire);

/// "half_extents" as people read it: "Half extents".
std::string readable(std::string_view name);
/// What the node is called: its label, that of its type, or its id.
std::string titleOf(const NodeBox& box);

}  // namespace fw::editor
