// `fieldwright export` of many meshes: a numbered file for every frame of a timeline, one that moves, or a
// file for every variant of a sweep.
#include <cstdio>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "graph/base/words.h"
#include "graph/bounds/region.h"
#include "graph/check/typed_parameter.h"
#include "graph/document/named_parameters.h"
#include "graph/document/sweep.h"
#include "runtime/cli/measured.h"
#include "runtime/cli/sequence.h"
#include "runtime/export/animated.h"
#include "runtime/export/outputs.h"
#include "runtime/play/mesh_sequence.h"
#include "runtime/system/interruption.h"
#include "runtime/system/output_file.h"

namespace fw::cli {

namespace {

using nlohmann::ordered_json;

int badExport(const std::string& message) {
    std::fprintf(stderr, "fieldwright export: %s\n", message.c_str());
    return kBadUsage;
}

/// What there is many of: files, and how the player comes to show one.
struct ManyMeshes {
    const char* one;  ///< "frame"
    PlayerOptions player = {.liveParameters = false};
    std::function<Result<FrameFiles>(const Graph&)> files = {};
    std::function<Done(Player&, long)> show = {};
    std::function<ordered_json(long)> about = {};  ///< what a report says of one beside its file's name
};

/// What the files hold, measured as each is written or, of one that was there, from it alone.
struct MeasuredMeshes {
    const MeshOutput& options;
    const ManyMeshes& many;
    MeshedFrom from = {};  ///< whatever the file
    std::map<long, Report> reports = {};

