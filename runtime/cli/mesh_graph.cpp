#include "runtime/cli/mesh_graph.h"

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdio>

#include "graph/compile/single_precision.h"
#include "runtime/bake/mesh_field_baker.h"
#include "runtime/cli/progress_lines.h"
#include "runtime/export/outputs.h"

namespace fw::cli {

Progress::Progress() : shown(progressIsShown()) {}

Progress::~Progress() {
    if (shown) hideProgress();
}

void Progress::start(const char* name, int percent, const char* shownAs) {
    finish();
    current = name;
    words = shownAs ? shownAs : name;
    since = Clock::now();
    show(percent);
}

void Progress::show(int percent) const {
    if (shown) showProgress(percent, words);
}

void Progress::finish() {
    if (!current.empty()) stages.emplace_back(current, millisecondsSince(since));
    current.clear();
}

Error in(Error error, const std::string& where) {
    error.message += " (" + where + ")";
    return error;
}

int badInput(const MeshOptions& options, Error error) {
    error.file = options.graph.path;
    print(error);
    return kBadInput;
}

bool readRegion(const MeshOptions& options, std::optional<Box>& region) {
    if (options.region.empty()) return true;
    const std::vector<double>& r = options.region;
    region = Box{{r[0], r[1], r[2]}, {r[3], r[4], r[5]}};
    for (int axis = 0; axis < 3; ++axis)
        if (!(region->lo[axis] < region->hi[axis])) {
            std::fprintf(stderr,
                         "fieldwright: --region has no extent along %c: write its least corner, then its "
                         "greatest: x0 y0 z0 x1 y1 z1\n",
                         "xyz"[axis]);
            return false;
        }
    return true;
}

std::optional<Graph> openKept(const MeshOptions& options, int& status) {
    std::optional<Graph> graph = openGraph(options.graph);
    if (!graph) return status = kBadInput, std::nullopt;
    if (const Done kept = checkReplacesNone(filesRead(*graph), options.outputs); !kept)
        return print(kept.error()), status = kBadUsage, std::nullopt;
    if (const Done there = checkCanBeWritten(options.outputs); !there)
        return print(there.error()), status = kSystemFailure, std::nullopt;
    return graph;
}

std::launch startOf(const MeshOptions& options) {
    return options.planned ? std::launch::deferred : std::launch::async;
}

std::optional<OpenedGraph> openForMesh(const MeshOptions& options, Progress& progress, int& status) {
    const auto fail = [&status](int with) {
        status = with;
        return std::nullopt;
    };
    std::optional<Box> region;
    if (!readRegion(options, region)) return fail(kBadUsage);
    // The device starts while the graph is read: on software Vulkan that takes longer than reading.
    OpeningDevice device(startOf(options), {.pick = options.device});
    progress.start("read", 0);
    std::optional<Graph> graph = openKept(options, status);
    if (!graph) return std::nullopt;
    if (options.planned && options.planned->parts == 1) return fail(kDone);
    progress.start("compile", 5);
    CompileOptions compileOptions;
    compileOptions.triangles = options.triangles;
    compileOptions.byShape = options.byShape;
    compileOptions.bake =
        meshFieldBaker([&] { return device.orNone(); },
                       {.progress = [&](double share) { progress.show(5 + int(5 * share)); }});
    std::optional<Program> program = openProgram(
        *graph, options.graph.time, std::move(compileOptions), [&] { return device.orNone(); },
        [&](int done, int all) {
            if (done == 1) progress.start("simulate", 10);
            progress.show(10 + 5 * done / all);
            return true;
        });
    if (!program) return fail(kBadInput);
    std::vector<std::string> images;  // those that code names, too
    for (const FieldImagePtr& image : program->ir.images()) images.push_back(image->file);
    if (const Done kept = checkReplacesNone(images, options.outputs); !kept)
        return print(kept.error()), fail(kBadUsage);
    progress.start("region", 10);
    const MeshRequest request{region, options.resolution.value_or(program->resolution),
                              options.method.value_or(program->method)};
    const Result<Box> box = meshRegion(*program, request, regionContext(*graph, options.graph.time));
    if (!box) return fail(badInput(options, box.error()));
    if (const std::optional<Error> note = precisionLoss(*graph, *program, *box)) print(*note);
    prepareKernels(*program, [&] { return !device.isOpen(); });
    progress.start("device", 15);
    Result<Device>& opened = device.get();
    if (!opened) return print(opened.error()), fail(kBadUsage);
    const LengthUnit unit = unitOf(*graph);
    return OpenedGraph{std::move(*opened), std::move(*program), request, *box, unit, std::move(*graph)};
}

Result<MeshedProgram> meshOpened(OpenedGraph opened, Progress& progress, bool timed) {
    const auto starts = [&](const char* stage) {
        const bool meshes = std::string_view(stage) == "mesh";
        progress.start(stage, meshes ? 50 : 20, meshes ? nullptr : kCompiling);
        return true;
    };
    return meshProgram(std::move(opened.device), std::move(opened.program), opened.request, opened.region,
                       starts, timed);
}

std::optional<MeshedProgram> meshGraph(const MeshOptions& options, Progress& progress, bool timed,
                                       int& status) {
    std::optional<OpenedGraph> opened = openForMesh(options, progress, status);
    if (!opened) return std::nullopt;
    Result<MeshedProgram> meshed = meshOpened(std::move(*opened), progress, timed);
    if (meshed) return std::move(*meshed);
    status = badInput(options, meshed.error());
    return std::nullopt;
}

std::optional<Player> openPlayer(const MeshOptions& options, Progress& progress, const PlayerOptions& wishes,
                                 int& status, const std::function<int(const Graph&)>& accept) {
    const auto fail = [&status](int with) {
        status = with;
        return std::nullopt;
    };
    PlayerOptions playerOptions = wishes;
    playerOptions.device = playerOptions.deviceOptions.pick = options.device;
    playerOptions.resolution = options.resolution.value_or(0);
    playerOptions.method = options.method;
    playerOptions.triangles = options.triangles;
    playerOptions.byShape = options.byShape;
    if (!readRegion(options, playerOptions.region)) return fail(kBadUsage);
    OpeningDevice opening(startOf(options), playerOptions.deviceOptions);
    progress.start("read", 0);
    std::optional<Graph> graph = openKept(options, status);
    if (!graph) return std::nullopt;
    if (accept)
        if (const int refused = accept(*graph); refused != kDone) return fail(refused);
    if (options.planned) return fail(kDone);
    progress.start("device", 10);
    Result<Device>& device = opening.get();
    if (!device) return print(device.error()), fail(kBadUsage);
    progress.start("pipelines", 20, kCompiling);
    Result<Player> player = Player::create(std::move(*graph), std::move(*device), playerOptions);
    if (!player) return fail(badInput(options, player.error()));
    for (const Error& note : player->notes()) print(note);
    player->seek(options.graph.time);
    return std::move(*player);
}

void noteLost(const std::string& now) {
    std::fprintf(stderr, "%sfieldwright: note: the device was lost (its driver crashed or was reset): %s\n",
                 isatty(STDERR_FILENO) ? "\r\033[K" : "", now.c_str());
}

void renewDevice(Player& player, const std::string& goesOn) {
    const std::string before = player.device().name();
    player.renewDevice();
    const std::string now = player.device().name();
    noteLost(goesOn + (now == before ? "" : ", on device '" + now + "'"));
}

std::optional<std::pair<int, int>> pictureSize(const char* command, const std::string& text) {
    std::pair<int, int> size;
    const char* end = text.data() + text.size();
    const auto width = std::from_chars(text.data(), end, size.first);
    const bool cross = width.ec == std::errc() && width.ptr != end && *width.ptr == 'x';
    const auto height = cross ? std::from_chars(width.ptr + 1, end, size.second) : width;
    if (!cross || height.ec != std::errc() || height.ptr != end) {
        std::fprintf(stderr, "fieldwright %s: --size %s: write width x height in pixels, as 1280x720\n",
                     command, text.c_str());
        return std::nullopt;
    }
    if (const Done fits = checkPictureSize(size.first, size.second); !fits) {
        std::fprintf(stderr, "fieldwright %s: --size %s: %s\n", command, text.c_str(),
                     fits.error().message.c_str());
        return std::nullopt;
    }
    return size;
}

}  // namespace fw::cli
