// GPU-assisted validation: what shaders reach lies within what is bound.
//
// Its kernels take many times as long to compile: a few exports, pictures and fluids with FIELDWRIGHT_LONG.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>

#include "tests/support/command.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::reach_test {

struct Work {
    const char* name;
    std::vector<std::string> words;  ///< of the command, but for its graph and output
    const char* sample;
    const char* ending;  ///< of the output
};

struct Reach : testing::TestWithParam<Work> {};

TEST_P(Reach, StaysWithinWhatIsBound) {
    const test::TempDir folder;
    std::vector<std::string> words = GetParam().words;
    words.insert(words.begin() + 1,
                 FIELDWRIGHT_SOURCE_DIR "/samples/" + std::string(GetParam().sample) + ".field.json");
    words.insert(words.end(), {"-o", folder.path(std::string("out") + GetParam().ending)});
    const test::CommandResult result =
        test::runCommand(words, {.environment = {"FIELDWRIGHT_VALIDATION=gpu"}});
    EXPECT_EQ(result.status, 0) << result.errors;
    EXPECT_EQ(result.errors.find("validation layer"), std::string::npos) << result.errors;
}

std::vector<Work> works() {
    const std::vector<std::string> mesh = {"export", "--resolution", "24"};
    const std::vector<std::string> sharp = {"export", "--resolution", "24", "--method", "dual-contouring"};
    std::vector<Work> all = {{"Mesh", mesh, "csg_part", ".glb"}, {"SharpMesh", sharp, "csg_part", ".glb"}};
    if (!std::getenv("FIELDWRIGHT_LONG")) return all;
    const std::vector<std::string> fluid = {"export", "--resolution", "20", "--time", "0.2"};
    const std::vector<std::string> picture = {"render", "--size", "96x54", "--samples", "2"};
    all.insert(all.end(), {{"Families", mesh, "brick_block", ".glb"},
                           {"Noise", mesh, "worn_steps", ".glb"},
                           {"MeshField", mesh, "eroded_duck", ".glb"},
                           {"SharpMeshField", sharp, "cut_duck", ".glb"},
                           {"Thin", {"export", "--resolution", "96"}, "gyroid_sphere", ".glb"},
                           {"Fluid", fluid, "dam_break", ".glb"},
                           {"Emitter", fluid, "fountain", ".glb"},
                           {"Collider", fluid, "drop_in_bowl", ".glb"},
                           {"Picture", picture, "csg_part", ".png"},
                           {"PictureOfFamilies", picture, "dusk_city", ".png"},
                           {"PictureOfFluid", picture, "fountain", ".png"}});
    return all;
}

std::string nameOf(const testing::TestParamInfo<Work>& info) { return info.param.name; }
INSTANTIATE_TEST_SUITE_P(, Reach, testing::ValuesIn(works()), nameOf);

/// Software devices leave these to the processor; tests have them run.
TEST(ReachOfKernels, ThatTheHostStandsInFor) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "half a minute: with FIELDWRIGHT_LONG";
    const test::ProgramResult result = test::runProgram(
        "FIELDWRIGHT_VALIDATION=gpu /proc/" + std::to_string(getpid()) +
        "/exe --gtest_filter=Mesher/EachMethod.BuffersGrowUntilTheSurfaceFits/MarchingCubes 2>&1");
    EXPECT_EQ(result.status, 0) << result.output;
}

}  // namespace fw::reach_test
