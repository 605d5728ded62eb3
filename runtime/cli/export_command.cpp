// `fieldwright export`: graph file to mesh file, with progress on a terminal and a report on request.
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <future>

#include "runtime/cli/commands.h"
#include "runtime/export/export.h"
#include "runtime/export/output_file.h"
#include "runtime/mesh_report.h"
#include "runtime/session.h"

namespace fw::cli {

namespace {

using Clock = std::chrono::steady_clock;

/// Times the stages of the run and shows them on a terminal as they start.
class Progress {
  public:
    explicit Progress(bool shown_) : shown(shown_) {}
    ~Progress() {
        if (shown) std::fprintf(stderr, "\r\033[K");
    }

    /// Ends the stage before and starts the next.
    void start(const char* name, int percent) {
        finish();
        current = name;
        since = Clock::now();
        if (shown) std::fprintf(stderr, "\r\033[K%3d %%  %s", percent, name), std::fflush(stderr);
    }
    void finish() {
        if (!current.empty())
            stages.emplace_back(current,
                                std::chrono::duration<double, std::milli>(Clock::now() - since).count());
        current.clear();
    }

    std::vector<std::pair<std::string, double>> stages;

  private:
    bool shown;
    std::string current;
    Clock::time_point since;
};

int stopped() {
    std::fprintf(stderr, "fieldwright export: interrupted; nothing was written\n");
    return kInterrupted;
}

/// |f| / |gradient f| by the CPU reference.
FieldError fieldError(const Program& program) {
    return [&program](std::span<const glm::dvec3> points, std::span<double> errors) {
        std::vector<Point> positions(points.size());
        for (std::size_t i = 0; i < points.size(); ++i)
            positions[i] = {points[i].x, points[i].y, points[i].z};
        std::vector<ValueGradient> results(points.size());
        evaluateGradient(program.ir, program.distance(), program.parameters(), positions, results);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Point& g = results[i].gradient;
            const double slope = std::hypot(g[0], g[1], g[2]);
            errors[i] = std::abs(results[i].value) / (slope > 1e-12 ? slope : 1.0);
        }
    };
}

Done writeText(const std::string& path, const std::string& text) {
    Result<OutputFile> file = OutputFile::open(path, nullptr);
    if (!file) return file.error();
    file->write(text);
    return file->commit();
}

}  // namespace

int runExport(const ExportOptions& options) {
    const auto begin = Clock::now();
    if (const Done known = checkExportPath(options.output); !known) return print(known.error()), kBadUsage;
    std::optional<Box> region;
    if (!options.region.empty()) {
        const std::vector<double>& r = options.region;
        region = Box{{r[0], r[1], r[2]}, {r[3], r[4], r[5]}};
        for (int axis = 0; axis < 3; ++axis)
            if (!(region->lo[axis] < region->hi[axis])) {
                std::fprintf(stderr,
                             "fieldwright export: --region has no extent along %c: write its least corner, "
                             "then its greatest: x0 y0 z0 x1 y1 z1\n",
                             "xyz"[axis]);
                return kBadUsage;
            }
    }

    // The device starts while the graph is read: on software Vulkan that takes longer than the rest.
    Progress progress(isatty(STDERR_FILENO));
    std::future<Result<Device>> opening =
        std::async(std::launch::async, [&] { return createDevice({.pick = options.device}); });
    progress.start("read", 0);
    const std::optional<Graph> graph = openGraph(options.graph);
    if (!graph) return kBadInput;
    progress.start("compile", 5);
    CompileOptions compileOptions;
    compileOptions.time = options.graph.time;
    Result<Program> program = compile(*graph, compileOptions);
    if (!program) return print(program.error()), kBadInput;
    progress.start("region", 10);
    const MeshRequest request{region, options.resolution.value_or(program->resolution)};
    Result<Box> box = meshRegion(*program, request);
    if (!box) {
        Error error = box.error();
        error.file = options.graph.path;
        return print(error), kBadInput;
    }
    progress.start("device", 15);
    Result<Device> device = opening.get();
    if (!device) return print(device.error()), kBadUsage;
    if (interrupted) return stopped();

    Session session(std::move(*device));
    progress.finish();
    progress.start("pipelines", 20);
    session.setProgram(std::move(*program));
    if (interrupted) return stopped();
    progress.start("mesh", 50);
    const Result<MesherResult> meshed =
        session.polygonise({*box, request.resolution}, !options.report.empty());
    if (!meshed) {
        Error error = meshed.error();
        error.file = options.graph.path;
        return print(error), kBadInput;
    }
    if (meshed->triangles == 0) {
        Error error;
        error.file = options.graph.path;
        error.message =
            "the surface does not pass through the region: move or enlarge --region, or raise --resolution";
        return print(error), kBadInput;
    }
    if (interrupted) return stopped();
    progress.start("download", 60);
    const Mesh mesh = session.download(*meshed);
    progress.start("write", 70);
    const Result<ExportedFiles> written = exportMesh(mesh, options.output, {.cancel = &interrupted});
    if (!written) return interrupted ? stopped() : (print(written.error()), kSystemFailure);
    progress.finish();

    if (meshed->capped)
        std::fprintf(stderr, "%s: note: the surface leaves the region and was closed at its boundary\n",
                     options.output.c_str());
    if (!options.report.empty()) {
        const double total = std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
        const uint64_t peak = peakMemoryBytes();
        progress.start("report", 85);
        Result<Report> report = reportOnFile(options.output, fieldError(session.program()));
        if (!report) return print(report.error()), kSystemFailure;
        progress.finish();
        report->capped = meshed->capped;
        report->stages = progress.stages;
        for (const StageTime& stage : meshed->stages)
            report->stages.emplace_back("mesh." + stage.name, stage.milliseconds);
        report->totalMs = total;
        report->peakMemoryBytes = peak;
        report->device = session.device().name();
        if (const Done saved = writeText(options.report, writeReport(*report)); !saved)
            return print(saved.error()), kSystemFailure;
    }
    return kDone;
}

}  // namespace fw::cli
