#include "runtime/system/cache_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <span>

#include "graph/base/result.h"
#include "runtime/system/output_file.h"
#include "runtime/system/user_folder.h"

namespace fw {
namespace {

struct Header {
    uint32_t magic = 0x43445746;  // "FWDC"
    uint32_t words = 0;
    uint64_t key = 0, checksum = 0;
};

/// Closed at its end; without waiting for whoever writes to a pipe.
struct Reading {
    explicit Reading(const std::string& path)
        : descriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {}
    Reading(const Reading&) = delete;
    ~Reading() {
        if (descriptor >= 0) ::close(descriptor);
    }
    /// Bytes of an ordinary file, 0 of all else.
    uint64_t size() const {
        struct stat status {};
        const bool ordinary = ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
        return ordinary ? uint64_t(status.st_size) : 0;
    }
    bool read(void* to, std::size_t bytes) const {
        for (auto* at = static_cast<char*>(to); bytes > 0;) {
            const ssize_t got = ::read(descriptor, at, bytes);
            if (got < 0 && errno == EINTR) continue;
            if (got <= 0) return false;
            at += got;
            bytes -= std::size_t(got);
        }
        return true;
    }
    const int descriptor;
};

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
    const Reading file(path);
    Header header;
    // The length is checked before it is believed: a damaged header must not cost a gigabyte.
    const uint64_t size = file.size();
    if (size < sizeof header || !file.read(&header, sizeof header) || header.magic != Header{}.magic ||
        header.key != key || size != sizeof header + uint64_t(header.words) * 4)
        return {};
    std::vector<uint32_t> words(header.words);
    if (!file.read(words.data(), words.size() * 4)) return {};
    if (hashBytes(words.data(), words.size() * 4) != header.checksum) return {};
    return words;
}

void writeCacheFile(const std::string& path, uint64_t key, const std::vector<uint32_t>& words) {
    if (path.empty()) return;
    std::error_code error;
    std::filesystem::create_directories(std::filesystem::path(path).parent_path(), error);
    Result<OutputFile> file = OutputFile::open(path, nullptr);
    if (!file) return;
    const Header header{
        .words = uint32_t(words.size()), .key = key, .checksum = hashBytes(words.data(), words.size() * 4)};
    file->write(&header, sizeof header);
    file->write(std::span<const uint32_t>(words));
    (void)file->commit();
}

}  // namespace fw
