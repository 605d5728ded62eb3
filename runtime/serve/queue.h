// One thread that does what it is given, in that order.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace fw::serve {

class Queue {
  public:
    Queue() : worker([this] { run(); }) {}
    Queue(const Queue&) = delete;
    /// Waits until all is done.
    ~Queue() {
        finish();
        worker.join();
    }

    void add(std::function<void()> work) {
        {
            const std::lock_guard lock(mutex);
            waiting.push_back(std::move(work));
        }
        changed.notify_one();
    }
    /// Nothing more is added.
    void finish() {
        {
            const std::lock_guard lock(mutex);
            finished = true;
        }
        changed.notify_one();
    }
    /// finish() was called, and all is done: the destructor need not wait.
    bool ended() {
        const std::lock_guard lock(mutex);
        return done;
    }

  private:
    void run() {
        std::unique_lock lock(mutex);
        for (;;) {
            changed.wait(lock, [this] { return finished || !waiting.empty(); });
            if (waiting.empty()) break;
            const std::function<void()> work = std::move(waiting.front());
            waiting.pop_front();
            lock.unlock();
            work();
            lock.lock();
        }
        done = true;
    }

    std::mutex mutex;
    std::condition_variable changed;
    std::deque<std::function<void()>> waiting;
    bool finished = false, done = false;
    std::thread worker;  // last: it uses the others
};

}  // namespace fw::serve
