// The fluid on the device: neighbours against all pairs, densities against sums in double, what must be kept,
// walls and obstacles. Where a figure is compared with a band it is printed. The long cases run where
// FIELDWRIGHT_LONG is set.
#include "runtime/particles/fluid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <map>
#include <numbers>
#include <random>
#include <set>

#include "graph/compile/compile.h"
#include "graph/emit/glsl.h"
#include "shaders/shared.h"
#include "tests/support/fluid.h"
#include "tests/support/gpu.h"
#include "tests/support/graph/expression_graph.h"

#include "shaders/particles/fluid.h"

namespace fw::fluid_test {

using test::device;
using test::energyOf;
using test::kernelsFor;
using test::mean;
using test::meanError;
using test::read;
using test::run;

class Fluid : public test::Fluid {};

std::vector<glm::vec3> randomPlaces(std::size_t count, float reach, uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(-reach, reach);
    std::vector<glm::vec3> places(count);
    for (glm::vec3& p : places) p = {unit(random), unit(random), unit(random)};
    return places;
}

/// Wendland's C2 with support 1.
double wendland(double r) {
    const double u = std::max(1.0 - r, 0.0);
    return 21.0 / (2.0 * std::numbers::pi) * u * u * u * u * (4.0 * r + 1.0);
}

TEST_F(Fluid, NeighboursAreThoseOfAllPairs) {
    FluidConfig config{.spacing = 0.1f, .gravity = glm::vec3(0.0f), .iterations = 1};
    std::vector<glm::vec3> together(60, glm::vec3(0.3f)), oneCell = randomPlaces(60, 0.04f, 2);
    for (const std::vector<glm::vec3>& places :
         {randomPlaces(1500, 1.0f, 1), fluidBlock(glm::vec3(-0.5f), glm::vec3(0.5f), 0.1f), together, oneCell,
          std::vector<glm::vec3>{glm::vec3(0.1f)}, std::vector<glm::vec3>{glm::vec3(-1.0f), glm::vec3(1.0f)}})
        for (const bool farOnce : {false, true}) {
            config.farOnce = farOnce;
            FluidParticles fluid;
            setFluid(device(), fluid, places, {});
            Commands commands(device());
            ASSERT_TRUE(recordFluidStep(commands, kernelsFor(), fluid, config, 1e-4f));
            submit(commands);
            // The weighed guesses are nearly those that the lists were made of, for there was one turn.
            const std::vector<glm::vec3> at = read(fluid.weighed, fluid.count);
            const auto counts = download<uint32_t>(device(), fluid.counts, fluid.count);
            const auto lists = download<uint32_t>(device(), fluid.lists, fluid.lists.size / 4);
            const float support = kFluidSupport * config.spacing,
                        reach = farOnce ? kFluidNear * support : support;
            const auto densities = download<float>(device(), fluid.densities, fluid.count);
            for (uint32_t i = 0; i < fluid.count; ++i) {
                // Of all that are in reach of the kernel, listed or not; where no wall is.
                const bool open = glm::all(glm::lessThan(glm::abs(at[i]), glm::vec3(1.0f - support)));
                const double perKernel = fluidLattice().weight / wendland(0.0);
                double density = fluidLattice().weight;
                std::set<uint32_t> found, wanted;
                for (uint32_t k = 0; k < counts[i]; ++k)
                    found.insert(lists[(i / 256 * 16 + k / 4) * 1024 + i % 256 * 4 + k % 4]);
                for (uint32_t j = 0; j < fluid.count; ++j) {
                    const double far = glm::distance(glm::dvec3(at[i]), glm::dvec3(at[j]));
                    if (j != i) density += perKernel * wendland(far / support);
                    if (j == i || far > 1.00003 * reach) continue;
                    if (far < 0.99997 * reach || found.contains(j)) wanted.insert(j);
                }
                ASSERT_EQ(found.size(), counts[i]);
                if (open) { ASSERT_NEAR(densities[i], density, 2e-4 * density); }
                ASSERT_EQ(found, wanted) << i << " of " << fluid.count;
            }
        }
}

TEST_F(Fluid, DensitiesAreSumsAndWallsAreFull) {
    double whole = 0.0;  // the kernel is normalised
    for (int i = 0; i < 10'000; ++i) {
        const double r = (i + 0.5) / 10'000;
        whole += wendland(r) * 4.0 * std::numbers::pi * r * r / 10'000;
    }
    EXPECT_NEAR(whole, 1.0, 1e-6);
    const double support = kFluidSupport;
    double lattice = 0.0;  // the density in a full lattice of spacing 1
    for (int z = -3; z <= 3; ++z)
        for (int y = -3; y <= 3; ++y)
            for (int x = -3; x <= 3; ++x)
                lattice += wendland(std::sqrt(double(x * x + y * y + z * z)) / support) /
                           (support * support * support);
    const double scale = 1.0 / lattice;  // which the fluid has, too
    EXPECT_NEAR(fluidLattice().weight, scale * wendland(0.0) / (support * support * support), 1e-6);
    FluidParticles fluid;
    const FluidConfig config{.spacing = 0.1f, .gravity = glm::vec3(0.0f), .iterations = 1};
    setFluid(device(), fluid, fluidBlock(glm::vec3(-1.0f), glm::vec3(1.0f), 0.1f), {});
    run(fluid, config, 1, 1e-4f);
    const std::vector<glm::vec3> at = read(fluid.weighed, fluid.count);
    const auto densities = download<float>(device(), fluid.densities, fluid.count);
    double least = 1e9, most = 0.0;
    for (uint32_t i = 0; i < fluid.count; ++i) {
        const bool inner = glm::all(glm::lessThan(glm::abs(at[i]), glm::vec3(0.72f)));
        if (inner) { EXPECT_NEAR(densities[i], 1.0, 1e-4); }
        const bool beside = !inner && glm::abs(at[i].y) < 0.72f && glm::abs(at[i].z) < 0.72f;
        if (beside)
            least = std::min(least, double(densities[i])), most = std::max(most, double(densities[i]));
    }
    std::printf("the kernel's sum over a full lattice %.4f; density beside a wall %.4f to %.4f\n", lattice,
                least, most);
    EXPECT_GT(least, 0.95);
    EXPECT_LT(most, 1.06);
}

TEST_F(Fluid, MomentumIsKeptAndFallsAreFree) {
    for (const double gravity : {0.0, -9.81}) {
        std::vector<glm::vec3> places = fluidBlock(glm::vec3(-0.4f), glm::vec3(0.0f), 0.05f);
        const std::size_t first = places.size();
        // Too dense where nothing falls, for then nothing is cut.
        for (const glm::vec3& p :
             fluidBlock(glm::vec3(0.03f), glm::vec3(0.4f), gravity == 0.0 ? 0.045f : 0.05f))
            places.push_back(p);
        std::vector<glm::vec3> velocities(places.size(), glm::vec3(0.3f, 0.1f, 0.0f));
        for (std::size_t i = first; i < places.size(); ++i) velocities[i] = glm::vec3(-0.6f, 0.2f, 0.1f);
        FluidParticles fluid;
        setFluid(device(), fluid, places, velocities);
        const FluidConfig config{.spacing = 0.05f,
                                 .lo = glm::vec3(-5.0f),
                                 .hi = glm::vec3(5.0f),
                                 .gravity = glm::vec3(0.0f, gravity, 0.0f),
                                 .viscosity = 12.0f,
                                 .tension = 5.0f};
        double sizes = 0.0;
        for (const glm::vec3& v : velocities) sizes += glm::length(v) / double(velocities.size());
        const double step = 1.0 / 120, time = 30 * step;
        run(fluid, config, 30, float(step));
        const glm::dvec3 fallen(0.0, gravity * time, 0.0);
        const glm::dvec3 speed = mean(velocities) + fallen;
        // Half a step's speed more than the parabola: velocities are taken at the steps' ends.
        const glm::dvec3 at = mean(places) + time * mean(velocities) + 0.5 * (time + step) * fallen;
        EXPECT_EQ(fluid.count, places.size());
        const double off = glm::length(mean(read(fluid.velocities, fluid.count)) - speed),
                     astray = glm::length(mean(read(fluid.places, fluid.count)) - at);
        std::printf("after %.2f s the momentum is off by %.1e of what it was, the centre of mass by %.1e m\n",
                    time, off / (sizes + glm::length(fallen)), astray);
        EXPECT_LT(off, 1e-5 * (sizes + glm::length(fallen)));
        EXPECT_LT(astray, 1e-5);
    }
}

TEST_F(Fluid, TheSameBytesEachTime) {
    for (const float error : {0.0f, 0.01f}) {
        std::vector<float> first;
        for (int i = 0; i < 3; ++i) {
            FluidParticles fluid;
            setFluid(device(), fluid, randomPlaces(3000, 0.6f, 7), {});
            run(fluid, {.spacing = 0.06f, .iterations = 8, .error = error}, 20, 1.0f / 60);
            const auto places = download<float>(device(), fluid.places, 4 * std::size_t(fluid.count));
            if (i == 0) first = places;
            EXPECT_EQ(places, first);
        }
    }
}

/// The turns of the last step.
uint32_t turnsOf(const FluidParticles& fluid) {
    return download<gpu::FluidTurns>(device(), fluid.turns, 1)[0].taken;
}

TEST_F(Fluid, TurnsEndAtTheErrorThatIsAskedFor) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "half a minute: with FIELDWRIGHT_LONG";
    // A column that breaks, and lies still at last.
    for (const float error : {0.01f, 0.003f}) {
        const FluidConfig config{.spacing = 0.05f,
                                 .lo = glm::vec3(0.0f),
                                 .hi = glm::vec3(1.0f, 1.2f, 0.3f),
                                 .viscosity = 10.0f,
                                 .iterations = 50,
                                 .error = error,
                                 .farOnce = false};
        FluidParticles fluid;
        setFluid(device(), fluid, fluidBlock(glm::vec3(0.0f), {0.4f, 0.9f, 0.3f}, config.spacing), {});
        uint32_t most = 0;
        for (int i = 0; i < 12; ++i) {
            run(fluid, config, 5, 1.0f / 120);
            EXPECT_LE(meanError(read(fluid.places, fluid.count), config), 1.001 * error) << i;
            EXPECT_LT(turnsOf(fluid), 50u);
            most = std::max(most, turnsOf(fluid));
        }
        run(fluid, config, 480, 1.0f / 120);
        const uint32_t rest = turnsOf(fluid);
        const double found = meanError(read(fluid.places, fluid.count), config);
        std::printf(
            "for a mean error of %.3f: up to %u turns while it breaks, %u at rest, where it is %.5f\n", error,
            most, rest, found);
        EXPECT_LE(found, 1.001 * error);
        EXPECT_LT(rest, most);
    }
}

