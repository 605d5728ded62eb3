// Particles to a density, the talk's three ways, beside what the slide says of them; and the fluid that makes
// such particles.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <optional>
#include <random>
#include <span>

#include "graph/document/json.h"
#include "runtime/particles/particle_volume.h"
#include "runtime/play/cached_run.h"
#include "runtime/play/player.h"
#include "shaders/shared.h"
#include "tests/bench/surface_baseline.h"
#include "tests/bench/tables.h"

#include "shaders/particles/density.h"

namespace fw::bench {
namespace {

constexpr uint32_t kParticles = 100'000;
constexpr float kRadiusInCells = 4.0f;
constexpr double kLeastOverExact = 40;

struct DensityWay {
    const char* name;
    std::optional<DensityMethod> method;  // none: the slide's own exact way
    const char* slide;                    // ms
};
constexpr DensityWay kWays[] = {{"exact", DensityMethod::exact, ""},
                                {"exact, cells of one sample", {}, "> 200"},
                                {"proxies", DensityMethod::proxies, "> 100"},
                                {"blur", DensityMethod::blur, "< 2"}};

/// Evenly in a ball, and the drops of a splash about it.
std::vector<glm::vec4> splash() {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
    std::vector<glm::vec4> places;
    while (places.size() < kParticles) {
        const glm::vec3 p(unit(random), unit(random), unit(random));
        const float far = glm::length(p);
        if (far < 0.7f || (far < 0.95f && places.size() % 20 == 0)) places.emplace_back(p, 0.0f);
    }
    return places;
}

constexpr double kMostFrameMs = 150;

/// Some 20,000 particles of a column of water that was let go, in 64 cells along the tank.
constexpr const char* kFluid = R"({"fieldwright": 1, "nodes": [
    {"id": "column", "type": "box", "inputs": {"half_extents": [0.5, 0.5, 0.5]}},
    {"id": "moved", "type": "translate", "inputs": {"surface": {"from": "column"}, "offset": [-0.5, 0.5, 0]}},
    {"id": "post", "type": "infinite_cylinder", "inputs": {"radius": 0.12}},
    {"id": "water", "type": "sph_fluid", "inputs": {"source": {"from": "moved"}, "spacing": 0.0368, "collide": {"from": "post_moved"},
        "tank_min": [-1, 0, -0.5], "tank_max": [1, 1.5, 0.5], "substeps": 2}},
    {"id": "post_moved", "type": "translate", "inputs": {"surface": {"from": "post"}, "offset": [0.5, 0, 0]}},
    {"id": "field", "type": "particles_to_field", "inputs": {"particles": {"from": "water"}, "radius": 0.08, "threshold": 0.7,
        "resolution": 64}},
    {"id": "out", "type": "output", "inputs": {"surface": {"from": "field"}, "resolution": 64}}]})";

/// The slide's exact way: cells as wide as a sample, where ours are as wide as a particle reaches.
void recordSlideExact(Commands& commands, DensityKernels& kernels, const Pipeline& kernel, DensityBuffers& b,
                      const DensityConfig& config, const Buffer& particles) {
    const DensityGrid& grid = config.grid;
    gpu::DensityPush push{};
    push.size = grid.size;
    push.particles = kParticles;
    push.origin = grid.origin;
    push.cell = push.radius = grid.cell;
    push.reach = int(kRadiusInCells);
    push.buckets = grid.size + 2 * push.reach + 3;  // rows are padded by up to three samples
    push.first = grid.origin - (float(push.reach) + 0.5f) * grid.cell;
    const auto buckets = uint32_t(push.buckets.x * push.buckets.y * push.buckets.z);
    const auto samples = uint32_t((grid.size.x + 3) / 4 * 4 * grid.size.y * grid.size.z);
    const auto run = [&](uint32_t items, const Pipeline& pipeline, std::span<const Descriptor> bound) {
        dispatch(commands, pipeline, spread(commands.device, groupsFor(items, DENSITY_GROUP)), push, bound);
        barrier(commands);
    };
    reserve(commands.device, b.keys, 4ull * kParticles);
    reserve(commands.device, b.sorted, 16ull * kParticles);
    reserve(commands.device, b.density, 4ull * samples);
    beginStage(commands, "sort");
    run(kParticles, kernels.bucket, std::array{Descriptor{0, particles}, Descriptor{1, b.keys}});
    sortByKey(commands, kernels.sort, b.buckets, b.keys, b.order, kParticles, buckets + 1);
    run(kParticles, kernels.gather,
        std::array{Descriptor{0, particles}, Descriptor{1, b.order}, Descriptor{2, b.sorted}});
    beginStage(commands, "density");
    run(samples, kernel,
        std::array{Descriptor{0, b.sorted}, Descriptor{1, b.buckets.starts}, Descriptor{2, b.density}});
}

