// The interface's fonts: DejaVu Sans and, for code, DejaVu Sans Mono, each baked at several sizes.
//
// Letters that an interface does not write itself, but names of files and texts of documents have, are baked
// only when they are wanted: from DejaVu, or, for those of China, Japan and Korea, from a font that may be
// installed beside it. What no font has is drawn as a mark. ImGui's letters have 16 bits: emoji beyond are
// marks too.
//
// Lifetime: the ImFonts are the atlas's, which is ImGui's context's.
#pragma once

#include <imgui.h>

#include <string>
#include <string_view>
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

/// Has the letters of the text in the fonts from the next frame on, as far as fonts here have them. For texts
/// that are not the program's own; on the thread of the interface.
void wantGlyphs(std::string_view text);
/// Whether some are that were not when fonts were baked last.
bool glyphsAreWanted();

/// Reads them into the atlas, for an interface of this scale. Where the files are not found, ImGui's own font
/// stands in, and `missing` says so.
Fonts readFonts(ImFontAtlas& atlas, float scale);
/// Bakes what was read, which takes a tenth of a second: on any thread, while no other touches the atlas.
void bakeFonts(ImFontAtlas& atlas);

}  // namespace fw::editor