TEST_F(Fluid, TurnsAreNoMoreThanAllowedAndNoneWhereNothingIsTooDense) {
    FluidConfig config{.spacing = 0.1f, .gravity = glm::vec3(0.0f), .iterations = 7, .error = 1e-6f};
    FluidParticles fluid;
    setFluid(device(), fluid, randomPlaces(3000, 0.5f, 3), {});
    run(fluid, config, 1, 0.01f);
    EXPECT_EQ(turnsOf(fluid), 7u);
    // And they are those of a step that does not ask.
    const std::vector<glm::vec3> ended = read(fluid.places, fluid.count);
    setFluid(device(), fluid, randomPlaces(3000, 0.5f, 3), {});
    config.error = NAN;  // which is none
    run(fluid, config, 1, 0.01f);
    EXPECT_EQ(read(fluid.places, fluid.count), ended);
    config.error = 0.01f;
    setFluid(device(), fluid, {glm::vec3(-0.5f), glm::vec3(0.0f), glm::vec3(0.5f)}, {});
    run(fluid, config, 3, 0.01f);
    EXPECT_EQ(turnsOf(fluid), 0u);
}

TEST_F(Fluid, ListsNeedNotBeBoundAtOnce) {
    Result<Device> tight = createDevice({});
    ASSERT_TRUE(tight);
    tight->limits.storageRange = 1 << 17;  // of 512 particles' lists
    const FluidKernels kernels = createFluidKernels(*tight, {});
    const std::vector<glm::vec3> places = randomPlaces(1500, 0.6f, 7);
    const FluidConfig config{.spacing = 0.1f};
    const auto stepped = [&](const Device& on, const FluidKernels& with) {
        FluidParticles fluid;
        setFluid(on, fluid, places, {});
        Commands commands(on);
        EXPECT_TRUE(recordFluidStep(commands, with, fluid, config, 0.01f));
        submit(commands);
        return download<float>(on, fluid.places, 4 * places.size());
    };
    EXPECT_EQ(stepped(*tight, kernels), stepped(device(), kernelsFor()));
}

