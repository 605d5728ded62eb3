// Nothing that the editor shows is cut off, whatever the size of the window and the scale of the interface.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <set>

#include "editor/shell/letters.h"
#include "editor/shell/theme.h"
#include "tests/editor/window/looks.h"
#include "tests/support/golden.h"

namespace fw::editor::test::looks_test {

struct Size {
    int width, height;
    float scale;
};

Picture cut(const Picture& picture, const Area& part) {
    const int x0 = int(part.lo.x), x1 = int(part.hi.x), y0 = int(part.lo.y), y1 = int(part.hi.y);
    Picture result{x1 - x0, y1 - y0, {}};
    for (int y = y0; y < y1; ++y) {
        const auto row = picture.pixels.begin() + 4 * (std::ptrdiff_t(y) * picture.width);
        result.pixels.insert(result.pixels.end(), row + 4 * x0, row + 4 * x1);
    }
    return result;
}

constexpr Size kSizes[] = {{800, 600, 1},     {1280, 800, 1},     {3840, 2160, 1}, {800, 600, 1.5f},
                           {1280, 800, 1.5f}, {3840, 2160, 1.5f}, {1280, 800, 2},  {3840, 2160, 2},
                           {3840, 2160, 3},   {800, 600, 2},      {800, 600, 3}};

/// Words so large leave no room in so small a window for the rest.
bool fitsLetters(const Size& size, const std::string& look) {
    const std::set<std::string> narrow = {"main",    "views",     "inspector", "problems", "history",
                                          "library", "shortcuts", "palette",   "start",    "message"};
    return float(size.width) / size.scale > 500.0f || narrow.contains(look);
}

TEST(Looks, NothingIsCutOff) {
    DrivenEditor driven(graphOfLooks(), 3840, 2160);
    NEEDS_EDITOR(driven);
    std::set<std::string> told;
    const char* shots = std::getenv("FIELDWRIGHT_SHOTS");
    for (const Size& size : kSizes) {
        resize(driven, size.width, size.height, size.scale);
        for (const Look& look : looks()) {
            if (!fitsLetters(size, look.name)) continue;
            show(driven, look);
            const std::string at = std::string(look.name) + " " + std::to_string(size.width) + " " +
                                   std::to_string(size.scale).substr(0, 3);
            for (const auto& found : {cutTexts(look), lostWindows(look)})
                for (const std::string& what : found)
                    if (told.insert(std::string(look.name) + what).second)
                        ADD_FAILURE() << at << ": " << what;
            if (shots) {
                driven->shell.frame([&] { showEditor(*driven); });
                (void)savePicture(driven.capture(), std::string(shots) + "/" + std::to_string(size.width) +
                                                        "_" + std::to_string(int(10 * size.scale)) + "_" +
                                                        look.name + ".png");
            }
        }
    }
}

/// Pictures of all of them, but for those that name folders and devices of the machine.
TEST(Looks, AsTheyWere) {
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::current_path("/");  // is in the names that dialogs propose
    DrivenEditor driven(graphOfLooks(), 2560, 1600);
    std::filesystem::current_path(before);
    NEEDS_EDITOR(driven);
    const std::set<std::string> ofTheMachine = {"open", "about"}, likeOthers = {"views"};
    for (const int scale : {1, 2}) {
        resize(driven, 1280 * scale, 800 * scale, float(scale));
        driven.moveAway();
        for (const Look& look : looks()) {
            if (ofTheMachine.contains(look.name) || likeOthers.contains(look.name)) continue;
            std::filesystem::current_path("/");
            show(driven, look);
            std::filesystem::current_path(before);
            fw::test::expectGolden(cut(driven.capture(), placeOf(look)),
                                   "editor/looks/" + std::string(look.name) + "_" + std::to_string(scale),
                                   {.mean = 1.5, .mostStrong = 0.01});
        }
    }
}

TEST(Looks, InLight) {
    DrivenEditor driven(graphOfLooks());
    NEEDS_EDITOR(driven);
    setTheme(Theme::light);
    const std::vector<Look> all = looks();
    for (const char* name : {"main", "inspector_code"}) {
        const auto look = std::ranges::find(all, std::string(name), &Look::name);
        show(driven, *look);
        fw::test::expectGolden(cut(driven.capture(), placeOf(*look)),
                               "editor/looks/" + std::string(name) + "_light");
    }
    setTheme(Theme::dark);
}

TEST(Looks, FilesMayHaveNamesOfEveryLanguage) {
    DrivenEditor driven;
    NEEDS_EDITOR(driven);
    const std::string text =
        R"({"fieldwright": 1, "nodes": [{"id": "ball", "type": "sphere", "at": [0, 0]}]})";
    const auto open = [&](const std::string& name) {
        const std::string path = driven.path(name + ".field.json");
        fw::test::writeText(path, text);
        openFile(*driven, path);
        driven.settle();
        EXPECT_EQ(driven->document.graph().nodes.size(), 1u) << name;
        // A step, and saved.
        apply(*driven, "Add Box", addNode(driven->document.graph(), "", "box", {300, 0}));
        EXPECT_TRUE(save(*driven)) << name;
        driven.settle();
        EXPECT_NE(fw::test::readText(path).find("\"box\""), std::string::npos) << name;
        return driven->files.title;
    };
    const std::string names = "Мост Γέφυρα 図面 설계 جسر";
    EXPECT_EQ(driven->shell.fonts().of(14)->FindGlyphNoFallback(0x56f3), nullptr);
    EXPECT_NE(open(names).find(names), std::string::npos);
    for (const ImWchar letter : {0x041c, 0x03ad, 0x56f3, 0x9762, 0xc124, 0x062c}) {
        for (const float size : {14.0f, 28.0f})
            EXPECT_TRUE(driven->shell.fonts().of(size)->FindGlyphNoFallback(letter)) << std::hex << letter;
        EXPECT_TRUE(driven->shell.fonts().codeOf(14)->FindGlyphNoFallback(letter)) << std::hex << letter;
    }
    EXPECT_NE(open("Tower 🗼").find("Tower 🗼"), std::string::npos);
    open("caf\xe9");  // no UTF-8
    EXPECT_EQ(wellFormed("caf\xe9"), "caf\xef\xbf\xbd");
    EXPECT_EQ(wellFormed("\xed\xa0\x80"), "\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd") << "half a pair";
    EXPECT_EQ(wellFormed(names), names);
}

}  // namespace fw::editor::test::looks_test
