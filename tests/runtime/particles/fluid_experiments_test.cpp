// The fluid against what is known of it: a tank at rest, a dam that breaks as in an experiment, a drop whose
// shape has a formula. What is compared with a band is printed and plotted. The long cases run where
// FIELDWRIGHT_LONG is set.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <random>

#include "tests/support/fluid.h"
#include "tests/support/gpu.h"
#include "tests/support/plot.h"

namespace fw::fluid_experiments_test {

using test::device;
using test::energyOf;
using test::kernelsFor;
using test::mean;
using test::read;
using test::run;

class FluidExperiments : public test::Fluid {};

TEST_F(FluidExperiments, WaterComesToRestInATank) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "an experiment of half a minute: FIELDWRIGHT_LONG";
    const float spacing = 0.05f, height = 0.4f;
    FluidParticles fluid;
    const FluidConfig config{.spacing = spacing,
                             .lo = glm::vec3(-0.5f, 0.0f, -0.3f),
                             .hi = glm::vec3(0.5f, 1.5f, 0.3f),
                             .viscosity = 12.0f};
    std::vector<test::Curve> curves;
    for (const bool collapses : {false, true}) {
        setFluid(device(), fluid,
                 fluidBlock({-0.5f, 0.0f, -0.3f},
                            collapses ? glm::vec3(0.0f, 2.0f * height, 0.3f) : glm::vec3(0.5f, height, 0.3f),
                            spacing),
                 {});
        const double lattice = energyOf(fluid, config);
        Commands commands(device());
        ASSERT_TRUE(recordSettling(commands, kernelsFor(), fluid, config));
        submit(commands);
        const double first = energyOf(fluid, config);
        double sprung = 0.0, least = first, growth = 0.0;
        test::Curve& curve =
            curves.emplace_back(test::Curve{.name = collapses ? "a column that collapses" : "a layer at rest",
                                            .color = collapses ? "#d55e00" : "#1771a0",
                                            .points = {{0.0, first / (0.5 * 9.81 * height)}}});
        for (int i = 1; i <= 120; ++i) {
            run(fluid, config, 10, 1.0f / 120);
            const double now = energyOf(fluid, config);
            sprung = std::max(sprung, now / first - 1.0);
            if (i <= 60) curve.points.emplace_back(i / 12.0, now / (0.5 * 9.81 * height));
            growth = std::max(growth, now / least - 1.0);
            least = std::min(now, least);
        }
        const std::vector<glm::vec3> places = read(fluid.places, fluid.count),
                                     velocities = read(fluid.velocities, fluid.count);
        const auto densities = download<float>(device(), fluid.densities, fluid.count);
        const std::vector<glm::vec3> weighed = read(fluid.weighed, fluid.count);
        std::vector<float> heights;
        double fastest = 0.0, squares = 0.0, density = 0.0;
        std::size_t inner = 0;
        for (uint32_t i = 0; i < fluid.count; ++i) {
            ASSERT_TRUE(glm::all(glm::greaterThanEqual(places[i], config.lo)) &&
                        glm::all(glm::lessThanEqual(places[i], config.hi)));
            heights.push_back(places[i].y);
            const double speed = glm::length(velocities[i]);
            fastest = std::max(fastest, speed), squares += speed * speed;
            if (weighed[i].y > 0.1f && weighed[i].y < 0.3f) density += densities[i], ++inner;
        }
        std::ranges::sort(heights);
        density /= double(inner);
        const double top = heights[heights.size() * 98 / 100] + 0.5 * spacing,
                     filled = 2.0 * mean(places).y / height, rms = std::sqrt(squares / double(fluid.count));
        std::printf(
            "water %s for 10 s: surface at %.3f m of %.1f, filled volume %.3f, density %.4f, speed %.4f m/s "
            "rms, "
            "%.3f at most; energy sprang up by %.4f before it was let go and by %.4f then, grew by %.4f at "
            "most in a twelfth of a second\n",
            collapses ? "collapsed and left" : "left", top, height, filled, density, rms, fastest,
            first / lattice - 1.0, sprung, growth);
        EXPECT_NEAR(density, 1.0, 0.03);
        EXPECT_NEAR(filled, 1.0, 0.05);
        EXPECT_NEAR(top, height, 0.5 * spacing);
        EXPECT_LT(rms, 0.01 * std::sqrt(9.81 * height));
        EXPECT_LT(growth, 0.01);
        EXPECT_LT(sprung, 0.01);
    }
    test::plot("fluid_tank", "seconds", "energy over that of a layer at rest", curves);
}

