// What flows through every wire of a scope at one point: the fields of its nodes, evaluated there.
//
// A scope's nodes are compiled once (compile/node_fields.h) and kept, until the document, the time or the
// scope is another; a thousand nodes take some 20 ms then, and some tenths of a millisecond at each further
// point. In a group the values are those of its first instance. The point is one of the picture's space, as
// it is for every node: what stands before a translation is read where the picture is, not where the
// translation leads.
//
// Lifetime: a ScopeFields serves one thread at a time, and any document.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "editor/viewport/pick.h"
#include "graph/compile/node_fields.h"
#include "graph/library/units.h"

namespace fw::editor {

/// What one output of a node gives at the point. Outputs without a value (of muted nodes, of those that the
/// output does not need, of meshes and particles) have no Reading.
struct Reading {
    std::string node, output;  ///< ids in the scope
    Type type = Type::scalar;
    std::vector<double> numbers;                      ///< of a surface its distance, metres
    std::optional<std::array<double, 3>> color = {};  ///< a surface's own, linear
    double slope = 0.0;  ///< length of the gradient of a surface's distance, or of a number; 1 of a distance
    std::string part =
        {};                ///< of several surfaces that went in the one whose value this is: the input's name
    bool awaited = false;  ///< particles or a mesh that are still being made: there are no numbers yet
    bool operator==(const Reading&) const = default;
};

class ScopeFields {
  public:
    /// Compiles unless that is what was asked for last. Why there are no values; empty if there are.
    const std::string& take(const Seen& seen, const std::string& scope);

    std::vector<Reading> at(const Point& point) const;
    /// The first output of the node that is a surface or a number, or the named one: its first root, which is
    /// a field of the Ir of fields(). None if it has no value.
    std::optional<IrId> root(const std::string& node, const std::string& output = {}) const;
    const NodeFields& fields() const { return known; }
    const std::vector<double>& parameters() const { return values; }

  private:
    /// A surface that goes into a node.
    struct Part {
        std::string input;
        std::size_t field;  ///< that gives it
    };

    void findParts(const Graph& graph, const std::string& scope);

    Seen asked;
    std::string askedScope, problem;
    NodeFields known;
    std::vector<double> values;                                   ///< of its live parameters
    std::vector<bool> awaited;                                    ///< of its fields
    std::map<std::string, std::vector<Part>, std::less<>> parts;  ///< by node, where there are several
};

/// "0.25 m", "(1, 0.5, 0)", "true": with so many digits, and a word where it is not a number.
std::string valueWords(const Reading& reading, int digits, const LengthUnit& lengths);

}  // namespace fw::editor
