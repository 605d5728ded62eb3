// The add-on in Debian's Blender, without its window; with FIELDWRIGHT_LONG. In a newer one, an extension:
// tests/package/systems.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "tests/support/graph/temp_dir.h"

namespace fw::blender_addon_test {

TEST(BlenderAddon, IsOneZipThatBlenderInstalls) {
    const test::TempDir folder;
    const test::ProgramResult listed =
        test::runProgram("cd '" + folder.folder.string() +
                         "' && unzip -q " FIELDWRIGHT_BINARY_DIR
                         "/fieldwright-blender.zip && python3 -m py_compile fieldwright/*.py");
    ASSERT_EQ(listed.status, 0) << listed.output;
    EXPECT_EQ(folder.names(), std::vector<std::string>{"fieldwright"});
    // Old versions of Blender and new ones read it in different places.
    std::string numbers = FIELDWRIGHT_VERSION;
    for (std::size_t dot = 0; (dot = numbers.find('.', dot)) != std::string::npos;)
        numbers.replace(dot, 1, ", ");
    EXPECT_NE(test::readText(folder.path("fieldwright/__init__.py")).find("\"version\": (" + numbers + ")"),
              std::string::npos);
    EXPECT_NE(test::readText(folder.path("fieldwright/blender_manifest.toml"))
                  .find("\nversion = \"" FIELDWRIGHT_VERSION "\""),
              std::string::npos);
}

void runsWell(const char* script) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "with FIELDWRIGHT_LONG";
    const test::TempDir folder, user, caches;
    const test::ProgramResult result = test::runProgram(
        "BLENDER_USER_SCRIPTS='" + user.folder.string() + "' BLENDER_USER_CONFIG='" + user.folder.string() +
        "' XDG_CACHE_HOME='" + caches.folder.string() +
        "' blender --background --factory-startup --python-exit-code 1 --python " FIELDWRIGHT_SOURCE_DIR
        "/tests/support/" +
        script +
        " -- " FIELDWRIGHT_BINARY_DIR "/fieldwright-blender.zip " FIELDWRIGHT_BINARY_DIR "/fieldwright '" +
        folder.folder.string() + "'");
    EXPECT_EQ(result.status, 0) << result.output;
    EXPECT_NE(result.output.find("all is well"), std::string::npos) << result.output;
    EXPECT_EQ(result.output.find("Traceback"), std::string::npos) << result.output;
}

TEST(BlenderAddon, ImportsDrivesFollowsAndIsRemoved) { runsWell("blender_addon.py"); }

TEST(BlenderAddon, TellsWhatIsWrongAndLeavesWhatIsOthers) { runsWell("blender_trouble.py"); }

}  // namespace fw::blender_addon_test
