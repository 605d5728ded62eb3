#include "editor/shell/loss.h"

#include <dlfcn.h>
#include <pthread.h>
#include <unistd.h>

#include <csignal>
#include <utility>

namespace fw::editor {

namespace {

sigset_t watched() {
    sigset_t set;
    sigemptyset(&set);
    for (const int signal : {SIGHUP, SIGINT, SIGTERM}) sigaddset(&set, signal);
    return set;
}

std::function<void()> displayLost;

int hear(void*) {
    if (displayLost) std::exchange(displayLost, {})();
    return 0;  // and Xlib ends the process
}

}  // namespace

SignalWatch::SignalWatch(std::function<void(int)> heard) {
    const sigset_t set = watched();
    pthread_sigmask(SIG_BLOCK, &set, nullptr);
    thread = std::thread([this, set, tell = std::move(heard)] {
        for (bool first = true;; first = false) {
            int signal = 0;
            if (sigwait(&set, &signal) != 0 || stop) return;
            if (!first) _exit(128 + signal);
            tell(signal);
        }
    });
}

SignalWatch::~SignalWatch() {
    stop = true;
    pthread_kill(thread.native_handle(), SIGTERM);
    thread.join();
}

void onDisplayLost(std::function<void()> lost) {
    displayLost = std::move(lost);
    // Xlib comes with GLFW; nothing else here needs it, so that it is looked up rather than linked.
    using Handler = int (*)(void*);
    const auto set = reinterpret_cast<Handler (*)(Handler)>(dlsym(RTLD_DEFAULT, "XSetIOErrorHandler"));
    if (set) set(hear);
}

}  // namespace fw::editor
