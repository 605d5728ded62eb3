// From a document to a program.
//
// compile() orders the nodes that the output needs, lowers each into one Ir (graph_lowering.h), propagates
// exactness, and keeps what the roots use.
//
// Parameters. Every number of the graph is folded into the code, except the *live* ones: those stand in slots
// of a parameter buffer, change by an upload, and do not enter structureHash. Constants are several times
// faster than loads, so live is asked for, not the default.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <vector>

#include "graph/assets/mesh_field.h"
#include "graph/compile/program.h"
#include "graph/document/graph.h"
#include "graph/evaluate/evaluate.h"

namespace fw {

/// What compile() is asked for beyond the graph.
struct CompileOptions {
    /// Inputs to keep live, as "node.input"; "time" keeps the seconds live.
    std::set<std::string> live = {};
    /// Keep every exposed parameter live, under its own name.
    bool liveExposed = false;
    /// Values that live inputs come to have, at so many moments, by their names in `live`: what has to hold
    /// at all of them, as the grids of particles, is made so. None: as they are now.
    std::vector<std::map<std::string, std::vector<double>>> moments = {};
    double time = 0.0;                  ///< seconds, folded unless live
    int triangles = 0;                  ///< decimates what the graph shows to so many at most; 0: does not
    bool byShape = false;               ///< then: MeshStage::byShape
    MeshFieldBaker bake = bakeOnHost;   ///< makes fields of meshes
    int finest = kMostFieldResolution;  ///< samples along a side of what is measured on a grid, at most;
                                        ///< fewer for whoever wants a program but not its field
    /// Every node that has part in an operation is known, for effortByNode(); takes longer.
    bool costByNode = false;
    /// compileErrors() also warns of fields that a software device would trace for long. It must find the
    /// solid.
    bool warnOfPictures = false;
    /// Ends the search for a solid whose distances are measured (measured_field.h); the error then has
    /// Code::cancelled.
    std::stop_token stop = {};
};

/// Compiles the field that the graph's output shows. The Error is the first of check()'s errors, if there are
/// any.
Result<Program> compile(const Graph& graph, const CompileOptions& options = {});

/// Every finding of lowering the graph's nodes (code that does not compile, fields that are too large,
/// numbers that may be out of range): the part of check() that needs the compiler. Expects a graph whose
/// structure is sound.
std::vector<Error> compileErrors(const Graph& graph, const CompileOptions& options = {});

/// Refuses names in `options.live` that are neither "time" nor an input that can be live (a number or vector
/// that is not linked); the Error has the nearest name. Expects a graph without errors.
Done checkLive(const Graph& graph, const CompileOptions& options);

/// The type of what a link gives among the document's nodes, or those of a group: also of an expression's
/// output, which nothing declares. Empty if there is no such output or its code has errors. The graph is
/// structurally sound.
std::optional<Type> compiledType(const Graph& graph, std::string_view group, const Link& link);

}  // namespace fw
