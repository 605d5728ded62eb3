// Everything on a second driver (support/second_driver.h): the samples are meshed by both methods as the
// first driver meshes them, look as they do there, and fluids and fields of meshes become what they become
// there.
//
// SwiftShader is slow: meshes of three samples, everything with FIELDWRIGHT_LONG. But for those whose kernels
// it compiles for many minutes or into more than 17 GB.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>

#include "graph/document/json.h"
#include "runtime/measure/mesh_report.h"
#include "runtime/particles/simulation.h"
#include "runtime/play/player.h"
#include "tests/support/golden.h"
#include "tests/support/second_driver.h"

namespace fw::second_driver_test {

const std::set<std::string> kTooMuch = {"cube_morph", "dusk_city",       "mesh_morph",
                                        "tap",        "table_and_stool", "wet_city"};
/// Of these the light alone: secondary rays, and those through glass.
const std::set<std::string> kTooMuchLight = {"cornell_box", "glass_of_water", "pool", "tidal_wave"};

std::vector<std::string> samples() {
    if (!std::getenv("FIELDWRIGHT_LONG")) return {"csg_part", "engraved_sign", "tower"};
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(FIELDWRIGHT_SOURCE_DIR "/samples"))
        if (const std::string name = entry.path().stem().stem();
            entry.path().string().ends_with(".field.json") && !kTooMuch.contains(name))
            names.push_back(name);
    std::sort(names.begin(), names.end());
    return names;
}

Player open(const std::string& sample, const PlayerOptions& options) {
    const Result<Graph> graph =
        readGraph(FIELDWRIGHT_SOURCE_DIR "/samples/" + sample + ".field.json", nullptr);
    if (!graph) throw SystemError(format(graph.error()));
    Result<Device> device = createDevice({.validation = true});
    if (!device) throw SystemError(format(device.error()));
    Result<Player> player = Player::create(*graph, std::move(*device), options);
    if (!player) throw SystemError(format(player.error()));
    return std::move(*player);
}

Report meshed(const std::string& sample, const PlayerOptions& options, double seconds = 0) {
    Player player = open(sample, options);
    player.seek(seconds);
    const Result<Mesh> mesh = player.mesh();
    if (!mesh) throw SystemError(format(mesh.error()));
    EXPECT_EQ(player.device().validationMessages(), std::vector<std::string>()) << sample;
    return reportOnMesh(mesh->positions, mesh->indices);
}

void expectAlike(const Report& first, const Report& second) {
    EXPECT_EQ(second.closedManifold(), first.closedManifold());
    EXPECT_EQ(second.shells, first.shells);
    EXPECT_EQ(second.eulerCharacteristic, first.eulerCharacteristic);
    // The second driver's sines are a little off, and move surfaces that are made of them by millionths of a
    // metre.
    EXPECT_NEAR(second.volume, first.volume, 1e-4 * std::abs(first.volume) + 5e-6 * first.area);
}

class OnSecondDriver : public testing::TestWithParam<std::string> {
  protected:
    void SetUp() override {
        if (const test::SecondDriver driver; !driver.works()) GTEST_SKIP() << driver.why();
    }
};
INSTANTIATE_TEST_SUITE_P(Samples, OnSecondDriver, testing::ValuesIn(samples()),
                         [](const auto& of) { return of.param; });

TEST_P(OnSecondDriver, MeshesAreAlikeByBothMethods) {
    for (const MeshMethod method : {MeshMethod::marchingCubes, MeshMethod::dualContouring}) {
        const PlayerOptions options{.resolution = 40, .method = method};
        const Report first = meshed(GetParam(), options);
        const test::SecondDriver driver;
        expectAlike(first, meshed(GetParam(), options));
    }
}

TEST_P(OnSecondDriver, LooksAsKept) {
    if (kTooMuchLight.contains(GetParam())) GTEST_SKIP() << "compiled into more than 17 GB";
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "minutes: with FIELDWRIGHT_LONG";
    const test::SecondDriver driver;
    Player player = open(GetParam(), {});
    EXPECT_NE(player.device().name().find("SwiftShader"), std::string::npos);
    const Result<Picture> picture = player.frame({.width = 256, .height = 256, .samples = 8});
    ASSERT_TRUE(picture) << format(picture.error());
    test::expectGolden(*picture, GetParam(), {.mean = 2.5, .mostStrong = 0.02});
    EXPECT_EQ(player.device().validationMessages(), std::vector<std::string>());
}

class OfSecondDriver : public OnSecondDriver {
  protected:
    void SetUp() override {
        if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "minutes: with FIELDWRIGHT_LONG";
        OnSecondDriver::SetUp();
    }
};
INSTANTIATE_TEST_SUITE_P(Once, OfSecondDriver, testing::Values("drop_in_bowl"));

TEST_P(OfSecondDriver, SixtyStepsOfAFluid) {
    constexpr double kSeconds = 60 * kSimulationStep;
    const PlayerOptions options{.resolution = 32};
    const Report first = meshed(GetParam(), options, kSeconds);
    const test::SecondDriver driver;
    const Report second = meshed(GetParam(), options, kSeconds);
    // A splash grows what rounding differs in: the surface is closed, and its volume near.
    EXPECT_TRUE(second.closedManifold());
    EXPECT_NEAR(second.volume, first.volume, 0.02 * first.volume);
}

TEST_P(OfSecondDriver, AMeshBecomesAField) {
    const PlayerOptions options{.resolution = 40};
    const Report first = meshed("cut_duck", options);
    const test::SecondDriver driver;
    expectAlike(first, meshed("cut_duck", options));
}

}  // namespace fw::second_driver_test