struct Front {
    double time, at;  ///< T = t sqrt(2 g / a), Z = z / a
};
/// Where the front of a collapsing column of base `a` and height 2 a is: the foremost particle with a third
/// of the neighbours that one at rest has, which are 24 near ones.
std::vector<Front> damBreak(float a, float spacing, float step, double until, double& growth) {
    FluidParticles fluid;
    const FluidConfig config{
        .spacing = spacing, .lo = glm::vec3(0.0f), .hi = a * glm::vec3(10.0f, 3.0f, 1.0f)};
    setFluid(device(), fluid, fluidBlock(glm::vec3(0.0f), a * glm::vec3(1.0f, 2.0f, 1.0f), spacing), {});
    const double first = energyOf(fluid, config), perSecond = std::sqrt(2.0 * 9.81 / a);
    std::vector<Front> fronts;
    growth = 0.0;
    for (double time = step; time * perSecond < until; time += step) {
        run(fluid, config, 1, step);
        // The counts are of the guesses, whose order the places keep.
        const std::vector<glm::vec3> places = read(fluid.places, fluid.count);
        const auto counts = download<uint32_t>(device(), fluid.counts, fluid.count);
        float front = 0.0f;
        for (uint32_t i = 0; i < fluid.count; ++i)
            if (counts[i] >= 24 / 3) front = std::max(front, places[i].x);
        fronts.push_back({time * perSecond, front / a});
        growth = std::max(growth, energyOf(fluid, config) / first - 1.0);
    }
    return fronts;
}

double frontAt(const std::vector<Front>& fronts, double time) {
    const auto after = std::ranges::lower_bound(fronts, time, {}, &Front::time);
    const auto before = after - 1;
    const double t = (time - before->time) / (after->time - before->time);
    return before->at + t * (after->at - before->at);
}

/// Martin and Moyce, Phil. Trans. R. Soc. A 244 (1952), figure 3, a = 2.25 in, as digitised in
/// pysph/examples/db_exp_data.py (BSD-3); those with 1.5 < T < 6. Published simulations without friction run
/// ahead of it, so the band is from -5 % to +20 %, with a time shift of 0.3 at most (the gate's).
constexpr Front kMartinMoyce[] = {{1.997, 2.292}, {2.547, 2.995}, {3.345, 4.134}, {4.034, 4.944},
                                  {4.418, 5.881}, {5.091, 6.980}, {5.685, 7.945}};

