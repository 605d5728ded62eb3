#include "tests/support/blender.h"

#include <gtest/gtest.h>

#include "tests/support/graph/temp_dir.h"

namespace fw::test {

nlohmann::json inBlender(const std::string& path, const std::vector<int>& frames, int fps) {
    std::string command =
        "blender --background --factory-startup --python-exit-code 1 --python '" FIELDWRIGHT_SOURCE_DIR
        "/tests/support/in_blender.py' -- '" +
        path + "' " + std::to_string(fps);
    for (const int frame : frames) command += " " + std::to_string(frame);
    const ProgramResult result = runProgram(command);
    const std::string before = "\nIn Blender: ";
    const std::size_t at = result.output.find(before);
    if (result.status != 0 || at == std::string::npos) {
        ADD_FAILURE() << command << "\n" << result.output;
        return {};
    }
    const std::size_t from = at + before.size();
    return nlohmann::json::parse(result.output.substr(from, result.output.find('\n', from) - from));
}

}  // namespace fw::test
