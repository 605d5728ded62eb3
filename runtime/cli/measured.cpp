#include "runtime/cli/measured.h"

#include <cstdio>
#include <future>

#include "runtime/export/export.h"
#include "runtime/measure/field_measure.h"
#include "runtime/system/output_file.h"

namespace fw::cli {

namespace {

Result<Report> reportOnPlaced(Result<WeldedMesh> read, const MeshedFrom& from, MeasureOptions measured) {
    if (!read) return read.error();
    measured.selfIntersections = measured.widths = true;
    for (glm::vec3& p : read->positions) p = from.placement.placeBack(p);
    Report report = reportOnWelded(*read, measured);
    report.unit = from.placement.document.name;
    report.fileLengths = from.placement.words();
    report.density = from.density;
    return report;
}

Result<Report> measure(const MeshOutput& options, const StoredMesh& file, const MeshedFrom& from,
                       Progress* progress) {
    const double total = progress ? millisecondsSince(progress->begun) : 0.0;
    const uint64_t peak = peakMemoryBytes();
    if (progress) progress->start("report", 85);
    std::future<MeasureOptions> compared;
    if (from.program && (!options.report.empty() || needDistances(options.required)))
        compared = std::async(std::launch::async, [&] {
            return measureOf(*from.program, from.region,
                             needDistances(options.required) ? Points::all : Points::affordable);
        });
    const std::optional<Completeness> completeness = completenessOf(from);
    Result<WeldedMesh> read = readWelded(file);
    Result<Report> report =
        reportOnPlaced(std::move(read), from, compared.valid() ? compared.get() : MeasureOptions{});
    if (!report) return report;
    if (progress) progress->finish(), report->stages = progress->stages;
    report->totalMs = total;
    report->peakMemoryBytes = peak;
    report->device = from.device;
    report->completeness = completeness, report->regionFound = from.regionFound;
    return report;
}

}  // namespace

std::optional<Completeness> completenessOf(const MeshedFrom& from) {
    return from.program ? std::optional(checkCompleteness(*from.program, from.region)) : std::nullopt;
}

Result<Report> reportOnThere(const std::string& path, const MeshedFrom& from) {
    return reportOnPlaced(readWelded({path, path}), from, {});
}

std::function<Done(const StoredMesh&)> measuring(const MeshOutput& options, const MeshedFrom& from,
                                                 Progress* progress, Report& report) {
    if (!options.measured()) return {};
    return [&, progress](const StoredMesh& file) -> Done {
        Result<Report> measured = measure(options, file, from, progress);
        if (!measured) return measured.error();
        report = std::move(*measured);
        return done();
    };
}

std::vector<LevelReport> reportOnLevels(std::span<const Mesh> levels, const std::string& path,
                                        const Program& program, const Box& region) {
    const MeasureOptions measure = measureOf(program, region, Points::affordable);
    std::vector<LevelReport> reports;
    for (const Mesh& level : levels) {
        const Report report = reportOnMesh(level.positions, level.indices, measure);
        reports.push_back({.name = levelName(path, {}, reports.size()),
                           .vertices = level.positions.size(),
                           .triangles = level.triangleCount(),
                           .error = farthest(report)});
    }
    return reports;
}

int tellUnmet(const MeshOutput& options, const std::string& file, const Report& report) {
    const std::vector<std::string> reasons = unmet(options.required, report);
    for (const std::string& reason : reasons) std::fprintf(stderr, "%s: %s\n", file.c_str(), reason.c_str());
    return reasons.empty() ? kDone : kBadInput;
}

int tellReport(const MeshOutput& options, const Report& report) {
    if (!options.report.empty()) {
        Result<OutputFile> file = OutputFile::open(options.report, nullptr);
        if (!file) return print(file.error()), kSystemFailure;
        const bool words = lowerExtension(options.report) == ".txt";
        file->write(words ? reportWords(report) : writeReport(report));
        if (const Done saved = file->commit(); !saved) return print(saved.error()), kSystemFailure;
    }
    return tellUnmet(options, options.output, report);
}

}  // namespace fw::cli
