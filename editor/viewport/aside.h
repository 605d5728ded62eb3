// Questions about the field that take longer than a frame, answered on a thread of its own.
//
// One is worked on at a time, and of those that wait only the newest is kept. An answer is a function that
// the interface's thread runs when it takes it. Lifetime: work may outlive neither what it refers to nor the
// Aside, whose end waits for it.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace fw::editor {

struct Editor;

class Aside {
  public:
    using Answer = std::function<void(Editor&)>;  ///< none: nothing to be done

    /// `answered` is called on the thread that works: to wake the interface.
    explicit Aside(std::function<void()> answered);
    ~Aside();

    void ask(std::function<Answer()> work);
    /// What was answered since the last call.
    Answer take();
    /// What is asked for or under way will have no answer.
    void forget();
    bool busy() const;

  private:
    void run();

    std::function<void()> answered;
    mutable std::mutex mutex;
    std::condition_variable asked;
    std::function<Answer()> next;
    Answer ready;
    bool stop = false, working = false;
    bool forgotten = false;  ///< what is under way is not wanted any more
    std::thread thread;
};

}  // namespace fw::editor
