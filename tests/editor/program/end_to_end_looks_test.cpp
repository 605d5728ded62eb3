// What a first start shows, and the light theme, in the real window.
#include <gtest/gtest.h>

#include "editor/shell/theme.h"
#include "tests/support/editor/program.h"

namespace fw::editor::test::end_to_end_looks_test {

TEST(EndToEndLooks, TheStartPageGoesWithTheFirstNodeAndTheThemeBecomesLight) {
    Program program;
    ASSERT_TRUE(program.works()) << "Xvfb, xdotool or xclip is not installed: run ./.install test";
    program.save();
    program.kill();
    program.start({});
    program.waitFor("Take the tour");
    program.waitFor("Open a sample");
    program.waitFor("document.field.json");  // was open last

    const ImVec2 beside(40, 300);
    program.moveTo(beside);
    program.keys("Shift+A");
    program.type("sphere\n");
    program.waitUntilGone("Take the tour");

    const auto isCanvas = [&](Theme theme) {
        setTheme(theme);
        const ImU32 wanted = themeColor(ThemeColor::canvas);
        setTheme(Theme::dark);
        return eventually([&] {
            const Picture seen = program.screen(Area{{30, 700}, {60, 720}});
            int count = 0;
            for (std::size_t i = 0; i < seen.pixels.size(); i += 4)
                count += seen.pixels[i] == (wanted & 255u) && seen.pixels[i + 2] == (wanted >> 16 & 255u);
            return count > 400;
        });
    };
    EXPECT_TRUE(isCanvas(Theme::dark));
    program.keys("Ctrl+Comma");
    program.clickOn("Dark");
    program.clickOn("Light");
    program.keys("Escape");
    EXPECT_TRUE(isCanvas(Theme::light));
}

}  // namespace fw::editor::test::end_to_end_looks_test
