// What Ctrl-C (SIGINT) and SIGTERM do to a command: they end it where it is, at once, with nothing unfinished
// left.
//
// Why not a flag that long work reads: most of the time goes to code that reads none (the driver's compiler,
// searches, bakes, reports), and what a command writes appears whole or not at all (output_file.h). So the
// handler removes the temporary files, says what became of the outputs, and leaves; the exit status is 128
// and the signal's number, 130 or 143. What must not be parted (two renames) is done under Uninterrupted.
#pragma once

#include <string>

namespace fw {

/// What is said, and done, when a signal ends the process.
struct WhenEnded {
    std::string said = {};    ///< behind "fieldwright: interrupted" or "fieldwright: ended"
    std::string folder = {};  ///< removed if it is empty; if not empty itself
    std::string kept = {};    ///< a line said if something is left in the folder
};

/// From now on the signals end the process.
void endOnSignals(WhenEnded when);
/// From now on this is said and done. Without effect on a program that has not called endOnSignals().
void whenEnded(WhenEnded when);

/// While one lives, signals wait. For moments, never around work.
class Uninterrupted {
  public:
    Uninterrupted();
    Uninterrupted(const Uninterrupted&) = delete;
    ~Uninterrupted();
};

}  // namespace fw
