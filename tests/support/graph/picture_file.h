// Pictures for tests to read.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace fw::test {

/// Writes an RGB picture, rows from the top, as PNG, BMP or TGA by the ending of the path.
void writePictureFile(const std::string& path, int width, int height, const std::vector<uint8_t>& rgb);

}  // namespace fw::test
