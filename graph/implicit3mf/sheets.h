// Image stacks: the sheets of a 3MF image3d as pictures that a graph samples, and the code that does so.
//
// The sheets become one picture for each channel that differs, its sheets as tiles beside and above each
// other, grey as stored; of 16 bits it takes two pictures, the upper and the lower bytes, since what is
// linear between them is linear between their sum. Along w values are interpolated between two tiles. A tile
// that wraps has a border of one pixel, so that what lies beyond its edge is what comes round.
#pragma once

#include <string>
#include <vector>

#include "graph/implicit3mf/model.h"

namespace fw::threemf {

struct SheetPicture {
    std::string name;   ///< "red", "red_fine"
    std::string bytes;  ///< of a PNG file
};

/// The channels of an image stack.
struct Sheets {
    int width = 0, height = 0, count = 0;  ///< pixels of a sheet, and sheets
    bool fine = false;                     ///< 16 bits: each channel has a second picture, of its lower bytes
    std::vector<SheetPicture> pictures = {};
    /// Of red, green, blue and alpha: the number of their channel, or -1 where it is 1 everywhere.
    std::array<int, 4> channels{-1, -1, -1, -1};
    int columns = 1, border = 0;  ///< tiles beside each other, and pixels around each
    std::vector<std::string> remarks = {};
};

/// Reads the sheets. The Error has a message only.
Result<Sheets> readSheets(const Package& package, const ImageStack& stack);

/// Code that gives one channel at `place` (u, v, w) by the function's rules, of its pictures that are the
/// inputs `image` and, of 16 bits, `fine`.
std::string sheetCode(const Sheets& sheets, const ImageFunction& function);

}  // namespace fw::threemf
