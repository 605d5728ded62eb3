// From a document to a program: what a runtime needs to evaluate the graph's field, and nothing of how it was
// drawn.
//
// compile() orders the nodes that the output needs, lowers each body into one Ir (language/lower.h),
// propagates exactness, and keeps what the roots use. Groups are expanded in place: their fields are values
// like any other. A muted node passes on its first input of its output's type.
//
// Parameters. Every number of the graph is folded into the code, except the *live* ones: those stand in slots
// of a parameter buffer, change by an upload, and do not enter structureHash. Constants are several times
// faster than loads, so live is asked for, not the default.
#pragma once

#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "graph/assets/mesh_field.h"
#include "graph/base/result.h"
#include "graph/compile/mesh_recipe.h"
#include "graph/document/graph.h"
#include "graph/evaluate/evaluate.h"
#include "graph/ir/families.h"
#include "graph/ir/ir.h"
#include "graph/library/types.h"

namespace fw {

/// That of this name, which is one of them.
MeshMethod meshMethod(std::string_view name);

/// One slot of the parameter buffer.
struct LiveParameter {
    std::string name;   ///< of an exposed parameter, else "node.input"; "time" for the seconds
    int component = 0;  ///< which component of a vector input
    double value = 0.0;
};

/// What compile() is asked for beyond the graph.
struct CompileOptions {
    /// Inputs to keep live, as "node.input"; "time" keeps the seconds live.
    std::set<std::string> live = {};
    /// Keep every exposed parameter live, under its own name.
    bool liveExposed = false;
    /// Values that live inputs come to have, at so many moments, by their names in `live`: what has to hold
    /// at all of them, as the grids of particles, is made so. None: as they are now.
    std::vector<std::map<std::string, std::vector<double>>> moments = {};
    double time = 0.0;                 ///< seconds, folded unless live
    MeshFieldBaker bake = bakeOnHost;  ///< makes fields of meshes
};

/// Of the surface that a node gives.
struct NodeExactness {
    Exactness exactness;
    std::string spoiledBy;  ///< as Program::spoiledBy
};

struct Program {
    Ir ir;
    std::array<IrId, 9> surface{};  ///< roots, in the order of SurfaceComponent
    std::vector<LiveParameter> live;
    Families families;           ///< of the distance
    uint64_t structureHash = 0;  ///< equal for equal code, whatever the live values

    Exactness exactness;
    std::string spoiledBy;  ///< node by which the field lost its exactness; empty if exact
    std::map<std::string, NodeExactness, std::less<>> nodeExactness;  ///< in groups by "instance/node"

    int resolution = 128;  ///< cells along the longest side
    MeshMethod method = MeshMethod::marchingCubes;
    std::optional<Box> region;      ///< given by a polygonize node
    std::vector<MeshStage> stages;  ///< what is done to the mesh, in order; not part of structureHash
    std::vector<Error> notes;       ///< warnings: what its user should know of meshes that were made fields

    IrId distance() const { return surface[distanceComponent]; }
    /// Some point's material differs from another's or from the default.
    bool hasMaterial() const;
    /// The live values in their slots.
    std::vector<double> parameters() const;
    /// What the field's buffer holds: the live values in their slots, then the families' tables. Not empty.
    std::vector<float> numbers() const;
};

/// Compiles the field that the graph's output shows. The Error is the first of check()'s errors, if there are
/// any.
Result<Program> compile(const Graph& graph, const CompileOptions& options = {});

/// Every error that lowering the graph's nodes finds (code that does not compile, fields that are too large):
/// the part of check() that needs the compiler. Expects a graph whose structure is sound.
std::vector<Error> compileErrors(const Graph& graph, const CompileOptions& options = {});

/// Refuses names in `options.live` that are neither "time" nor an input that can be live (a number or vector
/// that is not linked); the Error has the nearest name. Expects a graph without errors.
Done checkLive(const Graph& graph, const CompileOptions& options);

/// The type of what a link gives among the document's nodes, or those of a group: also of an expression's
/// output, which nothing declares. Empty if there is no such output or its code has errors. The graph is
/// structurally sound.
std::optional<Type> compiledType(const Graph& graph, std::string_view group, const Link& link);

}  // namespace fw
