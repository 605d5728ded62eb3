#include "editor/files/watch.h"

#include <sys/stat.h>

#include <cerrno>
#include <functional>
#include <utility>

#include "graph/document/json.h"

namespace fw::editor {

void FileWatch::follow(std::string path_, std::string_view text) {
    path = std::move(path_);
    hash = std::hash<std::string_view>()(text);
    there = true;
    // It may have been written again already: the first look reads it.
    stamp = {};
}

std::optional<FileWatch::Change> FileWatch::look(Clock::time_point now) {
    if (std::chrono::duration<double>(now - looked).count() < kWatchSeconds) return std::nullopt;
    looked = now;
    return lookNow();
}

std::optional<FileWatch::Change> FileWatch::lookNow() {
    if (path.empty()) return std::nullopt;
    struct stat status {};
    if (stat(path.c_str(), &status) != 0) {
        // What cannot be looked at for another reason may come back: a share that is away.
        const bool gone = errno == ENOENT || errno == ENOTDIR;
        if (!gone || !std::exchange(there, false)) return std::nullopt;
        stamp = {};
        return Change{.gone = true};
    }
    there = true;
    const Stamp seen{status.st_mtim.tv_sec, status.st_mtim.tv_nsec, status.st_size, status.st_ino};
    if (std::exchange(stamp, seen) == seen) return std::nullopt;
    Result<std::string> text = readGraphText(path);
    if (!text) {
        stamp = {};  // it is read once it can be, which need not change it
        return std::nullopt;
    }
    const std::size_t content = std::hash<std::string_view>()(*text);
    if (std::exchange(hash, content) == content) return std::nullopt;
    return Change{.text = std::move(*text)};
}

}  // namespace fw::editor
