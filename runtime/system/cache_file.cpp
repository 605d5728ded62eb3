#include "runtime/system/cache_file.h"

#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "graph/base/result.h"
#include "runtime/system/user_folder.h"

namespace fw {
namespace {

struct Header {
    uint32_t magic = 0x43445746;  // "FWDC"
    uint32_t words = 0;
    uint64_t key = 0, checksum = 0;
};

struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Close>;

}  // namespace

uint64_t hashBytes(const void* data, std::size_t size, uint64_t seed) {
    auto* bytes = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < size; ++i) seed = (seed ^ bytes[i]) * 0x100000001b3ull;
    return seed;
}

std::string cacheFolder() { return userFolder("XDG_CACHE_HOME", "/.cache"); }

std::string cachePath(const std::string& kind, const std::string& name) {
    std::string folder = cacheFolder();
    return folder.empty() ? folder : folder + "/" + kind + "/" + name;
}

std::vector<uint32_t> readCacheFile(const std::string& path, uint64_t key) {
    if (path.empty()) return {};
    File file(std::fopen(path.c_str(), "rb"));
    Header header;
    constexpr uint32_t kMostWords = 1u << 28;
    if (!file || std::fread(&header, sizeof header, 1, file.get()) != 1 || header.magic != Header{}.magic ||
        header.key != key || header.words > kMostWords)
        return {};
    // The length is checked before it is believed: a damaged header must not cost a gigabyte.
    std::error_code error;
    if (std::filesystem::file_size(path, error) != sizeof header + uint64_t(header.words) * 4 || error)
        return {};
    std::vector<uint32_t> words(header.words);
    if (std::fread(words.data(), 4, words.size(), file.get()) != words.size()) return {};
    if (hashBytes(words.data(), words.size() * 4) != header.checksum) return {};
    return words;
}

void writeCacheFile(const std::string& path, uint64_t key, const std::vector<uint32_t>& words) {
    if (path.empty()) return;
    static std::atomic<int> counter = 0;
    std::string temporary = path + "." + std::to_string(getpid()) + "." + std::to_string(counter++) + ".tmp";
    std::error_code error;
    std::filesystem::create_directories(std::filesystem::path(path).parent_path(), error);
    if (error) return;
    File file(std::fopen(temporary.c_str(), "wb"));
    if (!file) return;
    Header header{
        .words = uint32_t(words.size()), .key = key, .checksum = hashBytes(words.data(), words.size() * 4)};
    bool written = std::fwrite(&header, sizeof header, 1, file.get()) == 1 &&
                   std::fwrite(words.data(), 4, words.size(), file.get()) == words.size();
    written = std::fclose(file.release()) == 0 && written;
    if (written) std::filesystem::rename(temporary, path, error);
    if (!written || error) std::filesystem::remove(temporary, error);
}

}  // namespace fw
