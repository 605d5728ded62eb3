#include "editor/files/export_job.h"

#include <filesystem>
#include <mutex>
#include <thread>
#include <utility>

#include "editor/files/attempt.h"
#include "graph/document/unit.h"
#include "graph/implicit3mf/export.h"
#include "runtime/bake/mesh_field_baker.h"
#include "runtime/export/outputs.h"
#include "runtime/play/mesh_program.h"
#include "runtime/play/tiled_mesh.h"
#include "runtime/system/cancel_flag.h"
#include "runtime/system/clock.h"
#include "runtime/system/output_file.h"

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
                             {"unwrap", "laying the mesh flat for its textures", 0.68f},
                             {"bake", "baking textures", 0.7f},
                             {"write", "writing the file", 0.8f},
                             {"functions", "writing the field as functions", 0.5f},
                             {"count", "counting the triangles of the tiles", 0.2f},
                             {"tiles", "writing the tiles", 0.5f},
                             {"examine", "measuring the file", 0.9f}};
constexpr float kTiles = 0.3f;  // of the work: to count the tiles, about, and to write them

}  // namespace

struct ExportJob::Shared {
    struct Opened {
        Device device;
        Program program;
        Box region;
    };

    ExportWish wish;
    std::function<void()> changed;
    CancelFlag cancel;
    mutable std::mutex mutex;
    ExportState state;
    float stageBegan = 0.0f;
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
                change(
                    [&](ExportState& now) { now.stage = stage.words, now.part = stageBegan = stage.part; });
        return true;
    }

    /// So much of the stage's tiles is done; false if the work is to end.
    bool advance(float part) {
        change([&](ExportState& now) { now.part = stageBegan + kTiles * part; });
        return !cancel;
    }

    /// How the file is written.
    ExportOptions writing() const {
        ExportOptions how = writingOf(wish.file);
        how.placement = *placementOf(wish.path, unitOf(*wish.graph), wish.file.placement);
        how.cancel = &cancel;
        return how;
    }
    Done check();
    Result<Opened> open();
    Result<ExportState> atOnce(Opened opened);
    Result<ExportState> inTiles(Opened opened, int side);
    Result<ExportState> asFunctions();
    Result<ExportState> make();
    void run();
    std::vector<Error> findings;  ///< errors of the graph, where they ended it

    inline static const Error kStopped;
};

/// Whether the graph can be exported to the files that there will be.
Done ExportJob::Shared::check() {
    const std::vector<std::string> outputs = wishedPaths(wish.file, wish.path);
    if (const Done distinct = checkDistinct(wish.graph->path, outputs); !distinct) return distinct;
    if (const Done kept = checkReplacesNone(filesRead(*wish.graph), outputs); !kept) return kept;
    if (!start("check")) return kStopped;
    findings = errorsOf(*wish.graph);
    if (!findings.empty()) return findings.front();
    return done();
}

/// Everything that comes before the mesh.
Result<ExportJob::Shared::Opened> ExportJob::Shared::open() {
    if (const Done known = checkWish(wish.file, wish.path); !known) return known.error();
    OpeningDevice opening(std::launch::async, wish.device);
    if (const Done fine = check(); !fine) return fine.error();
    if (!start("compile")) return kStopped;
    CompileOptions options;
    options.triangles = wish.triangles;
    options.byShape = wish.file.textures.has_value();
    options.stop = cancel.token();
    options.bake = meshFieldBaker([&] { return opening.orNone(); });
    Result<Program> program = compileAtTime(
        *wish.graph, wish.seconds, std::move(options), [&] { return opening.orNone(); },
        [&](int, int) { return !cancel; });
    if (!program) return program.error();
    if (!start("region")) return kStopped;
    const Result<Box> region =
        meshRegion(*program, wish.mesh, regionContext(*wish.graph, wish.seconds, cancel.token()));
    if (!region) return region.error();
    prepareKernels(*program, [&] { return !opening.isOpen(); });
    if (!start("device")) return kStopped;
    Result<Device>& device = opening.get();
    if (!device) return device.error();
    return Opened{std::move(*device), std::move(*program), *region};
}

/// The steps of `fieldwright export`, but that the mesh is measured in memory.
Result<ExportState> ExportJob::Shared::atOnce(Opened opened) {
    const Result<MeshedProgram> meshed =
        meshProgram(std::move(opened.device), std::move(opened.program), wish.mesh, opened.region,
                    [this](const char* stage) { return start(stage); });
    if (!meshed) return meshed.error();
    if (!start("download")) return kStopped;
    std::vector<Mesh> levels = meshed->session.downloadLevels(meshed->mesh, std::size_t(wish.file.lods),
                                                              partsOf(wish.file, wish.path));
    if (!start("report")) return kStopped;
    ExportState made{.phase = Phase::done, .stage = "done", .part = 1.0f};
    made.report = reportOnMesh(levels[0].positions, levels[0].indices);
    made.report.unit = unitOf(*wish.graph).name;
    made.report.density = densityOf(*wish.graph);
    made.report.capped = meshed->mesh.capped;
    made.report.device = meshed->session.device().name();
    if (wish.file.textures) {
        Result<std::vector<Mesh>> dressed =
            withTextures(wish.file, std::move(levels), meshed->session.onHost(),
                         [this](const char* stage) { (void)start(stage); });
        if (!dressed) return dressed.error();
        levels = std::move(*dressed);
    }
    if (!start("write")) return kStopped;
    ExportOptions how = writing();
    how.cellSize = float(meshed->cellSize);
    Result<ExportedFiles> written = exportWished(wish.file, levels, wish.path, how);
    if (!written) return written.error();
    made.files = std::move(*written);
    return made;
}

