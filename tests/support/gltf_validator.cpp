#include "tests/support/gltf_validator.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <sstream>

#include "tests/support/graph/temp_dir.h"

namespace fw::test {
namespace {

/// Folder of the npm package gltf-validator, installed beside the build on first use.
std::string validatorModules() {
    const std::filesystem::path home = std::filesystem::path(FIELDWRIGHT_BINARY_DIR) / "gltf-validator";
    const std::filesystem::path modules = home / "node_modules";
    if (!std::filesystem::exists(modules / "gltf-validator")) {
        // Under another name first: two test programs may get here at once.
        const std::filesystem::path fresh = home.string() + "." + std::to_string(::getpid());
        std::filesystem::create_directories(fresh);
        const auto result = runProgram("npm install --silent --no-audit --no-fund --prefix '" +
                                       fresh.string() + "' gltf-validator@2.0.0-dev.3.10");
        EXPECT_EQ(result.status, 0) << "npm could not install gltf-validator:\n" << result.output;
        std::error_code taken;
        std::filesystem::rename(fresh, home, taken);
        if (taken) std::filesystem::remove_all(fresh);
    }
    return modules.string();
}

}  // namespace

void expectValidGltf(const std::vector<std::string>& files, bool knownAlone) {
    std::string command =
        "node '" FIELDWRIGHT_SOURCE_DIR "/tests/support/validate_gltf.js' '" + validatorModules() + "'";
    for (const std::string& file : files) command += " '" + file + "'";
    const auto result = runProgram(command);
    ASSERT_EQ(result.status, 0) << result.output;
    std::istringstream lines(result.output);
    std::size_t clean = 0;
    for (std::string line; std::getline(lines, line);) {
        clean += line.starts_with(knownAlone ? "0 0 0 0 " : "0 0 ");
        if (!knownAlone && line.starts_with("  ")) {
            EXPECT_TRUE(line.starts_with("  UNSUPPORTED_EXTENSION ") || line.starts_with("  UNUSED_OBJECT "))
                << line;
        }
    }
    EXPECT_EQ(clean, files.size()) << result.output;
}

}  // namespace fw::test
