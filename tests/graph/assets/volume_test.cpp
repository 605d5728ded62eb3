// Volumes: a sample's value and gradient, what intervals contain, what lies beyond the grid.
#include "graph/assets/volume.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "graph/assets/image.h"
#include "tests/support/graph/volume_intervals.h"

namespace fw::volume_test {

/// A volume of a distance with its gradient.
template <class Distance, class Gradient>
FieldVolumePtr volumeOf(const VolumeGrid& grid, Distance distance, Gradient gradient) {
    std::vector<float> distances;
    std::vector<glm::vec3> gradients;
    for (int z = 0; z < grid.size.z; ++z)
        for (int y = 0; y < grid.size.y; ++y)
            for (int x = 0; x < grid.size.x; ++x) {
                const glm::dvec3 p = grid.place({x, y, z});
                distances.push_back(float(distance(p)));
                gradients.emplace_back(gradient(p));
            }
    return std::make_shared<FieldVolume>(grid, distances, gradients);
}
const VolumeGrid kGrid{{-1.3, -1.2, -1.5}, 0.1, {27, 25, 31}};

double ball(const glm::dvec3& p) { return glm::length(p) - 0.8; }
glm::dvec3 outwards(const glm::dvec3& p) {
    const double length = glm::length(p);
    return length > 0.0 ? p / length : glm::dvec3(0.0);
}
FieldVolumePtr ballVolume() { return volumeOf(kGrid, ball, outwards); }

std::vector<glm::dvec3> randomPlaces(int count, double reach) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(-reach, reach);
    std::vector<glm::dvec3> places(static_cast<std::size_t>(count));
    for (glm::dvec3& p : places) p = {unit(random), unit(random), unit(random)};
    return places;
}

TEST(Volume, ItPassesThroughItsSamples) {
    const FieldVolumePtr volume = ballVolume();
    for (const glm::ivec3 at : {glm::ivec3(1, 1, 1), glm::ivec3(3, 7, 9), glm::ivec3(26, 24, 30)}) {
        const glm::dvec3 p = kGrid.place(at);
        for (const int channel : {tricubicChannel, trilinearChannel})
            EXPECT_NEAR(sampleVolume(volume->layers[std::size_t(channel)], p).value, ball(p), 1e-6);
        const glm::dvec3 gradient = sampleVolume(volume->layers[tricubicChannel], p - 1e-9).gradient;
        EXPECT_LT(glm::length(gradient - outwards(p)), 0.004);
    }
}

