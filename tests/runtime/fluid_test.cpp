// The fluid on the device: neighbours against all pairs, densities against sums in double, what must be kept,
// walls.
#include "runtime/particles/fluid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <numbers>
#include <random>
#include <set>

#include "graph/compile.h"
#include "graph/glsl.h"
#include "tests/support/expression_graph.h"
#include "tests/support/gpu.h"

namespace fw {
namespace {

using test::device;

/// By the obstacle's text, of all tests.
std::map<std::string, FluidKernels> kept;
class Fluid : public testing::Test {
  public:
    static void TearDownTestSuite() { kept.clear(); }
};
const FluidKernels& kernelsFor(const std::string& obstacle = {}) {
    const auto found = kept.find(obstacle);
    return found != kept.end() ? found->second
                               : kept.emplace(obstacle, createFluidKernels(device(), obstacle)).first->second;
}

struct State {
    std::vector<glm::vec3> places, velocities;
};
std::vector<glm::vec3> read(const Buffer& buffer, uint32_t count) {
    std::vector<glm::vec3> list;
    for (const glm::vec4& each : download<glm::vec4>(device(), buffer, count)) list.emplace_back(each);
    return list;
}

/// So many steps at once, in recordings of some.
void run(FluidParticles& fluid, const FluidConfig& config, int steps, float step,
         const std::string& obstacle = {}) {
    for (int done_ = 0; done_ < steps;) {
        Commands commands(device());
        for (int i = 0; i < 20 && done_ < steps; ++i, ++done_) {
            const Done recorded = recordFluidStep(commands, kernelsFor(obstacle), fluid, config, step);
            ASSERT_TRUE(recorded) << recorded.error().message;
        }
        submit(commands);
    }
}

std::vector<glm::vec3> randomPlaces(std::size_t count, float reach, uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(-reach, reach);
    std::vector<glm::vec3> places(count);
    for (glm::vec3& p : places) p = {unit(random), unit(random), unit(random)};
    return places;
}

TEST_F(Fluid, NeighboursAreThoseOfAllPairs) {
    const FluidConfig config{.spacing = 0.1f, .gravity = glm::vec3(0.0f), .iterations = 1};
    std::vector<glm::vec3> together(90, glm::vec3(0.3f)), oneCell = randomPlaces(80, 0.04f, 2);
    for (const std::vector<glm::vec3>& places :
         {randomPlaces(1500, 1.0f, 1), fluidBlock(glm::vec3(-0.5f), glm::vec3(0.5f), 0.1f), together, oneCell,
          std::vector<glm::vec3>{glm::vec3(0.1f)},
          std::vector<glm::vec3>{glm::vec3(-1.0f), glm::vec3(1.0f)}}) {
        FluidParticles fluid;
        setFluid(device(), fluid, places, {});
        Commands commands(device());
        ASSERT_TRUE(recordFluidStep(commands, kernelsFor(), fluid, config, 1e-4f));
        submit(commands);
        // The weighed guesses are those that the lists were made of, for there was one turn.
        const std::vector<glm::vec3> at = read(fluid.weighed, fluid.count);
        const auto counts = download<uint32_t>(device(), fluid.counts, fluid.count);
        const auto lists = download<uint32_t>(device(), fluid.lists, std::size_t(96) * fluid.count);
        const float support = kFluidSupport * config.spacing;
        for (uint32_t i = 0; i < fluid.count; ++i) {
            std::set<uint32_t> found, wanted;
            for (uint32_t k = 0; k < counts[i]; ++k) found.insert(lists[std::size_t(k) * fluid.count + i]);
            for (uint32_t j = 0; j < fluid.count; ++j) {
                const float far = glm::distance(glm::dvec3(at[i]), glm::dvec3(at[j]));
                if (j == i || far > support * 1.000001f) continue;
                if (far < support * 0.999999f || found.contains(j)) wanted.insert(j);
            }
            ASSERT_EQ(found.size(), counts[i]);
            ASSERT_EQ(found, wanted) << i << " of " << fluid.count;
        }
    }
}

/// Wendland's C2 with support 1.
double wendland(double r) {
    const double u = std::max(1.0 - r, 0.0);
    return 21.0 / (2.0 * std::numbers::pi) * u * u * u * u * (4.0 * r + 1.0);
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
    EXPECT_NEAR(lattice, 1.0, 0.02);
    FluidParticles fluid;
    const FluidConfig config{.spacing = 0.1f, .gravity = glm::vec3(0.0f), .iterations = 1};
    setFluid(device(), fluid, fluidBlock(glm::vec3(-1.0f), glm::vec3(1.0f), 0.1f), {});
    run(fluid, config, 1, 1e-4f);
    const std::vector<glm::vec3> at = read(fluid.weighed, fluid.count);
    const auto densities = download<float>(device(), fluid.densities, fluid.count);
    double least = 1e9, most = 0.0;
    for (uint32_t i = 0; i < fluid.count; ++i) {
        const bool inner = glm::all(glm::lessThan(glm::abs(at[i]), glm::vec3(0.72f)));
        if (inner) { EXPECT_NEAR(densities[i], lattice, 1e-4); }
        const bool beside = !inner && glm::abs(at[i].y) < 0.72f && glm::abs(at[i].z) < 0.72f;
        if (beside)
            least = std::min(least, double(densities[i])), most = std::max(most, double(densities[i]));
    }
    std::printf("density in a full lattice %.4f, beside a wall %.4f to %.4f\n", lattice, least, most);
    EXPECT_GT(least, 0.95);
    EXPECT_LT(most, 1.06);
}

TEST_F(Fluid, MomentumIsKeptAndFallsAreFree) {
    std::vector<glm::vec3> places = fluidBlock(glm::vec3(-0.4f), glm::vec3(0.0f), 0.05f);
    const std::size_t first = places.size();
    for (const glm::vec3& p : fluidBlock(glm::vec3(0.03f), glm::vec3(0.4f), 0.045f))
        places.push_back(p);  // too dense
    std::vector<glm::vec3> velocities(places.size(), glm::vec3(0.3f, 0.1f, 0.0f));
    for (std::size_t i = first; i < places.size(); ++i) velocities[i] = glm::vec3(-0.6f, 0.2f, 0.1f);
    for (const float gravity : {0.0f, -9.81f}) {
        FluidParticles fluid;
        setFluid(device(), fluid, places, velocities);
        const FluidConfig config{.spacing = 0.05f,
                                 .lo = glm::vec3(-5.0f),
                                 .hi = glm::vec3(5.0f),
                                 .gravity = glm::vec3(0.0f, gravity, 0.0f),
                                 .viscosity = 0.1f,
                                 .tension = 5.0f};
        glm::dvec3 before(0.0), after(0.0);
        double sizes = 0.0;
        for (const glm::vec3& v : velocities) before += v, sizes += glm::length(v);
        run(fluid, config, 30, 1.0f / 120);
        before.y += double(places.size()) * gravity * 30.0 / 120;
        sizes += double(places.size()) * std::abs(gravity) * 30.0 / 120;
        for (const glm::vec3& v : read(fluid.velocities, fluid.count)) after += v;
        EXPECT_EQ(fluid.count, places.size());
        EXPECT_LT(glm::length(after - before), 3e-5 * sizes) << gravity;
    }
}

TEST_F(Fluid, TheSameBytesEachTime) {
    std::vector<float> first;
    for (int i = 0; i < 3; ++i) {
        FluidParticles fluid;
        setFluid(device(), fluid, randomPlaces(3000, 0.6f, 7), {});
        run(fluid, {.spacing = 0.06f}, 20, 1.0f / 60);
        const auto places = download<float>(device(), fluid.places, 4 * std::size_t(fluid.count));
        if (i == 0) first = places;
        EXPECT_EQ(places, first);
    }
}

/// Settled water: the greatest speed, the height that 95 % are below, the mean density in its middle.
TEST_F(Fluid, WaterComesToRestInATank) {
    const float spacing = 0.05f;
    FluidParticles fluid;
    const FluidConfig config{.spacing = spacing,
                             .lo = glm::vec3(-0.5f, 0.0f, -0.3f),
                             .hi = glm::vec3(0.5f, 1.5f, 0.3f),
                             .viscosity = 0.1f};
    setFluid(device(), fluid, fluidBlock({-0.5f, 0.0f, -0.3f}, {0.0f, 0.8f, 0.3f}, spacing), {});
    run(fluid, config, 600, 1.0f / 120);
    const std::vector<glm::vec3> places = read(fluid.places, fluid.count),
                                 velocities = read(fluid.velocities, fluid.count);
    const auto densities = download<float>(device(), fluid.densities, fluid.count);
    std::vector<float> heights;
    double fastest = 0.0, sum = 0.0;
    std::size_t inner = 0;
    const std::vector<glm::vec3> weighed = read(fluid.weighed, fluid.count);
    for (uint32_t i = 0; i < fluid.count; ++i) {
        ASSERT_TRUE(glm::all(glm::greaterThanEqual(places[i], config.lo)) &&
                    glm::all(glm::lessThanEqual(places[i], config.hi)));
        heights.push_back(places[i].y);
        fastest = std::max(fastest, double(glm::length(velocities[i])));
        if (weighed[i].y > 0.1f && weighed[i].y < 0.3f) sum += densities[i], ++inner;
    }
    std::ranges::sort(heights);
    const double top = heights[heights.size() * 98 / 100] + 0.5 * spacing;
    std::printf("water at rest: surface at %.3f m (0.4 wanted), density %.4f, fastest %.3f m/s\n", top,
                sum / double(inner), fastest);
    EXPECT_NEAR(sum / double(inner), 1.0, 0.03);
    EXPECT_NEAR(top, 0.4, 0.03);
    EXPECT_LT(fastest, 0.3);
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

}  // namespace
}  // namespace fw
