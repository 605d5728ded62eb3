// `fieldwright export --particles`: what a node gives, as a file of points, or a numbered one for every
// frame.
#include <cstdio>
#include <filesystem>

#include "graph/compile/cached_particles.h"
#include "runtime/bake/mesh_field_baker.h"
#include "runtime/cli/mesh_graph.h"
#include "runtime/cli/sequence.h"
#include "runtime/export/outputs.h"
#include "runtime/export/points.h"
#include "runtime/play/mesh_sequence.h"
#include "runtime/play/particles_at.h"
#include "runtime/system/interruption.h"
#include "runtime/system/output_file.h"

namespace fw::cli {

namespace {

int badParticles(const std::string& message) {
    std::fprintf(stderr, "fieldwright export: %s\n", message.c_str());
    return kBadUsage;
}

/// The files of a sequence. Errors: bad usage.
Result<FrameFiles> filesOf(const ExportOptions& options, const Graph& graph) {
    FrameFiles files{.folder = options.output,
                     .ending = "." + (options.format.empty() ? "ply" : options.format),
                     .overwrite = options.sequence.overwrite,
                     .whole = isWholePoints};
    const Result<FrameRange> frames = framesOf(*readTimeline(graph), options.sequence.frames);
    if (!frames) return Error{.message = frames.error().message + " (--from, --to, --fps)"};
    const Result<FrameRange> part = partOf(*frames, options.sequence.frames.part);
    if (!part) return part.error();
    files.frames = *part;
    if (const Done free = checkFrames(files, graph); !free)
        return Error{.message = free.error().message + " (-o, --format)"};
    return files;
}

/// Writes the frames that are not there yet.
int writeFrames(const ExportOptions& options, const FrameFiles& files, NodeParticles& particles) {
    std::error_code failure;
    std::filesystem::create_directories(files.folder, failure);
    if (!std::filesystem::is_directory(files.folder))
        return print({.message = "cannot make the folder: " + failure.message(), .file = files.folder}),
               kSystemFailure;
    const long count = files.frames.count();
    const auto goesOn = [count](long kept) {
        return WhenEnded{.said = "; " + std::to_string(kept) + " of " + std::to_string(count) +
                                 " frames were made: the same command goes on"};
    };
    long kept = 0;
    bool empty = false;
    SequenceProgress progress("frame", count);
    whenEnded(goesOn(0));
    for (long frame = files.frames.first; frame < files.frames.last; ++frame) {
        const bool there = files.isThere(frame);
        if (!there) {
            const Result<ParticlePoints> points = particles.at(files.frames.time(frame));
            if (!points) return badInput(options.mesh, in(points.error(), "frame " + files.name(frame)));
            if (points->places.empty() && !std::exchange(empty, true))
                std::fprintf(stderr, "%s: note: node '%s' has no particles there, and the file is empty\n",
                             files.path(frame).c_str(), options.particles.c_str());
            const Done written = exportPoints(*points, files.path(frame), [&] { whenEnded(goesOn(++kept)); });
            if (!written) return print(written.error()), kSystemFailure;
        }
        progress.next(!there);
    }
    if (kept < count)
        std::fprintf(stderr, "%s: note: %ld of %ld frames were there already (--overwrite makes them anew)\n",
                     files.folder.c_str(), count - kept, count);
    return kDone;
}

int writeMoment(const ExportOptions& options, NodeParticles& particles, Progress& progress) {
    progress.start("simulate", 10);
    const Result<ParticlePoints> points = particles.at(options.mesh.graph.time, [&](int done, int all) {
        progress.show(10 + 80 * done / all);
        return true;
    });
    if (!points) return badInput(options.mesh, points.error());
    progress.start("write", 90);
    if (const Done written = exportPoints(*points, options.output); !written)
        return print(written.error()), kSystemFailure;
    progress.finish();
    if (points->places.empty())
        std::fprintf(stderr, "%s: note: node '%s' has no particles then: the file is empty\n",
                     options.output.c_str(), options.particles.c_str());
    return kDone;
}

}  // namespace

int exportParticles(const ExportOptions& options) {
    const GraphOptions& from = options.mesh.graph;
    const bool many = options.sequence.frames.asked();
    const std::string format = options.format.empty() ? "" : "." + options.format;
    if (const Done fine = checkPointsPath(many ? "a" + (format.empty() ? ".ply" : format) : options.output);
        !fine)
        return many ? badParticles("--format " + options.format + ": " + fine.error().message)
                    : (print(fine.error()), kBadUsage);
    if (many && checkPointsPath(options.output))
        return badParticles(options.output +
                            ": each frame is a file of its own, in a folder: give its name, and --format " +
                            lowerExtension(options.output).substr(1));
    if (!many && !format.empty() && lowerExtension(options.output) != format)
        return badParticles("the ending of " + options.output + " is not that of --format " + options.format);
    if (!many && options.sequence.overwrite)
        return badParticles("--overwrite is for a sequence: give --from, --to, --fps or --range");
    if (const Done distinct = checkDistinct(from.path, {options.output}); !distinct)
        return print(distinct.error()), kBadUsage;
    std::optional<Progress> progress(std::in_place);
    OpeningDevice device(startOf(options.mesh), {.pick = options.mesh.device});
    progress->start("read", 0);
    const std::optional<Graph> graph = openGraph(from);
    if (!graph) return kBadInput;
    if (const Done kept = checkReplacesNone(filesRead(*graph), {options.output}); !kept)
        return print(kept.error()), kBadUsage;
    const Result<Link> link = linkToParticles(*graph, options.particles);
    if (!link) return badInput(options.mesh, link.error());
    FrameFiles files;
    if (many) {
        Result<FrameFiles> wanted = filesOf(options, *graph);
        if (!wanted) return badParticles(wanted.error().message);
        files = std::move(*wanted);
    }
    if (options.mesh.planned && many) {
        const std::string& node = options.particles;
        options.mesh.planned->simulates = simulatesAnew(*graph, node.substr(0, node.find('.')));
        noteWork(*options.mesh.planned, "frame", files.frames);
    }
    if (options.mesh.planned) return kDone;
    Result<Device>& opened = device.get();
    if (!opened) return print(opened.error()), kBadUsage;
    CompileOptions compiling;
    compiling.bake = meshFieldBaker([&] { return &*opened; });
    Result<NodeParticles> particles = NodeParticles::open(*graph, *link, compiling, *opened);
    if (!particles) return badInput(options.mesh, particles.error());
    for (const Error& each : particles->notes()) print(each);
    if (!many) return writeMoment(options, *particles, *progress);
    progress.reset();
    return writeFrames(options, files, *particles);
}

}  // namespace fw::cli
