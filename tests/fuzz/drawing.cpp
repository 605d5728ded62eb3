// libFuzzer: the first byte says the format and whether a part is asked for, the others are read as a
// drawing. What is read has finite arcs that make an outline; what is refused must be refused with a reason.
//
//   cmake --preset fuzz && cmake --build --preset fuzz --target fuzz_drawing
//   build/fuzz/fuzz_drawing -max_total_time=60 -max_len=4096 -dict=tests/fuzz/drawing.dict CORPUS
//   tests/fuzz/drawing

#include <cmath>
#include <cstdint>

#include "graph/outlines/drawing.h"
#include "tests/fuzz/require.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const std::string bytes(reinterpret_cast<const char*>(data) + 1, size - 1), part = data[0] & 2 ? "a" : "";
    const fw::Result<fw::Drawing> drawing = data[0] & 1 ? fw::readDxf(bytes, part) : fw::readSvg(bytes, part);
    if (!drawing) {
        require(!drawing.error().message.empty(), "a refusal has a reason");
        return 0;
    }
    require(drawing->scale > 0 && std::isfinite(drawing->scale), "it has a size");
    const fw::Painted painted(drawing->painting);
    const std::optional<std::vector<fw::Arc>> found = painted.boundary();
    if (!found) return 0;  // too much crosses
    const std::vector<fw::Arc>& arcs = *found;
    for (const fw::Arc& arc : arcs)
        for (const double number : {arc.a.x, arc.a.y, arc.b.x, arc.b.y, arc.bend, arc.normal.x, arc.normal.y})
            require(std::isfinite(number), "arcs are finite");
    if (arcs.empty() || arcs.size() > 24) return 0;
    const fw::Outline outline(arcs, [&](glm::dvec2 p) { return painted.has(p); });
    for (int i = 0; i < 16; ++i)
        require(std::isfinite(fw::sampleOutline(outline, 0.1 * i - 0.8, 0.05 * i - 0.3).value),
                "distances are finite");
    return 0;
}
