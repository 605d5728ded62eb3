// Texts letter by letter: names of files may be in any language, and need not even be text.
#pragma once

#include <imgui.h>

#include <string>
#include <string_view>

namespace fw::editor {

inline constexpr char32_t kNoLetter = 0xfffd;  ///< stands for what is no UTF-8

/// Takes the first letter off; kNoLetter, and one byte off, where there is none. The text is not empty.
char32_t takeLetter(std::string_view& text);
/// With a mark in place of each byte that is no UTF-8.
std::string wellFormed(std::string_view text);

/// The text, or its beginning with "…", as wide as it may be in ImGui's present font.
std::string fitted(const std::string& text, float width);
/// The same in another font of this size.
std::string fitted(const std::string& text, float width, const ImFont* font, float size);
/// The same with the beginning left out: of paths, whose ends matter.
std::string fittedEnd(const std::string& text, float width);

/// Goes on in the line of the last item if something so wide still fits there; of a button the width of its
/// label is enough.
void besideIfFits(float width);
void besideIfFits(const char* buttonLabel);

}  // namespace fw::editor
