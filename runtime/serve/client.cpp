#include "runtime/serve/client.h"

#include <algorithm>
#include <utility>

#include "graph/base/words.h"
#include "graph/library/reference.h"

namespace fw::serve {

namespace {

std::size_t blobBytes(const Request& request) {
    std::size_t bytes = 0;
    for (const ComingBlob& blob : request.coming) bytes += blob.bytes;
    return bytes;
}

Answer versionAnswer() {
    Reply reply;
    reply.result = {{"name", "fieldwright"}, {"version", FIELDWRIGHT_VERSION}, {"protocol", kProtocol}};
    reply.result["format"] = kFormatVersion;
    reply.result["limits"] = {
        {"messageBytes", kMostMessageBytes},  {"blobBytes", kMostBlobBytes}, {"blobs", kMostBlobs},
        {"replyBytes", kMostReplyBytes},      {"documents", kMostDocuments}, {"waiting", kMostWaiting},
        {"resolution", kMostServedResolution}};
    return reply;
}

Answer nodesAnswer() {
    Reply reply;
    reply.result = Json::parse(nodesJson());
    return reply;
}

}  // namespace

void Client::serve() {
    for (std::string line; !ends;) {
        const Wire::Read read = wire.line(line);
        if (read == Wire::Read::end) break;
        if (read == Wire::Read::tooLong) {
            wire.send(answerLine(nullptr, Fault(kTooMuch, "a message is a line of at most " +
                                                              std::to_string(kMostMessageBytes >> 20) +
                                                              " MiB: send what is larger as a blob")));
            continue;
        }
        if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
        std::variant<Request, NoRequest> message = readRequest(line);
        if (const NoRequest* none = std::get_if<NoRequest>(&message)) {
            if (!wire.skip(none->coming)) break;
            wire.send(answerLine(none->id, none->fault));
            continue;
        }
        Request request = std::move(std::get<Request>(message));
        const std::size_t bytes = blobBytes(request);
        bool room = false;
        {
            const std::lock_guard lock(mutex);
            room = tasks.size() < kMostWaiting && waitingBytes + bytes <= kMostBlobBytes;
        }
        if (room || bytes == 0) {
            bool whole = true;
            for (const ComingBlob& blob : request.coming) {
                std::string& taken = request.blobs.emplace_back(blob.bytes, '\0');
                whole = whole && wire.bytes(taken.data(), taken.size());
            }
            if (!whole) break;
        } else if (!wire.skip(bytes)) {
            break;
        }
        if (room || request.method == "cancel" || request.method == "shutdown")
            take(std::move(request));
        else
            answer(
                request,
                Fault(kTooMuch, "at most " + std::to_string(kMostWaiting) + " requests, with blobs of " +
                                    std::to_string(kMostBlobBytes >> 20) +
                                    " MiB together, wait for their answers: wait for some, or cancel them"));
    }
    {
        const std::lock_guard lock(mutex);
        for (const TaskPtr& task : tasks) task->cancelled.request();
    }
    documents.clear();
    closing.clear();
}

void Client::answer(const Request& request, const Answer& answer) {
    if (!request.answered) return;
    const Reply* reply = std::get_if<Reply>(&answer);
    wire.send(answerLine(request.id, answer),
              reply ? std::span<const Blob>(reply->blobs) : std::span<const Blob>());
}

void Client::take(Request request) {
    const auto& methods = Document::methods();
    forgetEnded();
    const std::string& name = request.method;
    if (name == "cancel") return cancel(request);
    if (name == "version" || name == "nodes" || name == "shutdown") {
        if (const auto fault = Params(request.params, name).fault()) return answer(request, *fault);
        answer(request, name == "version" ? versionAnswer() : name == "nodes" ? nodesAnswer() : Reply{});
        if (name != "shutdown") return;
        ends = true;
        return shutDown();
    }
    if (name == "close") return close(std::move(request));
    if (name == "open") {
        if (Served* served = add(request))
            queue(*served, std::move(request), &Document::open, lastNumber, true);
        return;
    }
    if (name == "check" && !request.params.contains("document")) {
        if (Served* served = add(request))
            queue(*served, std::move(request), &Document::check, std::nullopt, false);
        return;
    }
    const auto method = std::ranges::find(methods, name, &std::pair<std::string, Document::Method>::first);
    if (method == methods.end() && name != "parameters") {
        std::vector<std::string> names = {"open",   "close",   "parameters", "nodes",
                                          "cancel", "version", "shutdown"};
        for (const auto& [known, does] : methods) names.push_back(known);
        return answer(request, Fault(kNoMethod, "there is no method " + inQuotes(name) +
                                                    meant(name, names, ": there are " + listed(names))));
    }
    const auto found = named(request);
    if (found == documents.end()) return;
    if (method != methods.end())
        return queue(*found->second, std::move(request), method->second, std::nullopt, true);
    if (const auto fault = Params(request.params, name).fault()) return answer(request, *fault);
    Reply reply;
    reply.result["parameters"] = found->second->document->parameters();
    answer(request, reply);
}

std::map<int, std::unique_ptr<Client::Served>>::iterator Client::named(Request& request) {
    const auto handle = request.params.find("document");
    const bool number = handle != request.params.end() && handle->is_number_integer() && *handle > 0;
    const auto found = number && *handle <= lastNumber ? documents.find(handle->get<int>()) : documents.end();
    if (found == documents.end())
        answer(request, Fault(kWrongParameters,
                              "\"document\" of " + request.method + " is the number that open answered" +
                                  (number ? ", and there is none " + handle->dump() + ", or it was closed"
                                          : ": give it")));
    else
        request.params.erase("document");
    return found;
}

Client::Served* Client::add(const Request& request) {
    if (open >= kMostDocuments) {
        answer(request,
               Fault(kTooMuch, "at most " + std::to_string(kMostDocuments) +
                                   " documents are open at once: close one, and wait for its answer"));
        return nullptr;
    }
    ++open;
    return documents.emplace(++lastNumber, std::make_unique<Served>(openDevice)).first->second.get();
}

void Client::queue(Served& served, Request request, Document::Method method, std::optional<int> opens,
                   bool lasts) {
    const auto task = std::make_shared<Task>();
    task->request = std::move(request);
    if (task->request.answered)
        task->tell = seldom([this, id = task->request.id](const char* part, double done) {
            wire.send(notificationLine("progress", {{"id", id}, {"part", part}, {"done", done}}));
        });
    {
        const std::lock_guard lock(mutex);
        tasks.push_back(task);
        waitingBytes += blobBytes(task->request);
    }
    served.queue.add([this, &served, task, method, opens, lasts] {
        Answer made = work(served, method, *task);
        const bool failed = std::holds_alternative<Fault>(made);
        if ((opens && failed) || !lasts) leave(served);
        if (Reply* reply = std::get_if<Reply>(&made)) {
            std::size_t bytes = 0;
            for (const Blob& blob : reply->blobs) bytes += blob.bytes.size();
            if (opens) reply->result["document"] = *opens;
            if (bytes > kMostReplyBytes)
                made = Fault(kTooMuch, "the answer has more than " + std::to_string(kMostReplyBytes >> 20) +
                                           " MiB: lower the resolution, or export it to a file");
        }
        {
            const std::lock_guard lock(mutex);
            std::erase(tasks, task);
            waitingBytes -= blobBytes(task->request);
        }
        answer(task->request, made);
    });
}

Answer Client::work(Served& served, Document::Method method, Task& task) {
    return guarded(*served.document, [&]() -> Answer {
        if (task.cancelled) return cancelledFault();
        if (served.over) return Fault(kWrongParameters, "the document could not be opened");
        Params params(task.request.params, task.request.method);
        return (*served.document.*method)(params, task);
    });
}

void Client::close(Request request) {
    const auto found = named(request);
    if (found == documents.end()) return;
    if (const auto fault = Params(request.params, request.method).fault()) return answer(request, *fault);
    Served& served = *closing.emplace_back(std::move(found->second));
    documents.erase(found);
    served.queue.add([this, &served, request = std::move(request)] {
        served.document.reset();  // before the answer: whoever has it knows that the memory is free
        leave(served);
        answer(request, Reply{});
    });
    served.queue.finish();
}

void Client::leave(Served& served) {
    if (!served.over.exchange(true)) --open;
}

void Client::cancel(const Request& request) {
    Params params(request.params, request.method);
    params.need("id");
    const Json* id = params.any("id");
    if (const auto fault = params.fault()) return answer(request, *fault);
    bool any = false;
    {
        const std::lock_guard lock(mutex);
        for (const TaskPtr& task : tasks)
            if (id && task->request.answered && task->request.id == *id) {
                task->cancelled.request();
                any = true;
            }
    }
    Reply reply;
    reply.result["cancelled"] = any;
    answer(request, reply);
}

void Client::forgetEnded() {
    for (auto each = documents.begin(); each != documents.end();) {
        const auto one = each++;
        if (!one->second->over) continue;
        one->second->queue.finish();
        closing.push_back(std::move(one->second));
        documents.erase(one);
    }
    std::erase_if(closing, [](const std::unique_ptr<Served>& served) { return served->queue.ended(); });
}

}  // namespace fw::serve
