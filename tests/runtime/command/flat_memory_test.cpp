// Memory stays flat however long is played. What is held against each other is the most that two runs took of
// it, of few and of many frames.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/support/command.h"
#include "tests/support/graph/temp_dir.h"
#include "tests/support/virtual_display.h"

namespace fw::flat_memory_test {

constexpr double kMostGrowth = 10.0;  // MB
constexpr int kFew = 60;

/// The peak of a run of the command that makes so many frames, in MB.
double peakOf(std::vector<std::string> words, const char* sample) {
    words.insert(words.begin() + 1, FIELDWRIGHT_SOURCE_DIR "/samples/" + std::string(sample) + ".field.json");
    // The layer keeps records of its own.
    const test::CommandResult result = test::runCommand(words, {.environment = {"FIELDWRIGHT_VALIDATION=0"}});
    EXPECT_EQ(result.status, 0) << result.errors;
    return result.peakMegabytes;
}

void expectFlat(const std::function<double(int)>& peakOfFrames) {
    const int many = kFew + (std::getenv("FIELDWRIGHT_LONG") ? 10'000 : 300);
    peakOfFrames(kFew);  // what is compiled is kept, and compiling takes memory
    const double few = peakOfFrames(kFew), all = peakOfFrames(many);
    std::printf("%.1f MB for %d frames, %.1f MB for %d\n", few, kFew, all, many);
    EXPECT_LT(all - few, kMostGrowth);
}

TEST(FlatMemory, OfPlaying) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "half a minute: with FIELDWRIGHT_LONG";
    const test::VirtualDisplay display;
    NEEDS_DISPLAY(display);
    expectFlat([](int frames) {
        return peakOf({"play", "--resolution", "32", "--size", "128x96", "--frames", std::to_string(frames)},
                      "moving_booleans");
    });
}

TEST(FlatMemory, OfASequence) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "half a minute: with FIELDWRIGHT_LONG";
    const test::TempDir folder;
    expectFlat([&](int frames) {
        return peakOf({"render", "--resolution", "32", "--size", "96x72", "--samples", "1", "--fps", "60",
                       "--to", std::to_string(frames / 60.0), "--overwrite", "-o", folder.path("frames")},
                      "moving_booleans");
    });
}

}  // namespace fw::flat_memory_test
