// The document: a graph as a person wrote it. A value; copying it is how undo works.
//
// Nothing here is checked against the node library (check.h does that) and nothing is compiled (compile.h).
// Keys the program does not know are kept as JSON in `extra` (null if there are none) and written back in the
// same object, after the known ones.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "graph/base/result.h"
#include "graph/document/kept_json.h"

namespace fw {

inline constexpr int kFormatVersion = 1;
inline constexpr std::size_t kMaxFileBytes = 16u << 20;
inline constexpr std::size_t kMaxNodes = 10'000;    ///< in one file, groups included
inline constexpr std::size_t kMaxSockets = 256;     ///< inputs of one node, inputs and outputs of one group
inline constexpr std::size_t kMaxEntries = 10'000;  ///< groups, parameters
inline constexpr std::size_t kMaxExpandedNodes = 200'000;  ///< with every instance of a group counted
inline constexpr std::size_t kMaxJsonValues = 2'000'000;   ///< in one file: bounds the memory of reading it
inline constexpr int kMaxNesting = 64;  ///< of JSON arrays and objects, and of groups in groups

/// 1-based place in the text of the file; 0 for a document that was not read from text.
struct TextPosition {
    int line = 0, column = 0;
    bool operator==(const TextPosition&) const {
        return true;
    }  // where a value stood is not part of the value
};

/// Where the values of JSON that is kept as written stood: one entry a value, in the order of the text (see
/// placed_json.h). Empty for a document that was not read from text.
struct TextPlaces {
    std::vector<TextPosition> list = {};
    bool operator==(const TextPlaces&) const { return true; }
};

/// An input's source: the named output of another node; the first output if `output` is empty.
struct Link {
    std::string node, output;
    bool operator==(const Link&) const = default;
};

struct InputValue {
    /// number, boolean, string, numbers (vectors; lists entry by entry), or link
    std::variant<double, bool, std::string, std::vector<double>, Link> value;
    TextPosition at = {};
    int entry = 0;  ///< numbers of an entry, if they are a list of points (2): [[x, y], …], or of stops (4)
    KeptJson extra = {};  ///< of a link
    bool operator==(const InputValue&) const = default;
};

struct Node {
    std::string id, type;
    std::optional<std::array<double, 2>> at;  ///< canvas position
    std::string label;
    bool muted = false, collapsed = false;
    std::string code;   ///< of an expression node
    std::string group;  ///< of a group node: the id of the group it instances
    std::vector<std::pair<std::string, InputValue>> inputs;
    KeptJson extra;
    TextPosition place, codePlace;
    bool operator==(const Node&) const = default;

    /// The value or link the file gives for this input; nullptr if it is left to its default.
    const InputValue* input(std::string_view name) const;
    /// Replaces the input, or adds it at the end.
    void set(std::string_view name, InputValue value);
};

/// An input of a group, seen inside as an output of its `group_input` node.
struct GroupInput {
    std::string name, type;           ///< type as in files: "float", "vec3", "surface", …
    std::optional<InputValue> value;  ///< default of an instance that gives none
    KeptJson extra;
    TextPosition place;
    bool operator==(const GroupInput&) const = default;
};

/// An output of a group, seen inside as an input of its `group_output` node.
struct GroupOutput {
    std::string name, type;
    KeptJson extra;
    TextPosition place;
    bool operator==(const GroupOutput&) const = default;
};

/// A reusable subgraph. Its node of type group_input has the group's inputs as outputs; the inputs of its
/// node of type group_output are the group's outputs. It may be a copy of the group in another graph file:
/// the copy is what counts, so that a document needs no other to be made, and the editor tells when they
/// differ.
struct Group {
    std::string id;
    std::string file = {};  ///< that it is a copy of, a path from this document's folder; empty: none
    std::string taken =
        {};  ///< what both were when they were last the same (editor/document/linked_groups.h)
    std::vector<GroupInput> inputs;
    std::vector<GroupOutput> outputs;
    std::vector<Node> nodes;
    KeptJson extra;
    TextPosition place;
    bool operator==(const Group&) const = default;
};

/// A parameter shown to whoever plays the graph: it drives one component or the whole of a node's input.
struct ExposedParameter {
    std::string name;
    std::string node, input;
    std::optional<double> min, max;
    KeptJson extra;
    TextPosition place;
    bool operator==(const ExposedParameter&) const = default;
};

struct Graph {
    int version = kFormatVersion;
    std::vector<Node> nodes;
    std::vector<Group> groups;
    std::vector<ExposedParameter> parameters;
    KeptJson scene, timeline, frames;  ///< kept as written; null if absent
    TextPlaces scenePlaces, timelinePlaces;
    KeptJson extra;    ///< unknown top-level keys
    std::string path;  ///< file it was read from; empty if none
    bool operator==(const Graph&) const = default;

    const Node* node(std::string_view id) const;
    Node* node(std::string_view id);
    const Group* group(std::string_view id) const;
};

/// About the node, or if that is null about the whole document.
Error errorAt(const Graph& graph, const Node* node, std::string message);
/// A warning at a node of the graph, or of a group in it, by its path "instance/node".
Error warningAt(const Graph& graph, const std::string& path, std::string message);

/// The entry of `nodes` with this id, or nullptr.
const Node* findNode(const std::vector<Node>& nodes, std::string_view id);

/// Whether the text is fit for the id of a node or a group: [a-z][a-z0-9_]*
bool isId(std::string_view text);
/// Whether it is fit for an input of a group or an expression: [A-Za-z_][A-Za-z0-9_]*
bool isName(std::string_view text);

}  // namespace fw
