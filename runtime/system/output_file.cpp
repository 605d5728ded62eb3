#include "runtime/system/output_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include "graph/base/fence.h"
#include "runtime/system/interruption.h"

namespace fw {
namespace {

constexpr std::size_t kBufferBytes = 256u << 10;
constexpr std::size_t kPieceBytes = 4u << 20;  // between two looks at the cancel flag
constexpr std::size_t kLongestName = 200;  // of the 255 bytes of most file systems: the suffix must fit too
constexpr char kCancelled[] = "cancelled; nothing was written";

std::string reason(int code) { return std::generic_category().message(code); }

Error failed(const std::string& path, const std::string& what) { return {.message = what, .file = path}; }

/// Names of temporary files. Whoever takes one out of its slot owns it, a signal's handler too. More files
/// than slots: those beyond stay behind if the process ends at once.
std::array<std::atomic<char*>, 16> unfinished;

int remember(const std::string& path) {
    char* name = ::strdup(path.c_str());
    for (std::size_t slot = 0; name && slot < unfinished.size(); ++slot) {
        char* none = nullptr;
        if (unfinished[slot].compare_exchange_strong(none, name)) return static_cast<int>(slot);
    }
    std::free(name);
    return -1;
}

void forget(int& slot) {
    if (slot >= 0) std::free(unfinished[static_cast<std::size_t>(slot)].exchange(nullptr));
    slot = -1;
}

/// Whether the path leads to the open file, and not to another of that name.
bool isAt(int descriptor, const std::string& path) {
    struct stat open {
    }, there{};
    return ::fstat(descriptor, &open) == 0 && ::lstat(path.c_str(), &there) == 0 &&
           open.st_ino == there.st_ino && open.st_dev == there.st_dev;
}

/// Removes a temporary file that no process holds; whether the name may be free now.
bool removeLeftOver(const std::string& path) {
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) return errno == ENOENT;
    struct stat status {};
    const bool free = ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) &&
                      ::flock(descriptor, LOCK_EX | LOCK_NB) == 0;
    // Whoever holds the lock of the file at a name is the only one to remove that name.
    const bool removed = free && (!isAt(descriptor, path) || ::unlink(path.c_str()) == 0);
    ::close(descriptor);
    return removed;
}

}  // namespace

void OutputFile::removeUnfinished() {
    for (std::atomic<char*>& slot : unfinished)
        if (const char* name = slot.exchange(nullptr)) ::unlink(name);
}

Result<OutputFile> OutputFile::open(const std::string& path, const std::atomic<bool>* cancel) {
    OutputFile file;
    file.shownPath = path;
    file.target = path;
    file.cancel = cancel;

    std::error_code code;
    if (std::filesystem::is_symlink(path, code)) {
        const auto resolved = std::filesystem::canonical(path, code);
        if (code) return failed(path, "cannot write: it is a link to nowhere (" + code.message() + ")");
        file.target = resolved.string();
    }

    if (const Done inside = checkMayWrite(file.target); !inside) return failed(path, inside.error().message);

    mode_t mode = 0;
    struct stat existing {};
    if (::stat(file.target.c_str(), &existing) == 0) {
        if (S_ISDIR(existing.st_mode)) return failed(path, "cannot write: it is a folder; name a file in it");
        if (!S_ISREG(existing.st_mode)) return failed(path, "cannot write: it is not a regular file");
        mode = existing.st_mode & 07777;
    }

    bool created = false;
    int cause = 0;
    {
        const Uninterrupted now;  // or the file would be there and its name not known
        created = file.create();
        cause = errno;
        if (created) file.slot = remember(file.temporary);
    }
    if (!created) {
        file.temporary.clear();
        std::string folder = std::filesystem::path(file.target).parent_path().string();
        if (folder.empty()) folder = ".";
        return failed(path, "cannot create a file in folder '" + folder + "': " + reason(cause));
    }
    // Best effort: a file system without permissions must not prevent the export.
    if (mode != 0 && ::fchmod(file.descriptor, mode) != 0) errno = 0;
    file.buffer = std::make_unique_for_overwrite<char[]>(kBufferBytes);
    return file;
}