TEST_F(Fluid, ManyParticlesGoInPartsToTheSameBytes) {
    // A timed recording is not sent on.
    const FluidConfig config{.spacing = 0.02f};
    const std::vector<glm::vec3> places = fluidBlock(glm::vec3(-0.6f), glm::vec3(0.6f), config.spacing);
    ASSERT_GT(places.size(), kParticlesSentTogether);
    const auto stepped = [&](bool timed, uint64_t& submissions) {
        FluidParticles fluid;
        setFluid(device(), fluid, places, {});
        const uint64_t before = device().record->submissions;
        Commands commands(device(), timed);
        EXPECT_TRUE(recordFluidSteps(commands, kernelsFor(), fluid, config, 0.01f, 2));
        submit(commands);
        submissions = device().record->submissions - before;
        return download<float>(device(), fluid.places, 4 * places.size());
    };
    uint64_t stages = 0, parts = 0;
    const bool same = stepped(true, stages) == stepped(false, parts);
    EXPECT_TRUE(same);
    EXPECT_GE(parts, 12u);
}

TEST_F(Fluid, FewParticlesGoTogether) {
    FluidParticles fluid;
    setFluid(device(), fluid, randomPlaces(3000, 0.6f, 8), {});
    const uint64_t before = device().record->submissions;
    Commands commands(device());
    ASSERT_TRUE(recordFluidSteps(commands, kernelsFor(), fluid, {.spacing = 0.06f}, 0.01f, 8));
    submit(commands);
    EXPECT_EQ(device().record->submissions - before, 1u);
}