    /// Measures the files that were there, and says what is wrong with any; the exit status.
    int end(const FrameFiles& files) {
        if (!options.measured()) return kDone;
        ordered_json list = ordered_json::array();
        bool unmet = false;
        for (long number = files.frames.first; number < files.frames.last; ++number) {
            const std::string path = files.path(number);
            if (!reports.contains(number)) {
                Result<Report> there = reportOnThere(path, from);
                if (!there) return print(there.error()), kSystemFailure;
                reports.emplace(number, std::move(*there));
            }
            const Report& report = reports.at(number);
            ordered_json entry = {{"file", files.name(number)}};
            entry.update(many.about(number));
            entry.update(ordered_json::parse(writeReport(report)));
            list.push_back(std::move(entry));
            unmet |= tellUnmet(options, path, report) != kDone;
        }
        if (!options.report.empty()) {
            Result<OutputFile> file = OutputFile::open(options.report, nullptr);
            if (!file) return print(file.error()), kSystemFailure;
            file->write(ordered_json{{std::string(many.one) + "s", list}}.dump(2) + "\n");
            if (const Done saved = file->commit(); !saved) return print(saved.error()), kSystemFailure;
        }
        return unmet ? kBadInput : kDone;
    }
};

int exportMany(const ExportOptions& options, const ManyMeshes& many, const std::string& ending) {
    if (exportFormat(options.output))
        return badExport(options.output + ": each " + many.one +
                         " is a file of its own, in a folder: give its name, and --format " +
                         lowerExtension(options.output).substr(1));
    fw::ExportOptions how = writingOf(options);
    how.mayBeEmpty = true;
    if (const Done fine = checkWish(options, "a" + ending, options.measured()); !fine)
        return badExport(fine.error().message);
    if (!options.report.empty())
        if (const Done distinct = checkDistinct(options.mesh.graph.path, {options.report}); !distinct)
            return print(distinct.error()), kBadUsage;

    FrameFiles files;
    MeasuredMeshes measured{options, many};
    const auto filesOfGraph = [&](const Graph& graph) -> Result<FrameFiles> {
        const Result<FrameFiles> wanted = many.files(graph);
        if (!wanted) return wanted.error();
        files = *wanted;
        how.placement = *placementOf("a" + ending, unitOf(graph), options.placement);
        measured.from.placement = how.placement, measured.from.density = densityOf(graph);
        const Result<FrameRange> part = partOf(files.frames, options.sequence.frames.part);
        if (!part) return part.error();
        files.frames = *part;
        if (const Done free = checkFrames(files, graph); !free)
            return Error{.message = free.error().message + " (-o, --format)"};
        return files;
    };
    WrittenBehind writing;  // behind what it refers to
    long emptyFiles = 0;
    const auto noteEmpty = [&](Player& player, const std::string& path) {
        if (emptyFiles++ > 0) return;
        const bool isEmpty = findRegion(player.programOnHost()).extent == Extent::empty;
        std::string what = "the solid is empty there";
        if (!isEmpty)
            what = "the solid is thinner than a cell of " +
                   shortNumber(longestSide(player.meshedRegion()) / player.resolution()) +
                   " m there (raise the resolution)";
        std::fprintf(stderr, "%s: note: %s, and the file has no triangles\n", path.c_str(), what.c_str());
    };
    const auto make = [&](Player& player, long number, const std::string& path, std::function<void()> kept) {
        if (const Done shown = many.show(player, number); !shown)
            return badInput(options.mesh, shown.error());
        Result<std::vector<Mesh>> levels = player.levels(std::size_t(options.lods), partsOf(options, path));
        if (!levels) return badInput(options.mesh, in(levels.error(), many.one + (' ' + files.name(number))));
        if (levels->front().indices.empty()) noteEmpty(player, path);
        fw::ExportOptions with = how;
        with.cellSize = float(longestSide(player.region()) / player.resolution());
        with.kept = std::move(kept);
        std::shared_ptr<const Program> program;
        if (options.measured() || options.textures)
            program = std::make_shared<Program>(player.programOnHost());
        const MeshedFrom from{program.get(), player.meshedRegion(), player.device().name(),
                              how.placement, measured.from.density, player.regionFound()};
        auto write = [&, path, number, with, program, from, levels = std::move(*levels)]() mutable -> Done {
            Report report;
            if (!levels[0].indices.empty())
                with.examine = measuring(options, from, nullptr, report);
            else if (options.measured())
                report.completeness = completenessOf(from), report.regionFound = from.regionFound;
            std::vector<LevelReport> coarser;
            if (options.lods > 1 && options.measured())
                coarser = reportOnLevels(levels, path, *program, from.region);
            Result<std::vector<Mesh>> made =
                program ? withTextures(options, std::move(levels), *program) : std::move(levels);
            if (!made) return in(made.error(), path);
            const Result<ExportedFiles> written = exportWished(options, *made, path, with);
            if (!written) return written.error();
            report.levels = std::move(coarser);
            measured.reports.emplace(number, std::move(report));
            return done();
        };
        if (const Done before = writing.begin(std::move(write)); !before)
            return print(before.error()), kSystemFailure;
        return kDone;
    };
    const auto end = [&] {
        if (emptyFiles > 1)
            std::fprintf(stderr, "%s: note: %ld files have no triangles\n", options.output.c_str(),
                         emptyFiles);
        const Done written = writing.end();
        return written ? kDone : (print(written.error()), kSystemFailure);
    };
    const int status = makeFrames({.command = "export",
                                   .one = many.one,
                                   .mesh = options.mesh,
                                   .player = many.player,
                                   .rests = many.one != std::string_view("frame"),
                                   .files = filesOfGraph,
                                   .make = make,
                                   .end = end},
                                  options.output);
    return status == kDone && !options.mesh.planned ? measured.end(files) : status;
}

std::string endingOf(const ExportOptions& options) {
    return "." + (options.format.empty() ? "glb" : options.format);
}

/// The names and numbers of a variant's values, of a graph that has such parameters.
using NamedNumbers = std::vector<std::pair<std::string, std::vector<double>>>;
Result<NamedNumbers> numbersOf(Graph graph, const Variant& variant) {
    NamedNumbers numbers;
    for (const NamedValue& value : variant.values) {
        if (const Done set = setParameter(graph, value.name, value.value); !set) return set.error();
        const NamedParameter parameter = *findParameter(graph, value.name);
        numbers.emplace_back(value.name, inputNumbers(*graph.node(parameter.node), parameter.input));
    }
    return numbers;
}

}  // namespace

Result<FrameRange> framesAsked(const Graph& graph, const ExportOptions& options) {
    Result<FrameRange> frames = framesOf(*readTimeline(graph), options.sequence.frames);
    if (!frames) return Error{.message = frames.error().message + " (--from, --to, --fps)"};
    return frames;
}

int exportSequence(const ExportOptions& options) {
    FrameRange range;
    const auto files = [&](const Graph& graph) -> Result<FrameFiles> {
        const Result<FrameRange> frames = framesAsked(graph, options);
        if (!frames) return frames.error();
        range = *frames;
        return meshFrames(options.output, endingOf(options), range, options.sequence.overwrite);
    };
    const auto show = [&](Player& player, long frame) { return player.seek(range.time(frame)), done(); };
    const auto about = [&](long frame) { return ordered_json{{"time", range.time(frame)}}; };
    return exportMany(options, {.one = "frame", .files = files, .show = show, .about = about},
                      endingOf(options));
}

int exportSweep(const ExportOptions& options) {
    const Result<std::vector<Variant>> variants = readSweep(options.sweep);
    if (!variants) return print(variants.error()), kBadUsage;
    std::vector<NamedNumbers> numbers;
    ManyMeshes many{.one = "variant"};
    many.files = [&](const Graph& graph) -> Result<FrameFiles> {
        for (const Variant& variant : *variants) {
            Result<NamedNumbers> found = numbersOf(graph, variant);
            if (!found) return Error{.message = found.error().message + " (--sweep, " + variant.stem + ")"};
            numbers.push_back(std::move(*found));
        }
        FrameFiles files = meshFrames(options.output, endingOf(options), {0, long(variants->size())},
                                      options.sequence.overwrite);
        files.stem = [&](long number) { return (*variants)[std::size_t(number)].stem; };
        return files;
    };
    many.show = [&](Player& player, long number) -> Done {
        for (const auto& [name, value] : numbers[std::size_t(number)])
            if (Done set = player.set(name, value); !set) return set;
        return done();
    };
    many.about = [&](long number) {
        ordered_json values = ordered_json::object();
        for (const auto& [name, value] : numbers[std::size_t(number)])
            values[name] = value.size() == 1 ? ordered_json(value.front()) : ordered_json(value);
        return ordered_json{{"values", values}};
    };
    many.player.liveParameters = true;
    return exportMany(options, many, endingOf(options));
}

}  // namespace fw::cli