TEST(Volume, APlaneIsExact) {
    const glm::dvec3 n = glm::normalize(glm::dvec3(1.0, -2.0, 0.5));
    const FieldVolumePtr volume = volumeOf(
        kGrid, [&](const glm::dvec3& p) { return glm::dot(n, p) - 0.3; },
        [&](const glm::dvec3&) { return n; });
    for (const glm::dvec3& p : randomPlaces(2'000, 1.2))
        for (const int channel : {tricubicChannel, trilinearChannel}) {
            const VolumeSample sample = sampleVolume(volume->layers[std::size_t(channel)], p);
            EXPECT_NEAR(sample.value, glm::dot(n, p) - 0.3, 1e-4);  // gradients have ten bits
            EXPECT_LT(glm::length(sample.gradient - n), 0.005);
        }
}

TEST(Volume, TricubicIsFarNearerToABallThanTrilinear) {
    const FieldVolumePtr volume = ballVolume();
    double cubic = 0.0, flat = 0.0;
    for (const glm::dvec3& p : randomPlaces(20'000, 1.2)) {
        if (glm::length(p) < 0.4) continue;
        cubic = std::max(cubic, std::abs(sampleVolume(volume->layers[tricubicChannel], p).value - ball(p)));
        flat = std::max(flat, std::abs(sampleVolume(volume->layers[trilinearChannel], p).value - ball(p)));
    }
    EXPECT_LT(cubic, 0.0006);
    EXPECT_GT(flat, 0.004);
}

TEST(Volume, GradientsAreThoseOfTheValues) {
    const FieldVolumePtr volume = ballVolume();
    constexpr double h = 1e-6;
    int compared = 0;
    for (const glm::dvec3& p : randomPlaces(4'000, 2.2))
        for (const int channel : {tricubicChannel, trilinearChannel}) {
            const VolumeLayer& layer = volume->layers[std::size_t(channel)];
            const VolumeSample sample = sampleVolume(layer, p);
            for (int axis = 0; axis < 3; ++axis) {
                glm::dvec3 step(0.0);
                step[axis] = h;
                const double slope =
                    (sampleVolume(layer, p + step).value - sampleVolume(layer, p - step).value) / (2.0 * h);
                const double cells = (p[axis] - kGrid.origin[axis]) / kGrid.cell;
                if (std::abs(cells - std::round(cells)) < 1e-4) continue;  // a trilinear kink
                ASSERT_NEAR(sample.gradient[axis], slope, 1e-4) << p.x << " " << p.y << " " << p.z;
                ++compared;
            }
        }
    EXPECT_GT(compared, 20'000);
}

TEST(Volume, BeyondTheGridItIsABoundThatIsContinuous) {
    const FieldVolumePtr volume = ballVolume();
    const VolumeLayer& layer = volume->layers[tricubicChannel];
    double least = 1.0;
    for (const glm::dvec3& p : randomPlaces(20'000, 6.0)) {
        const double value = sampleVolume(layer, p).value, wanted = ball(p);
        ASSERT_LE(value, wanted + 0.001);
        if (wanted > 0.5) least = std::min(least, value / wanted);
        // The nearest point of the grid, from both sides.
        const glm::dvec3 hi = kGrid.place(kGrid.size - 1), q = glm::clamp(p, kGrid.origin, hi);
        ASSERT_NEAR(sampleVolume(layer, q).value, sampleVolume(layer, q + 1e-7 * (p - q)).value, 1e-6);
    }
    EXPECT_GT(least, 0.7);
    EXPECT_GT(sampleVolume(layer, {1e12, 0.0, 0.0}).value, 9.99e11);
    EXPECT_TRUE(std::isfinite(sampleVolume(layer, {NAN, 0.0, 0.0}).value));
}

TEST(Volume, IntervalsContainEverySample) {
    std::mt19937 random(7);
    EXPECT_LT(test::expectIntervalsContain(*ballVolume(), 3'000, 0.3, random), 0.01);
}

TEST(Volume, IntervalsHoldForTheRoughestDistances) {
    // To a few points closer than the samples are, so that each corner of a cell has a nearest point of its
    // own.
    std::mt19937 random(8);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (int n = 0; n < 300; ++n) {
        const double sign = n % 2 == 0 ? 1.0 : -1.0, spread = 1.0 + n % 3;
        std::vector<glm::dvec3> points(2 + std::size_t(n) % 9);
        for (glm::dvec3& p : points) p = spread * glm::dvec3(unit(random), unit(random), unit(random));
        const auto nearest = [&](const glm::dvec3& p) {
            return *std::ranges::min_element(points, {},
                                             [&](const glm::dvec3& q) { return glm::distance(p, q); });
        };
        const VolumeGrid grid{glm::dvec3(-1.5), 1.0, glm::ivec3(4)};
        const auto distance = [&](const glm::dvec3& p) { return sign * glm::distance(p, nearest(p)); };
        const auto gradient = [&](const glm::dvec3& p) { return sign * outwards(p - nearest(p)); };
        // Within the grid: at the border of one that was made of a mesh, distances are positive.
        test::expectIntervalsContain(*volumeOf(grid, distance, gradient), 40, 0.0, random);
        if (testing::Test::HasFailure()) return;
    }
}

TEST(Volume, ColorsAreLinearLightBetweenSamples) {
    const VolumeGrid grid{{0.0, 0.0, 0.0}, 1.0, {2, 2, 3}};
    const std::vector<float> distances(12, 1.0f);
    const std::vector<glm::vec3> gradients(12, glm::vec3(0.0f));
    std::vector<uint32_t> colors(12, 0x000000);
    for (std::size_t i = 0; i < 12; i += 2)
        colors[i + 1] = 0x4080FF;  // at x = 1: red 255, green 128, blue 64
    const FieldVolume volume(grid, distances, gradients, colors);
    ASSERT_TRUE(volume.colored());
    EXPECT_NEAR(sampleVolume(volume.layers[redChannel], {1.0, 0.5, 1.5}).value, 1.0, 1e-12);
    EXPECT_NEAR(sampleVolume(volume.layers[redChannel], {0.25, 0.5, 1.5}).value, 0.25, 1e-12);
    EXPECT_NEAR(sampleVolume(volume.layers[greenChannel], {1.0, 0.0, 2.0}).value, decodeSrgb(128 / 255.0),
                1e-12);
    EXPECT_NEAR(sampleVolume(volume.layers[blueChannel], {9.0, 0.0, 2.0}).value, decodeSrgb(64 / 255.0),
                1e-12);
    EXPECT_EQ(sampleVolume(volume.layers[blueChannel], {9.0, 0.0, 2.0}).gradient.x, 0.0);
}

TEST(Volume, TheDevicesTexelsHoldEachSampleWithTheNext) {
    const FieldVolumePtr volume = ballVolume();
    const std::vector<uint32_t> texels = volumeTexels({volume, volume});
    ASSERT_EQ(texels.size(), 8 * texelCount(*volume));
    const std::size_t at = volume->grid.index(4, 5, 6);
    for (const std::size_t first : {std::size_t(0), texelCount(*volume)})
        for (std::size_t k = 0; k < 4; ++k)
            EXPECT_EQ(texels[4 * (first + at) + k], volume->words[2 * at + k]);
    EXPECT_EQ(volumeTexels({}).size(), 4u);
}

}  // namespace fw::volume_test