/// How far a surface's distances are from its formula, in drops: of some samples, none of them deep inside,
/// where all that matters is that they are.
struct Deviation {
    double most = 0.0, mean = 0.0;
};
Deviation deviationOf(const Device& device, const Buffer& distances, const std::vector<glm::vec4>& places,
                      const SurfaceConfig& config) {
    constexpr std::size_t kEach = 101;
    const SurfaceBaseline formula(places, config.drop, config.surface);
    const auto width = std::size_t(config.grid.size.x), height = std::size_t(config.grid.size.y),
               pitch = (width + 3) / 4 * 4, samples = pitch * height * std::size_t(config.grid.size.z);
    const std::vector<float> found = download<float>(device, distances, samples);
    Deviation off;
    std::size_t seen = 0;
    for (std::size_t i = 0; i < samples; i += kEach) {
        const glm::dvec3 at(double(i % pitch), double(i / pitch % height), double(i / (pitch * height)));
        const double wanted = formula.at(glm::dvec3(config.grid.origin) + double(config.grid.cell) * at);
        if (i % pitch >= width || wanted < -0.5 * double(config.drop)) continue;
        const double apart =
            std::abs(double(found[i]) * double(config.grid.cell) - wanted) / double(config.drop);
        off.most = std::max(off.most, apart), off.mean += apart, ++seen;
    }
    off.mean /= double(seen);
    return off;
}

/// Surfaces whose particles feel one another four cells away, as many as the blur's.
void surfaceTable(Bench& bench, ParticleVolumeKernels& kernels, const std::vector<glm::vec4>& places,
                  const Buffer& particles) {
    Table table{.title = "From " + count(kParticles) + " particles to a surface, four cells wide (ms)",
                .header = {"surface", "samples", "all", "sort", "shape", "blocks", "surface",
                           "times the blur", "off at most, drops", "on average"}};
    DensityBuffers buffers;
    Buffer shapes;
    for (const int size : bench.sizes({128})) {
        const DensityGrid grid{
            .origin = glm::vec3(-1.0f), .cell = 2.0f / float(size - 1), .size = glm::ivec3(size)};
        const float radius = kRadiusInCells * grid.cell;
        double blur = 0.0;
        for (const ParticleSurface surface :
             {ParticleSurface::blobs, ParticleSurface::average, ParticleSurface::anisotropic}) {
            const bool blobs = surface == ParticleSurface::blobs;
            const double reach = surface == ParticleSurface::average ? AVERAGE_REACH : ANISOTROPIC_REACH;
            const SurfaceConfig config{grid, float(radius / reach), surface};
            const auto run = [&](bool timed) {
                const auto start = Clock::now();
                Commands commands(bench.device(), timed);
                const Done recorded = blobs ? recordDensity(commands, kernels.density, buffers,
                                                            {grid, radius}, particles, kParticles)
                                            : recordSurface(commands, kernels.density, kernels.surface,
                                                            buffers, shapes, config, particles, kParticles);
                if (!recorded) bench.fail(recorded.error().message);
                submit(commands);
                return std::pair(millisecondsSince(start), commands.stages);
            };
            const Figure all = measure(bench.options.repeats, [&] { return run(false).first; });
            if (blobs) blur = all.median();
            std::map<std::string, double> stages;
            for (const StageTime& stage : run(true).second) stages[stage.name] += stage.milliseconds;
            const auto time = [&](const char* stage) {
                return stages[stage] > 0.0 ? number(stages[stage]) : "";
            };
            table.rows.push_back({blobs ? "blobs, by the blur" : kParticleSurfaceNames[std::size_t(surface)],
                                  count(grid.size.x * grid.size.y * grid.size.z), text(all), time("sort"),
                                  time("shape"), time("blocks"), time("surface"), number(all.median() / blur),
                                  "", ""});
            if (blobs) continue;
            const Deviation off = deviationOf(bench.device(), buffers.density, places, config);
            table.rows.back().end()[-2] = number(off.most), table.rows.back().end()[-1] = number(off.mean);
        }
    }
    table.notes.push_back("Wanted: average at most 4 times the blur, anisotropic at most 12 times.");
    print(table, bench.options.markdown);
}

