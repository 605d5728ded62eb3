// A file that appears whole or not at all: written under a temporary name in the same folder, then renamed.
//
// Lifetime: open, any number of writes, commit. Destroyed without a commit it removes the temporary file. The
// first failure (full disk, cancelled) is kept; later writes do nothing and commit returns it.
//
// Durability: rename is atomic, so whoever opens the name sees the old file or the new one, whole, and a
// killed process leaves the old one, and a temporary file that the next one to write the name removes: as
// long as a process lives it holds a lock of it. There is no fsync: measured, it triples the time of writing,
// and a mesh can be made again from its graph. After a power cut within the system's write-back time (about
// 30 s) the name may hold the old file or, on file systems that do not order data before a rename, a short
// one.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "graph/base/result.h"

namespace fw {

class OutputFile {
  public:
    /// Creates the temporary file beside `path`, with the permissions of the file it will replace if there is
    /// one. A symbolic link is followed. Errors: `path` is a folder or a device, its folder is missing or
    /// unwritable.
    static Result<OutputFile> open(const std::string& path, const std::atomic<bool>* cancel);

    OutputFile(OutputFile&& other) noexcept;
    OutputFile& operator=(OutputFile&&) = delete;
    ~OutputFile();

    /// Appends bytes; small writes are gathered, large ones go to the system in pieces of 4 MiB without a
    /// copy.
    void write(const void* data, std::size_t size);
    void write(std::string_view text) { write(text.data(), text.size()); }
    template <class T>
    void write(std::span<const T> values) {
        write(values.data(), values.size_bytes());
    }

    /// What is written next goes to byte `place` on, before or behind what was written. In the end every byte
    /// of the file must have been.
    void goTo(uint64_t place);
    /// The byte that is written next.
    uint64_t position() const { return next; }

    /// False once a write has failed or the export was cancelled: formatting more is pointless.
    bool good() const { return failure.empty(); }
    /// Bytes of the file so far.
    uint64_t size() const { return reached; }

    /// Writes what is buffered; the name still shows the old file. For exports of several files.
    Done finish();
    /// The file that holds the bytes until commit().
    const std::string& place() const { return temporary; }
    /// Finishes if that is not done, then renames to the final name and calls `kept`; no signal ends the
    /// process between them, so that what it says of the file there (whenEnded()) is true.
    Done commit(const std::function<void()>& kept = {});

    /// Removes the temporary files of all that are open, for a process that ends at once: safe in a signal's
    /// handler.
    static void removeUnfinished();

  private:
    OutputFile() = default;
    bool create();
    void flush();
    void put(const char* data, std::size_t size);
    void discard();

    std::string shownPath;  ///< as the user gave it
    std::string target;     ///< with links resolved
    std::string temporary;  ///< empty once renamed or removed
    int slot = -1;          ///< where removeUnfinished() finds its name
    std::string failure;
    const std::atomic<bool>* cancel = nullptr;
    int descriptor = -1;
    bool finished = false;
    uint64_t next = 0, reached = 0;
    uint64_t flushed = 0;  ///< where the buffer's first byte goes
    std::unique_ptr<char[]> buffer;
    std::size_t buffered = 0;
};

/// The ending of a path's name with its point, in small letters: ".glb".
std::string lowerExtension(const std::string& path);

}  // namespace fw