TEST_F(FluidExperiments, ADamBreaksAsInTheExperiment) {
    const float a = 0.5f;
    double growth = 0.0;
    const std::vector<Front> fronts = damBreak(a, a / 20, 1.0f / 120, 6.1, growth);
    std::printf("dam break, front over the experiment's:");
    for (const Front& wanted : kMartinMoyce) {
        const double ratio = frontAt(fronts, wanted.time) / wanted.at;  // without a shift
        std::printf(" T %.2f: %+.1f %%", wanted.time, 100.0 * (ratio - 1.0));
        EXPECT_GT(ratio, 0.95) << wanted.time;
        EXPECT_LT(ratio, 1.20) << wanted.time;
    }
    for (std::size_t i = 1; i < fronts.size(); ++i) EXPECT_GT(fronts[i].at, fronts[i - 1].at - 0.05);
    test::Curve found{.name = "20 particles to the column's width", .color = "#1771a0", .points = {}},
        known{.name = "Martin and Moyce, a = 2.25 in", .color = "#d55e00", .points = {}, .dots = true};
    for (const Front& each : fronts) found.points.emplace_back(each.time, each.at);
    for (const Front& each : kMartinMoyce) known.points.emplace_back(each.time, each.at);
    test::plot("fluid_dam_break", "T = t √(2g / a)", "front Z = z / a", {found, known});
    const auto four = std::ranges::find_if(fronts, [](const Front& each) { return each.at > 4.0; });
    const double slope = (frontAt(fronts, 6.0) - four->at) / (6.0 - four->time);
    std::printf("; slope beyond Z = 4: %.2f; energy grew by %.4f at most\n", slope, growth);
    EXPECT_GT(slope, 1.4);
    EXPECT_LT(slope, 2.0);
    EXPECT_LT(growth, 0.01);
    if (!std::getenv("FIELDWRIGHT_LONG")) return;
    const std::vector<Front> finer = damBreak(a, a / 40, 1.0f / 240, 6.1, growth);
    std::printf("with half the spacing and step:");
    for (const Front& wanted : kMartinMoyce) {
        const double ratio = frontAt(finer, wanted.time) / frontAt(fronts, wanted.time);
        std::printf(" T %.2f: %+.1f %%", wanted.time, 100.0 * (ratio - 1.0));
        EXPECT_NEAR(ratio, 1.0, 0.05) << wanted.time;
    }
    std::printf("; energy grew by %.4f at most\n", growth);
    EXPECT_LT(growth, 0.01);
}

/// The highest that any particle gets within so many seconds, in steps as a scene takes them, metres above
/// the floor.
float highest(const std::vector<glm::vec3>& from, const FluidConfig& config, float step, double seconds) {
    FluidParticles fluid;
    setFluid(device(), fluid, from, {});
    float high = 0.0f;
    for (double time = 0; time < seconds; time += 4 * step) {
        run(fluid, config, 4, step);
        for (const glm::vec3& p : read(fluid.places, fluid.count)) high = std::max(high, p.y);
    }
    return high;
}

/// Water does not leap higher than what it fell from, but where much of it lifts little: before a wall, as
/// high as the front of a dam's wave, whose speed is 2 sqrt(g H) (Ritter, 1892), has energy for, 2 H.
TEST_F(FluidExperiments, NothingLeapsHigherThanItsEnergyAllows) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "half a minute: with FIELDWRIGHT_LONG";
    const float spacing = 0.04f, step = 1.0f / 240;
    const FluidConfig config{.spacing = spacing, .lo = {0, 0, 0}, .hi = {2, 4, 0.6}};
    const float dam = highest(fluidBlock({0, 0, 0}, {0.6, 0.8, 0.6}, spacing), config, step, 2.0);
    std::printf("a dam of 0.8 m before a wall: %.3f m\n", dam);
    EXPECT_LT(dam, 2 * 0.8f);
    const float block = highest(fluidBlock({0.8, 0.8, 0.1}, {1.2, 1.2, 0.5}, spacing), config, step, 1.5);
    std::printf("a block that falls from 1.2 m on the floor: %.3f m\n", block);
    EXPECT_LT(block, 1.2f);
    std::vector<glm::vec3> pool = fluidBlock({0, 0, 0}, {2, 0.2, 0.6}, spacing);
    for (const glm::vec3& p : fluidBlock({0.8, 0.8, 0.1}, {1.2, 1.2, 0.5}, spacing)) pool.push_back(p);
    const float splash = highest(pool, config, step, 1.5);
    std::printf("and into a pool: %.3f m\n", splash);
    EXPECT_LT(splash, 1.2f);
}

/// Root mean square of an axis.
double spreadAlong(const std::vector<glm::vec3>& places, int axis) {
    double squares = 0.0;
    for (const glm::vec3& p : places) squares += double(p[axis]) * p[axis];
    return std::sqrt(squares / double(places.size()));
}

