// `fieldwright export`: graph file to mesh file, with progress on a terminal and a report on request.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/common.hpp>

#include "runtime/cli/measured.h"
#include "runtime/cli/sequence.h"
#include "runtime/cli/tiled_export.h"
#include "runtime/export/export.h"
#include "runtime/export/outputs.h"
#include "runtime/play/tiled_mesh.h"
#include "runtime/system/interruption.h"
#include "runtime/system/output_file.h"

namespace fw::cli {

namespace {

constexpr char kOrTiles[] =
    "; or let it be meshed in tiles: without stages and --manifold, to .ply, .stl, .obj, .glb or .gltf";

/// The exit status if nothing was written.
int notWritten(const ExportOptions& options, const Error& error) {
    if (error.code != Error::Code::tooMuchSurface) return badInput(options.mesh, error);
    Error more = error;
    more.message += kOrTiles;
    return badInput(options.mesh, more);
}

struct WholeMesh {
    MeshedProgram program;
    std::vector<Mesh> levels;  ///< of detail; one at least
};

/// All of the mesh at once. Where the device has no room for it and tiles can be had, says so, and it is an
/// error as of too much surface.
Result<WholeMesh> meshWhole(const ExportOptions& options, OpenedGraph graph, Progress& progress, bool timed) {
    const bool canTile = canBeTiled(options, graph);
    try {
        Result<MeshedProgram> meshed = meshOpened(std::move(graph), progress, timed);
        if (!meshed) return meshed.error();
        progress.start("download", 60);
        std::vector<Mesh> levels = meshed->session.downloadLevels(meshed->mesh, std::size_t(options.lods),
                                                                  partsOf(options, options.output));
        return WholeMesh{std::move(*meshed), std::move(levels)};
    } catch (const DeviceTooSmall& full) {
        if (!canTile) throw DeviceTooSmall(full.what() + std::string(kOrTiles));
        std::fprintf(stderr, "%s: note: %s: it is meshed in tiles instead\n", options.output.c_str(),
                     full.what());
        return Error{.message = full.what(), .code = Error::Code::tooMuchSurface};
    }
}

/// exportTiles(); where the device has no room for one, and the options leave their number open, of tiles
/// with half the side, and again.
int tiledExport(const ExportOptions& options, const MeshOptions& wanted, OpenedGraph opened,
                Progress& progress) {
    ExportOptions tiled = options;
    std::optional<OpenedGraph> graph = std::move(opened);
    const int resolution = graph->request.resolution;
    for (int side = kTileCells;; side /= 2) {
        try {
            return exportTiles(tiled, std::move(*graph), progress);
        } catch (const DeviceTooSmall& full) {
            if (options.tiles > 0 || !options.share.empty() || side / 2 < kLeastTile) {
                sayWhatIsKept(tilesFolder(options.output));
                throw DeviceTooSmall(full.what() +
                                     std::string(options.tiles > 0 ? "; or take more --tiles" : ""));
            }
        }
        tiled.tiles = std::max(2 * resolution / side, 1);
        int status = kDone;
        graph.reset();
        graph = openForMesh(wanted, progress, status);
        if (!graph) return status;
    }
}

void note(const ExportOptions& options, const MesherResult& meshed) {
    if (meshed.capped)
        std::fprintf(stderr, "%s: note: the surface leaves the region and was closed at its boundary\n",
                     options.output.c_str());
    if (meshed.undecimated)
        std::fprintf(stderr,
                     "%s: note: decimate ended at %u triangles: no more could go within its error, "
                     "half the solid's size at most, and with every part left a solid; raise the error or "
                     "the number\n",
                     options.output.c_str(), meshed.triangles);
}

void noteLevels(const ExportOptions& options, const std::vector<LevelReport>& levels) {
    for (const LevelReport& level : levels)
        std::fprintf(stderr, "%s: note: %s has %llu triangles, at most %.3g m from the surface\n",
                     options.output.c_str(), level.name.c_str(),
                     static_cast<unsigned long long>(level.triangles), level.error);
    if (options.lods > 1 && levels.size() < std::size_t(options.lods))
        std::fprintf(stderr,
                     "%s: note: it has no further levels: no more triangles can go with every part left "
                     "a solid\n",
                     options.output.c_str());
}

/// Of what is to be printed, or has its lengths in a unit that was asked for.
void noteUnlikelySize(const ExportOptions& options, const Mesh& mesh, const Placement& placement) {
    if (lowerExtension(options.output) != ".3mf" && options.placement.unit.empty() &&
        !options.placement.forPrinting())
        return;
    glm::vec3 least(INFINITY), greatest(-INFINITY);
    for (const glm::vec3& p : mesh.positions) least = glm::min(least, p), greatest = glm::max(greatest, p);
    const glm::vec3 size = greatest - least;
    if (const auto words = unlikelySize(std::max({size.x, size.y, size.z}), placement.document))
        std::fprintf(stderr, "%s: note: %s\n", options.output.c_str(), words->c_str());
}

}  // namespace

int runExport(const ExportOptions& options) {
    Progress progress;
    if (!options.particles.empty()) return exportParticles(options);
    if (options.implicit) return exportImplicit(options);
    if (options.animated) return exportAnimated(options);
    if (!options.instances.empty()) return exportInstances(options);
    if (!options.sweep.empty()) return exportSweep(options);
    if (options.sequence.frames.asked()) return exportSequence(options);
    if (const std::string ending = lowerExtension(options.output);
        !options.format.empty() && ending != "." + options.format)
        return print({.message =
                          "its ending is not that of --format " + options.format +
                          ": leave that out, or ask for a sequence or a sweep (--from, --to, --fps, --sweep)",
                      .file = options.output}),
               kBadUsage;
    if (options.sequence.overwrite)
        return print({.message = "--overwrite is for a sequence or a sweep: give --from, --to, --fps, "
                                 "--range or --sweep",
                      .file = options.output}),
               kBadUsage;
    const bool tiled = options.tiles > 0 || !options.share.empty();
    if (const Done fine =
            tiled ? checkTiledExport(options) : checkWish(options, options.output, options.measured());
        !fine)
        return print(fine.error()), kBadUsage;
    if (tiled && options.share.empty())
        if (const auto known = placementOf(options.output, *lengthUnit("m"), options.placement); !known)
            return print(known.error()), kBadUsage;
    MeshOptions wanted = options.mesh;
    wanted.outputs = wishedPaths(options, options.output);
    if (!options.report.empty()) wanted.outputs.push_back(options.report);
    if (const Done distinct = checkDistinct(options.mesh.graph.path, wanted.outputs); !distinct)
        return print(distinct.error()), kBadUsage;
    int status = kDone;
    std::optional<OpenedGraph> graph = openForMesh(wanted, progress, status);
    if (!graph) return status;
    if (options.mesh.planned) return checkShares(options, *graph, uint32_t(options.mesh.planned->parts));
    if (tiled || wantsTiles(options, *graph))
        return tiledExport(options, wanted, std::move(*graph), progress);
    const bool canTile = canBeTiled(options, *graph);
    fw::ExportOptions how = writingOf(options);
    how.placement = *placementOf(options.output, graph->unit, options.placement);
    const std::optional<double> density = densityOf(graph->graph);
    Result<WholeMesh> whole = meshWhole(options, std::move(*graph), progress, options.measured());
    if (!whole && canTile && whole.error().code == Error::Code::tooMuchSurface) {
        graph.reset();
        graph = openForMesh(wanted, progress, status);
        return graph ? tiledExport(options, wanted, std::move(*graph), progress) : status;
    }
    if (!whole) return notWritten(options, whole.error());
    const MeshedProgram& meshed = whole->program;
    const bool found = options.mesh.region.empty() && !meshed.session.program().region;
    const Program onHost = options.textures || options.lods > 1 ? meshed.session.onHost() : Program();
    std::vector<LevelReport> levels;
    if (options.lods > 1) levels = reportOnLevels(whole->levels, options.output, onHost, meshed.region);
    Result<std::vector<Mesh>> made = withTextures(
        options, std::move(whole->levels), onHost,
        [&](const char* stage) { progress.start(stage, std::string_view(stage) == "unwrap" ? 62 : 65); });
    if (!made) return badInput(options.mesh, made.error());
    progress.start("write", 70);
    how.cellSize = static_cast<float>(meshed.cellSize);
    Report report;
    const MeshedFrom from{&meshed.session.program(),
                          meshed.region,
                          meshed.session.device().name(),
                          how.placement,
                          density,
                          found};
    how.examine = measuring(options, from, &progress, report);
    how.kept = [] { whenEnded({.said = "; the mesh was written"}); };
    const Result<ExportedFiles> written = exportWished(options, *made, options.output, how);
    if (!written) return print(written.error()), kSystemFailure;
    progress.finish();
    note(options, meshed.mesh);
    noteUnlikelySize(options, made->front(), how.placement);
    noteLevels(options, levels);
    report.levels = std::move(levels);
    report.capped = meshed.mesh.capped;
    for (const StageTime& stage : meshed.mesh.stages)
        report.stages.emplace_back("mesh." + stage.name, stage.milliseconds);
    return tellReport(options, report);
}

}  // namespace fw::cli
