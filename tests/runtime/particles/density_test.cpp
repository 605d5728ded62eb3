// Particles to densities on the device: sorting against the host's, each way against the formula.
#include "runtime/particles/density.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <numeric>
#include <optional>
#include <random>

#include "tests/support/gpu.h"

namespace fw::density_test {

using test::device;

/// Kernels of all tests.
std::optional<DensityKernels> kept;
class DensityOnDevice : public testing::Test {
  public:
    static void TearDownTestSuite() { kept.reset(); }
    DensityKernels& kernels() {
        if (!kept) kept = createDensityKernels(device());
        return *kept;
    }
};

std::vector<uint32_t> sortedOnDevice(const CountingSort& sort, const std::vector<uint32_t>& keys,
                                     uint32_t bound, std::vector<uint32_t>* starts = nullptr) {
    CountingSortBuffers buffers;
    Buffer given = createBuffer(device(), 4 * std::max<std::size_t>(keys.size(), 1)), order;
    upload(device(), given, keys);
    Commands commands(device());
    sortByKey(commands, sort, buffers, given, order, uint32_t(keys.size()), bound);
    submit(commands);
    if (starts) *starts = download<uint32_t>(device(), buffers.starts, bound);
    return download<uint32_t>(device(), order, keys.size());
}

TEST_F(DensityOnDevice, TheSortIsStable) {
    std::mt19937 random(3);
    for (const uint32_t items : {0u, 1u, 2u, 63u, 64u, 65u, 1000u, 4097u, 100'003u, 1'000'000u})
        for (const uint32_t bound : {1u, 7u, 4096u, 4097u, 300'000u}) {
            if (bound == 1 && items > 4097) continue;
            std::vector<uint32_t> keys(items), wanted(items), counts(bound + 1, 0);
            for (uint32_t& key : keys) key = std::min<uint32_t>(random() % bound, random() % bound);
            std::iota(wanted.begin(), wanted.end(), 0u);
            std::ranges::stable_sort(wanted, {}, [&](uint32_t i) { return keys[i]; });
            for (const uint32_t key : keys) ++counts[key + 1];
            std::partial_sum(counts.begin(), counts.end(), counts.begin());
            counts.pop_back();
            std::vector<uint32_t> starts;
            const std::vector<uint32_t> order = sortedOnDevice(kernels().sort, keys, bound, &starts);
            ASSERT_EQ(starts, counts) << items << " items, keys below " << bound;
            if (items / bound < 1000) {
                ASSERT_EQ(order, wanted) << items << " items, keys below " << bound;
            } else {
                for (std::size_t i = 1; i < order.size(); ++i) ASSERT_LE(keys[order[i - 1]], keys[order[i]]);
            }
        }
}

using Places = std::vector<glm::vec4>;

Places inBall(std::size_t count, float radius, uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
    Places places;
    while (places.size() < count) {
        const glm::vec3 p(unit(random), unit(random), unit(random));
        if (glm::length(p) < 1.0f) places.emplace_back(radius * p, 0.0f);
    }
    return places;
}

std::vector<float> densityOf(DensityKernels& kernels, const Places& places, const DensityConfig& config) {
    DensityBuffers buffers;
    Buffer particles = createBuffer(device(), std::max<std::size_t>(16 * places.size(), 16));
    upload(device(), particles, places);
    Commands commands(device());
    const Done recorded =
        recordDensity(commands, kernels, buffers, config, particles, uint32_t(places.size()));
    EXPECT_TRUE(recorded) << (recorded ? "" : recorded.error().message);
    submit(commands);
    const glm::ivec3 size = config.grid.size;
    const auto pitch = std::size_t((size.x + 3) / 4 * 4);
    const auto padded =
        download<float>(device(), buffers.density, pitch * std::size_t(size.y) * std::size_t(size.z));
    std::vector<float> density;
    for (std::size_t row = 0; row < std::size_t(size.y) * std::size_t(size.z); ++row)
        density.insert(density.end(), &padded[row * pitch], &padded[row * pitch] + size.x);
    return density;
}

/// The formula, in double.
std::vector<double> densityByFormula(const Places& places, const DensityConfig& config) {
    std::vector<double> density;
    const DensityGrid& grid = config.grid;
    for (int z = 0; z < grid.size.z; ++z)
        for (int y = 0; y < grid.size.y; ++y)
            for (int x = 0; x < grid.size.x; ++x) {
                const glm::dvec3 p = glm::dvec3(grid.origin) + double(grid.cell) * glm::dvec3(x, y, z);
                double sum = 0.0;
                for (const glm::vec4& place : places) {
                    const glm::dvec3 off = p - glm::dvec3(place);
                    const double s = 1.0 - glm::dot(off, off) / (double(config.radius) * config.radius);
                    if (s > 0.0) sum += s * s * s;
                }
                density.push_back(sum);
            }
    return density;
}

const DensityGrid kGrid{.origin = glm::vec3(-1.0f, -0.9f, -0.8f), .cell = 0.05f, .size = {41, 38, 35}};

double worstOf(const std::vector<float>& found, const std::vector<double>& wanted) {
    double worst = 0.0;
    for (std::size_t i = 0; i < wanted.size(); ++i) worst = std::max(worst, std::abs(found[i] - wanted[i]));
    return worst;
}

TEST_F(DensityOnDevice, ExactIsTheFormula) {
    Places apart = inBall(3000, 0.7f, 1), beyond = inBall(500, 3.0f, 2),
           one = {glm::vec4(0.1f, 0.2f, 0.3f, 0.0f)};
    Places together(200, glm::vec4(0.05f, 0.0f, 0.05f, 0.0f));
    Places broken = inBall(100, 0.5f, 4);
    for (std::size_t i = 0; i < broken.size(); i += 7) broken[i] = glm::vec4(NAN, 0.0f, INFINITY, 0.0f);
    for (const float radius : {0.03f, 0.2f, 0.6f})
        for (const Places& places : {apart, beyond, one, together, broken}) {
            const DensityConfig config{kGrid, radius, DensityMethod::exact};
            Places finite = places;
            std::erase_if(finite, [](const glm::vec4& p) { return !std::isfinite(p.x); });
            const std::vector<double> wanted = densityByFormula(finite, config);
            const double most = std::max(1.0, *std::ranges::max_element(wanted));
            EXPECT_LE(worstOf(densityOf(kernels(), places, config), wanted), 1e-5 * most) << radius;
        }
}

TEST_F(DensityOnDevice, ProxiesAndBlurAreNearIt) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    for (const float radius : {0.1f, 0.2f, 0.4f}) {
        const Places places = inBall(3000, 0.7f, 1);
        const std::vector<double> wanted = densityByFormula(places, {kGrid, radius, DensityMethod::exact});
        const double most = *std::ranges::max_element(wanted);
        for (const DensityMethod method : {DensityMethod::proxies, DensityMethod::blur}) {
            const std::vector<float> found = densityOf(kernels(), places, {kGrid, radius, method});
            double squares = 0.0;
            for (std::size_t i = 0; i < wanted.size(); ++i)
                squares += (found[i] - wanted[i]) * (found[i] - wanted[i]);
            const double mean = std::sqrt(squares / double(wanted.size())) / most;
            const double worst = worstOf(found, wanted) / most;
            std::printf("radius %.0f cells, %s: off by %.2f %% at most, %.2f %% on average, of the densest\n",
                        radius / kGrid.cell, method == DensityMethod::proxies ? "proxies" : "blur",
                        100 * worst, 100 * mean);
            EXPECT_LT(worst, 0.25);
            EXPECT_LT(mean, 0.06);
        }
    }
}

TEST_F(DensityOnDevice, TheSameBytesEachTime) {
    const Places places = inBall(20'000, 0.7f, 5);
    for (const DensityMethod method : {DensityMethod::exact, DensityMethod::proxies, DensityMethod::blur}) {
        const DensityConfig config{kGrid, 0.2f, method};
        const std::vector<float> first = densityOf(kernels(), places, config);
        for (int i = 0; i < 3; ++i) EXPECT_EQ(densityOf(kernels(), places, config), first);
    }
}

TEST_F(DensityOnDevice, WithoutParticlesThereIsNone) {
    for (const DensityMethod method : {DensityMethod::exact, DensityMethod::proxies, DensityMethod::blur})
        for (const float value : densityOf(kernels(), {}, {kGrid, 0.2f, method})) ASSERT_EQ(value, 0.0f);
}

TEST_F(DensityOnDevice, TooWideParticlesAreRefused) {
    DensityBuffers buffers;
    Buffer particles = createBuffer(device(), 16);
    for (const DensityMethod method : {DensityMethod::proxies, DensityMethod::blur}) {
        Commands commands(device());
        const Done recorded =
            recordDensity(commands, kernels(), buffers, {kGrid, 2.0f, method}, particles, 1);
        ASSERT_FALSE(recorded);
        EXPECT_NE(recorded.error().message.find("lower the resolution or the radius"), std::string::npos);
    }
}

TEST_F(DensityOnDevice, WhateverTheRadiusIs) {
    const Places places = {glm::vec4(0.0f)};
    const float none = std::nanf(""), endless = INFINITY;
    for (const DensityMethod method : {DensityMethod::exact, DensityMethod::proxies, DensityMethod::blur})
        for (const float radius :
             {0.0f, -1.0f, none, endless, 1e-45f, 1e-38f, 1e-20f, 1e-6f, 10.0f, 1e6f, 1e10f, 3e38f}) {
            const DensityConfig config{kGrid, radius, method};
            DensityBuffers buffers;
            Buffer particles = createBuffer(device(), 16);
            upload(device(), particles, places);
            Commands commands(device());
            const Done recorded = recordDensity(commands, kernels(), buffers, config, particles, 1);
            if (!recorded) {
                EXPECT_NE(recorded.error().message.find("radius"), std::string::npos);
                continue;
            }
            submit(commands);
            const auto pitch = std::size_t(kGrid.size.x + 3) / 4 * 4;
            for (const float value : download<float>(device(), buffers.density, pitch))
                ASSERT_TRUE(value >= 0.0f && value <= 1.0f) << radius;
        }
}

TEST_F(DensityOnDevice, ManyInOnePlaceAreAllCounted) {
    const Places places(150'000, glm::vec4(0.01f, 0.0f, -0.02f, 0.0f));
    const double many = double(places.size());
    for (const DensityMethod method : {DensityMethod::proxies, DensityMethod::blur}) {
        const DensityConfig config{kGrid, 0.2f, method};
        const double allowed = method == DensityMethod::proxies ? 1e-3 : 0.25;
        std::vector<double> wanted = densityByFormula({places[0]}, config);
        for (double& each : wanted) each *= many;
        EXPECT_LT(worstOf(densityOf(kernels(), places, config), wanted), allowed * many);
    }
}

TEST_F(DensityOnDevice, FarFromTheOriginAsWell) {
    // Where floats are a quarter of a metre apart, as in the coordinates of surveys.
    const glm::vec3 far(500'000.0f, 4'000'000.0f, 120.0f);
    const DensityGrid grid{.origin = far - 10.0f, .cell = 0.5f, .size = {41, 41, 41}};
    Places places = inBall(2000, 12.0f, 8);
    for (glm::vec4& place : places) place += glm::vec4(far, 0.0f);
    for (const float radius : {0.7f, 2.0f, 30.0f})
        for (const float value : densityOf(kernels(), places, {grid, radius, DensityMethod::exact}))
            ASSERT_TRUE(value >= 0.0f && value <= 2000.0f) << radius;
}

TEST(BlurWeights, AreThoseWhoseProductsAreNearest) {
    for (const double radius : {1.0, 2.5, 4.0, 9.3}) {
        const std::vector<float> w = blurWeights(radius);
        const int reach = int(std::ceil(radius));
        ASSERT_EQ(w.size(), std::size_t(reach) + 1);
        const auto squares = [&](std::size_t changed, double by) {
            double sum = 0.0;
            const auto at = [&](int i) {
                return w[std::size_t(std::abs(i))] + (std::size_t(std::abs(i)) == changed ? by : 0.0);
            };
            for (int i = -reach; i <= reach; ++i)
                for (int j = -reach; j <= reach; ++j)
                    for (int k = -reach; k <= reach; ++k) {
                        const double s = std::max(1.0 - (i * i + j * j + k * k) / (radius * radius), 0.0);
                        const double off = at(i) * at(j) * at(k) - s * s * s;
                        sum += off * off;
                    }
            return sum;
        };
        for (std::size_t i = 0; i < w.size(); ++i)
            for (const double by : {-1e-3, 1e-3})
                EXPECT_GT(squares(i, by), squares(i, 0.0)) << radius << " " << i;
    }
}

}  // namespace fw::density_test
