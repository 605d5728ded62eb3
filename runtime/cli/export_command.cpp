// `fieldwright export`: graph file to mesh file, with progress on a terminal and a report on request.
#include <cstdio>
#include <fstream>

#include "runtime/cli/mesh_graph.h"
#include "runtime/cli/tiled_export.h"
#include "runtime/export/export.h"
#include "runtime/measure/field_measure.h"
#include "runtime/system/clock.h"
#include "runtime/system/output_file.h"

namespace fw::cli {

namespace {

Done writeText(const std::string& path, const std::string& text) {
    Result<OutputFile> file = OutputFile::open(path, nullptr);
    if (!file) return file.error();
    file->write(text);
    return file->commit();
}

}  // namespace

int runExport(const ExportOptions& options) {
    const auto begin = Clock::now();
    const bool tiled = options.tiles > 0 || !options.share.empty();
    const bool reported = !options.report.empty() || !options.required.empty();
    fw::ExportOptions how{.manifold = options.manifold, .cancel = &interrupted};
    if (const Done fine = tiled ? checkTiledExport(options) : checkExportPath(options.output, how, reported);
        !fine)
        return print(fine.error()), kBadUsage;
    std::vector<std::string> outputs = exportedPaths(options.output);
    if (!options.report.empty()) outputs.push_back(options.report);
    if (const Done distinct = checkDistinct(options.mesh.graph.path, outputs); !distinct)
        return print(distinct.error()), kBadUsage;
    Progress progress;
    int status = kDone;
    std::optional<OpenedGraph> graph = openForMesh(options.mesh, progress, status);
    if (!graph) return status;
    if (tiled || wantsTiles(options, *graph)) return exportTiles(options, std::move(*graph), progress);
    const bool canTile = canBeTiled(options, *graph);
    Result<MeshedProgram> opened = meshOpened(std::move(*graph), progress, reported);
    if (interrupted) return stopped();
    if (!opened && canTile && opened.error().code == Error::Code::tooMuchSurface) {
        graph = openForMesh(options.mesh, progress, status);
        return graph ? exportTiles(options, std::move(*graph), progress) : status;
    }
    if (!opened) {
        Error error = opened.error();
        if (error.code == Error::Code::tooMuchSurface)
            error.message +=
                "; or let it be meshed in tiles: by marching cubes, without stages, --report, --require and "
                "--manifold, to .ply, .stl, .glb or .gltf";
        return badInput(options.mesh, error);
    }
    Session& session = opened->session;
    const MesherResult& meshed = opened->mesh;
    progress.start("download", 60);
    const Mesh mesh = session.download(meshed);
    progress.start("write", 70);
    how.cellSize = static_cast<float>(opened->cellSize);
    const Result<ExportedFiles> written = exportMesh(mesh, options.output, how);
    if (!written) return interrupted ? stopped() : (print(written.error()), kSystemFailure);
    progress.finish();

    if (meshed.capped)
        std::fprintf(stderr, "%s: note: the surface leaves the region and was closed at its boundary\n",
                     options.output.c_str());
    if (meshed.undecimated)
        std::fprintf(stderr,
                     "%s: note: decimate left out nothing: the mesh is as far from the surface as its error "
                     "allows, or farther; raise the error, or the resolution\n",
                     options.output.c_str());
    if (reported) {
        const double total = millisecondsSince(begin);
        const uint64_t peak = peakMemoryBytes();
        progress.start("report", 85);
        const bool compared = !options.report.empty() || needField(options.required);
        MeasureOptions measured;
        if (compared) measured = measureOf(session.program(), opened->region);
        measured.selfIntersections = true;
        Result<Report> report = reportOnFile(options.output, measured);
        if (!report) return print(report.error()), kSystemFailure;
        progress.finish();
        report->capped = meshed.capped;
        report->stages = progress.stages;
        for (const StageTime& stage : meshed.stages)
            report->stages.emplace_back("mesh." + stage.name, stage.milliseconds);
        report->totalMs = total;
        report->peakMemoryBytes = peak;
        report->device = session.device().name();
        if (!options.report.empty())
            if (const Done saved = writeText(options.report, writeReport(*report)); !saved)
                return print(saved.error()), kSystemFailure;
        const std::vector<std::string> reasons = unmet(options.required, *report);
        for (const std::string& reason : reasons)
            std::fprintf(stderr, "%s: %s\n", options.output.c_str(), reason.c_str());
        if (!reasons.empty()) return kBadInput;
    }
    return kDone;
}

}  // namespace fw::cli
