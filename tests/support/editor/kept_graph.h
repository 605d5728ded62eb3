// Graphs that stand in docs/graphs: what the tutorial and the tour end with, byte by byte.
//
// With FIELDWRIGHT_UPDATE_TASKS=1 what was made is kept in place of what stands there.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "editor/canvas/view.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::editor::test {

inline void expectKept(const std::string& made, const std::string& name) {
    const std::string path = std::string(FIELDWRIGHT_SOURCE_DIR "/docs/graphs/") + name;
    if (std::getenv("FIELDWRIGHT_UPDATE_TASKS")) fw::test::writeText(path, made);
    const std::string kept = fw::test::readText(path);
    EXPECT_TRUE(made == kept) << "docs/graphs/" << name << " is another:\n"
                              << kept << "\nthan what was made:\n"
                              << made;
}

/// Looks at the canvas so that every place of whole eights about the middle (of whole eights) is on a whole
/// pixel, wherever the panel lies: a node that is added there has just that place in the file.
inline void lookExactly(CanvasView& view, ImVec2 middle) {
    view.zoom = 0.625f / view.scale;
    const ImVec2 centre = view.panel.centre();
    view.middle = {middle.x + (centre.x - std::floor(centre.x)) / 0.625f,
                   middle.y + (centre.y - std::floor(centre.y)) / 0.625f};
}

}  // namespace fw::editor::test