TEST_F(Fluid, GoesOnFromWhatWasRead) {
    const FluidConfig config{.spacing = 0.06f};
    FluidParticles fluid, again;
    setFluid(device(), fluid, randomPlaces(3000, 0.6f, 8), {});
    run(fluid, config, 10, 1.0f / 120);
    setFluid(device(), again, read(fluid.places, fluid.count), read(fluid.velocities, fluid.count));
    for (FluidParticles* each : {&fluid, &again}) run(*each, config, 10, 1.0f / 120);
    EXPECT_EQ(read(fluid.places, fluid.count), read(again.places, again.count));
    EXPECT_EQ(read(fluid.velocities, fluid.count), read(again.velocities, again.count));
}

TEST_F(Fluid, FarNeighboursOnceAreNearlyExact) {
    // Of a column that has half collapsed, one step both ways.
    FluidConfig config{.spacing = 0.04f, .lo = glm::vec3(0.0f), .hi = glm::vec3(2.0f, 1.0f, 0.4f)};
    FluidParticles fluid;
    setFluid(device(), fluid, fluidBlock(glm::vec3(0.0f), {0.4f, 0.8f, 0.4f}, config.spacing), {});
    run(fluid, config, 40, 1.0f / 120);
    const std::vector<glm::vec3> places = read(fluid.places, fluid.count),
                                 velocities = read(fluid.velocities, fluid.count);
    std::vector<glm::vec3> ended[2];
    std::vector<float> densities[2];
    for (const int way : {0, 1}) {
        config.farOnce = way == 1;
        setFluid(device(), fluid, places, velocities);
        run(fluid, config, 1, 1.0f / 120);
        ended[way] = read(fluid.places, fluid.count);
        densities[way] = download<float>(device(), fluid.densities, fluid.count);
    }
    double apart = 0.0, moved = 0.0, off = 0.0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        apart += glm::distance(ended[0][i], ended[1][i]) / double(places.size());
        moved += glm::length(velocities[i]) / 120.0 / double(places.size());
        off += std::abs(densities[0][i] - densities[1][i]) / double(places.size());
    }
    std::printf(
        "far neighbours once a step: %.4f spacings off after a step on average, in which a particle moves "
        "%.3f; "
        "density off by %.4f\n",
        apart / config.spacing, moved / config.spacing, off);
    EXPECT_LT(apart / config.spacing, 0.01);
    EXPECT_LT(off, 0.01);
}

