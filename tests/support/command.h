// Runs the real `fieldwright` as a user would and says what came of it: status, both streams, and what it
// cost.
#pragma once

#include <signal.h>
#include <sys/types.h>

#include <functional>
#include <string>
#include <vector>

namespace fw::test {

struct CommandOptions {
    std::vector<std::string> wrapper = {};      ///< words before the program: {"unshare", "-rm", …}
    std::vector<std::string> environment = {};  ///< "NAME=value" entries over the test's own
    int interruptAfterMs = -1;                  ///< sends `signal` after this time, if not negative
    int signal = SIGINT;
    /// Standard error is a terminal, and `signal` is sent when this is first read there; nothing if empty.
    std::string interruptAt = {};
    std::function<void()> meanwhile = {};  ///< called while the command runs; `signal` is sent behind it
    long maxFileBytes = -1;                ///< RLIMIT_FSIZE, if not negative
};

struct CommandResult {
    int status = -1;  ///< exit status; 128 + signal if it was killed
    bool killed = false;
    std::string output, errors;
    double cpuSeconds = 0.0;  ///< user and system time
    double peakMegabytes = 0.0;
};

// What bounds a program's work on hostile input: its processor's time, in seconds, and its memory. Under a
// sanitizer it is slower and larger.
#ifdef __SANITIZE_ADDRESS__
inline constexpr double kMostSeconds = 10.0, kMostMegabytes = 1500.0;
#else
inline constexpr double kMostSeconds = 2.0, kMostMegabytes = 500.0;
#endif

/// `fieldwright` with these arguments. Its caches lie in a folder of the test program's own unless the
/// options' environment says otherwise.
CommandResult runCommand(const std::vector<std::string>& arguments, const CommandOptions& options = {});

/// Expects that the command ended by itself with this status, said all of `parts` on standard error in at
/// most five lines, printed no result, and took less than `maxSeconds` of processor time and kMostMegabytes.
void expectRefusal(const CommandResult& result, int status, const std::vector<std::string>& parts,
                   double maxSeconds = kMostSeconds);

}  // namespace fw::test
