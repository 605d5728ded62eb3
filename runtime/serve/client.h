// One client: reads its requests, has them answered, and drops all that is its when it goes.
//
// Each document has a thread, which answers what is asked of it in order; documents answer beside each other.
// What needs no work (`parameters`, `cancel`, `version`, `nodes`) is answered by the reader at once, whatever
// runs.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "runtime/serve/document.h"
#include "runtime/serve/queue.h"
#include "runtime/serve/wire.h"

namespace fw::serve {

class Client {
  public:
    /// `shutDown` is called when the client asks for the server's end. The wire outlives it.
    Client(Wire& wire_, OpenDevice openDevice_, std::function<void()> shutDown_)
        : wire(wire_), openDevice(std::move(openDevice_)), shutDown(std::move(shutDown_)) {}

    /// Returns when the client is gone, or asked for the end, and all its work has ended.
    void serve();

  private:
    struct Served {
        explicit Served(const OpenDevice& openDevice) : document(std::in_place, openDevice) {}
        std::optional<Document> document;
        std::atomic<bool> over = false;  ///< closed, could not be opened, or was for one request alone
        Queue queue;                     // last: its work refers to the others
    };

    void take(Request request);
    void answer(const Request& request, const Answer& answer);
    /// Has the document's thread do it. `lasts`: the document stays open if there is no fault.
    void queue(Served& served, Request request, Document::Method method, std::optional<int> opens,
               bool lasts);
    Answer work(Served& served, Document::Method method, Task& task);
    void close(Request request);
    void cancel(const Request& request);
    /// The document that the request names; answers it if there is none.
    std::map<int, std::unique_ptr<Served>>::iterator named(Request& request);
    /// A new one; null, and the request is answered, if there are too many.
    Served* add(const Request& request);
    /// It no longer counts as open. For the document's thread, before the answer that says so.
    void leave(Served& served);
    void forgetEnded();

    Wire& wire;
    OpenDevice openDevice;
    std::function<void()> shutDown;
    bool ends = false;
    int lastNumber = 0;
    std::map<int, std::unique_ptr<Served>> documents;  ///< by handle
    std::vector<std::unique_ptr<Served>> closing;      ///< with work left, or a thread that ends
    std::atomic<std::size_t> open = 0;                 ///< of both, those that did not leave()
    std::mutex mutex;
    std::vector<TaskPtr> tasks;    ///< without an answer
    std::size_t waitingBytes = 0;  ///< of their blobs
};

}  // namespace fw::serve
