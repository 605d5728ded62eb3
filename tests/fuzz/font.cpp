// libFuzzer: the first byte says what is written, the others are the font's file. What is painted has finite
// arcs that make an outline; what is refused must be refused with a reason.
//
//   cmake --preset fuzz && cmake --build --preset fuzz --target fuzz_font
//   build/fuzz/fuzz_font -max_total_time=60 -max_len=4096 -dict=tests/fuzz/font.dict CORPUS tests/fuzz/font

#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>

#include "graph/outlines/letters.h"
#include "tests/fuzz/require.h"

namespace {

/// A folder for the font, which is read as any graph's is.
struct Folder {
    std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("fieldwright-fuzz-font-" + std::to_string(getpid()));
    Folder() { std::filesystem::create_directories(path); }
    ~Folder() { std::filesystem::remove_all(path); }
};

}  // namespace

// Names that fontconfig has seen stay with it.
extern "C" const char* __lsan_default_suppressions() { return "leak:libfontconfig"; }

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) {
    // Letters, letters that are kerned and in lines, and those of scripts that are shaped.
    constexpr const char* kTexts[] = {"ABC", "AB\nBA CC", "\u0628\u0628 A", "\u0915\u094D\u0937\u093F A"};
    static const Folder folder;
    if (size == 0) return 0;
    std::ofstream(folder.path / "a.ttf", std::ios::binary)
        .write(reinterpret_cast<const char*>(data) + 1, std::streamsize(size - 1));
    const fw::Result<fw::Painting> painting =
        fw::paintText((folder.path / "a.field.json").string(), kTexts[data[0] % 4], {.fontFile = "a.ttf"});
    if (!painting) {
        require(!painting.error().message.empty(), "a refusal has a reason");
        return 0;
    }
    const fw::Painted painted(*painting);
    const std::optional<std::vector<fw::Arc>> arcs = painted.boundary();
    if (!arcs) return 0;  // too much crosses
    for (const fw::Arc& arc : *arcs)
        for (const double number : {arc.a.x, arc.a.y, arc.b.x, arc.b.y, arc.bend, arc.normal.x, arc.normal.y})
            require(std::isfinite(number), "arcs are finite");
    if (arcs->empty() || arcs->size() > 24) return 0;
    const fw::Outline outline(*arcs, [&](glm::dvec2 p) { return painted.has(p); });
    for (int i = 0; i < 16; ++i)
        require(std::isfinite(fw::sampleOutline(outline, 0.1 * i - 0.8, 0.05 * i - 0.3).value),
                "distances are finite");
    return 0;
}
