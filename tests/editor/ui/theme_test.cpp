// The scheme can be read, and types told apart, by everyone.
#include "editor/shell/desktop_theme.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <utility>

namespace fw::editor::theme_test {

double linear(double value) {
    return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

glm::dvec3 linearOf(ImU32 color) {
    const auto part = [&](int shift) { return linear(double((color >> shift) & 255u) / 255.0); };
    return {part(0), part(8), part(16)};
}

/// Relative luminance as the Web Content Accessibility Guidelines define it.
double luminance(ImU32 color) { return glm::dot(linearOf(color), glm::dvec3(0.2126, 0.7152, 0.0722)); }

double contrast(ImU32 a, ImU32 b) {
    const double x = luminance(a) + 0.05, y = luminance(b) + 0.05;
    return std::max(x, y) / std::min(x, y);
}

/// How people see linear sRGB who lack one kind of cones, as glm has matrices: by columns. From G. M.
/// Machado, M. M. Oliveira, L. A. F. Fernandes: A Physiologically-based Model for Simulation of Color Vision
/// Deficiency, IEEE Transactions on Visualization and Computer Graphics 15 (6), 2009, severity 1.
const std::pair<const char*, glm::dmat3> kVisions[] = {
    {"all cones", glm::dmat3(1.0)},
    {"protanopia",
     {0.152286, 0.114503, -0.003882, 1.052583, 0.786281, -0.048116, -0.204868, 0.099216, 1.051998}},
    {"deuteranopia",
     {0.367322, 0.280085, -0.011820, 0.860646, 0.672501, 0.042940, -0.227968, 0.047413, 0.968881}},
    {"tritanopia",
     {1.255528, -0.078411, 0.004733, -0.076749, 0.930809, 0.691367, -0.178779, 0.147602, 0.303900}},
};

/// CIE 1976 L*a*b* of linear sRGB with the white D65.
glm::dvec3 lab(glm::dvec3 color) {
    const glm::dmat3 toXyz(0.4124564, 0.2126729, 0.0193339, 0.3575761, 0.7151522, 0.1191920, 0.1804375,
                           0.0721750, 0.9503041);
    const glm::dvec3 xyz = toXyz * glm::clamp(color, 0.0, 1.0) / glm::dvec3(0.95047, 1.0, 1.08883);
    const auto f = [](double t) {
        return t > 216.0 / 24389.0 ? std::cbrt(t) : (24389.0 / 27.0 * t + 16.0) / 116.0;
    };
    return {116.0 * f(xyz.y) - 16.0, 500.0 * (f(xyz.x) - f(xyz.y)), 200.0 * (f(xyz.y) - f(xyz.z))};
}

/// How far apart two colours are for those who see them least apart: CIE 1976 difference, of which about 2.3
/// can just be noticed.
double leastDifference(ImU32 a, ImU32 b) {
    double least = INFINITY;
    for (const auto& [name, sees] : kVisions)
        least = std::min(least, glm::distance(lab(sees * linearOf(a)), lab(sees * linearOf(b))));
    return least;
}

/// What holds of one scheme holds of the other.
class Themes : public testing::TestWithParam<Theme> {
  protected:
    void SetUp() override { setTheme(GetParam()); }
    void TearDown() override { setTheme(Theme::dark); }
};
INSTANTIATE_TEST_SUITE_P(Theme, Themes, testing::Values(Theme::dark, Theme::light), [](const auto& each) {
    return std::string(each.param == Theme::light ? "Light" : "Dark");
});

TEST_P(Themes, CodeStandsOut) {
    for (ThemeColor ink = ThemeColor::codeWord; ink < ThemeColor::codeNumber; ink = ThemeColor(int(ink) + 1))
        for (const ThemeColor paper : {ThemeColor::canvas, ThemeColor::codeLine})
            EXPECT_GE(contrast(themeColor(ink), themeColor(paper)), 4.5) << int(ink) << ' ' << int(paper);
    EXPECT_GE(contrast(themeColor(ThemeColor::argument), themeColor(ThemeColor::header)), 4.5);
    EXPECT_GE(contrast(themeColor(ThemeColor::text), themeColor(ThemeColor::textSelected)), 4.5);
}

TEST_P(Themes, LinesAreSeen) {
    for (const ThemeColor paper : {ThemeColor::canvas, ThemeColor::node}) {
        EXPECT_GE(contrast(themeColor(ThemeColor::selected), themeColor(paper)), 3.0);
        EXPECT_GE(contrast(themeColor(ThemeColor::active), themeColor(paper)), 2.9);
        for (std::size_t axis = 0; axis < 3; ++axis)
            EXPECT_GE(contrast(axisColor(axis), themeColor(paper)), 3.0) << axis;
        for (int type = 0; type < kTypes; ++type)
            EXPECT_GE(contrast(typeColor(Type(type)), themeColor(paper)), 2.8) << type;
    }
}

TEST_P(Themes, WordsOverThePictureStandOutOnTheirPlate) {
    const ImU32 plate = themeColor(ThemeColor::plate);
    const unsigned alpha = plate >> IM_COL32_A_SHIFT & 255u;
    // Over what is as bright as the plate is dark, or the other way round, and over grey.
    for (const unsigned below : {0u, 128u, 200u}) {
        ImU32 paper = IM_COL32_A_MASK;
        for (const int shift : {0, 8, 16})
            paper |= ((plate >> shift & 255u) * alpha + below * (255u - alpha)) / 255u << shift;
        for (const ThemeColor ink : {ThemeColor::text, ThemeColor::warning})
            EXPECT_GE(contrast(themeColor(ink), paper), 4.5) << int(ink) << ' ' << below;
    }
}

TEST_P(Themes, TextStandsOut) {
    ImGui::CreateContext();
    applyTheme(1.0f);
    const auto field = ImGui::ColorConvertFloat4ToU32(ImGui::GetStyle().Colors[ImGuiCol_FrameBg]),
               panel = ImGui::ColorConvertFloat4ToU32(ImGui::GetStyle().Colors[ImGuiCol_WindowBg]);
    for (const ThemeColor ink : {ThemeColor::text, ThemeColor::quiet, ThemeColor::error, ThemeColor::warning})
        for (const ImU32 paper : {themeColor(ThemeColor::canvas), themeColor(ThemeColor::node), panel, field})
            EXPECT_GE(contrast(themeColor(ink), paper), 4.5) << int(ink) << ' ' << std::hex << paper;
    // Text on what ImGui draws itself: fields, buttons, tabs, lists and menus in all their states.
    for (const ImGuiCol paper :
         {ImGuiCol_PopupBg, ImGuiCol_FrameBgHovered, ImGuiCol_FrameBgActive, ImGuiCol_ButtonHovered,
          ImGuiCol_ButtonActive, ImGuiCol_MenuBarBg, ImGuiCol_TitleBg, ImGuiCol_TitleBgActive,
          ImGuiCol_Header, ImGuiCol_HeaderHovered, ImGuiCol_HeaderActive, ImGuiCol_Tab, ImGuiCol_TabHovered,
          ImGuiCol_TabActive, ImGuiCol_TableHeaderBg, ImGuiCol_TextSelectedBg})
        EXPECT_GE(contrast(themeColor(ThemeColor::text),
                           ImGui::ColorConvertFloat4ToU32(ImGui::GetStyle().Colors[paper])),
                  4.5)
            << ImGui::GetStyleColorName(paper);
    for (int i = 0; i < kCategories; ++i)
        EXPECT_GE(contrast(themeColor(ThemeColor::onTitle), categoryColor(Category(i))), 4.5) << i;
    ImGui::DestroyContext();
}

TEST_P(Themes, TypesDifferInShapeOrInLightness) {
    for (int a = 0; a < kTypes; ++a) {
        EXPECT_GE(contrast(typeColor(Type(a)), themeColor(ThemeColor::node)), 3.0) << a;
        for (int b = 0; b < a; ++b)
            EXPECT_TRUE(socketShape(Type(a)) != socketShape(Type(b)) ||
                        contrast(typeColor(Type(a)), typeColor(Type(b))) >= 1.5)
                << a << ' ' << b;
    }
}

TEST_P(Themes, TypesOfOneShapeDifferForTheColourBlind) {
    double least = INFINITY;
    for (int a = 0; a < kTypes; ++a)
        for (int b = 0; b < a; ++b) {
            if (socketShape(Type(a)) != socketShape(Type(b))) continue;
            const double apart = leastDifference(typeColor(Type(a)), typeColor(Type(b)));
            EXPECT_GE(apart, 30.0) << typeName(Type(a)) << ' ' << typeName(Type(b));
            least = std::min(least, apart);
        }
    std::printf("types of one shape: at least %.1f apart\n", least);
}

TEST_P(Themes, CategoriesDifferForTheColourBlind) {
    double least = INFINITY;
    for (int a = 0; a < kCategories; ++a) {
        EXPECT_GE(leastDifference(categoryColor(Category(a)), themeColor(ThemeColor::node)), 10.0)
            << categoryName(Category(a));
        for (int b = 0; b < a; ++b) {
            const double apart = leastDifference(categoryColor(Category(a)), categoryColor(Category(b)));
            EXPECT_GE(apart, 12.0) << categoryName(Category(a)) << ' ' << categoryName(Category(b));
            least = std::min(least, apart);
        }
    }
    std::printf("categories: at least %.1f apart\n", least);
}

TEST_P(Themes, StatesDifferForTheColourBlind) {
    const ThemeColor states[] = {ThemeColor::selected, ThemeColor::active, ThemeColor::error,
                                 ThemeColor::edge};
    for (const ThemeColor a : states)
        for (const ThemeColor b : states) {
            if (a == b) continue;
            EXPECT_GE(leastDifference(themeColor(a), themeColor(b)), 20.0) << int(a) << ' ' << int(b);
        }
}

TEST(Theme, OfTheDesktop) {
    EXPECT_EQ(themeOfGtkName(""), std::nullopt);
    EXPECT_EQ(themeOfGtkName("Adwaita:dark"), Theme::dark);
    EXPECT_EQ(themeOfGtkName("Adwaita"), Theme::light);
    EXPECT_EQ(themeOfGtkSettings("[Settings]\ngtk-theme-name=Breeze\n"), Theme::light);
    EXPECT_EQ(themeOfGtkSettings("[Settings]\ngtk-theme-name = Yaru-dark\n"), Theme::dark);
    EXPECT_EQ(themeOfGtkSettings("[Settings]\ngtk-application-prefer-dark-theme=1\n"), Theme::dark);
    EXPECT_EQ(themeOfGtkSettings("gtk-theme-name=Breeze\n"), std::nullopt) << "no section";
    EXPECT_EQ(themeOfKdeGlobals("[Colors:Window]\r\nBackgroundNormal=239,240,241\r\n"), Theme::light);
    EXPECT_EQ(themeOfKdeGlobals("[Colors:Window]\nBackgroundNormal=32,35,38"), Theme::dark);
    EXPECT_EQ(themeOfKdeGlobals("[Colors:Window]\nBackgroundNormal=blue"), std::nullopt);
    EXPECT_EQ(themeOf(themeChoice("light")), Theme::light);
    EXPECT_EQ(themeOf(themeChoice("of tomorrow")), Theme::dark);
}

/// Machado's matrices keep white and grey as they are.
TEST(Theme, SimulatedVisionKeepsGrey) {
    for (const auto& [name, sees] : kVisions)
        EXPECT_LT(glm::distance(sees * glm::dvec3(0.5), glm::dvec3(0.5)), 1e-3) << name;
}

}  // namespace fw::editor::theme_test
