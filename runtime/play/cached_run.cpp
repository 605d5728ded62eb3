#include "runtime/play/cached_run.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "graph/compile/cached_particles.h"
#include "runtime/system/output_file.h"

namespace fw {

namespace fs = std::filesystem;

Result<CachedRun> CachedRun::open(Graph graph, const std::string& folder, const CompileOptions& options,
                                  const Device& device) {
    CachedRun run(folder, options, device);
    useCache(graph, "");
    Result<LiveProgram> live = compileLive(std::move(graph), options);
    if (!live) return live.error();
    run.live = std::move(*live);
    for (const FieldVolumePtr& volume : run.live.program.ir.volumes())
        if (volume->particles)
            for (CachedSimulation& each : simulationsOf(run.live.graph, volume->particles->particles))
                if (std::ranges::find(run.simulated, each.node, &CachedSimulation::node) ==
                    run.simulated.end())
                    run.simulated.push_back(std::move(each));
    std::ranges::sort(run.simulated, {}, &CachedSimulation::node);
    if (run.simulated.empty()) return nothingSimulated(run.live.graph);
    return run;
}

Error nothingSimulated(const Graph& graph) {
    return Error{.message =
                     "nothing that this graph shows is simulated: link an emitter, particle_dynamics or an "
                     "sph_fluid to its output by particles_to_field, or name a node of them",
                 .file = graph.path};
}

std::string CachedRun::headerPath() const {
    return (fs::absolute(folder) / kParticleCacheName).lexically_normal().string();
}

Done CachedRun::fits() const {
    std::error_code failure;
    if (fs::exists(folder, failure) && !fs::is_directory(folder, failure))
        return Error{.message = "this is a file: a particle cache is a folder", .file = folder};
    if (!fs::exists(headerPath(), failure)) return done();
    const Result<ParticleCachePtr> there = readParticleCache("", headerPath());
    if (!there) return Error{.message = there.error().message + ", or remove it", .file = folder};
    for (const CachedSimulation& each : simulated) {
        const CachedSimulation* const before = (*there)->of(each.node);
        if (before && !(*before == each))
            return Error{
                .message = "the cache there is of another simulation: " + differenceOf(*before, each) +
                           ": choose another folder, or have it made anew (--overwrite)",
                .file = folder};
    }
    return done();
}

Done CachedRun::begin(const FrameRange& frames, bool anew) {
    ParticleCache cache{.folder = folder, .simulations = simulated};
    if (const Result<ParticleCachePtr> there = readParticleCache("", headerPath()); there)
        for (const CachedSimulation& before : (*there)->simulations)
            if (!cache.of(before.node)) cache.simulations.push_back(before);
    std::ranges::sort(cache.simulations, {}, &CachedSimulation::node);
    for (const CachedSimulation& each : simulated) {
        const CachedStates states{(fs::path(folder) / each.folder()).string(), each.key()};
        std::error_code failure;
        fs::create_directories(states.folder, failure);
        if (!fs::is_directory(states.folder))
            return Error{.message = "cannot make the folder: " + failure.message(), .file = states.folder};
        if (!anew) continue;
        for (const int step : statesUpTo(states, Simulation::stepAt(kMostSimulated)))
            fs::remove(statePath(states, step), failure);
    }
    const nlohmann::ordered_json about = {
        {"frames", {{"first", frames.first}, {"last", frames.last - 1}, {"fps", frames.framesPerSecond}}}};
    Result<OutputFile> header = OutputFile::open(headerPath(), nullptr);
    if (!header) return header.error();
    header->write(writeParticleCache(cache, kSimulationStep, about.dump()));
    if (Done written = header->commit(); !written) return written;
    Graph reading = std::move(live.graph);
    useCache(reading, headerPath());
    Result<LiveProgram> compiled = compileLive(std::move(reading), compiling);
    if (!compiled) return compiled.error();
    live = std::move(*compiled);
    fields.setProgram(live.program);
    for (const auto& each : fields.simulations())
        if (!each->caches().empty()) simulations.push_back(each);
    return done();
}

std::vector<int> CachedRun::steps(const FrameRange& frames) const {
    std::vector<int> list;
    for (long frame = frames.first; frame < frames.last; ++frame)
        if (const int step = Simulation::stepAt(timelineTime(live.timeline, frames.time(frame)));
            list.empty() || list.back() != step)
            list.push_back(step);
    std::ranges::sort(list);
    list.erase(std::unique(list.begin(), list.end()), list.end());
    return list;
}

bool CachedRun::isThere(int step) const {
    return std::ranges::all_of(simulations, [&](const auto& simulation) {
        return std::ranges::all_of(simulation->caches(),
                                   [&](const CachedStates& each) { return stateIsThere(each, step); });
    });
}

Result<std::function<Done()>> CachedRun::make(int step, const std::function<bool(int, int)>& progress) {
    std::vector<std::pair<CachedStates, ParticleState>> made;
    for (const auto& simulation : simulations) {
        const Result<bool> gone = simulation->goTo(
            step * kSimulationStep, [&](double time) { return live.valuesAt(time); }, progress);
        if (!gone) {
            Error error = gone.error();
            error.file = live.graph.path;
            return error;
        }
        std::vector<ParticleState> states = simulation->states();
        for (std::size_t i = 0; i < states.size(); ++i)
            made.emplace_back(simulation->caches()[i], std::move(states[i]));
    }
    std::function<Done()> write = [made = std::move(made)]() -> Done {
        for (const auto& [where, state] : made)
            if (Done written = writeState(where, state); !written) return written;
        return done();
    };
    return write;
}

}  // namespace fw
