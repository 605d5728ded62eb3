#include "editor/files/export_job.h"

#include <atomic>
#include <mutex>
#include <new>
#include <thread>
#include <utility>

#include "graph/check/check.h"
#include "runtime/bake/mesh_field_baker.h"
#include "runtime/export/outputs.h"
#include "runtime/play/mesh_program.h"
#include "runtime/system/clock.h"

namespace fw::editor {

namespace {

using Phase = ExportState::Phase;

struct Stage {
    const char *name, *words;
    float part;  ///< of the work before it, about
};
constexpr Stage kStages[] = {{"check", "checking the graph", 0.0f},
                             {"compile", "compiling the graph", 0.02f},
                             {"region", "looking for the solid", 0.05f},
                             {"device", "opening the device", 0.1f},
                             {"pipelines", "compiling for the device", 0.15f},
                             {"mesh", "making the mesh", 0.4f},
                             {"download", "reading the mesh", 0.6f},
                             {"report", "measuring the mesh", 0.65f},
                             {"write", "writing the file", 0.8f}};

}  // namespace

struct ExportJob::Shared {
    ExportWish wish;
    std::function<void()> changed;
    std::atomic<bool> cancel = false;
    mutable std::mutex mutex;
    ExportState state;
    std::thread thread;

    void change(const std::function<void(ExportState&)>& how) {
        {
            std::lock_guard lock(mutex);
            how(state);
        }
        if (changed) changed();
    }

    /// Goes on to the stage; false if the work is to end.
    bool start(std::string_view name) {
        if (cancel) return false;
        for (const Stage& stage : kStages)
            if (name == stage.name)
                change([&](ExportState& now) { now.stage = stage.words, now.part = stage.part; });
        return true;
    }

    Result<ExportState> make();
    void run();
    std::vector<Error> findings;  ///< errors of the graph, where they ended it
};

/// The steps of `fieldwright export`, but that the mesh is measured in memory.
Result<ExportState> ExportJob::Shared::make() {
    const Clock::time_point begin = Clock::now();
    const Error stopped;
    if (const Done known = checkExportPath(wish.path, {.manifold = wish.manifold}); !known)
        return known.error();
    if (const Done distinct = checkDistinct(wish.graph->path, exportedPaths(wish.path)); !distinct)
        return distinct.error();
    if (const Done kept = checkReplacesNone(filesRead(*wish.graph), exportedPaths(wish.path)); !kept)
        return kept.error();
    OpeningDevice opening(std::launch::async, wish.device);
    if (!start("check")) return stopped;
    findings = check(*wish.graph);
    std::erase_if(findings, [](const Error& each) { return each.severity != Error::Severity::error; });
    if (!findings.empty()) return findings.front();
    if (!start("compile")) return stopped;
    CompileOptions options;
    options.bake = meshFieldBaker([&] { return opening.orNone(); });
    Result<Program> program = compileAtTime(
        *wish.graph, wish.seconds, std::move(options), [&] { return opening.orNone(); },
        [&](int, int) { return !cancel; });
    if (!program) return program.error();
    if (!start("region")) return stopped;
    const Result<Box> region = meshRegion(*program, wish.mesh, &*wish.graph);
    if (!region) return region.error();
    prepareKernels(*program, [&] { return !opening.isOpen(); });
    if (!start("device")) return stopped;
    Result<Device>& device = opening.get();
    if (!device) return device.error();
    const Result<MeshedProgram> meshed =
        meshProgram(std::move(*device), std::move(*program), wish.mesh, *region,
                    [this](const char* stage) { return start(stage); });
    if (!meshed) return meshed.error();
    if (!start("download")) return stopped;
    const Mesh mesh = meshed->session.download(meshed->mesh);
    if (!start("report")) return stopped;
    ExportState made{.phase = Phase::done, .stage = "done", .part = 1.0f};
    made.report = reportOnMesh(mesh.positions, mesh.indices);
    made.report.capped = meshed->mesh.capped;
    made.report.device = meshed->session.device().name();
    if (!start("write")) return stopped;
    Result<ExportedFiles> written = exportMesh(
        mesh, wish.path, {.cellSize = float(meshed->cellSize), .manifold = wish.manifold, .cancel = &cancel});
    if (!written) return written.error();
    made.files = std::move(*written);
    made.report.totalMs = millisecondsSince(begin);
    return made;
}

void ExportJob::Shared::run() {
    const auto attempt = [this]() -> Result<ExportState> {
        try {
            return onceMoreIfLost([this] { return make(); },
                                  [this] { change([](ExportState& now) { now.again = true; }); });
        } catch (const std::bad_alloc&) {
            return Error{.message = "out of memory: lower the resolution, or give a smaller region"};
        } catch (const std::exception& error) { return Error{.message = error.what()}; }
    };
    Result<ExportState> made = attempt();
    change([&](ExportState& now) {
        if (made) {
            made->again = now.again;
            now = std::move(*made);
        } else if (cancel) {
            now.phase = Phase::cancelled, now.stage = "cancelled";
        } else {
            now.phase = Phase::failed, now.stage = "failed";
            now.problems = findings.empty() ? std::vector{made.error()} : std::move(findings);
        }
    });
}

ExportJob::ExportJob(ExportWish wish, std::function<void()> changed) : shared(std::make_unique<Shared>()) {
    shared->wish = std::move(wish);
    shared->changed = std::move(changed);
    shared->thread = std::thread([state = shared.get()] { state->run(); });
}

ExportJob::~ExportJob() {
    shared->cancel = true;
    shared->thread.join();
}

void ExportJob::cancel() { shared->cancel = true; }
bool ExportJob::cancelling() const { return shared->cancel; }

ExportState ExportJob::state() const {
    std::lock_guard lock(shared->mutex);
    return shared->state;
}

}  // namespace fw::editor