/// What far cells by the mean of their particles would cost and save, as the talk has it: on the host, in a
/// lattice that was shaken.
TEST_F(Fluid, FarCellsByTheirMeansWouldNotPay) {
    const double support = kFluidSupport;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> shake(-0.25, 0.25);
    std::vector<glm::dvec3> places;
    for (int z = -6; z <= 6; ++z)
        for (int y = -6; y <= 6; ++y)
            for (int x = -6; x <= 6; ++x)
                places.emplace_back(x + shake(random), y + shake(random), z + shake(random));
    for (const double share : {0.5, 1.0}) {
        const double side = share * support;
        const auto cellOf = [&](const glm::dvec3& p) { return glm::ivec3(glm::floor(p / side)); };
        struct Cell {
            glm::dvec3 sum{0.0};
            double count = 0.0;
        };
        std::map<std::array<int, 3>, Cell> cells;
        for (const glm::dvec3& p : places) {
            const glm::ivec3 at = cellOf(p);
            Cell& cell = cells[{at.x, at.y, at.z}];
            cell.sum += p, cell.count += 1.0;
        }
        double exactTerms = 0.0, terms = 0.0, squares = 0.0, looked = 0.0;
        for (const glm::dvec3& p : places) {
            if (glm::length(p) > 3.0) continue;
            const glm::ivec3 own = cellOf(p);
            const auto near =
                [&](const glm::ivec3& cell) {  // the particle's own cell, or the eight-and-twenty
                    const glm::ivec3 off = glm::abs(cell - own);
                    return std::max({off.x, off.y, off.z}) <= (share < 1.0 ? 1 : 0);
                };
            double exact = 0.0, averaged = 0.0;
            for (const glm::dvec3& q : places) {
                const double far = glm::distance(p, q) / support;
                if (far >= 1.0) continue;
                exact += wendland(far), exactTerms += 1.0;
                if (near(cellOf(q))) averaged += wendland(far), terms += 1.0;
            }
            for (const auto& [at, cell] : cells) {
                const double far = glm::distance(p, cell.sum / cell.count) / support;
                if (near({at[0], at[1], at[2]}) || far >= 1.0) continue;
                averaged += cell.count * wendland(far), terms += 1.0;
            }
            squares += (averaged / exact - 1.0) * (averaged / exact - 1.0), looked += 1.0;
        }
        const double left = terms / exactTerms, off = std::sqrt(squares / looked);
        std::printf(
            "cells of %.1f of the support, far ones by their means: %.2f of the terms, density off by %.3f\n",
            share, left, off);
        EXPECT_TRUE(left > 0.75 || off > 0.05);
    }
}

/// Energy of the surface, over the tension's pull of pairs: fluid.h has it.
double surfaceEnergy(const std::vector<glm::vec3>& places, float spacing) {
    const double support = kFluidSupport * spacing,
                 slope = 20.0 * fluidLattice().weight / (support * support);
    const auto fall = [](double q) {  // the integral of 64 q^3 (1 - q)^3
        return 64.0 * q * q * q * q * (0.25 + q * (-0.6 + q * (0.5 - q / 7.0)));
    };
    const auto attraction = [&](double q) {
        const double far = fall(kFluidNear) - fall(std::max(q, 0.5));
        return far + (q < 0.5 ? 2.0 * (fall(0.5) - fall(q)) - (0.5 - q) : 0.0);
    };
    double sum = 0.0;
    for (const glm::dvec3 p : places) {
        glm::dvec3 gradient(0.0);
        for (const glm::dvec3 other : places) {
            const double q = glm::distance(p, other) / support, u = 1.0 - q;
            if (q >= kFluidNear || q == 0.0) continue;
            sum -= 0.5 * support * attraction(q);
            gradient -= slope * u * u * u * (p - other);
        }
        sum += 0.5 * FLUID_LEVELLING * support * support * support * glm::dot(gradient, gradient);
    }
    return sum / double(places.size());
}

/// Root mean squares along the principal axes, the least first.
glm::dvec3 axesOf(const std::vector<glm::vec3>& places) {
    glm::dmat3 m(0.0);
    const glm::dvec3 middle = mean(places);
    for (const glm::dvec3 p : places) m += glm::outerProduct(p - middle, p - middle) / double(places.size());
    // The roots of its characteristic polynomial, after Smith (1961).
    const double third = (m[0][0] + m[1][1] + m[2][2]) / 3.0;
    const glm::dmat3 rest = m - glm::dmat3(third);
    double squares = 0.0;
    for (int i = 0; i < 3; ++i) squares += glm::dot(rest[i], rest[i]);
    const double size = std::sqrt(squares / 6.0);
    if (size < 1e-12 * third) return glm::dvec3(std::sqrt(third));
    const double turn =
        std::acos(std::clamp(glm::determinant(rest) / (2.0 * size * size * size), -1.0, 1.0)) / 3.0;
    const auto root = [&](int k) {
        return std::sqrt(third + 2.0 * size * std::cos(turn + k * 2.0 * std::numbers::pi / 3.0));
    };
    return {root(1), root(2), root(0)};
}

