// Particles to a density, the talk's three ways, beside what the slide says of them; and the fluid that makes
// such particles.
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <random>

#include "runtime/particles/density.h"
#include "tests/bench/tables.h"

namespace fw::bench {
namespace {

constexpr uint32_t kParticles = 100'000;
constexpr float kRadiusInCells = 4.0f;
constexpr double kLeastOverExact = 40;

struct Way {
    const char* name;
    DensityMethod method;
    const char* slide;  // ms
};
constexpr Way kWays[] = {{"exact", DensityMethod::exact, "> 200"},
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

}  // namespace

void particlesTable(Bench& bench) {
    const Device& device = bench.device();
    DensityKernels kernels = createDensityKernels(device);
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
        for (const Way& way : kWays) {
            config.method = way.method;
            const auto run = [&](bool timed) {
                const auto start = Clock::now();
                Commands commands(device, timed);
                if (const Done recorded =
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
    fluidTable(bench);
}

}  // namespace fw::bench
