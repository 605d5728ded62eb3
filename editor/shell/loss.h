// What ends the program from outside while a document is open: a signal that asks it to, or the display going
// away.
#pragma once

#include <atomic>
#include <functional>
#include <thread>

namespace fw::editor {

/// Hears SIGHUP, SIGINT and SIGTERM on a thread of its own, so that what they call for need not be safe in a
/// signal's handler. To be made before any other thread: they must not take these signals themselves. A
/// second signal ends the process at once. Lifetime: one a process.
class SignalWatch {
  public:
    /// `heard` is called on the thread with the first signal's number.
    explicit SignalWatch(std::function<void(int)> heard);
    SignalWatch(const SignalWatch&) = delete;
    SignalWatch& operator=(const SignalWatch&) = delete;
    ~SignalWatch();

  private:
    std::atomic<bool> stop = false;
    std::thread thread;
};

/// Calls `lost` when the X server is gone, on the thread that noticed, from within a call of the window
/// system that never returns: `lost` has to end the process. Nothing where there is no X. Empty: no more.
void onDisplayLost(std::function<void()> lost);

}  // namespace fw::editor
