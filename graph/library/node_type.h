// The node library: one table, one entry a node type, its meaning written in the field language.
//
// Everything that knows node types reads this table: the checker, the compiler, the expression language
// (every node type is a function there, its arguments in the order of `inputs`), the reference page, the JSON
// schema and the editor. Adding a node is one entry in one of the files under nodes/.
//
// A body is field-language code (language/parser.h). Its inputs are names in scope, already evaluated at the
// context position `p`; an input of type surface, scalar, vec2 or vec3 is also callable at another position:
// `a(vec3(abs(p.x), p.yz))`. String, points, stops and image inputs are visible as compile-time values.
//
// What a body returns becomes the node's only output; with several outputs it assigns each by name and
// returns nothing. A scalar returned where the output is a surface gets the default material;
// `with_distance(s, d)` is the surface `s` with its distance replaced; `mix(a, b, t)` and `c ? a : b` work on
// whole surfaces.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "graph/base/box.h"
#include "graph/base/file_kind.h"
#include "graph/library/types.h"

namespace fw {

enum class Category : unsigned char {
    shape,
    shape2d,
    spline,
    combine,
    domain,
    field,
    maths,
    material,
    mesh,
    particles,
    structure
};
inline constexpr int kCategories = int(Category::structure) + 1;
std::string_view categoryName(Category category);

/// Default of an input where the file gives none. `position` means: the context position.
struct InputDefault {
    enum class Kind : unsigned char { none, position, numbers, text } kind = Kind::none;
    std::vector<double> numbers;  ///< one per component; of a list entry by entry
    std::string text;
};

/// Where in space an input can be taken hold of, in the node's own space. It begins at the origin, at the end
/// of another input's grip, or at the place that the other one is.
struct Grip {
    enum class Kind : unsigned char {
        none,
        length,     ///< held at `along` times it, or at the direction `with` times it
        sizes,      ///< along x, y and z, each held at its number times that of `along`
        angle,      ///< held where `along`, turned towards `towards`, points; per metre: of one metre
        direction,  ///< held at its tip
        corner      ///< of a box whose other corner is `with`: held at the middles of its three faces
    } kind = Kind::none;
    std::array<double, 3> along = {0, 0, 0};    ///< of a length of unit length
    std::string from = {};                      ///< the other input, "-name" for the opposite end
    std::array<double, 3> towards = {0, 0, 0};  ///< of unit length, across `along`
    std::array<double, 3> middle = {0, 0, 0};   ///< of an angle, metres
    std::string with = {};  ///< another input; of an angle the length at whose end it is held; empty: 1 m
    explicit operator bool() const { return kind != Kind::none; }
};

struct InputSpec {
    std::string name;
    Type type;
    InputDefault value;
    double min = -std::numeric_limits<double>::infinity();  ///< smallest value allowed, each component
    double max = std::numeric_limits<double>::infinity();
    std::vector<std::string> options = {};  ///< the allowed strings of an enum input
    /// "m", "1/m", "m/s", "degrees", "degrees/m" (units.h), "color" (linear sRGB), "" for a plain number,
    /// "any" for one that is whatever its node is wired to.
    std::string unit = {};
    std::string doc = {};
    bool positive = false;           ///< must be > 0 (min alone allows equality)
    bool known = false;              ///< of a number: it must be known when the graph is compiled
    bool lines = false;              ///< of a text: it may have several lines
    bool whole = false;              ///< of a surface: what it is, light passing through it or not
    const FileKind* file = nullptr;  ///< of an image, or a string that is the path of a file: its kind
    bool ordered = false;            ///< of points: as orderProblem() has it; stops always are
    Grip grip = {};                  ///< where it is held, unless its unit and range say so
};

struct OutputSpec {
    std::string name;
    Type type;
};

/// What an exactness rule may ask about the node it classifies. A rule assumes that `p` is the context
/// position and that no number depends on position; where one does, whoever asks the rule lowers its answer
/// to distorted().
struct ExactnessArguments {
    /// Exactness of the named surface input; that of empty space if unconnected.
    std::function<Exactness(std::string_view)> surface;
    /// Whether the named surface input's distance depends on this coordinate (0: x) of the position.
    std::function<bool(std::string_view, int axis)> varies;
    /// Constant value of the named input's component; nullopt if it varies, is live or is linked to a field.
    std::function<std::optional<double>(std::string_view, int component)> constant;
    /// Chosen string of the named enum input.
    std::function<std::string(std::string_view)> option;
    /// Whether the solid of the named surface is proven to be inside the half-space dot(normal, p) <= offset.
    /// `normal` has unit length. Runs a search in space at each call.
    std::function<bool(std::string_view, const Point& normal, double offset)> within;
    /// A box that is proven to contain all points where the named surface's distance is below `level`. The
    /// box is inverted (lo > hi) if no such point exists, and nullopt if the search finds no bounds.
    std::function<std::optional<Box>(std::string_view, double level)> bounds;
    /// Whether the named surface's distance is proven not to change if this coordinate changes its sign.
    std::function<bool(std::string_view, int axis)> mirrored;
};
using ExactnessRule = std::function<Exactness(const ExactnessArguments&)>;

/// The rule of a shape whose class does not depend on its inputs.
ExactnessRule always(Exactness exactness);
/// The rule of a node that keeps the class of this surface input.
ExactnessRule sameAs(std::string input);

/// What a document takes a node for, where it is more than a function of its inputs.
enum class NodeRole : unsigned char {
    plain,
    output,       ///< what is seen, played and exported
    parameter,    ///< a number with a name, for whoever plays the document
    expression,   ///< has code and inputs of its own
    reroute,      ///< passes on its one input
    frame,        ///< a comment
    group,        ///< an instance of one of the document's groups
    groupInput,   ///< inside a group: what it receives
    groupOutput,  ///< inside a group: what it gives
};

/// How the compiler treats a node without a body (compile/graph_lowering.h).
class GraphLowering;
struct NodeAt;
struct Lowered;
using LowerHook = Lowered (*)(GraphLowering&, const NodeAt&);

struct NodeType {
    std::string id;
    std::string label;
    Category category;
    std::string doc;  ///< first sentence is the tooltip; ends with a full stop
    std::vector<InputSpec> inputs;
    std::vector<OutputSpec> outputs;
    ExactnessRule exactness = {};           ///< of the surface output; empty for nodes without one
    std::string body = {};                  ///< field language; empty where there is a hook that needs none
    LowerHook lower = nullptr;              ///< in place of the body
    std::vector<std::string> aliases = {};  ///< former ids, still read; also searched by the editor
    bool open = false;  ///< the document decides what inputs and outputs there are beside those of the table
    NodeRole role = NodeRole::plain;
};

/// Every node type, in the order of the reference page (graph/nodes/node_types.cpp). Built once.
const std::vector<NodeType>& nodeTypes();
/// The entry with this id or alias; nullptr if there is none.
const NodeType* findNodeType(std::string_view id);
/// The role of the node type with this id or alias; plain if there is none.
NodeRole roleOf(std::string_view id);
/// The id of the one node type of this role.
const std::string& idOf(NodeRole role);
/// Index of the named input in `type.inputs`; -1 if there is none.
int inputIndex(const NodeType& type, std::string_view name);
/// Index of the named output in `type.outputs`; -1 if there is none.
int outputIndex(const NodeType& type, std::string_view name);
/// "above 0", "at least 0 and at most 1". The input has a range.
std::string rangeWords(const InputSpec& input);
/// What stands for the least number above 0, where one is wanted.
inline constexpr double kLeastPositive = 1e-6;
/// Why `value` may not be a component of this input: "the value 2 is out of range: it must be at most 1".
/// Empty if it may.
std::optional<std::string> rangeProblem(const InputSpec& input, double value);
/// Entries of stops, and of points that are ordered, at most.
inline constexpr std::size_t kMostStops = 32;
/// Why these numbers are no stops, or no points of a curve: there are none, or more than kMostStops; the
/// first number of an entry is below that of the one before; a colour is below 0. Empty if they are.
std::optional<std::string> orderProblem(Type type, std::span<const double> numbers);
/// The id of the node type whose name is nearest by edit distance: for "did you mean". Empty if none is near.
std::string nearestNodeType(std::string_view id);

}  // namespace fw
