// Whether a file has changed on disk since it was last asked about.
//
// By looking at it (modification time to the nanosecond, size, inode), some ten times a second: that finds
// what editors do, writing in place or renaming a new file over the old, on every file system, where change
// notices get lost over networks and with renames. A file that is missing for a moment has not changed yet.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>

namespace fw {

class FileWatch {
  public:
    explicit FileWatch(std::string path_) : path(std::move(path_)) { changed(); }

    /// True once after each change.
    bool changed();

  private:
    std::string path;
    int64_t seconds = 0, nanoseconds = 0;
    off_t size = -1;
    ino_t inode = 0;
};

}  // namespace fw
