// The scheme can be read, and types told apart, by everyone.
#include "editor/shell/theme.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace fw::editor {
namespace {

/// Relative luminance as the Web Content Accessibility Guidelines define it.
double luminance(ImU32 color) {
    const auto linear = [&](int shift) {
        const double value = double((color >> shift) & 255u) / 255.0;
        return value <= 0.03928 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
    };
    return 0.2126 * linear(0) + 0.7152 * linear(8) + 0.0722 * linear(16);
}

double contrast(ImU32 a, ImU32 b) {
    const double x = luminance(a) + 0.05, y = luminance(b) + 0.05;
    return std::max(x, y) / std::min(x, y);
}

constexpr int kTypes = int(Type::mesh) + 1, kCategories = int(Category::structure) + 1;

TEST(Theme, TextStandsOut) {
    ImGui::CreateContext();
    applyTheme(1.0f);
    const auto field = ImGui::ColorConvertFloat4ToU32(ImGui::GetStyle().Colors[ImGuiCol_FrameBg]),
               panel = ImGui::ColorConvertFloat4ToU32(ImGui::GetStyle().Colors[ImGuiCol_WindowBg]);
    for (const ThemeColor ink : {ThemeColor::text, ThemeColor::quiet, ThemeColor::error, ThemeColor::warning})
        for (const ImU32 paper : {themeColor(ThemeColor::canvas), themeColor(ThemeColor::node), panel, field})
            EXPECT_GE(contrast(themeColor(ink), paper), 4.5) << int(ink) << ' ' << std::hex << paper;
    for (int i = 0; i < kCategories; ++i)
        EXPECT_GE(contrast(themeColor(ThemeColor::onTitle), categoryColor(Category(i))), 4.5) << i;
    ImGui::DestroyContext();
}

TEST(Theme, TypesDifferInShapeOrInLightness) {
    for (int a = 0; a < kTypes; ++a) {
        EXPECT_GE(contrast(typeColor(Type(a)), themeColor(ThemeColor::node)), 3.0) << a;
        for (int b = 0; b < a; ++b)
            EXPECT_TRUE(socketShape(Type(a)) != socketShape(Type(b)) ||
                        contrast(typeColor(Type(a)), typeColor(Type(b))) >= 1.5)
                << a << ' ' << b;
    }
}

}  // namespace
}  // namespace fw::editor
