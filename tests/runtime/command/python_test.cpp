// The Python module: against the command, and as docs/python.md has it.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/support/command.h"
#include "tests/support/graph/temp_dir.h"

#ifdef FIELDWRIGHT_PYTHON

namespace fw::python_test {

using test::TempDir;

/// Runs a script of Python in a folder of its own, with the module.
test::ProgramResult runPython(const TempDir& folder, const std::string& arguments) {
    return test::runProgram("cd '" + folder.folder.string() +
                            "' && PYTHONPATH=" FIELDWRIGHT_BINARY_DIR "/python " FIELDWRIGHT_PYTHON " " +
                            arguments + " 2>&1");
}

TEST(Python, IsWhatTheCommandIs) {
    const TempDir folder;
    const test::ProgramResult result =
        runPython(folder, FIELDWRIGHT_SOURCE_DIR "/tests/support/python_module.py " FIELDWRIGHT_BINARY_DIR
                                                 "/fieldwright " FIELDWRIGHT_SOURCE_DIR
                                                 "/samples " FIELDWRIGHT_SOURCE_DIR "/tests/data/bad");
    EXPECT_EQ(result.status, 0) << result.output;
}

TEST(Python, ExamplesOfThePageRun) {
    const std::string page = test::readText(FIELDWRIGHT_SOURCE_DIR "/docs/python.md");
    const TempDir folder;
    int examples = 0;
    for (std::size_t at = page.find("```python\n"); at != std::string::npos;
         at = page.find("```python\n", at)) {
        at += 10;
        test::writeText(folder.path("example.py"), page.substr(at, page.find("```", at) - at));
        const test::ProgramResult result = runPython(folder, "example.py");
        EXPECT_EQ(result.status, 0) << result.output;
        ++examples;
        if (examples == 1) { EXPECT_NE(result.output.find("2.98"), std::string::npos) << result.output; }
    }
    EXPECT_EQ(examples, 3);
    for (const char* made : {"part.png", "part.stl", "load.png", "solids.npz"})
        EXPECT_TRUE(std::filesystem::exists(folder.path(made))) << made;
}

/// The wheel in an environment of its own, as pip installs it.
TEST(Python, TheWheelInstalls) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "set FIELDWRIGHT_LONG";
    const TempDir folder;
    const test::ProgramResult result = test::runProgram(
        "cd '" + folder.folder.string() +
        "' && (" FIELDWRIGHT_PYTHON
        " -m venv --system-site-packages env && env/bin/pip install --no-deps --quiet " FIELDWRIGHT_BINARY_DIR
        "/*.whl && "
        "env/bin/python -c 'import fieldwright as fw; print(fw.Graph(fw.nodes.sphere(radius=1)).eval([3, 0, "
        "0]))' && "
        "env/bin/pip uninstall --quiet --yes fieldwright && ! env/bin/python -c 'import fieldwright') 2>&1");
    EXPECT_EQ(result.status, 0) << result.output;
    EXPECT_NE(result.output.find("2.0"), std::string::npos) << result.output;
}

}  // namespace fw::python_test

#endif
