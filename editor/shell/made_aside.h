// One thing at a time that is made beside the interface, which is woken once it is there.
//
// That it is there comes before the waking: an interface that slept already draws what it was woken for, and
// sleeps again.
#pragma once

#include <chrono>
#include <future>
#include <utility>

#include "editor/shell/shell.h"

namespace fw::editor {

/// Lifetime: the destructor waits for what is being made.
template <class T>
class MadeAside {
  public:
    /// Calls make() on a thread of its own. What was begun before must have been taken.
    template <class Make>
    void begin(Make make) {
        std::packaged_task<T()> task(std::move(make));
        made = task.get_future();
        running = std::async(std::launch::async, [task = std::move(task)]() mutable {
            task();
            Shell::wake();
        });
    }
    /// Whether something was begun, and not yet taken.
    bool begun() const { return made.valid(); }
    bool isThere() const {
        return begun() && made.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    }
    /// What make() returned, or threw.
    T take() { return made.get(); }

  private:
    std::future<T> made;
    std::future<void> running;
};

}  // namespace fw::editor
