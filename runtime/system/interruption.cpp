#include "runtime/system/interruption.h"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <string_view>
#include <utility>

#include "runtime/system/output_file.h"

namespace fw {
namespace {

constexpr int kEnding = -1;
std::atomic<int> holds = 0;    // how many Uninterrupted live, or kEnding
std::atomic<int> waiting = 0;  // a signal that came meanwhile
WhenEnded* ending = nullptr;   // changed and read with `holds` taken

void say(std::string_view text) {
    if (write(STDERR_FILENO, text.data(), text.size()) < 0) return;  // nobody is left to tell
}

/// Safe in a signal's handler; `holds` is kEnding.
[[noreturn]] void end(int signal) {
    OutputFile::removeUnfinished();
    const WhenEnded& when = *ending;
    const bool kept = !when.folder.empty() && rmdir(when.folder.c_str()) != 0;
    if (isatty(STDERR_FILENO)) say("\r\033[K");
    say(signal == SIGINT ? "fieldwright: interrupted" : "fieldwright: ended");
    say(when.said);
    say("\n");
    if (kept && access(when.folder.c_str(), F_OK) == 0) say(when.kept);
    _exit(128 + signal);
}

void onSignal(int signal) {
    int none = 0;
    if (holds.compare_exchange_strong(none, kEnding)) end(signal);
    if (none == kEnding) return;
    waiting = signal;
    // The last hold may have gone meanwhile, without having seen it.
    none = 0;
    if (holds.compare_exchange_strong(none, kEnding)) end(signal);
}

}  // namespace

void endOnSignals(WhenEnded when) {
    whenEnded(std::move(when));
    struct sigaction action {};
    action.sa_handler = onSignal;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

void whenEnded(WhenEnded when) {
    const Uninterrupted now;
    delete std::exchange(ending, new WhenEnded(std::move(when)));
}

Uninterrupted::Uninterrupted() {
    for (int count = holds;;) {
        while (count == kEnding) pause();  // another thread ends the process
        if (holds.compare_exchange_weak(count, count + 1)) return;
    }
}

Uninterrupted::~Uninterrupted() {
    if (--holds != 0 || waiting == 0) return;
    int none = 0;
    if (holds.compare_exchange_strong(none, kEnding)) end(waiting);
}

}  // namespace fw