/// Created by nobody else, and locked for as long as it is open: a temporary file without a lock is left over
/// from a process that was killed, and goes. On file systems without locks each stays.
bool OutputFile::create() {
    const std::filesystem::path full(target);
    const std::string stem = "." + full.filename().string().substr(0, kLongestName) + ".";
    for (unsigned number = 0;;) {
        temporary = (full.parent_path() / (stem + std::to_string(number) + ".tmp")).string();
        descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor >= 0) {
            if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
                ::close(std::exchange(descriptor, -1));  // just taken for left over
                ++number;
            } else if (isAt(descriptor, temporary)) {
                return true;
            } else {
                ::close(std::exchange(descriptor, -1));
            }
        } else if (errno != EEXIST) {
            return false;
        } else if (!removeLeftOver(temporary)) {
            ++number;
        }
    }
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : shownPath(std::move(other.shownPath)),
      target(std::move(other.target)),
      temporary(std::exchange(other.temporary, {})),
      slot(std::exchange(other.slot, -1)),
      failure(std::move(other.failure)),
      cancel(other.cancel),
      descriptor(std::exchange(other.descriptor, -1)),
      finished(other.finished),
      next(other.next),
      reached(other.reached),
      flushed(other.flushed),
      buffer(std::move(other.buffer)),
      buffered(std::exchange(other.buffered, 0)) {}

OutputFile::~OutputFile() { discard(); }

void OutputFile::discard() {
    if (descriptor >= 0) ::close(std::exchange(descriptor, -1));
    if (!temporary.empty()) ::unlink(std::exchange(temporary, {}).c_str());
    forget(slot);
}

void OutputFile::write(const void* data, std::size_t size) {
    next += size;
    reached = std::max(reached, next);
    if (!good() || size == 0) return;
    if (size > kBufferBytes - buffered) flush();
    if (size >= kBufferBytes) {
        put(static_cast<const char*>(data), size);
    } else {
        std::memcpy(buffer.get() + buffered, data, size);
        buffered += size;
    }
}

void OutputFile::goTo(uint64_t place) {
    if (place == next) return;
    flush();
    next = flushed = place;
}

void OutputFile::flush() {
    const std::size_t size = std::exchange(buffered, 0);
    put(buffer.get(), size);
}

void OutputFile::put(const char* data, std::size_t size) {
    while (size > 0 && good()) {
        if (cancel && cancel->load(std::memory_order_relaxed)) {
            failure = kCancelled;
            return;
        }
        const ssize_t count =
            ::pwrite(descriptor, data, std::min(size, kPieceBytes), static_cast<off_t>(flushed));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) {
            failure = "cannot write: " + reason(count < 0 ? errno : ENOSPC) + "; nothing was written";
            return;
        }
        data += count;
        size -= static_cast<std::size_t>(count);
        flushed += static_cast<std::size_t>(count);
    }
}

Done OutputFile::finish() {
    if (!finished) {
        finished = true;
        flush();
        if (good() && cancel && cancel->load(std::memory_order_relaxed)) failure = kCancelled;
        // Some file systems (network, quota) report a full disk only when the file is closed. The other
        // descriptor keeps the lock.
        const int copy = ::fcntl(descriptor, F_DUPFD_CLOEXEC, 0);
        if (copy >= 0 && ::close(copy) != 0 && good())
            failure = "cannot write: " + reason(errno) + "; nothing was written";
    }
    if (good()) return done();
    discard();
    return failed(shownPath, failure);
}

Done OutputFile::commit(const std::function<void()>& kept) {
    if (Done whole = finish(); !whole) return whole;
    const Uninterrupted now;
    if (::rename(temporary.c_str(), target.c_str()) != 0) {
        failure = "cannot replace the file: " + reason(errno);
        discard();
        return failed(shownPath, failure);
    }
    temporary.clear();
    discard();
    if (kept) kept();
    return done();
}

std::string lowerExtension(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    for (char& c : extension)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return extension;
}

}  // namespace fw
