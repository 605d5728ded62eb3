// Subgroups of 4, 8 and 16 lanes: Mesa's software device has as many as LP_NATIVE_VECTOR_WIDTH has words.
// Points and triangles are the same bytes. Of normals some differ by a step of their code with 16 lanes,
// which rounds a root otherwise: they stay in the mesh, and an STL file has none of them.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/support/command.h"
#include "tests/support/gpu.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::subgroups_test {

struct Export {
    const char* name;  ///< of the sample, and of the test
    const char* resolution;
    std::vector<std::string> options = {};
    bool fluid = false;  ///< whose particles move by roots, which 16 lanes round otherwise
};

struct Subgroups : testing::TestWithParam<Export> {};

TEST_P(Subgroups, OfEverySizeGiveTheSameBytes) {
    if (!test::device().software) GTEST_SKIP() << "a hardware device";
    const test::TempDir folder;
    const auto exported = [&](const std::string& width) {
        const std::string mesh = folder.path(width + ".stl");
        std::vector<std::string> words = {
            "export",       FIELDWRIGHT_SOURCE_DIR "/samples/" + std::string(GetParam().name) + ".field.json",
            "-o",           mesh,
            "--resolution", GetParam().resolution};
        words.insert(words.end(), GetParam().options.begin(), GetParam().options.end());
        // Kernels that the driver keeps are of one width.
        const test::CommandResult result =
            test::runCommand(words, {.environment = {"LP_NATIVE_VECTOR_WIDTH=" + width,
                                                     "MESA_SHADER_CACHE_DIR=" + folder.path(width)}});
        EXPECT_EQ(result.status, 0) << result.errors;
        return test::readText(mesh);
    };
    const std::string of8 = exported("256");
    EXPECT_GT(of8.size(), 10'000u);
    EXPECT_TRUE(exported("128") == of8) << "subgroups of 4";
    if (GetParam().fluid) return;
    EXPECT_TRUE(exported("512") == of8) << "subgroups of 16";
}

const std::vector<Export> kFew = {{"csg_part", "48"}, {"dusk_city", "40", {"--method", "dual-contouring"}}};
const std::vector<Export> kMore = {{"dam_break", "32", {"--time", "0.2"}, true},
                                   {"tower", "256"},
                                   {"menger", "200", {"--method", "dual-contouring"}},
                                   {"gyroid_sphere", "160"},
                                   {"eroded_duck", "64"},
                                   {"cut_duck", "64"},
                                   {"fountain", "48", {"--time", "1"}, true},
                                   {"drop_in_bowl", "40", {"--time", "0.4"}, true},
                                   {"goblet", "96"},
                                   {"worn_steps", "80"},
                                   {"brick_block", "96"}};

std::string nameOf(const testing::TestParamInfo<Export>& info) { return info.param.name; }
INSTANTIATE_TEST_SUITE_P(Few, Subgroups, testing::ValuesIn(kFew), nameOf);
INSTANTIATE_TEST_SUITE_P(More, Subgroups,
                         testing::ValuesIn(std::getenv("FIELDWRIGHT_LONG") ? kMore : std::vector<Export>()),
                         nameOf);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(Subgroups);

}  // namespace fw::subgroups_test