TEST_F(Fluid, TensionMakesABallOfABarAndNoEnergy) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "half a minute: with FIELDWRIGHT_LONG";
    // The last is cut to what a step can take.
    const std::vector<float> tensions =
        std::getenv("FIELDWRIGHT_LONG") ? std::vector{0.0f, 0.4f, 1e6f} : std::vector{0.4f};
    for (const float tension : tensions) {
        const FluidConfig config{.spacing = 0.1f,
                                 .lo = glm::vec3(-2.0f),
                                 .hi = glm::vec3(2.0f),
                                 .gravity = glm::vec3(0.0f),
                                 .tension = tension};
        const float step = 1.0f / 120;
        const double most = kFluidMostTension * std::pow(config.spacing, 3) / (step * step),
                     pull = std::min<double>(tension, most) /
                            (kTensionOfPairs * config.spacing * config.spacing);
        FluidParticles fluid;
        setFluid(device(), fluid, fluidBlock({-1.6f, -0.4f, -0.4f}, {1.6f, 0.4f, 0.4f}, config.spacing), {});
        const glm::dvec3 middle = mean(read(fluid.places, fluid.count));
        const auto energy = [&] {
            return energyOf(fluid, config) +
                   pull * surfaceEnergy(read(fluid.places, fluid.count), config.spacing);
        };
        run(fluid, config, 1, step);  // of whose end velocities are, and places of its beginning
        const double first = energy();
        double grown = 0.0, swing = 0.0;
        for (int i = 0; i < 60; ++i) {
            run(fluid, config, i < 8 ? 5 : 24, step);
            grown = std::max(grown, energy() - first);
            swing = std::max(swing, glm::length(mean(read(fluid.velocities, fluid.count))));
        }
        const std::vector<glm::vec3> places = read(fluid.places, fluid.count);
        const glm::dvec3 axes = axesOf(places);
        const double off = glm::length(mean(places) - middle);
        std::printf(
            "tension %.2f: axes %.3f %.3f %.3f m, longest over shortest %.3f; energy %.3f, grew from %.3f by "
            "%.1e "
            "at most; the middle moved by %.1e m, at %.1e m/s at most\n",
            tension, axes.x, axes.y, axes.z, axes.z / axes.x, energy(), first, grown, off, swing);
        EXPECT_LE(grown, 1e-6 + 1e-4 * std::abs(first));
        EXPECT_LT(off, 1e-3 * config.spacing);
        if (tension == 0.0f) { EXPECT_GT(axes.z / axes.x, 3.9); }
        if (tension > 0.0f) { EXPECT_LT(axes.z / axes.x, 1.15); }
    }
}

/// Rayleigh, "On the Capillary Phenomena of Jets" (Proc. R. Soc. 29, 1879): a ball of radius R that is pulled
/// long swings with the period 2 pi sqrt(R^3 / (8 tension)).
TEST_F(Fluid, DropsSwingAsRayleighHasIt) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "an experiment of half a minute: FIELDWRIGHT_LONG";
    double sum = 0.0;
    for (const float spacing : {0.13f, 0.1f, 0.08f}) {
        FluidConfig config{.spacing = spacing,
                           .lo = glm::vec3(-2.0f),
                           .hi = glm::vec3(2.0f),
                           .gravity = glm::vec3(0.0f),
                           .viscosity = 5.0f,
                           .tension = 0.3f};
        const double radius = 0.8, step = 1.0 / 240,
                     wanted =
                         2.0 * std::numbers::pi * std::sqrt(std::pow(radius, 3) / (8.0 * config.tension));
        std::vector<glm::vec3> places = fluidBlock(glm::vec3(-1.0f), glm::vec3(1.0f), spacing);
        std::erase_if(places, [&](const glm::vec3& p) { return glm::length(p) > radius; });
        FluidParticles fluid;
        setFluid(device(), fluid, places, {});
        run(fluid, config, 720, float(step));
        places = read(fluid.places, fluid.count);
        std::vector<glm::vec3> velocities;
        for (const glm::vec3& p : places) velocities.push_back(0.25f * glm::vec3(-p.x, -p.y, 2.0f * p.z));
        setFluid(device(), fluid, places, velocities);
        config.viscosity = 0.0f;
        // Half a period is from when it is round to when it is so again.
        const auto length = [&] {
            glm::dvec3 squares(0.0);
            for (const glm::dvec3 p : read(fluid.places, fluid.count)) squares += p * p;
            return std::log(2.0 * squares.z / (squares.x + squares.y));
        };
        const double round = length();
        double before = round, half = 0.0;
        for (int i = 4; i < 800 && half == 0.0; i += 4) {
            run(fluid, config, 4, float(step));
            const double now = length();
            if (before > round && now <= round) half = step * (i - 4 * (round - now) / (before - now));
            before = now;
        }
        std::printf("spacing %.2f: period %.2f s, %.2f of Rayleigh's\n", spacing, 2.0 * half,
                    2.0 * half / wanted);
        EXPECT_NEAR(2.0 * half / wanted, 1.0, 0.15);
        sum += 2.0 * half / wanted;
    }
    EXPECT_NEAR(sum / 3.0, 1.0, 0.1);
}

