#include "editor/viewport/aside.h"

#include <exception>
#include <utility>

#include "editor/editor.h"

namespace fw::editor {

Aside::Aside(std::function<void()> answered_) : answered(std::move(answered_)), thread([this] { run(); }) {}

Aside::~Aside() {
    {
        std::lock_guard lock(mutex);
        stop = true;
    }
    asked.notify_all();
    thread.join();
}

void Aside::ask(std::function<Answer()> work) {
    std::lock_guard lock(mutex);
    next = std::move(work);
    asked.notify_all();
}

Aside::Answer Aside::take() {
    std::lock_guard lock(mutex);
    return std::exchange(ready, nullptr);
}

void Aside::forget() {
    std::lock_guard lock(mutex);
    next = nullptr, ready = nullptr;
    forgotten = working;
}

bool Aside::busy() const {
    std::lock_guard lock(mutex);
    return working || next;
}

void Aside::run() {
    std::unique_lock lock(mutex);
    for (;;) {
        asked.wait(lock, [&] { return stop || next; });
        if (stop) return;
        const std::function<Answer()> work = std::exchange(next, nullptr);
        working = true;
        lock.unlock();
        Answer answer;
        try {
            answer = work();
        } catch (const std::exception& error) {
            answer = [why = std::string(error.what())](Editor& editor) { say(editor, why); };
        }
        lock.lock();
        working = false;
        if (std::exchange(forgotten, false)) continue;
        ready = std::move(answer);
        if (answered) answered();
    }
}

}  // namespace fw::editor
