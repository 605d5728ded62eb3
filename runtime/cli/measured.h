// `--report` and `--require`: what is said of a mesh file. It is measured before it is in its place, so that
// a command that ends meanwhile leaves nothing.
#pragma once

#include "runtime/cli/mesh_graph.h"
#include "runtime/measure/mesh_report.h"

namespace fw::cli {

/// What fw::ExportOptions::examine has to be to measure the file into `report`: nothing, unless that is
/// asked. It is measured against the program of `session`, which was meshed in `region`, if one is given.
/// Errors: as readWelded(). All that is given must outlive it.
std::function<Done(const StoredMesh&)> measuring(const MeshOutput& options, const Session* session,
                                                 const Box& region, Progress& progress, Report& report);

/// Writes the report, and says in what the mesh is not what it is required to be; the exit status.
int tellReport(const MeshOutput& options, const Report& report);

}  // namespace fw::cli
