#include "editor/shell/letters.h"

#include <cfloat>
#include <vector>

namespace fw::editor {

namespace {

/// Where each letter begins, and the end.
std::vector<std::size_t> beginnings(std::string_view text) {
    std::vector<std::size_t> all{0};
    for (std::string_view rest = text; !rest.empty();) {
        takeLetter(rest);
        all.push_back(text.size() - rest.size());
    }
    return all;
}

float widthOf(std::string_view text) { return ImGui::CalcTextSize(text.data(), text.data() + text.size()).x; }

}  // namespace

char32_t takeLetter(std::string_view& text) {
    const auto byte = [&](std::size_t i) { return i < text.size() ? (unsigned char)text[i] : 0u; };
    const unsigned first = byte(0);
    std::size_t count = first < 0x80u ? 1 : first < 0xc2u ? 0 : first < 0xe0u ? 2 : first < 0xf0u ? 3 : 4;
    if (first > 0xf4u) count = 0;
    char32_t letter = count <= 1 ? first : first & (0x7fu >> count);
    for (std::size_t i = 1; i < count; ++i) {
        if ((byte(i) & 0xc0u) != 0x80u) count = 0;
        letter = letter << 6 | (byte(i) & 0x3fu);
    }
    constexpr char32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
    if (letter < kLeast[count] || letter > 0x10ffff || (letter >= 0xd800 && letter < 0xe000)) count = 0;
    text.remove_prefix(count > 0 ? count : 1);
    return count > 0 ? letter : kNoLetter;
}

std::string wellFormed(std::string_view text) {
    std::string whole;
    while (!text.empty()) {
        std::string_view rest = text;
        const bool none = takeLetter(rest) == kNoLetter && text.size() - rest.size() == 1;
        if (none)
            whole += "\xef\xbf\xbd";
        else
            whole += text.substr(0, text.size() - rest.size());
        text = rest;
    }
    return whole;
}

std::string fitted(const std::string& text, float width) {
    return fitted(text, width, ImGui::GetFont(), ImGui::GetFontSize());
}

std::string fitted(const std::string& text, float width, const ImFont* font, float size) {
    const auto widthOf = [&](const std::string& words) {
        return font->CalcTextSizeA(size, FLT_MAX, 0.0f, words.c_str()).x;
    };
    if (widthOf(text) <= width) return text;
    const std::vector<std::size_t> ends = beginnings(text);
    std::size_t low = 0, high = ends.size() - 1;
    while (low + 1 < high) {
        const std::size_t middle = (low + high) / 2;
        (widthOf(text.substr(0, ends[middle]) + "…") <= width ? low : high) = middle;
    }
    return text.substr(0, ends[low]) + "…";
}

std::string fittedEnd(const std::string& text, float width) {
    if (widthOf(text) <= width) return text;
    const std::vector<std::size_t> begins = beginnings(text);
    std::size_t low = 0, high = begins.size() - 1;
    while (low + 1 < high) {
        const std::size_t middle = (low + high) / 2;
        (widthOf("…" + text.substr(begins[middle])) <= width ? high : low) = middle;
    }
    return "…" + text.substr(begins[high]);
}

void besideIfFits(float width) {
    const float right = ImGui::GetCursorScreenPos().x + ImGui::GetContentRegionAvail().x;  // of a column too
    if (ImGui::GetItemRectMax().x + ImGui::GetStyle().ItemSpacing.x + width <= right) ImGui::SameLine();
}

void besideIfFits(const char* buttonLabel) {
    besideIfFits(ImGui::CalcTextSize(buttonLabel, nullptr, true).x + 2.0f * ImGui::GetStyle().FramePadding.x);
}

}  // namespace fw::editor
