// Text as outlines: laid out in lines, shaped by HarfBuzz, drawn by the font.
//
// Each line is parted by direction (Unicode's bidirectional algorithm, by FriBidi) and by script, and each
// run is shaped, so that Arabic joins and Devanagari takes its order. Letters overlap where a font draws them
// so: what is filled is what is wound a number of times other than 0.
//
// The unit is the em: the size of the text is what it is multiplied by. The baseline of the first line is y =
// 0.
//
// Lifetime: fonts that were used lately stay in memory.
#pragma once

#include <string>

#include "graph/base/result.h"
#include "graph/outlines/boundary.h"
#include "graph/outlines/outline.h"

namespace fw {

inline constexpr std::size_t kMostTextBytes = 20'000;

struct TextLayout {
    enum class Align : unsigned char { left, center, right };
    enum class Anchor : unsigned char { middle, baseline, top, bottom };
    std::string family =
        "DejaVu Sans";  ///< as fontconfig has it, with a style behind a colon: "DejaVu Serif:bold"
    std::string fontFile =
        {};  ///< a path as openAsset() has it; if it is not empty the family does not matter
    Align align = Align::center;  ///< of the lines, about x = 0
    /// What is at y = 0: the middle between `top` and `bottom`; the first line's baseline; the top of its
    /// capitals; the last line's baseline.
    Anchor anchor = Anchor::middle;
    double letterSpacing = 0;  ///< further space behind each letter, em
    double lineSpacing = 1;    ///< of the font's own
    bool kerning = true;
};

/// What is painted of a text (UTF-8; lines end with \n) from the folder of the file `graphPath`. Errors, with
/// a message only: no such font, or it is damaged; it has no letter for something (and which family has); too
/// long; no UTF-8.
Result<Painting> paintText(const std::string& graphPath, const std::string& text, const TextLayout& layout);

/// The same as an outline; null of a text without anything to see. One that was made lately is not made
/// again.
Result<OutlinePtr> outlineOfText(const std::string& graphPath, const std::string& text,
                                 const TextLayout& layout);

}  // namespace fw
