// `--report` and `--require`: what is said of a mesh file. It is measured before it is in its place, so that
// a command that ends meanwhile leaves nothing.
#pragma once

#include "runtime/cli/mesh_graph.h"
#include "runtime/export/placement.h"
#include "runtime/measure/mesh_report.h"

namespace fw::cli {

/// What a mesh file is held against: the program that it was made of, if it is known, the region that was
/// meshed, and the device.
struct MeshedFrom {
    const Program* program = nullptr;
    Box region = {};
    std::string device = {};
    Placement placement = {};
    std::optional<double> density = {};  ///< the document's
    bool regionFound = false;            ///< by the program, not given by the user
};

/// What fw::ExportOptions::examine has to be to measure the file into `report`: nothing, unless that is
/// asked. Its stages are those of `progress`, if one is given. Errors: as readWelded(). All that is given
/// must outlive it.
std::function<Done(const StoredMesh&)> measuring(const MeshOutput& options, const MeshedFrom& from,
                                                 Progress* progress, Report& report);

/// Whether the region that was meshed holds all of the solid; empty without a program.
std::optional<Completeness> completenessOf(const MeshedFrom& from);

/// What a mesh file holds that was written before; its lengths are the graph's. Of `from` the placement and
/// the density count.
Result<Report> reportOnThere(const std::string& path, const MeshedFrom& from);

/// What levels of detail are, the finest first, held against the program's field in the region that was
/// meshed; with their names in a file of that path.
std::vector<LevelReport> reportOnLevels(std::span<const Mesh> levels, const std::string& path,
                                        const Program& program, const Box& region);

/// Says in what a mesh is not what it is required to be; the exit status.
int tellUnmet(const MeshOutput& options, const std::string& file, const Report& report);

/// Writes the report, as JSON or, to a .txt, in words, and says in what the mesh is not what it is required
/// to be; the exit status.
int tellReport(const MeshOutput& options, const Report& report);

}  // namespace fw::cli
