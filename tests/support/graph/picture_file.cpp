#include "tests/support/graph/picture_file.h"

#include <gtest/gtest.h>
#include <stb/stb_image_write.h>

namespace fw::test {

void writePictureFile(const std::string& path, int width, int height, const std::vector<uint8_t>& rgb) {
    ASSERT_EQ(rgb.size(), std::size_t(3 * width * height));
    int written = 0;
    if (path.ends_with(".png"))
        written = stbi_write_png(path.c_str(), width, height, 3, rgb.data(), 3 * width);
    else if (path.ends_with(".bmp"))
        written = stbi_write_bmp(path.c_str(), width, height, 3, rgb.data());
    else if (path.ends_with(".tga"))
        written = stbi_write_tga(path.c_str(), width, height, 3, rgb.data());
    ASSERT_NE(written, 0) << path;
}

}  // namespace fw::test
