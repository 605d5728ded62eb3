#include "runtime/render/picture.h"

#include <stb/stb_image_write.h>

#include <algorithm>
#include <new>

#include "runtime/system/output_file.h"

namespace fw {

Done checkPictureSize(int width, int height) {
    if (std::min(width, height) >= kLeastPictureSide && std::max(width, height) <= kMostPictureSide &&
        int64_t(width) * height <= kMostPicturePixels)
        return done();
    return Error{.message = "a picture's sides are from " + std::to_string(kLeastPictureSide) + " to " +
                            std::to_string(kMostPictureSide) + " pixels, with at most " +
                            std::to_string(kMostPicturePixels) + " in all"};
}

std::string pngOf(const Picture& picture) {
    const int channels = picture.alpha ? 4 : 3;
    std::vector<uint8_t> bytes;
    bytes.reserve(picture.pixels.size() / 4 * std::size_t(channels));
    for (std::size_t i = 0; i < picture.pixels.size(); i += 4)
        bytes.insert(bytes.end(), picture.pixels.begin() + i, picture.pixels.begin() + i + channels);
    std::string png;
    const auto append = [](void* to, void* data, int size) {
        static_cast<std::string*>(to)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
    };
    // The only failure: the encoder has no memory left.
    if (!stbi_write_png_to_func(append, &png, picture.width, picture.height, channels, bytes.data(),
                                channels * picture.width))
        throw std::bad_alloc();
    return png;
}

Done savePicture(const Picture& picture, const std::string& path, const std::function<void()>& kept) {
    Result<OutputFile> file = OutputFile::open(path, nullptr);
    if (!file) return file.error();
    file->write(pngOf(picture));
    return file->commit(kept);
}

}  // namespace fw
