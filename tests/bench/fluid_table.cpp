// A fluid's step, beside plain C++ that does the same; and with its foam.
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include "runtime/particles/foam.h"
#include "shaders/shared.h"
#include "tests/bench/fluid_baseline.h"
#include "tests/bench/tables.h"

#include "shaders/particles/fluid.h"

namespace fw::bench {
namespace {

constexpr int kSizes[] = {20'000, 100'000, 500'000};
constexpr int kSettle = 10;  // steps before the first that counts
constexpr float kStep = 1.0f / 240.0f;

/// A column twice as high as wide that breaks in a tank of a metre.
struct Scene {
    FluidConfig config;
    std::vector<glm::vec3> places;
};
Scene damBreak(int particles) {
    const float across = std::round(std::cbrt(float(particles) / 2.0f));
    Scene scene;
    scene.config.spacing = 0.5f / across;
    scene.config.lo = glm::vec3(0.0f), scene.config.hi = glm::vec3(1.5f, 1.2f, 0.5f);
    scene.places = fluidBlock(glm::vec3(0.0f), {0.5f, 1.0f, 0.5f}, scene.config.spacing);
    return scene;
}

/// Steps of a sixtieth of a second, of a column that has broken for a while: of the fluid alone, and with its
/// foam.
void foamTable(Bench& bench, const FluidKernels& kernels) {
    constexpr int kParts = 8, kFall = 24, kSlots = 50'000;
    constexpr float kWhole = 1.0f / 60.0f;
    const Device& device = bench.device();
    const FoamKernels foamKernels = createFoamKernels(device, {});
    Table table{.title = "A step of a sixtieth of a second with foam, in eight parts (ms)",
                .header = {"particles", "foam", "slots", "without", "with", "times as long"}};
    for (const int size : {20'000, 100'000}) {
        const Scene scene = damBreak(size);
        FluidParticles fluid;
        FoamParticles foam;
        setFluid(device, fluid, scene.places, {});
        clearFoam(device, foam, kSlots);
        uint32_t steps = 0;
        const auto run = [&](bool foams) {
            const auto start = Clock::now();
            Commands commands(device);
            if (const Done recorded =
                    recordFluidSteps(commands, kernels, fluid, scene.config, kWhole / kParts, kParts);
                !recorded)
                bench.fail(recorded.error().message);
            if (foams)
                recordFoamStep(commands, foamKernels, foam, {.step = steps++}, fluid, scene.config, kWhole);
            submit(commands);
            return millisecondsSince(start);
        };
        for (int i = 0; i < kFall; ++i) run(true);
        Figure without, with;
        for (int i = 0; i < bench.options.repeats; ++i) {
            without.runs.push_back(run(false));
            with.runs.push_back(run(true));
        }
        for (Figure* each : {&without, &with}) std::ranges::sort(each->runs);
        const auto velocities = download<glm::vec4>(device, foam.velocities, kSlots);
        const auto there = std::ranges::count_if(velocities, [](const glm::vec4& v) { return v.w >= 0.0f; });
        table.rows.push_back({count(fluid.count), count(uint64_t(there)), count(kSlots), text(without),
                              text(with), number(with.median() / without.median())});
    }
    print(table, bench.options.markdown);
}

/// Steps of a column that breaks: with so many turns each, and with turns that end at the error that those
/// leave.
void errorTable(Bench& bench, const FluidKernels& kernels) {
    constexpr int kSteps = 60;
    const Device& device = bench.device();
    Table table{.title = "A step of a fluid at an equal error, the mean of a quarter of a second (ms)",
                .header = {"particles", "error of four turns", "step", "error where they end at it", "turns",
                           "step", "of four turns"}};
    for (const int size : {20'000, 100'000}) {
        struct Run {
            Figure times = {};
            double error = 0.0, turns = 0.0;  ///< means
        };
        const auto breaks = [&](float error) {
            Run run;
            Scene scene = damBreak(size);
            scene.config.error = error;
            if (error > 0.0f) scene.config.iterations = 32;
            for (int i = 0; i < bench.options.repeats; ++i) {
                FluidParticles fluid;
                setFluid(device, fluid, scene.places, {});
                double milliseconds = 0.0;
                for (int step = 0; step < kSteps; ++step) {
                    const auto start = Clock::now();
                    Commands commands(device);
                    if (const Done recorded = recordFluidStep(commands, kernels, fluid, scene.config, kStep);
                        !recorded)
                        bench.fail(recorded.error().message);
                    submit(commands);
                    milliseconds += millisecondsSince(start) / kSteps;
                    double sum = 0.0;
                    for (const float density : download<float>(device, fluid.densities, fluid.count))
                        sum += std::max(density - 1.0f, 0.0f);
                    run.error += sum / fluid.count / kSteps / bench.options.repeats;
                    if (error > 0.0f)
                        run.turns += double(download<gpu::FluidTurns>(device, fluid.turns, 1)[0].taken) /
                                     kSteps / bench.options.repeats;
                }
                run.times.runs.push_back(milliseconds);
            }
            std::ranges::sort(run.times.runs);
            return run;
        };
        const Run four = breaks(0.0f), ended = breaks(float(four.error));
        table.rows.push_back({count(size), number(four.error), text(four.times), number(ended.error),
                              number(ended.turns), text(ended.times),
                              number(ended.times.median() / four.times.median())});
    }
    print(table, bench.options.markdown);
}

}  // namespace

void fluidTable(Bench& bench) {
    const Device& device = bench.device();
    const FluidKernels kernels = createFluidKernels(device, {});
    Table table{.title = "A step of a fluid, four turns (ms)",
                .header = {"particles", "far ones", "step", "predict", "sort", "neighbours", "density",
                           "velocity", "ns a particle", "plain C++", "its sort", "neighbours", "density",
                           "velocity", "times as fast"}};
    for (const bool farOnce : {false, true}) {
        double least = INFINITY, most = 0.0;
        for (const int size : kSizes) {
            Scene scene = damBreak(size);
            scene.config.farOnce = farOnce;
            FluidParticles fluid;
            setFluid(device, fluid, scene.places, {});
            FluidBaseline plain(scene.config, scene.places, {});
            const auto run = [&](bool timed) {
                const auto start = Clock::now();
                Commands commands(device, timed);
                if (const Done recorded = recordFluidStep(commands, kernels, fluid, scene.config, kStep);
                    !recorded)
                    bench.fail(recorded.error().message);
                submit(commands);
                return std::pair(millisecondsSince(start), commands.stages);
            };
            // Their cells differ, so their orders do; what does not is the centre of mass.
            run(false), plain.step(kStep);
            const glm::dvec3 off = [&] {
                glm::dvec3 sum(0.0);
                for (const glm::vec4& p : download<glm::vec4>(device, fluid.places, fluid.count))
                    sum += glm::vec3(p);
                for (const glm::vec3& p : plain.places) sum -= p;
                return sum / double(fluid.count);
            }();
            if (!(glm::length(off) < 1e-4 * scene.config.spacing))
                bench.fail("the fluid's step is not that of plain C++: off by " +
                           std::to_string(glm::length(off)) + " m");
            for (int i = 0; i < kSettle; ++i) run(false), plain.step(kStep);
            // In turn, so that what else the machine does slows both.
            Figure ours, theirs;
            std::vector<FluidBaselineTimes> parts;
            for (int i = 0; i < bench.options.repeats; ++i) {
                ours.runs.push_back(run(false).first);
                parts.push_back(plain.step(kStep));
                theirs.runs.push_back(parts.back().totalMs());
            }
            for (Figure* each : {&ours, &theirs}) std::ranges::sort(each->runs);
            std::ranges::sort(parts, {}, &FluidBaselineTimes::totalMs);
            const FluidBaselineTimes& middle = parts[parts.size() / 2];
            const double perParticle = 1e6 * ours.median() / double(fluid.count);
            least = std::min(least, perParticle), most = std::max(most, perParticle);
            std::vector<std::string> row{count(fluid.count), farOnce ? "once" : "each turn", text(ours)};
            for (const StageTime& stage : run(true).second) row.push_back(number(stage.milliseconds));
            row.insert(row.end(), {number(perParticle), text(theirs), number(middle.sortMs),
                                   number(middle.neighboursMs), number(middle.densityMs),
                                   number(middle.velocityMs), number(theirs.median() / ours.median())});
            table.rows.push_back(row);
        }
        table.notes.push_back(
            std::string("Far neighbours felt ") + (farOnce ? "once a step" : "in each turn") +
            ": the longest time of a particle is " + number(most / least) + " times the shortest.");
    }
    print(table, bench.options.markdown);
    errorTable(bench, kernels);
    foamTable(bench, kernels);
}

}  // namespace fw::bench
