// Surfaces about particles (runtime/particles/particle_surface.h) on the device: against their formulas in
// double, and what they are for: round drops, flat faces, the right volume.
#include "runtime/particles/particle_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <random>

#include "runtime/measure/mesh_report.h"
#include "runtime/particles/particle_volume.h"
#include "runtime/play/player.h"
#include "shaders/shared.h"
#include "tests/bench/surface_baseline.h"
#include "tests/support/gpu.h"
#include "tests/support/graph/temp_dir.h"
#include "tests/support/second_driver.h"

#include "shaders/particles/density.h"

namespace fw::particle_surface_test {

using test::device;
using Places = std::vector<glm::vec4>;

constexpr double kPi = 3.14159265358979;
constexpr double kDropOfSpacing = 0.6203504908994;  // whose volume is that of a cube of side 1
constexpr ParticleSurface kSmooth[] = {ParticleSurface::average, ParticleSurface::anisotropic};
const char* nameOf(ParticleSurface surface) { return kParticleSurfaceNames[std::size_t(surface)]; }

std::optional<ParticleVolumeKernels> kept;
class ParticleSurfaceOnDevice : public testing::Test {
  public:
    static void TearDownTestSuite() { kept.reset(); }
    static ParticleVolumeKernels& kernels() {
        if (!kept) kept = createParticleVolumeKernels(device());
        return *kept;
    }
};

Result<std::vector<float>> distancesOn(const Device& device, ParticleVolumeKernels& kernels,
                                       const Places& places, const SurfaceConfig& config) {
    DensityBuffers buffers;
    Buffer shapes, particles = createBuffer(device, std::max<std::size_t>(16 * places.size(), 16));
    upload(device, particles, places);
    Commands commands(device);
    if (const Done recorded = recordSurface(commands, kernels.density, kernels.surface, buffers, shapes,
                                            config, particles, uint32_t(places.size()));
        !recorded)
        return recorded.error();
    submit(commands);
    const glm::ivec3 size = config.grid.size;
    const auto pitch = std::size_t((size.x + 3) / 4 * 4);
    const auto padded =
        download<float>(device, buffers.density, pitch * std::size_t(size.y) * std::size_t(size.z));
    std::vector<float> distances;
    for (std::size_t row = 0; row < std::size_t(size.y) * std::size_t(size.z); ++row)
        distances.insert(distances.end(), &padded[row * pitch], &padded[row * pitch] + size.x);
    return distances;
}

Result<std::vector<float>> distancesOf(const Places& places, const SurfaceConfig& config) {
    return distancesOn(device(), ParticleSurfaceOnDevice::kernels(), places, config);
}

std::vector<float> made(const Places& places, const SurfaceConfig& config) {
    Result<std::vector<float>> distances = distancesOf(places, config);
    if (!distances) throw SystemError(distances.error().message);
    return std::move(*distances);
}

Places lattice(const glm::ivec3& many, float spacing) {
    Places places;
    for (int z = 0; z < many.z; ++z)
        for (int y = 0; y < many.y; ++y)
            for (int x = 0; x < many.x; ++x)
                places.emplace_back(spacing * (glm::vec3(x, y, z) - 0.5f * glm::vec3(many - 1)), 0.0f);
    return places;
}

/// A body, some sheets and drops of it, none on any lattice.
Places splash(std::size_t count, uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
    Places places = lattice({8, 8, 8}, 0.1f);
    for (glm::vec4& place : places)
        place += 0.025f * glm::vec4(unit(random), unit(random), unit(random), 0.0f);
    for (int i = 0; i < 8; ++i)
        for (int j = 0; j < 8; ++j)
            places.emplace_back(0.5f + 0.09f * float(i) * 0.6f, -0.4f + 0.09f * float(j),
                                0.09f * float(i) * 0.8f, 0);
    while (places.size() < count) places.emplace_back(unit(random), unit(random), unit(random), 0.0f);
    return places;
}

TEST_F(ParticleSurfaceOnDevice, IsTheFormula) {
    const double drop = 0.062;
    const Places places = splash(700, 3);
    for (const float cell : {0.031f, 0.055f}) {
        const int many = int(2.2f / cell);
        const DensityGrid grid{.origin = glm::vec3(-1.1f), .cell = cell, .size = {many, many - 1, many + 2}};
        for (const ParticleSurface surface : kSmooth) {
            const bench::SurfaceBaseline formula(places, drop, surface);
            const std::vector<float> found = made(places, {grid, float(drop), surface});
            double worst = 0.0, sum = 0.0;
            std::size_t count = 0;
            for (std::size_t i = 0; i < found.size(); i += cell < 0.04f ? 5 : 1) {
                const glm::ivec3 at(int(i) % grid.size.x, int(i) / grid.size.x % grid.size.y,
                                    int(i) / (grid.size.x * grid.size.y));
                const glm::dvec3 p = glm::dvec3(grid.origin) + double(cell) * glm::dvec3(at);
                const double wanted = formula.at(p);
                const double value = double(found[i]) * double(cell);
                if (wanted < -0.5 * drop) {  // as good as inside
                    ASSERT_LT(value, -0.3 * drop) << i;
                    continue;
                }
                worst = std::max(worst, std::abs(value - wanted)), sum += std::abs(value - wanted), ++count;
            }
            std::printf("%s, cells of %.2f drops: off by %.5f drops at most, %.7f on average\n",
                        nameOf(surface), cell / drop, worst / drop, sum / double(count) / drop);
            EXPECT_LT(worst, surface == ParticleSurface::average ? 2e-4 * drop : 0.05 * drop);
            EXPECT_LT(sum / double(count), surface == ParticleSurface::average ? 5e-6 * drop : 1e-5 * drop);
        }
    }
}

TEST_F(ParticleSurfaceOnDevice, TheSameBytesEachTimeAndInEveryOrder) {
    Places places = splash(2000, 4);
    const DensityGrid grid{.origin = glm::vec3(-1.1f), .cell = 0.04f, .size = glm::ivec3(55)};
    for (const ParticleSurface surface : kSmooth) {
        const SurfaceConfig config{grid, 0.062f, surface};
        const std::vector<float> first = made(places, config);
        for (int i = 0; i < 3; ++i) EXPECT_EQ(made(places, config), first);
        // Another order rounds sums otherwise.
        Places mixed = places;
        std::ranges::shuffle(mixed, std::mt19937(1));
        const std::vector<float> other = made(mixed, config);
        double worst = 0.0;
        for (std::size_t i = 0; i < first.size(); ++i)
            worst = std::max(worst, double(std::abs(first[i] - other[i])));
        std::printf("%s in another order: off by %.6f cells at most\n", nameOf(surface), worst);
        EXPECT_LT(worst, 0.02);
    }
}

void expectSameOn(const Device& other, double allowed) {
    const Places places = splash(1000, 5);
    const DensityGrid grid{.origin = glm::vec3(-1.1f), .cell = 0.06f, .size = {37, 36, 35}};
    ParticleVolumeKernels kernels = createParticleVolumeKernels(other);
    for (const ParticleSurface surface : kSmooth) {
        const std::vector<float> first = made(places, {grid, 0.062f, surface});
        const Result<std::vector<float>> second =
            distancesOn(other, kernels, places, {grid, 0.062f, surface});
        ASSERT_TRUE(second) << second.error().message;
        double worst = 0.0;
        for (std::size_t i = 0; i < first.size(); ++i)
            worst = std::max(worst, double(std::abs(first[i] - (*second)[i])));
        std::printf("%s: off by %.6f cells at most\n", nameOf(surface), worst);
        EXPECT_LE(worst, allowed);
    }
    EXPECT_EQ(other.validationMessages(), std::vector<std::string>());
}

TEST_F(ParticleSurfaceOnDevice, TheSameWhereDevicesHaveLess) {
    Result<Device> least = createDevice({.validation = true});
    ASSERT_TRUE(least);
    DeviceLimits most = leastLimits();
    most.invocations = DENSITY_GROUP;
    least->limits = lowered(least->limits, most);
    least->limits.groups = 64;
    least->pushDescriptors = nullptr;
    expectSameOn(*least, 0.0);
}

TEST_F(ParticleSurfaceOnDevice, AlikeOnASecondDriver) {
    const test::SecondDriver driver;
    if (!driver.works()) GTEST_SKIP() << driver.why();
    const Result<Device> second = createDevice({.validation = true});
    ASSERT_TRUE(second);
    ASSERT_NE(second->name().find("SwiftShader"), std::string::npos);
    expectSameOn(*second, 0.05);
}

TEST_F(ParticleSurfaceOnDevice, WhateverThereIs) {
    const DensityGrid grid{.origin = glm::vec3(-1.0f), .cell = 0.1f, .size = {21, 20, 19}};
    for (const ParticleSurface surface : kSmooth) {
        for (const float drop : {0.0f, -1.0f, std::nanf(""), INFINITY, 1e-45f, 1e-38f, 1e-20f, 1e-6f}) {
            const auto refused = distancesOf({glm::vec4(0.0f)}, {grid, drop, surface});
            ASSERT_FALSE(refused) << drop;
            EXPECT_NE(refused.error().message.find("radius of a drop"), std::string::npos);
        }
        for (const float drop :
             {0.004f, 0.05f, 1.0f, 1e6f, 1e30f})  // far below a cell, and far above the grid
            for (const float value : made({glm::vec4(0.03f)}, {grid, drop, surface}))
                ASSERT_TRUE(std::isfinite(value) && value >= -1.001f * drop / grid.cell) << drop;
        for (const float value : made({}, {grid, 0.1f, surface})) ASSERT_GT(value, 0.7f);
        Places broken = splash(900, 7);
        Places finite;
        for (std::size_t i = 0; i < broken.size(); ++i)
            if (i % 7 == 0)
                broken[i] =
                    i % 2 == 0 ? glm::vec4(NAN, 0.0f, INFINITY, 0.0f) : glm::vec4(1e30f, -1e30f, 5, 0);
            else
                finite.push_back(broken[i]);
        EXPECT_EQ(made(broken, {grid, 0.06f, surface}), made(finite, {grid, 0.06f, surface}));
        // Thousands in one place are seen.
        const std::vector<float> heap = made(Places(5000, glm::vec4(0.0f)), {grid, 0.15f, surface});
        EXPECT_LT(heap[(std::size_t(10) * 20 + 10) * 21 + 10], 0.0f);
    }
}

TEST_F(ParticleSurfaceOnDevice, MoreThanTheDeviceCanBindIsRefused) {
    Buffer particles = createBuffer(device(), 16), shapes;
    DensityBuffers buffers;
    Commands commands(device());
    for (const ParticleSurface surface : kSmooth) {
        const Done fine = recordSurface(commands, kernels().density, kernels().surface, buffers, shapes,
                                        {.grid = {.origin = {}, .cell = 1.0f, .size = glm::ivec3(2000)},
                                         .drop = 1.0f,
                                         .surface = surface},
                                        particles, 1);
        ASSERT_FALSE(fine);
        EXPECT_NE(fine.error().message.find("lower the resolution"), std::string::npos);
    }
    const auto many = uint32_t(device().limits.storageRange / (4 * SHAPE_WORDS) + 1);
    const Done crowd = recordSurface(commands, kernels().density, kernels().surface, buffers, shapes,
                                     {.grid = {.origin = {}, .cell = 1.0f, .size = glm::ivec3(8)},
                                      .drop = 1.0f,
                                      .surface = ParticleSurface::anisotropic},
                                     particles, many);
    ASSERT_FALSE(crowd);
    EXPECT_NE(crowd.error().message.find("fewer particles"), std::string::npos);
}

/// The mesh of the surface about particles of a file, by cells of about this size along both grids.
Mesh meshOf(const Places& places, ParticleSurface surface, double drop, double cell) {
    glm::dvec3 lo(1e30), hi(-1e30);
    std::string text;
    char line[256];
    for (const glm::vec4& place : places) {
        lo = glm::min(lo, glm::dvec3(place)), hi = glm::max(hi, glm::dvec3(place));
        std::snprintf(line, sizeof line, "%.9g %.9g %.9g\n", double(place.x), double(place.y),
                      double(place.z));
        text += line;
    }
    const double margin = 3.0 * drop + 3.0 * cell;
    lo -= margin, hi += margin;
    const int cells = int(std::ceil(std::max({hi.x - lo.x, hi.y - lo.y, hi.z - lo.z}) / cell));
    // Blobs whose drop is this one.
    std::snprintf(line, sizeof line, R"("drop": %.9g, "radius": %.9g, "threshold": 0.3, "resolution": %d)",
                  drop, drop / std::sqrt(1.0 - std::cbrt(0.3)), cells);
    std::string node = R"("surface": ")" + std::string(nameOf(surface)) + R"(", "method": "exact", )" + line;
    std::snprintf(line, sizeof line,
                  R"(, "region_min": [%.9g, %.9g, %.9g], "region_max": [%.9g, %.9g, %.9g])", lo.x, lo.y, lo.z,
                  hi.x, hi.y, hi.z);
    node += line;
    test::TempDir dir;
    test::writeText(dir.path("some.xyz"), text);
    test::writeText(dir.path("a.field.json"), R"({"fieldwright": 1, "nodes": [
        {"id": "file", "type": "particle_file", "inputs": {"path": "some.xyz"}},
        {"id": "field", "type": "particles_to_field", "inputs": {"particles": {"from": "file"}, )" +
                                                  node + R"(}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "field"}}}]})");
    Result<Player> player =
        Player::open(dir.path("a.field.json"), {.resolution = cells, .deviceOptions = {.validation = true}});
    if (!player) throw SystemError(format(player.error()));
    Result<Mesh> mesh = player->mesh();
    if (!mesh) throw SystemError(format(mesh.error()));
    EXPECT_EQ(player->device().validationMessages(), std::vector<std::string>());
    return std::move(*mesh);
}

TEST_F(ParticleSurfaceOnDevice, DropsAreRoundWhereverTheyAre) {
    std::mt19937 random(2);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    const double drop = 0.05;
    Places places = lattice({5, 2, 2}, 0.4f);  // no two feel one another
    for (glm::vec4& place : places)
        place += 0.05f * glm::vec4(unit(random), unit(random), unit(random), 0.0f);
    for (const ParticleSurface surface :
         {ParticleSurface::blobs, ParticleSurface::average, ParticleSurface::anisotropic})
        for (const double cells : {2.0, 3.3}) {
            const Mesh mesh = meshOf(places, surface, drop, drop / cells);
            double worst = 0.0;
            for (const glm::vec3& vertex : mesh.positions) {
                double nearest = 1e30;
                for (const glm::vec4& place : places)
                    nearest = std::min(nearest, glm::distance(glm::dvec3(vertex), glm::dvec3(place)));
                worst = std::max(worst, std::abs(nearest / drop - 1.0));
            }
            std::printf("%s, %.1f cells a drop's radius: off by %.2f %% at most\n", nameOf(surface), cells,
                        100.0 * worst);
            EXPECT_LT(worst, 0.02) << nameOf(surface);
            EXPECT_EQ(reportOnMesh(mesh.positions, mesh.indices).shells, 20u);
        }
}

TEST_F(ParticleSurfaceOnDevice, ABlockIsFlatAndAsLargeAsItIs) {
    const double spacing = 0.1, drop = kDropOfSpacing * spacing;
    const glm::ivec3 many(16, 14, 15);
    const glm::dvec3 half = 0.5 * spacing * glm::dvec3(many);
    for (const ParticleSurface surface : kSmooth) {
        const Mesh mesh = meshOf(lattice(many, float(spacing)), surface, drop, 0.5 * drop);
        const Report report = reportOnMesh(mesh.positions, mesh.indices);
        const double volume = 8.0 * half.x * half.y * half.z;
        double least = 1e30, most = -1e30;
        for (const glm::vec3& vertex : mesh.positions) {
            const glm::dvec3 from = half - glm::abs(glm::dvec3(vertex));
            // Of a face, two and a half spacings from the edges.
            for (int axis = 0; axis < 3; ++axis)
                if (std::abs(from[axis]) < spacing && from[(axis + 1) % 3] > 2.5 * spacing &&
                    from[(axis + 2) % 3] > 2.5 * spacing)
                    least = std::min(least, -from[axis]), most = std::max(most, -from[axis]);
        }
        std::printf("%s: faces from %.4f to %.4f spacings off, volume by %.2f %%\n", nameOf(surface),
                    least / spacing, most / spacing, 100.0 * (report.volume / volume - 1.0));
        EXPECT_TRUE(report.closedManifold());
        EXPECT_EQ(report.shells, 1u);
        EXPECT_GT(least, -0.05 * spacing);
        EXPECT_LT(most, 0.05 * spacing);
        EXPECT_NEAR(report.volume, volume, 0.02 * volume);
    }
}

TEST_F(ParticleSurfaceOnDevice, ABallIsRound) {
    const double spacing = 0.1, drop = kDropOfSpacing * spacing, radius = 0.6;
    Places places = lattice(glm::ivec3(13), float(spacing));
    std::erase_if(places, [&](const glm::vec4& p) { return glm::length(glm::vec3(p)) > float(radius); });
    const double wanted = std::cbrt(double(places.size()) * spacing * spacing * spacing * 0.75 / kPi);
    for (const ParticleSurface surface : kSmooth) {
        const Mesh mesh = meshOf(places, surface, drop, 0.5 * drop);
        double worst = 0.0;
        for (const glm::vec3& vertex : mesh.positions)
            worst = std::max(worst, std::abs(double(glm::length(vertex)) - wanted));
        std::printf("%s: a ball of %.1f spacings is off by %.2f spacings at most\n", nameOf(surface),
                    wanted / spacing, worst / spacing);
        EXPECT_LT(worst, 0.3 * spacing);  // cut from a lattice, its particles are half a spacing off
        EXPECT_EQ(reportOnMesh(mesh.positions, mesh.indices).shells, 1u);
    }
}

TEST_F(ParticleSurfaceOnDevice, DropsApartAreTwoAndTogetherOne) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    const double spacing = 0.1, drop = kDropOfSpacing * spacing;
    for (const ParticleSurface surface : kSmooth)
        for (const float apart : {0.5f, 1.0f, 2.2f, 2.6f, 3.0f, 4.5f}) {
            const float off = apart * float(spacing);
            const Mesh mesh =
                meshOf({glm::vec4(0.0f), {0.6f * off, 0.0f, 0.8f * off, 0.0f}}, surface, drop, 0.4 * drop);
            const Report report = reportOnMesh(mesh.positions, mesh.indices);
            EXPECT_EQ(report.shells, apart > 1.5f ? 2u : 1u) << nameOf(surface) << ' ' << apart;
            EXPECT_TRUE(report.closedManifold());
            // Nothing but them: no third in their midst.
            EXPECT_LT(report.volume, 2.5 * spacing * spacing * spacing);
        }
}

TEST_F(ParticleSurfaceOnDevice, AThinSheetHoldsTogether) {
    const double spacing = 0.1, drop = kDropOfSpacing * spacing;
    Places places = lattice({14, 14, 1}, float(spacing));
    // Across the grid.
    for (glm::vec4& place : places)
        place = {0.8f * place.x - 0.6f * place.y * 0.6f, 0.8f * place.y,
                 0.6f * place.x + 0.8f * 0.6f * place.y, 0};
    for (const ParticleSurface surface : kSmooth) {
        const Mesh mesh = meshOf(places, surface, drop, 0.5 * drop);
        const Report report = reportOnMesh(mesh.positions, mesh.indices);
        EXPECT_EQ(report.shells, 1u);
        EXPECT_EQ(report.eulerCharacteristic, 2) << nameOf(surface);  // no hole
        EXPECT_TRUE(report.closedManifold());
    }
}

TEST_F(ParticleSurfaceOnDevice, LinesAndLayersHoldTheirVolume) {
    const double spacing = 0.1, drop = kDropOfSpacing * spacing;
    for (const glm::ivec3 many : {glm::ivec3(24, 1, 1), glm::ivec3(14, 14, 1)}) {
        const Mesh mesh = meshOf(lattice(many, float(spacing)), ParticleSurface::average, drop, 0.4 * drop);
        const double volume = many.x * many.y * many.z * spacing * spacing * spacing;
        const double found = reportOnMesh(mesh.positions, mesh.indices).volume;
        std::printf("%d x %d x %d particles: the volume is off by %.1f %%\n", many.x, many.y, many.z,
                    100.0 * (found / volume - 1.0));
        EXPECT_NEAR(found, volume, 0.06 * volume);
    }
}

TEST_F(ParticleSurfaceOnDevice, ASplashIsAsLargeAsTheFluidWas) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    std::string text = test::readText(FIELDWRIGHT_SOURCE_DIR "/samples/drop_in_bowl.field.json");
    const auto replace = [&](const std::string& from, const std::string& to) {
        const std::size_t at = text.find(from);
        if (at == std::string::npos) throw SystemError("the sample lacks " + from);
        text.replace(at, from.size(), to);
    };
    replace(R"("radius": 0.09, "threshold": 0.7, "resolution": 112)", R"("surface": "SURFACE")");
    replace(R"({"surface": {"from": "all"}, "resolution": 192})",
            R"({"surface": {"from": "field"}, "resolution": 128})");
    for (const ParticleSurface smooth : kSmooth) {
        const std::string surface = nameOf(smooth);
        std::string own = text;
        own.replace(own.find("SURFACE"), 7, surface);
        const test::TempDir dir;
        test::writeText(dir.path("a.field.json"), own);
        Result<Player> player =
            Player::open(dir.path("a.field.json"), {.deviceOptions = {.validation = true}});
        ASSERT_TRUE(player) << format(player.error());
        const auto volumeAt = [&](double seconds) {
            player->seek(seconds);
            const Result<Mesh> mesh = player->mesh();
            if (!mesh) throw SystemError(format(mesh.error()));
            return reportOnMesh(mesh->positions, mesh->indices).volume;
        };
        const double start = volumeAt(0.0), splashing = volumeAt(0.6);
        std::printf("%s: the volume grows by %.1f %%\n", surface.c_str(), 100.0 * (splashing / start - 1.0));
        EXPECT_NEAR(splashing, start, 0.1 * start) << surface;
    }
}

}  // namespace fw::particle_surface_test