TEST_F(Fluid, TheCurlOfWhatTurnsIsTwiceItsTurning) {
    FluidParticles fluid;
    const FluidConfig config{
        .spacing = 0.1f, .gravity = glm::vec3(0.0f), .viscosity = 0.0f, .vorticity = 1.0f};
    const std::vector<glm::vec3> places = fluidBlock(glm::vec3(-0.8f), glm::vec3(0.8f), 0.1f);
    std::vector<glm::vec3> velocities;
    const glm::vec3 turning(0.3f, -0.2f, 0.5f);
    for (const glm::vec3& p : places) velocities.push_back(glm::cross(turning, p));
    setFluid(device(), fluid, places, velocities);
    run(fluid, config, 1, 1e-3f);
    const std::vector<glm::vec3> curls = read(fluid.curls, fluid.count), at = read(fluid.places, fluid.count);
    for (uint32_t i = 0; i < fluid.count; ++i)
        if (glm::all(glm::lessThan(glm::abs(at[i]), glm::vec3(0.5f)))) {
            EXPECT_LT(glm::distance(curls[i], 2.0f * turning), 0.1f);
        }
}

TEST_F(Fluid, VorticityKeepsASwirlAlive) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    // A vortex of Taylor and Green in a closed box, after two seconds.
    std::vector<double> left;
    for (const float vorticity : {0.0f, 1.0f, 3.0f}) {
        const FluidConfig config{.spacing = 0.05f,
                                 .lo = glm::vec3(-0.5f, -0.5f, 0.0f),
                                 .hi = glm::vec3(0.5f, 0.5f, 0.2f),
                                 .gravity = glm::vec3(0.0f),
                                 .viscosity = 0.5f,
                                 .vorticity = vorticity};
        FluidParticles fluid;
        setFluid(device(), fluid, fluidBlock(config.lo, config.hi, config.spacing), {});
        Commands commands(device());
        ASSERT_TRUE(recordSettling(commands, kernelsFor(), fluid, config));
        submit(commands);
        const std::vector<glm::vec3> places = read(fluid.places, fluid.count);
        std::vector<glm::vec3> velocities;
        for (const glm::vec3& p : places) {
            const glm::vec3 q = float(std::numbers::pi) * p;
            velocities.emplace_back(-std::cos(q.x) * std::sin(q.y), std::sin(q.x) * std::cos(q.y), 0.0f);
        }
        setFluid(device(), fluid, places, velocities);
        const double first = energyOf(fluid, config);
        run(fluid, config, 240, 1.0f / 120);
        left.push_back(energyOf(fluid, config) / first);
        std::printf("vorticity %.0f 1/s: %.3f of a vortex' energy is left after 2 s\n", vorticity,
                    left.back());
    }
    EXPECT_GT(left[1], 1.1 * left[0]);
    EXPECT_GT(left[2], left[1]);
    EXPECT_LT(left[2], 1.5);
}

TEST_F(Fluid, NothingGetsIntoAnObstacle) {
    const Program program = *compile(test::expressionGraph("length(p - vec3(0.1, 0.3, 0.0)) - 0.3"));
    const std::string obstacle = emitField(program);
    FluidParticles fluid;
    const FluidConfig config{
        .spacing = 0.06f, .lo = glm::vec3(-0.6f, 0.0f, -0.4f), .hi = glm::vec3(0.6f, 1.5f, 0.4f)};
    setFluid(device(), fluid, fluidBlock({-0.5f, 0.7f, -0.4f}, {0.5f, 1.3f, 0.4f}, 0.06f), {});
    const int steps = std::getenv("FIELDWRIGHT_LONG") ? 10'000 : 200;
    run(fluid, config, steps, 1.0f / 60, obstacle);
    float deepest = 1.0f;
    for (const glm::vec3& p : read(fluid.places, fluid.count)) {
        ASSERT_TRUE(std::isfinite(p.x + p.y + p.z));
        deepest = std::min(deepest, glm::distance(p, glm::vec3(0.1f, 0.3f, 0.0f)) - 0.3f);
    }
    std::printf("deepest in the obstacle: %.5f m\n", deepest);
    EXPECT_GT(deepest, -0.02f * config.spacing);
}

