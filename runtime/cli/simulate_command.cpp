// `fieldwright simulate`: what a graph simulates, run once and kept in a particle cache.
#include <cstdio>
#include <filesystem>
#include <memory>

#include "graph/compile/cached_particles.h"
#include "runtime/bake/mesh_field_baker.h"
#include "runtime/cli/mesh_graph.h"
#include "runtime/cli/sequence.h"
#include "runtime/export/outputs.h"
#include "runtime/play/cached_run.h"
#include "runtime/play/mesh_sequence.h"
#include "runtime/play/particles_at.h"
#include "runtime/system/interruption.h"

namespace fw::cli {

namespace {

int badSimulation(const std::string& message) {
    std::fprintf(stderr, "fieldwright simulate: %s\n", message.c_str());
    return kBadUsage;
}

Error at(const Graph& graph, Error error) {
    error.file = graph.path;
    return error;
}

/// Writes the steps that are not there yet, each while the next is simulated; the exit status.
int write(CachedRun& run, const std::vector<int>& steps, const SimulateOptions& options) {
    const auto count = long(steps.size());
    const auto goesOn = [count](long kept) {
        return WhenEnded{.said = "; " + std::to_string(kept) + " of " + std::to_string(count) +
                                 " frames were kept: the same command goes on"};
    };
    long kept = 0;
    WrittenBehind writing;
    SequenceProgress progress("frame", count);
    whenEnded(goesOn(0));
    for (const int step : steps) {
        const bool there = run.isThere(step);
        if (there) {
            whenEnded(goesOn(++kept));
        } else {
            Result<std::function<Done()>> state = run.make(step);
            if (!state) return print(state.error()), kBadInput;
            auto keep = [write = std::move(*state), goesOn, number = ++kept]() -> Done {
                Done written = write();
                if (written) whenEnded(goesOn(number));
                return written;
            };
            if (const Done before = writing.begin(std::move(keep)); !before)
                return print(before.error()), kSystemFailure;
        }
        progress.next(!there);
    }
    const Done written = writing.end();
    if (!written) return print(written.error()), kSystemFailure;
    if (progress.made < count)
        std::fprintf(stderr, "%s: note: %ld of %ld frames were there already (--overwrite makes them anew)\n",
                     options.output.c_str(), count - progress.made, count);
    return kDone;
}

}  // namespace

int runSimulate(const SimulateOptions& options) {
    OpeningDevice device(std::launch::async, {.pick = options.device});
    std::optional<CachedRun> run;
    FrameRange frames;
    {
        Progress progress;
        progress.start("read", 0);
        std::optional<Graph> graph = openGraph(options.graph);
        if (!graph) return kBadInput;
        const Result<FrameRange> range = framesOf(*readTimeline(*graph), options.sequence.frames);
        if (!range) return badSimulation(range.error().message + " (--from, --to, --fps)");
        frames = *range;
        if (!options.node.empty()) {
            const Result<Link> link = linkToParticles(*graph, options.node);
            if (!link) return print(at(*graph, link.error())), kBadInput;
            graph = showingParticles(std::move(*graph), *link);
        }
        if (options.planned) {
            useCache(*graph, "");
            return simulatesAnew(*graph) ? kDone : (print(nothingSimulated(*graph)), kBadInput);
        }
        progress.start("device", 20, kCompiling);
        Result<Device>& opened = device.get();
        if (!opened) return print(opened.error()), kBadUsage;
        CompileOptions compiling;
        compiling.bake = meshFieldBaker([&] { return &*opened; });
        Result<CachedRun> made = CachedRun::open(std::move(*graph), options.output, compiling, *opened);
        if (!made) return print(made.error()), kBadInput;
        run.emplace(std::move(*made));
        if (!options.sequence.overwrite)
            if (const Done fits = run->fits(); !fits) return print(fits.error()), kBadUsage;
        if (const Done begun = run->begin(frames, options.sequence.overwrite); !begun)
            return print(begun.error()), kSystemFailure;
    }
    return write(*run, run->steps(frames), options);
}

}  // namespace fw::cli
