// Picture files: where they may lie, and how they become a FieldImage.
#include <stb/stb_image.h>

#include <algorithm>

#include "graph/assets/image.h"
#include "graph/base/asset_file.h"

namespace fw {

namespace {

Error problem(const std::string& path, const std::string& what) {
    return fileProblem(path, kPictureFile, what);
}

bool startsWith(const std::string& bytes, std::string_view magic) { return bytes.starts_with(magic); }

/// Of the formats that the decoder knows, those that a graph may use.
bool isKnownFormat(const std::string& bytes, const std::string& path) {
    return startsWith(bytes, "\x89PNG\r\n\x1A\n") || startsWith(bytes, "\xFF\xD8\xFF") ||
           startsWith(bytes, "BM") ||
           (endingOf(path) == ".tga" && !startsWith(bytes, "#?"));  // which begin with nothing of their own
}

Result<FieldImagePtr> decode(const std::string& bytes, const std::string& path, const std::string& file) {
    if (bytes.empty()) return problem(path, "is an empty file");
    if (!isKnownFormat(bytes, path)) return problem(path, "is none: use " + anyOf(kPictureFile));
    const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
    const int length = static_cast<int>(bytes.size());
    int width = 0, height = 0, channels = 0;
    if (!stbi_info_from_memory(data, length, &width, &height, &channels) || width < 1 || height < 1)
        return problem(path, "is damaged, or of a kind that cannot be read: save it again as PNG");
    if (std::max(width, height) > kMaxImageSide)
        return problem(path, "has " + std::to_string(width) + " x " + std::to_string(height) +
                                 " pixels: at most " + std::to_string(kMaxImageSide) +
                                 " along a side can be used, so scale it down");
    const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
        stbi_load_from_memory(data, length, &width, &height, &channels, 4), stbi_image_free);
    if (!pixels) return problem(path, "is damaged or cut off: save or copy it again");
    std::vector<uint32_t> texels;
    texels.reserve(std::size_t(width) * std::size_t(height));
    for (int y = height; y-- > 0;)
        for (int x = 0; x < width; ++x) {
            const stbi_uc* pixel = pixels.get() + 4 * (std::size_t(y) * std::size_t(width) + std::size_t(x));
            texels.push_back(uint32_t(pixel[0]) | uint32_t(pixel[1]) << 8 | uint32_t(pixel[2]) << 16);
        }
    return std::make_shared<const FieldImage>(width, height, std::move(texels), file);
}

}  // namespace

Result<FieldImagePtr> readImage(const std::string& graphPath, const std::string& path) {
    return readAsset<FieldImage>(
        graphPath, path, kPictureFile,
        [&](const std::string& bytes, const std::string& file) { return decode(bytes, path, file); });
}

}  // namespace fw
