// Particles as fields on the device: distances of one, densities' surfaces of many, bounds, against the host.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <random>

#include "graph/document/json.h"
#include "runtime/particles/particle_volume.h"
#include "tests/support/device_field.h"
#include "tests/support/gpu.h"
#include "tests/support/graph/volume_intervals.h"

namespace fw::particle_field_test {

using test::device;

std::optional<ParticleVolumeKernels> kept;
class ParticleFieldOnDevice : public testing::Test {
  public:
    static void TearDownTestSuite() { kept.reset(); }
    static ParticleVolumeKernels& kernels() {
        if (!kept) kept = createParticleVolumeKernels(device());
        return *kept;
    }
};

/// A program whose field is of particles in the box from -1 to 1.
Program programOf(int resolution) {
    const std::string text =
        R"({"fieldwright": 1, "nodes": [{"id": "rain", "type": "emitter"},
        {"id": "field", "type": "particles_to_field", "inputs": {"particles": {"from": "rain"}, "region_min": [-1, -1, -1],
            "region_max": [1, 1, 1], "resolution": )" +
        std::to_string(resolution) + R"(}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "field"}}}]})";
    return *compile(*parseGraph(text, "test.field.json", nullptr));
}

FieldVolumePtr made(const FieldVolume& unmade, const std::vector<glm::vec4>& places, double radius,
                    double threshold, DensityMethod method = DensityMethod::exact,
                    bool trueDistance = false) {
    Buffer particles = createBuffer(device(), 16 * std::max<std::size_t>(places.size(), 1)),
           volumes = createBuffer(device(), kTexelBytes * texelCount(unmade));
    upload(device(), particles, places);
    ParticleVolumeBuffers buffers;
    Commands commands(device());
    const Done recorded = recordParticleVolume(commands, ParticleFieldOnDevice::kernels(), buffers,
                                               {.grid = unmade.grid,
                                                .numbers = {radius, threshold, 0.0},
                                                .method = method,
                                                .trueDistance = trueDistance},
                                               particles, uint32_t(places.size()), volumes, 0);
    if (!recorded) throw SystemError(recorded.error().message);
    submit(commands);
    return downloadVolume(device(), unmade, volumes, 0);
}

std::vector<glm::vec4> splash(std::size_t count, float reach, uint32_t seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> near(0.0f, reach);
    std::vector<glm::vec4> places;
    while (places.size() < count) {
        const glm::vec3 p(near(random), near(random), near(random));
        if (glm::length(p) < 0.8f) places.emplace_back(p, 0.0f);
    }
    return places;
}

TEST_F(ParticleFieldOnDevice, OneIsABallWithItsDistances) {
    const Program program = programOf(96);
    const FieldVolume& unmade = *program.ir.volumes()[0];
    const glm::dvec3 middle(0.113, -0.071, 0.052);
    for (const double threshold : {0.1, 0.3, 0.6}) {
        const double radius = 0.4, ball = radius * std::sqrt(1.0 - std::cbrt(threshold));
        const FieldVolumePtr volume = made(unmade, {glm::vec4(middle, 0.0f)}, radius, threshold);
        std::mt19937 random(3);
        std::uniform_real_distribution<double> unit(-0.95, 0.95);
        double worstNear = 0.0, worstSlope = 0.0, nearestFar = 1.0;
        for (int i = 0; i < 20'000; ++i) {
            const glm::dvec3 p(unit(random), unit(random), unit(random));
            const double exact = glm::length(p - middle) - ball;
            const VolumeSample sample = sampleVolume(volume->layers[0], p);
            if (exact > 0.0) { EXPECT_LT(sample.value, exact + unmade.grid.cell) << exact; }
            EXPECT_EQ(sample.value < 0.0, exact < 0.0) << exact;
            if (std::abs(exact) < 0.05) {
                worstNear = std::max(worstNear, std::abs(sample.value - exact) * (exact > 0.0 ? 1.0 : 0.2));
                worstSlope = std::max(worstSlope, std::abs(glm::length(sample.gradient) - 1.0));
            }
            if (exact > 0.3) nearestFar = std::min(nearestFar, sample.value / exact);
        }
        std::printf(
            "threshold %.1f: distances near the surface off by %.5f m at most, slopes by %.4f; far away at "
            "least %.2f of "
            "the distance\n",
            threshold, worstNear, worstSlope, nearestFar);
        EXPECT_LT(worstNear, 0.1 * unmade.grid.cell);
        EXPECT_GT(nearestFar, 0.2);
    }
}

TEST_F(ParticleFieldOnDevice, TheSurfaceOfManyIsWhereTheDensityIsTheThreshold) {
    const Program program = programOf(64);
    const FieldVolume& unmade = *program.ir.volumes()[0];
    const double radius = 0.16, threshold = 0.8;
    const std::vector<glm::vec4> places = splash(600, 0.3f, 5);
    const auto density = [&](const glm::dvec3& p) {
        double sum = 0.0;
        for (const glm::vec4& each : places) {
            const glm::dvec3 off = p - glm::dvec3(each);
            const double s = std::max(1.0 - glm::dot(off, off) / (radius * radius), 0.0);
            sum += s * s * s;
        }
        return sum;
    };
    const FieldVolumePtr volume = made(unmade, places, radius, threshold);
    for (std::size_t i = 0; i < unmade.grid.samples(); i += 37) {
        const int x = int(i) % unmade.grid.size.x, rest = int(i) / unmade.grid.size.x;
        const double wanted =
            density(unmade.grid.place({x, rest % unmade.grid.size.y, rest / unmade.grid.size.y}));
        const float value = std::bit_cast<float>(volume->words[2 * i]);
        if (std::abs(wanted - threshold) > 1e-3) {
            EXPECT_EQ(value<0.0f, wanted> threshold) << wanted << ' ' << value;
        }
    }
    // What blocks say is what the host finds in the samples.
    const std::vector<uint32_t> blocks =
        blockRanges(unmade.grid, std::span(volume->words).first(2 * unmade.grid.samples()));
    ASSERT_EQ(volume->words.size(), 2 * unmade.grid.samples() + blocks.size());
    std::size_t count = 0;
    for (const glm::ivec3& level : blockLevels(unmade.grid))
        count += std::size_t(level.x * level.y * level.z);
    for (std::size_t i = 0; i < 2 * count; ++i)
        ASSERT_EQ(std::bit_cast<float>(volume->words[2 * unmade.grid.samples() + i]),
                  std::bit_cast<float>(blocks[i]))
            << i;
    std::mt19937 random(9);
    test::expectIntervalsContain(*volume, 2'000, 0.3, random);
}

TEST_F(ParticleFieldOnDevice, TrueDistancesAreThoseEverywhere) {
    const Program program = programOf(80);
    const FieldVolume& unmade = *program.ir.volumes()[0];
    const double radius = 0.4, threshold = 0.3, ball = radius * std::sqrt(1.0 - std::cbrt(threshold));
    const std::vector<glm::vec4> places = {{0.4f, 0.1f, 0.2f, 0}, {-0.45f, 0, -0.1f, 0}};  // too far to meet
    const FieldVolumePtr volume = made(unmade, places, radius, threshold, DensityMethod::exact, true);
    double worst = 0.0, slopes = 0.0;
    for (std::size_t i = 0; i < unmade.grid.samples(); i += 7) {
        const int x = int(i) % unmade.grid.size.x, rest = int(i) / unmade.grid.size.x;
        const glm::dvec3 p = unmade.grid.place({x, rest % unmade.grid.size.y, rest / unmade.grid.size.y});
        double exact = 1e9;
        for (const glm::vec4& each : places)
            exact = std::min(exact, glm::distance(p, glm::dvec3(each)) - ball);
        worst = std::max(worst, std::abs(std::bit_cast<float>(volume->words[2 * i]) - exact));
        if (std::abs(exact) > 0.02 && exact > 0.1 - ball)
            slopes =
                std::max(slopes, std::abs(glm::length(sampleVolume(volume->layers[0], p).gradient) - 1.0));
    }
    std::printf("true distances off by %.4f cells at most, slopes by %.4f\n", worst / unmade.grid.cell,
                slopes);
    EXPECT_LT(worst, 0.5 * unmade.grid.cell);
    EXPECT_LT(slopes, 0.01);
    std::mt19937 random(9);
    test::expectIntervalsContain(*volume, 1'000, 0.3, random);
    const FieldVolumePtr none = made(unmade, {}, radius, threshold, DensityMethod::exact, true);
    EXPECT_GT(std::bit_cast<float>(none->words[0]), 1e3f);
}

TEST_F(ParticleFieldOnDevice, TheDeviceReadsItAsTheHostDoes) {
    Program program = programOf(40);
    for (const int many : {0, 1, 300}) {
        const FieldVolumePtr volume =
            made(*program.ir.volumes()[0], splash(std::size_t(many), 0.4f, 8), 0.2, 0.4);
        program.ir.replaceVolume(0, volume);
        std::mt19937 random(2);
        std::uniform_real_distribution<float> unit(-1.5f, 1.5f);
        std::vector<std::array<float, 3>> points;
        for (int i = 0; i < 3000; ++i) points.push_back({unit(random), unit(random), unit(random)});
        for (const float half : {0.01f, 0.1f, 0.6f}) {
            const std::vector<test::FieldSample> samples = test::evaluateOnDevice(program, points, half);
            for (std::size_t i = 0; i < points.size(); ++i) {
                const Point p{points[i][0], points[i][1], points[i][2]};
                const double value = evaluate(program.ir, program.distance(), {}, p);
                ASSERT_NEAR(samples[i].value, value, 2e-5 * (1.0 + std::abs(value))) << i;
                const Box box{{p[0] - half, p[1] - half, p[2] - half},
                              {p[0] + half, p[1] + half, p[2] + half}};
                const Interval range = evaluateInterval(program.ir, program.distance(), {}, box);
                ASSERT_LE(samples[i].interval[0], range.lo + 1e-6 * (1.0 + std::abs(range.lo))) << i;
                ASSERT_GE(samples[i].interval[1],
                          std::min(range.hi, 1e30) * (range.hi > 0 ? 1 - 1e-6 : 1) - 1e-6)
                    << i;
                ASSERT_GE(samples[i].interval[0],
                          range.lo - 0.5 * volume->grid.cell * (1.0 + std::abs(range.lo)))
                    << i;
            }
        }
    }
}

TEST_F(ParticleFieldOnDevice, MoreThanTheDeviceCanBindIsRefused) {
    const uint64_t most = device().limits.storageRange;
    if (most > 1u << 30) GTEST_SKIP() << "this device can bind more than is good for a test";
    const Program program = programOf(16);
    Buffer particles = createBuffer(device(), 16), volumes = createBuffer(device(), most + 16);
    ParticleVolumeBuffers buffers;
    Commands commands(device());
    const Done recorded = recordParticleVolume(
        commands, kernels(), buffers, {.grid = program.ir.volumes()[0]->grid}, particles, 1, volumes, 0);
    ASSERT_FALSE(recorded);
    EXPECT_NE(recorded.error().message.find("lower the resolution"), std::string::npos)
        << recorded.error().message;
}

TEST_F(ParticleFieldOnDevice, TheBorderIsClosedAndNoneIsEmpty) {
    const Program program = programOf(24);
    const FieldVolume& unmade = *program.ir.volumes()[0];
    for (const DensityMethod method : {DensityMethod::blur, DensityMethod::exact, DensityMethod::proxies}) {
        std::vector<glm::vec4> everywhere;
        for (int i = 0; i < 13; ++i)
            for (int j = 0; j < 13; ++j)
                for (int k = 0; k < 13; ++k)
                    everywhere.emplace_back(0.2f * glm::vec3(i - 6, j - 6, k - 6), 0.0f);
        const FieldVolumePtr full = made(unmade, everywhere, 0.3, 0.5, method),
                             none = made(unmade, {}, 0.3, 0.5, method);
        for (int i = 0; i < unmade.grid.size.x; ++i)
            for (int j = 0; j < unmade.grid.size.y; ++j)
                for (int k = 0; k < unmade.grid.size.z; ++k) {
                    const glm::ivec3 at(i, j, k), end = unmade.grid.size - 1;
                    const bool border =
                        glm::any(glm::equal(at, glm::ivec3(0))) || glm::any(glm::equal(at, end));
                    const std::size_t index = 2 * unmade.grid.index(i, j, k);
                    // Only the exact way knows of particles beyond the grid.
                    const bool beside = glm::any(glm::lessThan(glm::min(at, end - at), glm::ivec3(4)));
                    if (border || !beside || method == DensityMethod::exact) {
                        ASSERT_EQ(std::bit_cast<float>(full->words[index]) < 0.0f, !border)
                            << i << ' ' << j << ' ' << k;
                    }
                    ASSERT_GT(std::bit_cast<float>(none->words[index]), 100.0f);
                }
    }
}

}  // namespace fw::particle_field_test
