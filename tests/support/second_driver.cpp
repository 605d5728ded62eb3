#include "tests/support/second_driver.h"

#include <cstdlib>
#include <filesystem>

namespace fw::test {
namespace {

constexpr const char* kVariable = "VK_ICD_FILENAMES";  // read whenever an instance is made
constexpr const char* kFile = "/usr/lib/chromium/vk_swiftshader_icd.json";

}  // namespace

SecondDriver::SecondDriver() : there(std::filesystem::exists(kFile)) {
    if (!there) return;
    if (const char* value = std::getenv(kVariable)) {
        had = true;
        previous = value;
    }
    setenv(kVariable, kFile, 1);
}

SecondDriver::~SecondDriver() {
    if (!there) return;
    if (had)
        setenv(kVariable, previous.c_str(), 1);
    else
        unsetenv(kVariable);
}

const char* SecondDriver::why() { return "no second driver: install chromium-common, which has SwiftShader"; }

}  // namespace fw::test
