// From a document to a mesh in device memory: what whoever exports does, the `fieldwright` command and the
// editor alike, so that both make the same bytes.
//
// Lifetime: a MeshedProgram holds the device and the mesh on it.
#pragma once

#include <functional>

#include "graph/compile/compile.h"
#include "runtime/play/session.h"

namespace fw {

/// Compiles what the graph, in which check() found no error, is that many seconds after its start. Errors as
/// compile(). What particles make is simulated up to then on the device that `simulator` gives, and without
/// samples if there is no simulator; `progress` as Simulation::goTo(). Errors then as makeParticles().
Result<Program> compileAtTime(const Graph& graph, double seconds, CompileOptions options = {},
                              const std::function<const Device*()>& simulator = {},
                              const std::function<bool(int done, int all)>& progress = {});

/// Called as a stage of the work starts, with its name; false ends the work there.
using StageStarts = std::function<bool(const char* stage)>;

struct MeshedProgram {
    Session session;
    MesherResult mesh;  ///< has triangles
    Box region;         ///< what it was meshed in
    double cellSize;    ///< of the grid, along the region's longest side, metres
};

/// Compiles the program for the device (stage "pipelines") and meshes it (stage "mesh"). `region` is
/// meshRegion() of the request. Errors: as Session::polygonise, nothingToSee(), and a message of its own
/// where `starts` ended it.
Result<MeshedProgram> meshProgram(Device device, Program program, const MeshRequest& request,
                                  const Box& region, const StageStarts& starts, bool timed = false);

/// What to say of a solid that has no triangle in `region`, which the user gave or which was found.
Error nothingToSee(bool given, const Box& region, int resolution);

}  // namespace fw
