// A finished picture on the host, and its PNG file.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "graph/base/result.h"

namespace fw {

inline constexpr int kLeastPictureSide = 16, kMostPictureSide = 8192;
inline constexpr int kMostPicturePixels = 32 << 20;  ///< 128 MiB of four bytes, which every device can bind

/// Rows from the top, sRGB, four bytes a pixel: red, green, blue, alpha. Colours are not multiplied by alpha.
struct Picture {
    int width = 0, height = 0;
    std::vector<uint8_t> pixels;
    bool alpha = false;  ///< some of it may be below 255
};

/// An Error where no picture of this size can be made.
Done checkPictureSize(int width, int height);

/// The bytes of a PNG file of it, with alpha only if it has some.
std::string pngOf(const Picture& picture);

/// Writes the picture as PNG; `kept` as in OutputFile::commit(). Errors: as
/// OutputFile.
Done savePicture(const Picture& picture, const std::string& path, const std::function<void()>& kept = {});

}  // namespace fw
