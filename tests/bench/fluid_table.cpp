// A fluid's step, beside plain C++ that does the same.
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include "runtime/particles/fluid.h"
#include "tests/bench/fluid_baseline.h"
#include "tests/bench/tables.h"

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
}

}  // namespace fw::bench
