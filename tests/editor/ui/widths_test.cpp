// The width that the viewport's views of walls and gaps go by.
#include "editor/viewport/widths.h"

#include <gtest/gtest.h>

#include "editor/viewport/viewport.h"

namespace fw::editor::widths_test {

TEST(WidthViews, GoByWhatIsAskedForAndElseByTheSolidsSize) {
    Viewport view;
    view.shown.region = Box{{-1, -1, -1}, {1, 1, 1.5}};
    EXPECT_EQ(leastWidth(view), 0.0f) << "nothing to draw anew in other views";
    for (const uint32_t shown : {RENDER_THICKNESS, RENDER_GAP}) {
        view.view = shown;
        view.leastWidth = 0.0f;
        EXPECT_FLOAT_EQ(leastWidth(view), 0.01f);
        view.leastWidth = 0.3f;
        EXPECT_EQ(leastWidth(view), 0.3f);
    }
    view.leastWidth = 0.0f;
    view.shown.region = Box{{0, 0, 0}, {60, 20, 20}};  // of a part in millimetres
    EXPECT_FLOAT_EQ(leastWidth(view), 1.0f);
}

}  // namespace fw::editor::widths_test
