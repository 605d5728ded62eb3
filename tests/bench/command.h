// The fieldwright command as a process of its own, as a user starts it: the one beside this program.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace fw::bench {

struct Outcome {
    int status = 0;           ///< exit status, -1 if it did not exit
    double milliseconds = 0;  ///< wall clock
    uint64_t peakBytes = 0;   ///< greatest resident set, or this process's at the spawn if that was more
};

/// Runs it with arguments; caches lie in `cache`, what it prints is dropped. Watching its memory
/// costs it some time.
Outcome runCommand(std::vector<std::string> arguments, const std::string& cache);

/// A folder of its own under the system's for temporary files, removed with its content at the end.
struct TemporaryFolder {
    TemporaryFolder();
    ~TemporaryFolder();
    std::string path;
};

}  // namespace fw::bench