/// What becomes of a density: samples of a volume.
void volumeTable(Bench& bench, ParticleVolumeKernels& kernels, const Buffer& particles) {
    Table table{
        .title = "From " + count(kParticles) + " particles to a volume, four cells wide, by the blur (ms)",
        .header = {"samples", "values", "all", "density", "distance", "sweep", "samples written"}};
    for (const int size : bench.sizes({64, 128}))
        for (const bool trueDistance : {false, true}) {
            ParticleVolumeBuffers buffers;
            ParticleVolumeConfig config;
            config.numbers.threshold = 0.5;
            config.trueDistance = trueDistance;
            config.grid.origin = glm::dvec3(-1.0);
            config.grid.cell = 2.0 / double(size - 1);
            config.grid.size = glm::ivec3(size);
            config.numbers.radius = kRadiusInCells * config.grid.cell;
            std::size_t texels = config.grid.samples();
            for (const glm::ivec3& level : blockLevels(config.grid))
                texels += std::size_t(level.x) * std::size_t(level.y) * std::size_t(level.z);
            Buffer volumes = createBuffer(bench.device(), kTexelBytes * texels);
            const auto run = [&](bool timed) {
                const auto start = Clock::now();
                Commands commands(bench.device(), timed);
                if (const Done recorded = recordParticleVolume(commands, kernels, buffers, config, particles,
                                                               kParticles, volumes, 0);
                    !recorded)
                    bench.fail(recorded.error().message);
                submit(commands);
                return std::pair(millisecondsSince(start), commands.stages);
            };
            const Figure all = measure(bench.options.repeats, [&] { return run(false).first; });
            std::map<std::string, double> stages;
            for (const StageTime& stage : run(true).second) stages[stage.name] += stage.milliseconds;
            table.rows.push_back({count(config.grid.samples()), trueDistance ? "true distances" : "near",
                                  text(all), number(stages["splat"] + stages["blur"]),
                                  number(stages["distance"]), trueDistance ? number(stages["sweep"]) : "",
                                  number(stages["samples"])});
        }
    print(table, bench.options.markdown);
}

/// A step, the field, the mesh and the picture, again and again.
void frameTable(Bench& bench) {
    const Result<Graph> graph = parseGraph(kFluid, "fluid.field.json", nullptr);
    if (!graph) return bench.fail(format(graph.error()));
    Result<Device> device = createDevice({.pick = bench.options.device});
    if (!device) return bench.fail(device.error().message);
    Result<Player> player = Player::create(*graph, std::move(*device));
    if (!player) return bench.fail(format(player.error()));
    Picture picture;
    RenderOptions options{.width = 640, .height = 360};
    const auto frame = [&](std::vector<double>* parts) {
        const auto start = Clock::now();
        player->advance(1.0 / 60);
        const Result<MesherResult> mesh = player->meshOnDevice();
        if (!mesh) bench.fail(format(mesh.error()));
        const double made = millisecondsSince(start);
        const Result<bool> drawn = player->show(options, picture);
        if (!drawn) bench.fail(format(drawn.error()));
        const double all = millisecondsSince(start);
        if (parts) parts->push_back(made);
        return all;
    };
    for (int i = 0; i < 10; ++i) frame(nullptr);
    std::vector<double> made;
    const Figure all = measure(std::max(bench.options.repeats, 15), [&] { return frame(&made); });
    std::ranges::sort(made);
    Table table{.title = "A frame of a fluid at 640x360: step, field of 64 cells, mesh, picture (ms)",
                .header = {"particles", "all", "until the mesh", "picture"}};
    const double until = made[made.size() / 2];
    table.rows.push_back(
        {count(player->particles()), text(all), number(until), number(all.median() - until)});
    table.notes.push_back("Wanted at most " + number(kMostFrameMs) +
                          " ms: " + (all.median() <= kMostFrameMs ? "met." : "missed."));
    print(table, bench.options.markdown);
}

