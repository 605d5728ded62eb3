// The node canvas: draws a scope of the document and turns what mouse and keyboard do on it into edits.
//
// Everything about a node comes from its descriptor by way of boxes.h; there is no code for single types.
// The canvas changes the document itself, one step of undo a gesture; what needs other parts of the program
// (a menu to add from, entering a group) it asks of its caller. What keys do is in editor/commands.h.
//
//     mouse                        does
//     left                         select; drag moves nodes, a wire from a socket, a box around nodes
//     Alt + left drag              select by lasso (Shift adds, Ctrl takes away, as with the box)
//     middle, Space + left drag    pan; the wheel zooms to the cursor
//     right click                  asks for the add menu; on a number, for that of its keys
//     Ctrl + right drag            cuts wires; with Shift a reroute in each; with Alt connects two nodes
//     double click                 enters a group; on a frame's title: its words and colour
#pragma once

#include <array>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "editor/canvas/fields.h"
#include "editor/canvas/thumbnails.h"
#include "editor/shell/shell.h"
#include "graph/compile/compile.h"

namespace fw::editor {

/// What the canvas would like its caller to do.
struct CanvasWishes {
    struct Add {
        ImVec2 at;                 ///< canvas units
        std::optional<Plug> plug;  ///< the open end of a wire, to be connected with what is added
        bool plugIsOutput = false;
    };
    std::optional<Add> add;
    std::string enter;                 ///< the id of a group
    std::string activate;              ///< the id of a node to be shown in the preview
    std::optional<Plug> field;         ///< an input with numbers whose keys are asked for
    std::optional<std::size_t> frame;  ///< the index of a comment frame whose words are to be changed
};

/// What one output of a node gives at a place, in words; and as a colour, linear, if it is one.
struct OutputValue {
    std::string output, words;
    std::optional<std::array<double, 3>> color = {};
};
/// By node id. Of outputs that are not here there is nothing to be said.
using CanvasValues = std::map<std::string, std::vector<OutputValue>, std::less<>>;

/// What the canvas shows besides the document.
struct CanvasMarks {
    std::map<std::string, const Error*, std::less<>>
        findings;  ///< by node id within the scope, the worst of each
    std::function<const NodeExactness*(const std::string&)> exactness;  ///< of a node's id; nullptr: unknown
    std::string spoiledBy;                                              ///< the node that spoiled the field
    std::set<std::string> pinned;                                       ///< the nodes that the preview shows
    std::map<std::string, const Thumbnails::Shown*, std::less<>> thumbnails;  ///< by node id
    std::map<std::string, double, std::less<>> costs;  ///< by node id: its part of a sample of the field
    /// Of each "node.input" that the timeline moves.
    std::map<std::string, MovedField, std::less<>> animated;
    const CanvasValues* values = nullptr;  ///< that outputs have at the place probed; none is: nullptr
};

/// What the mouse has begun on the canvas.
struct CanvasGesture {
    enum class Kind : unsigned char {
        none,
        press,
        pan,
        move,
        box,
        lasso,
        wire,
        cut,
        reroute,
        lazy,
        frame,
        corner,
        map
    } kind = Kind::none;
    Hand hand = Hand::none;          ///< of the document, as long as the gesture goes on
    int button = 0;                  ///< ImGui's, that holds it
    ImVec2 begin{0, 0};              ///< canvas units, where the button went down
    std::vector<ImVec2> trail = {};  ///< of a lasso, a cut: canvas units
    Graph base = {};                 ///< the document when the gesture began
    std::string node = {};           ///< that was pressed
    std::size_t frame = 0;           ///< index of the frame that was
    Plug plug = {};                  ///< the fixed end of the wire under the mouse
    bool plugIsOutput = false;
    Area map = {};                 ///< that the minimap showed: what is seen by now would widen it ever more
    bool tookOff = false;          ///< the wire was on an input before
    std::string refused = {};      ///< why the wire under the mouse cannot be dropped here
    std::set<Plug> partners = {};  ///< sockets that it could be dropped on
};

struct Canvas {
    CanvasView view;
    std::string scope;                ///< the group shown; empty: the document's nodes
    std::set<std::string> selection;  ///< ids within the scope
    std::string active;               ///< of them the one selected last: what the inspector shows
    NumberHand number;                ///< that is dragged or typed on a node
    CanvasGesture gesture;
    bool minimap = true;
    bool costs = false;        ///< shown on the nodes
    bool exactness = false;    ///< shown on the wires: those that are no distance are broken
    bool spacePans = false;    ///< Space went down and was used to pan: its release asks for nothing
    bool frameNext = true;     ///< show all nodes with the next frame
    bool addsNext = false;     ///< a number was entered on a node, and the menu of nodes is asked for
    double restedSince = 0.0;  ///< seconds of ImGui's clock, when the mouse last moved
    std::vector<bool> lit;     ///< wires on the way through the one under the mouse; empty: none is

    /// Selects these alone.
    void select(const NodeIds& nodes);
    /// Forgets what is not in the document any more; leaves a group that is gone.
    void follow(const Graph& graph);
};

/// Shows the canvas in the rest of ImGui's current window. `boxes` is made of the document as it is; it is
/// left behind when the document changes.
CanvasWishes showCanvas(Canvas& canvas, Document& document, const Boxes& boxes, const CanvasMarks& marks,
                        const Shell& shell);

/// Whether nodes are seen large enough to have their numbers edited on them.
bool showsFields(const CanvasView& view);

/// How far a wire's surface can be trusted, as it is drawn: plain, in dashes, in dots.
enum class WireTrust : unsigned char { exact, bound, steep };
WireTrust trustOf(const Exactness& exactness);

/// Draws boxes, wires, frames and minimap over what is there (used by showCanvas).
void drawCanvas(const Canvas& canvas, const Boxes& boxes, const CanvasMarks& marks, const Shell& shell);
/// Whether there is a minimap: not where it would cover half of the panel.
bool hasMinimap(const Canvas& canvas, const Boxes& boxes);
/// Where it is, pixels, and the part of the canvas that it shows.
Area minimapArea(const CanvasView& view);
Area minimapShows(const Canvas& canvas, const Boxes& boxes);

}  // namespace fw::editor
