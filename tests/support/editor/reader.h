// Reads the screen: finds words where the interface's own fonts have drawn them.
//
// The words are drawn once more, as the editor draws text, and looked for in the picture by normalised
// correlation, so that colours and what lies behind do not matter. Nothing in the program helps.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "editor/canvas/view.h"
#include "editor/shell/fonts.h"
#include "runtime/render/picture.h"

namespace fw::editor::test {

class Reader {
  public:
    Reader();

    enum class Face : unsigned char { text, code };
    /// Where these whole words, of one colour, stand first in the picture, rows from the top; their size in
    /// pixels. Only within the area, if there is one.
    std::optional<Area> find(const Picture& picture, const std::string& words, float size = kFontSize,
                             const std::optional<Area>& within = std::nullopt, Face face = Face::text);

  private:
    /// How much of each pixel the text covers.
    struct Mask {
        int width = 0, height = 0;
        std::vector<float> cover;
    };
    const Mask& maskOf(const std::string& words, float size, Face face);

    std::unique_ptr<ImFontAtlas> atlas;
    Fonts fonts;
    std::map<std::tuple<std::string, float, Face>, Mask> masks;
    std::vector<float> light;  ///< of the picture that is read
};

}  // namespace fw::editor::test
