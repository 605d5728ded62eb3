// The installed package, from the outside: samples/embed configures, builds and runs against an install
// prefix.
#include <gtest/gtest.h>

#include <sstream>

#include "tests/support/graph/temp_dir.h"

namespace fw::embed_test {

using test::runProgram;
using test::TempDir;

std::string quoted(const std::string& text) { return "'" + text + "'"; }

TEST(Embed, ASmallProgramBuildsAgainstTheInstalledPackageAndPlays) {
    const TempDir folder;
    const std::string source = FIELDWRIGHT_SOURCE_DIR, prefix = folder.path("prefix"),
                      build = folder.path("build");
    auto step = [](const std::string& line) {
        const auto result = runProgram(line);
        EXPECT_EQ(result.status, 0) << line << "\n" << result.output;
        return result.output;
    };
    step("cmake --install " + quoted(FIELDWRIGHT_BINARY_DIR) + " --prefix " + quoted(prefix));
    step("cmake -S " + quoted(source + "/samples/embed") + " -B " + quoted(build) +
         " -D CMAKE_PREFIX_PATH=" + quoted(prefix) + " -D CMAKE_CXX_FLAGS=" + quoted(FIELDWRIGHT_CXX_FLAGS));
    step("cmake --build " + quoted(build));
    const std::string embed = quoted(build + "/embed") + " ", samples = source + "/samples/";

    // A line for every half second of a timeline of 6 s, and the mesh changes.
    std::istringstream lines(step(embed + quoted(samples + "cube_morph.field.json")));
    std::vector<std::string> said;
    for (std::string line; std::getline(lines, line);) said.push_back(line);
    ASSERT_EQ(said.size(), 12u);
    EXPECT_EQ(said[0].substr(0, 8), " 0.0 s: ");
    EXPECT_NE(said[0].substr(8), said[5].substr(8));
    EXPECT_EQ(said[0].substr(8),
              step(embed + quoted(samples + "cube_morph.field.json")).substr(8, said[0].size() - 8));

    const auto set = runProgram(embed + quoted(samples + "tower.field.json") + " 'tube width' 0.1");
    EXPECT_EQ(set.status, 0) << set.output;
    const auto wrong = runProgram(embed + quoted(samples + "tower.field.json") + " 'tube widht' 0.1");
    EXPECT_EQ(wrong.status, 1);
    EXPECT_NE(wrong.output.find("did you mean 'tube width'?"), std::string::npos) << wrong.output;
    EXPECT_EQ(runProgram(embed + "/nowhere.field.json").status, 1);
}

}  // namespace fw::embed_test