/// The same with tiles of so many cells a side, measured from the file if there is memory for that.
Result<ExportState> ExportJob::Shared::inTiles(Opened opened, int side) {
    MeshRequest request = wish.mesh;
    const bool given = request.region || opened.program.region;
    request.region = opened.region;
    if (request.resolution == 0) request.resolution = opened.program.resolution;
    const Result<CellGrid> grid = cellGrid(opened.region, request.resolution);
    if (!grid) return grid.error();
    const TilePlan plan = planTiles(*grid, side);
    Session session(std::move(opened.device));
    if (!start("pipelines")) return kStopped;
    session.setProgram(std::move(opened.program));
    const auto goesOn = [&](std::size_t tile) { return advance(float(tile) / float(plan.tiles.size())); };
    if (!start("count")) return kStopped;
    Result<CountedTiles> tiles = countTiles(session, request, plan, goesOn);
    if (!tiles) return tiles.error();
    MeshPieces& mesh = tiles->mesh;
    if (mesh.triangleCount == 0) return nothingToSee(given, opened.region, request.resolution);
    ExportState made{.phase = Phase::done, .stage = "done", .part = 1.0f, .tiled = true};
    made.measured = bool(checkMeasurable(mesh.triangleCount, freeMemoryBytes()));
    made.report.vertices = mesh.vertexCount;
    made.report.triangles = mesh.triangleCount;
    mesh.load = [&goesOn, load = mesh.load](std::size_t tile, MeshPieces::Part part) -> Result<Mesh> {
        if (!goesOn(tile)) return kStopped;
        return load(tile, part);
    };
    if (!start("tiles")) return kStopped;
    ExportOptions how = writing();
    if (made.measured)
        how.examine = [&](const StoredMesh& file) -> Done {
            if (!start("examine")) return kStopped;
            Result<WeldedMesh> read = readWelded(file);
            if (!read) return read.error();
            for (glm::vec3& p : read->positions) p = how.placement.placeBack(p);
            made.report = reportOnWelded(*read);
            return done();
        };
    Result<ExportedFiles> written = exportPieces(mesh, wish.path, how);
    if (!written) return written.error();
    made.files = std::move(*written);
    made.report.unit = unitOf(*wish.graph).name;
    made.report.density = densityOf(*wish.graph);
    made.report.capped = tiles->capped;
    made.report.device = session.device().name();
    return made;
}

/// The steps of `fieldwright export --implicit`.
Result<ExportState> ExportJob::Shared::asFunctions() {
    if (const Done fine = check(); !fine) return fine.error();
    if (!start("compile")) return kStopped;
    const Result<Program> program = compileAtTime(*wish.graph, wish.seconds, {.stop = cancel.token()});
    if (!program) return program.error();
    if (!start("region")) return kStopped;
    const Result<Box> region =
        meshRegion(*program, wish.mesh, regionContext(*wish.graph, wish.seconds, cancel.token()));
    if (!region) return region.error();
    if (!start("functions")) return kStopped;
    const std::string file = std::filesystem::path(wish.path).filename().string();
    Result<Exported3mf> functions =
        export3mf(*program, *region, unitOf(*wish.graph), file.substr(0, file.find('.')));
    if (!functions) return functions.error();
    if (!start("write")) return kStopped;
    Result<OutputFile> out = OutputFile::open(wish.path, &cancel);
    if (!out) return out.error();
    out->write(functions->bytes);
    if (const Done written = out->commit(); !written) return written.error();
    ExportState made{.phase = Phase::done, .stage = "done", .part = 1.0f};
    made.files = {.paths = {wish.path}, .bytes = functions->bytes.size()};
    made.functions = functions->nodes;
    made.notes = std::move(functions->warnings);
    return made;
}

Result<ExportState> ExportJob::Shared::make() {
    if (wish.functions) return asFunctions();
    Result<Opened> opened = open();
    if (!opened) return opened.error();
    const Program& program = opened->program;
    if (!checkTilesWish(wish.file, wish.path) || !checkPiecesPath(wish.path) || !checkTiles(program))
        return atOnce(std::move(*opened));
    if ((wish.mesh.resolution > 0 ? wish.mesh.resolution : program.resolution) <= kMostUntiled) {
        try {
            Result<ExportState> made = atOnce(std::move(*opened));
            if (made || made.error().code != Error::Code::tooMuchSurface) return made;
        } catch (const DeviceTooSmall&) {}  // a tile needs less
        opened = open();
    }
    for (int side = kTileCells; opened; side /= 2, opened = open()) {
        try {
            return inTiles(std::move(*opened), side);
        } catch (const DeviceTooSmall&) {
            if (side / 2 < kLeastTile) throw;
        }
    }
    return opened.error();
}

void ExportJob::Shared::run() {
    const Clock::time_point begin = Clock::now();
    Result<ExportState> made =
        attempt([this] { return make(); }, [this] { change([](ExportState& now) { now.again = true; }); },
                "lower the resolution, or give a smaller region");
    change([&](ExportState& now) {
        if (made) {
            made->again = now.again;
            made->report.totalMs = millisecondsSince(begin);
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
    shared->cancel.request();
    shared->thread.join();
}

void ExportJob::cancel() { shared->cancel.request(); }
bool ExportJob::cancelling() const { return shared->cancel; }

ExportState ExportJob::state() const {
    std::lock_guard lock(shared->mutex);
    return shared->state;
}

}  // namespace fw::editor