/// Monaghan, "Simulating Free Surface Flows with SPH" (JCP 110, 1994): a disc with the velocity (-A x, A y)
/// becomes an ellipse with a' = -A a, b' = A b, A' = A^2 (a^2 - b^2) / (a^2 + b^2). Two walls without
/// friction make the space flat. Particles begin a little off the lattice: the columns of one stay columns,
/// however they are stretched, which the kernel takes for denser than they are: the short axis was 26 % off.
TEST_F(FluidExperiments, ADropBecomesTheEllipse) {
    const float spacing = 0.05f, thickness = 4 * spacing, step = 1.0f / 120;
    const FluidConfig config{.spacing = spacing,
                             .lo = glm::vec3(-3.0f, -3.0f, 0.0f),
                             .hi = glm::vec3(3.0f, 3.0f, thickness),
                             .gravity = glm::vec3(0.0f)};
    std::vector<glm::vec3> places = fluidBlock({-1.0f, -1.0f, 0.0f}, {1.0f, 1.0f, thickness}, spacing);
    std::erase_if(places, [](const glm::vec3& p) { return p.x * p.x + p.y * p.y > 1.0f; });
    std::mt19937 random(5);
    std::uniform_real_distribution<float> off(-0.05f * spacing, 0.05f * spacing);
    for (glm::vec3& p : places) p += glm::vec3(off(random), off(random), off(random));
    FluidParticles fluid;
    setFluid(device(), fluid, places, {});
    for (int i = 0; i < 60; ++i) {  // a lattice between walls is too dense: it parts without gaining speed
        run(fluid, config, 1, step);
        places = read(fluid.places, fluid.count);
        setFluid(device(), fluid, places, {});
    }
    std::vector<glm::vec3> velocities;
    for (const glm::vec3& p : places) velocities.emplace_back(-p.x, p.y, 0.0f);
    setFluid(device(), fluid, places, velocities);
    const double across = spreadAlong(places, 0), along = spreadAlong(places, 1),
                 energy = energyOf(fluid, config);
    double a = 1.0, b = 1.0, rate = 1.0, growth = 0.0;
    test::Curve longAxis{.name = "long axis", .color = "#1771a0", .points = {{0.0, 1.0}}},
        wantedLong{.name = "exact", .color = "#d55e00", .points = {}, .dots = true},
        shortAxis{.name = "short axis", .color = "#0a5c39", .points = {{0.0, 1.0}}},
        wantedShort{.name = "exact", .color = "#e69f00", .points = {}, .dots = true};
    for (int i = 0; i < 120; ++i) {
        for (int k = 0; k < 100; ++k) {
            const double h = step / 100.0, change = rate * rate * (a * a - b * b) / (a * a + b * b);
            a -= h * a * rate, b += h * b * rate, rate += h * change;
        }
        run(fluid, config, 1, step);
        growth = std::max(growth, energyOf(fluid, config) / energy - 1.0);
        if ((i + 1) % 12 != 0) continue;
        const std::vector<glm::vec3> now = read(fluid.places, fluid.count);
        const double ratioA = spreadAlong(now, 0) / across / a, ratioB = spreadAlong(now, 1) / along / b,
                     seconds = double(step) * (i + 1);
        longAxis.points.emplace_back(seconds, ratioB * b), wantedLong.points.emplace_back(seconds, b);
        shortAxis.points.emplace_back(seconds, ratioA * a), wantedShort.points.emplace_back(seconds, a);
        if (i + 1 != 96 && i + 1 != 120) continue;
        std::printf("drop after %.1f s: b %.4f, %+.1f %%; a %.4f, %+.1f %%; energy grew by %.4f at most\n",
                    double(step) * (i + 1), b, 100 * (ratioB - 1), a, 100 * (ratioA - 1), growth);
        EXPECT_NEAR(ratioB, 1.0, 0.03);
        EXPECT_NEAR(ratioA, 1.0, 0.1);
    }
    test::plot("fluid_drop", "seconds", "semi-axis", {longAxis, wantedLong, shortAxis, wantedShort});
    EXPECT_NEAR(a, 0.43946, 2e-3);  // the reference's own figures for 1 s
    EXPECT_NEAR(b, 2.27552, 5e-3);
    EXPECT_LT(growth, 0.01);
}

}  // namespace fw::fluid_experiments_test
