// Letters: their outlines against FreeType's pictures, and scripts that are shaped.
#include "graph/outlines/letters.h"

#include <ft2build.h>
#include FT_FREETYPE_H
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <numeric>

#include "tests/support/graph/temp_dir.h"

namespace fw::letters_test {

using glm::dvec2;

constexpr const char* kDejaVu = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";

std::vector<Arc> boundaryOf(const std::string& text, const TextLayout& layout = {}) {
    const Result<Painting> painting = paintText("", text, layout);
    EXPECT_TRUE(painting) << painting.error().message;
    return painting ? Painted(*painting).boundary().value() : std::vector<Arc>();
}
double areaOf(const std::vector<Arc>& arcs) {
    double twice = 0;
    for (const Arc& arc : arcs) twice += twiceAreaBeside(arc);
    return 0.5 * twice;
}
struct Extent {
    dvec2 lo{1e9}, hi{-1e9};
};
Extent extentOf(const std::vector<Arc>& arcs) {
    Extent extent;
    for (const Arc& arc : arcs)
        extent.lo = glm::min(extent.lo, arc.a), extent.hi = glm::max(extent.hi, arc.a);
    return extent;
}
/// Closed contours among the arcs.
std::size_t contoursOf(const std::vector<Arc>& arcs) {
    std::map<std::pair<long, long>, std::size_t> places;
    std::vector<std::size_t> parent;
    const auto number = [&](dvec2 p) {
        const auto [found, isNew] =
            places.emplace(std::pair(std::lround(p.x * 1e6), std::lround(p.y * 1e6)), parent.size());
        if (isNew) parent.push_back(parent.size());
        return found->second;
    };
    const auto root = [&](std::size_t i) {
        while (parent[i] != i) i = parent[i];
        return i;
    };
    for (const Arc& arc : arcs) parent[root(number(arc.a))] = root(number(arc.b));
    std::size_t count = 0;
    for (std::size_t i = 0; i < parent.size(); ++i) count += parent[i] == i;
    return count;
}

TEST(Letters, AreWhatFreeTypePaints) {
    FT_Library library = nullptr;
    FT_Face face = nullptr;
    ASSERT_EQ(FT_Init_FreeType(&library), 0);
    ASSERT_EQ(FT_New_Face(library, kDejaVu, 0, &face), 0) << "run ./.install";
    const int em = std::getenv("FIELDWRIGHT_LONG") ? 2048 : 512;
    FT_Set_Pixel_Sizes(face, 0, unsigned(em));
    const std::map<std::string, unsigned long> letters = {{"g", 'g'}, {"&", '&'},  {"@", '@'},   {"8", '8'},
                                                          {"Q", 'Q'}, {"ß", 0xDF}, {"ф", 0x444}, {"Ω", 0x3A9},
                                                          {"%", '%'}, {"i", 'i'}};
    for (const auto& [text, code] : letters) {
        SCOPED_TRACE(text);
        const Result<OutlinePtr> outline = outlineOfText(
            "", text, {.align = TextLayout::Align::left, .anchor = TextLayout::Anchor::baseline});
        ASSERT_TRUE(outline && *outline);
        ASSERT_EQ(FT_Load_Char(face, code, FT_LOAD_NO_HINTING | FT_LOAD_NO_BITMAP), 0);
        ASSERT_EQ(FT_Render_Glyph(face->glyph, FT_RENDER_MODE_NORMAL), 0);
        const FT_GlyphSlot glyph = face->glyph;
        const auto width = int(glyph->bitmap.width), height = int(glyph->bitmap.rows);
        ASSERT_GT(width * height, em * em / 40);
        int wrong = 0;
        for (int y = -4; y < height + 4; ++y)
            for (int x = -4; x < width + 4; ++x) {
                const bool within = x >= 0 && y >= 0 && x < width && y < height;
                const bool painted = within && glyph->bitmap.buffer[y * glyph->bitmap.pitch + x] > 127;
                const dvec2 p = dvec2(glyph->bitmap_left + x + 0.5, glyph->bitmap_top - y - 0.5) / double(em);
                const double value = sampleOutline(**outline, p.x, p.y).value;
                wrong += painted != (value < 0) && std::abs(value) * em > 0.5;
            }
        EXPECT_EQ(wrong, 0);
    }
    FT_Done_Face(face);
    FT_Done_FreeType(library);
}

TEST(Letters, HolesAreHolesAndLinesStandBelowEachOther) {
    EXPECT_EQ(contoursOf(boundaryOf("o")), 2u);
    EXPECT_EQ(contoursOf(boundaryOf("B8")), 6u);
    const Extent one = extentOf(boundaryOf("HH")), two = extentOf(boundaryOf("HH\nHH"));
    EXPECT_NEAR(one.lo.y, -one.hi.y, 1e-6) << "the middle is at y = 0";
    EXPECT_NEAR(one.lo.x + one.hi.x, 0, 0.1);
    EXPECT_NEAR(two.hi.y - two.lo.y - (one.hi.y - one.lo.y), 1.164, 0.01)
        << "DejaVu's lines are 1.164 em apart";
    TextLayout layout{.align = TextLayout::Align::left, .anchor = TextLayout::Anchor::baseline};
    EXPECT_NEAR(extentOf(boundaryOf("HH", layout)).lo.y, 0, 1e-6);
    EXPECT_GT(extentOf(boundaryOf("HH", layout)).lo.x, 0);
    layout.anchor = TextLayout::Anchor::top;
    EXPECT_NEAR(extentOf(boundaryOf("HH\nHH", layout)).hi.y, 0, 1e-6);
    layout.anchor = TextLayout::Anchor::bottom;
    EXPECT_NEAR(extentOf(boundaryOf("HH\nHH", layout)).lo.y, 0, 1e-6);
    layout.align = TextLayout::Align::right;
    EXPECT_LT(extentOf(boundaryOf("HH", layout)).hi.x, 0.1);
    const double spaced = extentOf(boundaryOf("HHH", {.letterSpacing = 0.5})).hi.x;
    EXPECT_NEAR(spaced - extentOf(boundaryOf("HHH")).hi.x, 0.5, 0.02) << "two gaps, about the centre";
    const Extent kerned = extentOf(boundaryOf("AVAVAV")),
                 apart = extentOf(boundaryOf("AVAVAV", {.kerning = false}));
    EXPECT_LT(kerned.hi.x - kerned.lo.x, apart.hi.x - apart.lo.x - 0.1);
    EXPECT_TRUE(boundaryOf("").empty());
    EXPECT_TRUE(boundaryOf(" \n ").empty());
}

TEST(Letters, AreShapedByTheirScript) {
    // Two letters of Arabic join; with a joiner forbidden between them they do not.
    const std::vector<Arc> joined = boundaryOf("\u0628\u0628"), apart = boundaryOf("\u0628\u200C\u0628");
    EXPECT_EQ(contoursOf(joined), 3u) << "one stroke and two dots";
    EXPECT_EQ(contoursOf(apart), 4u);
    // From right to left, digits in it from left to right: the digit that is written last stands on the left.
    const Extent whole = extentOf(boundaryOf("\u0628 1"));
    const double digit = extentOf(boundaryOf("1")).hi.x - extentOf(boundaryOf("1")).lo.x;
    const std::vector<Arc> line = boundaryOf("\u0628 1");
    double left = 0;
    for (const Arc& arc : line)
        if (arc.a.x < whole.lo.x + digit + 0.05) left = std::max(left, arc.a.y);
    EXPECT_NEAR(left, extentOf(line).hi.y, 1e-6) << "a digit is the higher of the two";
    if (!std::filesystem::exists("/usr/share/fonts/truetype/lohit-devanagari"))
        GTEST_SKIP() << "needs fonts-lohit-deva: run ./.install test";
    const TextLayout devanagari{.family = "Lohit Devanagari"};
    const auto area = [&](const std::string& text) { return areaOf(boundaryOf(text, devanagari)); };
    EXPECT_LT(area("\u0915\u094D\u0937"), 0.9 * (area("\u0915") + area("\u0937")))
        << "ksha is a letter of its own";
    // The sign of i stands before the letter that it is written behind: the letter's own stem is on the
    // right.
    const Extent ki = extentOf(boundaryOf("\u0915\u093F", devanagari)),
                 k = extentOf(boundaryOf("\u0915", devanagari));
    EXPECT_GT(ki.hi.x - ki.lo.x, k.hi.x - k.lo.x + 0.1);
    EXPECT_GT(ki.hi.y, k.hi.y + 0.05);
}

TEST(Letters, OverlapsAreInside) {
    // A font that draws one letter over another: negative spacing does it too.
    const std::vector<Arc> over = boundaryOf("OO", {.letterSpacing = -0.6});
    EXPECT_LT(areaOf(over), 2 * areaOf(boundaryOf("O")) - 0.01);
    EXPECT_GT(contoursOf(over), 2u);
}

TEST(Letters, WhatCannotBeWrittenIsRefusedByName) {
    const auto why = [](const std::string& text, const TextLayout& layout = {}) {
        const Result<Painting> painting = paintText("", text, layout);
        return painting ? std::string() : painting.error().message;
    };
    EXPECT_NE(why("a\U000F0000").find("U+F0000"), std::string::npos) << why("a\U000F0000");
    EXPECT_NE(why("x", {.family = "No Such Font"}).find("'No Such Font'"), std::string::npos);
    EXPECT_NE(why("\xFF").find("UTF-8"), std::string::npos);
    EXPECT_NE(why("\xC3").find("UTF-8"), std::string::npos);
    EXPECT_NE(why(std::string(30'000, 'x')).find("20000"), std::string::npos);
    EXPECT_NE(why("x", {.fontFile = "no.ttf"}).find("does not exist"), std::string::npos);
    const test::TempDir folder;
    test::writeText(folder.path("bad.ttf"), "no font at all");
    const Result<Painting> bad = paintText(folder.path("a.field.json"), "x", {.fontFile = "bad.ttf"});
    ASSERT_FALSE(bad);
    EXPECT_NE(bad.error().message.find("damaged"), std::string::npos);
    std::filesystem::copy_file(kDejaVu, folder.path("own.ttf"));
    const Result<Painting> own =
        paintText(folder.path("a.field.json"), "x", {.family = "No Such Font", .fontFile = "own.ttf"});
    ASSERT_TRUE(own) << own.error().message;
}

}  // namespace fw::letters_test