/// Frames of a fluid as a cache gets and gives them.
void cacheTable(Bench& bench) {
    namespace fs = std::filesystem;
    const Result<Graph> graph = parseGraph(kFluid, "", nullptr);
    if (!graph) return bench.fail(format(graph.error()));
    const fs::path folder =
        fs::temp_directory_path() / ("fieldwright-bench-" + std::to_string(::getpid()) + "-cache");
    const FrameRange frames{0, 40, 30.0};
    std::vector<double> simulated, written, read;
    /// Milliseconds of each frame until its state is on the host; and of writing it, where that is done.
    const auto pass = [&](std::vector<double>& made, std::vector<double>* writing) {
        Result<CachedRun> run = CachedRun::open(*graph, folder.string(), {}, bench.device());
        if (!run) return bench.fail(format(run.error()));
        if (const Done begun = run->begin(frames, false); !begun) return bench.fail(format(begun.error()));
        for (const int step : run->steps(frames)) {
            auto start = Clock::now();
            const Result<std::function<Done()>> write = run->make(step);
            if (!write) return bench.fail(format(write.error()));
            if (step > 0) made.push_back(millisecondsSince(start));
            start = Clock::now();
            if (!writing) continue;
            if (const Done kept = (*write)(); !kept) return bench.fail(format(kept.error()));
            writing->push_back(millisecondsSince(start));
        }
        std::ranges::sort(made);
    };
    pass(simulated, &written);
    pass(read, nullptr);
    std::error_code failure;
    uintmax_t bytes = 0;
    for (const auto& each : fs::directory_iterator(folder / "water", failure)) bytes += each.file_size();
    fs::remove_all(folder, failure);
    if (read.empty()) return;
    std::ranges::sort(written);
    Table table{.title = "A frame of a fluid, two steps, in a particle cache (ms)",
                .header = {"MB", "simulated", "written", "read", "times as fast to read"}};
    const Figure first{simulated}, second{written}, third{read};
    table.rows.push_back({number(double(bytes) / double(frames.count()) * 1e-6), text(first), text(second),
                          text(third), number(first.median() / third.median())});
    print(table, bench.options.markdown);
}

}  // namespace

void particlesTable(Bench& bench) {
    const Device& device = bench.device();
    ParticleVolumeKernels volumeKernels = createParticleVolumeKernels(device);
    DensityKernels& kernels = volumeKernels.density;
    const Pipeline slideExact = createComputePipeline(device, {.name = "bench/slide_exact.comp"});
    DensityBuffers buffers;
    const std::vector<glm::vec4> places = splash();
    Buffer particles = createBuffer(device, 16 * places.size());
    upload(device, particles, places);
    Table table{.title = "From " + count(kParticles) + " particles to a density, four cells wide (ms)",
                .header = {"way", "samples", "all", "sort", "splat", "density", "blur",
                           "times as fast as exact", "off at most, %", "on average, %", "the slide's ms"}};
    for (const int size : bench.sizes({128})) {
        DensityConfig config{
            .grid = {.origin = glm::vec3(-1.0f), .cell = 2.0f / float(size - 1), .size = glm::ivec3(size)}};
        config.radius = kRadiusInCells * config.grid.cell;
        const std::size_t samples = std::size_t((size + 3) / 4 * 4) * std::size_t(size) * std::size_t(size);
        std::vector<float> exact;
        double slowest = 0.0;
        for (const DensityWay& way : kWays) {
            config.method = way.method.value_or(DensityMethod::exact);
            const auto run = [&](bool timed) {
                const auto start = Clock::now();
                Commands commands(device, timed);
                if (!way.method)
                    recordSlideExact(commands, kernels, slideExact, buffers, config, particles);
                else if (const Done recorded =
                             recordDensity(commands, kernels, buffers, config, particles, kParticles);
                         !recorded)
                    bench.fail(recorded.error().message);
                submit(commands);
                return std::pair(millisecondsSince(start), commands.stages);
            };
            const Figure all = measure(bench.options.repeats, [&] { return run(false).first; });
            const std::vector<StageTime> stages = run(true).second;
            const std::vector<float> density = download<float>(device, buffers.density, samples);
            if (exact.empty()) exact = density, slowest = all.median();
            double most = 0.0, worst = 0.0, squares = 0.0;
            for (std::size_t i = 0; i < samples; ++i) {
                const double off = std::abs(double(density[i]) - exact[i]);
                most = std::max(most, double(exact[i])), worst = std::max(worst, off), squares += off * off;
            }
            if (!way.method && !(worst < 1e-5 * most))
                bench.fail("the slide's exact way is off by " + std::to_string(worst / most) +
                           " of the densest");
            std::vector<std::string> row{way.name, count(samples), text(all)};
            for (const char* wanted : {"sort", "splat", "density", "blur"}) {
                double sum = 0.0;
                for (const StageTime& stage : stages)
                    if (stage.name == wanted) sum += stage.milliseconds;
                row.push_back(sum > 0.0 ? number(sum) : "");
            }
            row.push_back(number(slowest / all.median()));
            row.push_back(number(100 * worst / most));
            row.push_back(number(100 * std::sqrt(squares / double(samples)) / most));
            row.push_back(way.slide);
            table.rows.push_back(row);
        }
    }
    table.notes.push_back("Errors are of the densest sample. Blur is wanted at least " +
                          number(kLeastOverExact) + " times as fast as exact.");
    print(table, bench.options.markdown);
    surfaceTable(bench, volumeKernels, places, particles);
    volumeTable(bench, volumeKernels, particles);
    frameTable(bench);
    cacheTable(bench);
    fluidTable(bench);
}

}  // namespace fw::bench
