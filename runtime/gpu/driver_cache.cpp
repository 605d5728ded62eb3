#include "runtime/gpu/driver_cache.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>

namespace fw {
namespace {

namespace fs = std::filesystem;

constexpr off_t kIndexBytes = 8 + 65536 * 20;  // of Mesa up to 23; the driver resizes what it finds
std::string whyNone;

std::string driverCacheFolder() {
    for (const auto& [variable, below] :
         {std::pair("MESA_SHADER_CACHE_DIR", ""), std::pair("MESA_GLSL_CACHE_DIR", ""),
          std::pair("XDG_CACHE_HOME", ""), std::pair("HOME", "/.cache")})
        if (const char* folder = std::getenv(variable); folder && *folder)
            return std::string(folder) + below + "/mesa_shader_cache";
    return {};
}

/// Whether every page of the file can be written to, or that cannot be known.
bool hasRoom(const std::string& index) {
    const int file = open(index.c_str(), O_RDWR | O_CREAT | O_NONBLOCK | O_CLOEXEC, 0644);
    if (file < 0) return errno != ENOSPC && errno != EDQUOT;
    struct stat status {};
    bool room = true;
    if (fstat(file, &status) == 0 && S_ISREG(status.st_mode)) {
        const bool fails = fallocate(file, 0, 0, std::max(status.st_size, kIndexBytes)) != 0;
        room = !fails || (errno != ENOSPC && errno != EDQUOT);
        if (!room && status.st_size == 0) unlink(index.c_str());
    }
    close(file);
    return room;
}

}  // namespace

void makeRoomForDriverCache() {
    const std::string folder = driverCacheFolder();
    if (folder.empty() || std::getenv("MESA_SHADER_CACHE_DISABLE")) return;
    std::error_code failure;
    fs::create_directories(folder, failure);
    const bool full = failure == std::errc::no_space_on_device;
    if (!full && (failure || hasRoom(folder + "/index"))) return;
    whyNone = "there is no room for " + folder;
    setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
    setenv("MESA_GLSL_CACHE_DISABLE", "true", 1);  // before Mesa 21
}

const std::string& whyNoDriverCache() { return whyNone; }

}  // namespace fw
