// Picture files: where they may lie, and how they become a FieldImage.
#include <fcntl.h>
#include <stb/stb_image.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <map>
#include <mutex>

#include "graph/image.h"

namespace fw {

namespace {

namespace fs = std::filesystem;

Error problem(const std::string& path, const std::string& what) {
    return {.message = "the picture " + inQuotes(path) + " " + what};
}

/// The file that the path leads to, symbolic links followed. It may not exist.
Result<std::string> locate(const std::string& graphPath, const std::string& path) {
    if (path.find('\0') != std::string::npos) return problem(path, "has a NUL byte in its path: remove it");
    std::error_code failure;
    const fs::path folder = fs::path(graphPath).parent_path();
    const fs::path root = fs::weakly_canonical(folder.empty() ? fs::path(".") : folder, failure);
    if (failure) return problem(path, "cannot be looked up: " + failure.message());
    const fs::path target = fs::weakly_canonical(root / path, failure);
    if (failure) return problem(path, "cannot be looked up: " + failure.message());
    const fs::path inside = target.lexically_relative(root);
    if (fs::path(path).is_absolute() || inside.empty() || *inside.begin() == "..")
        return problem(path,
                       "lies outside the folder of the graph: move it there and write its path from the "
                       "graph's file");
    return target.string();
}

struct OpenFile {
    int number;
    ~OpenFile() {
        if (number >= 0) close(number);
    }
};

bool startsWith(const std::string& bytes, std::string_view magic) { return bytes.starts_with(magic); }

/// Of the formats that the decoder knows, those that a graph may use.
bool isKnownFormat(const std::string& bytes, const std::string& path) {
    std::string ending = fs::path(path).extension().string();
    for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return startsWith(bytes, "\x89PNG\r\n\x1A\n") || startsWith(bytes, "\xFF\xD8\xFF") ||
           startsWith(bytes, "BM") || ending == ".tga";  // whose files begin with nothing of their own
}

Result<FieldImagePtr> decode(const std::string& bytes, const std::string& path, const std::string& file) {
    if (bytes.empty()) return problem(path, "is an empty file");
    if (!isKnownFormat(bytes, path)) return problem(path, "is none: use a PNG, JPEG, BMP or TGA file");
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

/// What was read before and is still held somewhere. By path; `stamp` tells whether the file is the same.
struct Known {
    std::array<int64_t, 4> stamp;
    std::weak_ptr<const FieldImage> image;
};

}  // namespace

Result<FieldImagePtr> readImage(const std::string& graphPath, const std::string& path) {
    const Result<std::string> file = locate(graphPath, path);
    if (!file) return file.error();
    // Not waiting for whoever writes to a pipe.
    const OpenFile open_{::open(file->c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
    struct stat status = {};
    if (open_.number < 0 || fstat(open_.number, &status) != 0)
        return problem(path, errno == ENOENT || errno == ENOTDIR ? "does not exist: check the path"
                             : errno == EACCES                   ? "may not be read: change its permissions"
                                               : "cannot be opened: " + std::string(std::strerror(errno)));
    if (S_ISDIR(status.st_mode)) return problem(path, "is a folder: name a picture in it");
    if (!S_ISREG(status.st_mode)) return problem(path, "is no ordinary file: name a picture");
    if (status.st_size > static_cast<off_t>(kMaxImageFileBytes))
        return problem(path, "is a file of more than " + std::to_string(kMaxImageFileBytes >> 20) +
                                 " MiB: use a smaller one");

    static std::mutex mutex;
    static std::map<std::string, Known> known;
    const std::array<int64_t, 4> stamp = {int64_t(status.st_ino), int64_t(status.st_size),
                                          int64_t(status.st_mtim.tv_sec), int64_t(status.st_mtim.tv_nsec)};
    {
        const std::lock_guard lock(mutex);
        const auto found = known.find(*file);
        if (found != known.end() && found->second.stamp == stamp)
            if (FieldImagePtr held = found->second.image.lock()) return held;
        std::erase_if(known, [](const auto& entry) { return entry.second.image.expired(); });
    }
    std::string bytes(static_cast<std::size_t>(status.st_size), '\0');
    std::size_t read = 0;
    while (read < bytes.size()) {
        const ssize_t got = ::read(open_.number, bytes.data() + read, bytes.size() - read);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return problem(path, "cannot be read: " + std::string(std::strerror(errno)));
        if (got == 0) break;  // it has just become shorter
        read += static_cast<std::size_t>(got);
    }
    bytes.resize(read);
    const Result<FieldImagePtr> image = decode(bytes, path, *file);
    if (image) {
        const std::lock_guard lock(mutex);
        known[*file] = {stamp, *image};
    }
    return image;
}

}  // namespace fw
