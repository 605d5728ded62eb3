// Notices that another program changed or removed a file.
//
// It looks at the file's time and size, and reads it only if those are others; what matters is the content.
// Each change is told once. Lifetime: one a document; it holds nothing open.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace fw::editor {

inline constexpr double kWatchSeconds = 1.0;  ///< at least, between two looks

class FileWatch {
  public:
    using Clock = std::chrono::steady_clock;
    struct Change {
        bool gone = false;
        std::string text = {};  ///< what the file holds now
    };

    /// From now on this file, which holds `text` as far as its reader or writer knows. Empty: none.
    void follow(std::string path, std::string_view text);
    /// What changed since it was last told.
    std::optional<Change> lookNow();
    /// The same; nothing if that was looked for less than kWatchSeconds ago.
    std::optional<Change> look(Clock::time_point now = Clock::now());

  private:
    /// What tells that a file was written since.
    struct Stamp {
        int64_t seconds = 0, nanoseconds = 0, bytes = -1;
        uint64_t number = 0;  ///< of the file in its file system: another one has its name now
        bool operator==(const Stamp&) const = default;
    };

    std::string path;
    Stamp stamp;
    std::size_t hash = 0;  ///< of the content
    bool there = true;
    Clock::time_point looked = {};
};

}  // namespace fw::editor
