// The interface's fonts: DejaVu Sans and, for code, DejaVu Sans Mono, each baked at several sizes.
//
// Lifetime: the ImFonts are the atlas's, which is ImGui's context's.
#pragma once

#include <imgui.h>

#include <string>
#include <vector>

namespace fw::editor {

inline constexpr float kFontSize = 14.0f;  ///< pixels, of the interface's text at scale 1

/// Text at any size between the smallest and largest baked one stays crisp: the nearest baked size is taken.
struct Fonts {
    std::vector<ImFont*> text;  ///< by rising size
    std::vector<ImFont*> code;  ///< the same, of fixed width
    std::string missing = {};   ///< what to install for the fonts that are meant; empty if they are there
    /// The font whose pixels are nearest to this size.
    ImFont* of(float pixels) const;
    ImFont* codeOf(float pixels) const;
    /// The size that of(pixels) is to be drawn at: as it was baked, if that is nearly the same.
    float crisp(float pixels) const;
};

/// Bakes them into the atlas, for an interface of this scale; text of size kFontSize becomes the default
/// font. Where the files are not found, ImGui's own font stands in, and `missing` says so.
Fonts bakeFonts(ImFontAtlas& atlas, float scale);

}  // namespace fw::editor
