// The Model Context Protocol on standard input and output: an assistant models with the tools that it is
// shown.
//
// Revisions 2025-06-18 and 2024-11-05 of modelcontextprotocol.io/specification: `initialize`, `ping`,
// `tools/list`, `tools/call`, and the notifications of cancelling and of progress. What a tool cannot do is
// its result, marked as an error, so that the assistant reads what to mend; an error of the protocol is one
// that the client made.
//
// Graphs are files below the roots. What was opened for one call is kept for the next, and read again when
// the file has changed.
#pragma once

#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "runtime/serve/document.h"
#include "runtime/serve/queue.h"
#include "runtime/serve/wire.h"

namespace fw::serve {

inline constexpr std::size_t kKeptGraphs = 4;  ///< whose devices stay open

class Assistant {
  public:
    Assistant(Wire& wire_, OpenDevice openDevice_) : wire(wire_), openDevice(std::move(openDevice_)) {}

    /// Returns when the client is gone and all work has ended.
    void serve();

  private:
    struct Kept {
        std::string path, text;
        std::unique_ptr<Document> document;
    };

    void take(Request request);
    Answer initialize(const Request& request);
    void call(Request request);
    void cancel(const Request& request);
    void answer(const Request& request, const Answer& answer);

    Answer listNodes(Params& params);
    Answer nodeHelp(Params& params);
    Answer writeGraph(Params& params);
    Answer checkGraph(Params& params, Task& task);
    Answer look(Params& params, Task& task);
    Answer measure(Params& params, Task& task);
    Answer exportMesh(Params& params, Task& task);
    /// The file's document, kept or new; the first of those that are kept then.
    Document& documentOf(const std::string& path);
    /// Has the first of them be what its file is now.
    std::optional<Fault> readAnew(const std::string& path, Task& task);
    /// Does `work` with the document that the arguments name, at their time, with their values, and all
    /// others as in the file.
    Answer with(Params& params, Task& task, const std::function<Answer(Document&)>& work);

    Wire& wire;
    OpenDevice openDevice;
    bool greeted = false;
    std::list<Kept> kept;  ///< the last used first
    std::mutex mutex;
    std::vector<TaskPtr> tasks;  ///< without an answer
    std::unique_ptr<Queue> queue;
};

}  // namespace fw::serve
