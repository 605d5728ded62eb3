#include "runtime/system/file_watch.h"

#include <sys/stat.h>

#include <tuple>

namespace fw {

bool FileWatch::changed() {
    struct stat now {};
    if (stat(path.c_str(), &now) != 0) return false;
    const auto before = std::tuple(seconds, nanoseconds, size, inode);
    seconds = now.st_mtim.tv_sec, nanoseconds = now.st_mtim.tv_nsec;
    size = now.st_size, inode = now.st_ino;
    return before != std::tuple(seconds, nanoseconds, size, inode);
}

}  // namespace fw
