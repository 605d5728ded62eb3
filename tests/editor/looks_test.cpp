// Nothing that the editor shows is cut off, whatever the size of the window and the scale of the interface.
#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "editor/shell/letters.h"
#include "tests/editor/looks.h"

namespace fw::editor::test::looks_test {

struct Size {
    int width, height;
    float scale;
};

// Smaller windows than these have no room for words so large.
constexpr Size kSizes[] = {{800, 600, 1},    {1280, 800, 1},    {3840, 2160, 1},
                           {800, 600, 1.5f}, {1280, 800, 1.5f}, {3840, 2160, 1.5f},
                           {1280, 800, 2},   {3840, 2160, 2},   {3840, 2160, 3}};

TEST(Looks, NothingIsCutOff) {
    DrivenEditor driven(graphOfLooks(), 3840, 2160);
    NEEDS_EDITOR(driven);
    std::set<std::string> told;
    const char* shots = std::getenv("FIELDWRIGHT_SHOTS");
    for (const Size& size : kSizes) {
        resize(driven, size.width, size.height, size.scale);
        for (const Look& look : looks()) {
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