TEST_F(Fluid, AHoleLetsItThrough) {
    // A plate across the tank, with and without a hole; half a second.
    for (const bool hole : {false, true}) {
        const std::string plate = "abs(p.y - 0.5) - 0.08";
        const Program program =
            *compile(test::expressionGraph(hole ? "max(" + plate + ", 0.2 - length(p.xz))" : plate));
        const std::string obstacle = emitField(program);
        FluidParticles fluid;
        const FluidConfig config{
            .spacing = 0.05f, .lo = glm::vec3(-0.4f, 0.0f, -0.4f), .hi = glm::vec3(0.4f, 1.2f, 0.4f)};
        setFluid(device(), fluid, fluidBlock({-0.4f, 0.6f, -0.4f}, {0.4f, 1.0f, 0.4f}, 0.05f), {});
        run(fluid, config, 60, 1.0f / 120, obstacle);
        std::size_t below = 0;
        for (const glm::vec3& p : read(fluid.places, fluid.count)) below += p.y < 0.4f ? 1 : 0;
        std::printf("%zu of %u went through the plate %s a hole\n", below, fluid.count,
                    hole ? "with" : "without");
        if (hole) { EXPECT_GT(below, fluid.count / 10); }
        if (!hole) { EXPECT_EQ(below, 0u); }
    }
}

TEST_F(Fluid, NoneOneAndAllInAPlaceAndALongStep) {
    for (const std::vector<glm::vec3>& places :
         {std::vector<glm::vec3>{}, std::vector<glm::vec3>{glm::vec3(0.2f)},
          std::vector<glm::vec3>(500, glm::vec3(0.1f))})
        for (const float step : {1.0f / 60, 1.0f}) {
            FluidParticles fluid;
            setFluid(device(), fluid, places, {});
            run(fluid, {.spacing = 0.1f}, 20, step);
            for (const glm::vec3& p : read(fluid.places, fluid.count)) {
                ASSERT_TRUE(std::isfinite(p.x + p.y + p.z));
                ASSERT_TRUE(glm::all(glm::lessThanEqual(glm::abs(p), glm::vec3(1.0f))));
            }
        }
}

TEST_F(Fluid, ParticlesInOnePlacePart) {
    FluidParticles fluid;
    setFluid(device(), fluid, std::vector<glm::vec3>(30, glm::vec3(0.1f)), {});
    run(fluid, {.spacing = 0.1f, .gravity = glm::vec3(0.0f)}, 60, 1.0f / 60);
    const std::vector<glm::vec3> places = read(fluid.places, fluid.count);
    for (std::size_t i = 0; i < places.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) EXPECT_GT(glm::distance(places[i], places[j]), 0.01f);
}

TEST_F(Fluid, WhatCannotBeIsRefused) {
    const auto refusal = [](const FluidConfig& config, float step, uint32_t count = 1) {
        FluidParticles fluid;
        fluid.count = count;
        Commands commands(device());
        const Done recorded = recordFluidStep(commands, kernelsFor(), fluid, config, step);
        return recorded ? std::string("none") : recorded.error().message;
    };
    EXPECT_NE(refusal({.spacing = 0.0f}, 0.01f).find("greater than 0"), std::string::npos);
    EXPECT_NE(refusal({.spacing = NAN}, 0.01f).find("greater than 0"), std::string::npos);
    EXPECT_NE(refusal({}, 0.0f).find("greater than 0"), std::string::npos);
    EXPECT_NE(refusal({.lo = glm::vec3(1.0f), .hi = glm::vec3(-1.0f)}, 0.01f).find("greater than 0"),
              std::string::npos);
    EXPECT_NE(refusal({.spacing = 1e-4f}, 0.01f).find("more cells"), std::string::npos);
    EXPECT_NE(refusal({}, 0.01f, UINT32_MAX).find("particles at most"), std::string::npos);
}

}  // namespace fw::fluid_test
