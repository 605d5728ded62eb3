#include "runtime/serve/assistant.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "graph/base/words.h"
#include "graph/check/check.h"
#include "graph/document/json.h"
#include "graph/library/node_type.h"
#include "graph/library/reference.h"
#include "runtime/serve/tools.h"

namespace fw::serve {

namespace {

constexpr std::array<const char*, 2> kRevisions = {"2025-06-18", "2024-11-05"};  // the newest first

std::string base64(std::string_view bytes) {
    constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (i + k < bytes.size() ? uint8_t(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            text += i + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

/// What a tool says.
Reply said(std::string text) {
    Reply reply;
    reply.result["content"] = Json::array({{{"type", "text"}, {"text", std::move(text)}}});
    return reply;
}

std::string words(const std::vector<Error>& findings) {
    std::string text;
    for (const Error& finding : findings) text += format(finding) + "\n";
    return text;
}

/// An answer as a tool has it: what is at fault is for the assistant to read.
Answer asTool(Answer answer) {
    const Fault* fault = std::get_if<Fault>(&answer);
    if (!fault || fault->code == kCancelled) return answer;
    Reply reply = said(fault->findings.empty() ? format(fault->error) : words(fault->findings));
    reply.result["isError"] = true;
    return reply;
}

std::string firstSentence(const std::string& doc) { return doc.substr(0, doc.find('.') + 1); }

/// The arguments of Document's methods that have these names here too.
Json taken(Params& params, std::initializer_list<const char*> names) {
    Json json = Json::object();
    for (const char* name : names)
        if (const Json* value = params.any(name)) json[name] = *value;
    return json;
}

/// One of Document's methods with these parameters.
Answer asked(Document& document, Answer (Document::*method)(Params&, Task&), const Json& json,
             const char* tool, Task& task) {
    Params params(json, tool);
    return (document.*method)(params, task);
}

bool failed(const Answer& answer) { return std::holds_alternative<Fault>(answer); }

}  // namespace

void Assistant::serve() {
    queue = std::make_unique<Queue>();
    for (std::string line;;) {
        const Wire::Read read = wire.line(line);
        if (read == Wire::Read::end) break;
        if (read == Wire::Read::tooLong) {
            wire.send(answerLine(
                nullptr, Fault(kTooMuch,
                               "a message has at most " + std::to_string(kMostMessageBytes >> 20) + " MiB")));
            continue;
        }
        if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
        std::variant<Request, NoRequest> message = readRequest(line);
        if (const NoRequest* none = std::get_if<NoRequest>(&message))
            wire.send(answerLine(none->id, none->fault));
        else
            take(std::move(std::get<Request>(message)));
    }
    {
        const std::lock_guard lock(mutex);
        for (const TaskPtr& task : tasks) task->cancelled.request();
    }
    queue.reset();
}

void Assistant::answer(const Request& request, const Answer& answer) {
    if (request.answered) wire.send(answerLine(request.id, answer));
}

void Assistant::take(Request request) {
    const std::string& method = request.method;
    if (method == "notifications/cancelled") return cancel(request);
    if (method.starts_with("notifications/")) return;
    if (method == "ping") return answer(request, Reply{});
    if (method == "initialize") return answer(request, initialize(request));
    if (!greeted) return answer(request, Fault(kNoRequest, "initialize comes first"));
    if (method == "tools/call") return call(std::move(request));
    if (method != "tools/list")
        return answer(request, Fault(kNoMethod, "there is no method " + inQuotes(method) +
                                                    ": there are initialize, ping, tools/list, tools/call"));
    Reply reply;
    reply.result["tools"] = toolsJson();
    answer(request, reply);
}

Answer Assistant::initialize(const Request& request) {
    const auto asked = request.params.find("protocolVersion");
    if (asked == request.params.end() || !asked->is_string())
        return Fault(kWrongParameters, "initialize: \"protocolVersion\" is a text: \"2025-06-18\"");
    greeted = true;
    const bool known = std::ranges::find(kRevisions, asked->get<std::string>()) != kRevisions.end();
    Reply reply;
    reply.result["protocolVersion"] = known ? *asked : Json(kRevisions[0]);
    reply.result["capabilities"] = {{"tools", {{"listChanged", false}}}};
    reply.result["serverInfo"] = {
        {"name", "fieldwright"}, {"title", "Fieldwright"}, {"version", FIELDWRIGHT_VERSION}};
    reply.result["instructions"] = assistantInstructions();
    return reply;
}

void Assistant::call(Request request) {
    using Tool = std::function<Answer(Assistant&, Params&, Task&)>;
    static const std::vector<std::pair<std::string, Tool>> tools = {
        {"list_nodes", [](Assistant& a, Params& params, Task&) { return a.listNodes(params); }},
        {"node_help", [](Assistant& a, Params& params, Task&) { return a.nodeHelp(params); }},
        {"write_graph", [](Assistant& a, Params& params, Task&) { return a.writeGraph(params); }},
        {"check_graph", &Assistant::checkGraph},
        {"look", &Assistant::look},
        {"measure", &Assistant::measure},
        {"export", &Assistant::exportMesh}};
    const Json named = request.params.value("name", Json());
    if (!named.is_string())
        return answer(request,
                      Fault(kWrongParameters, "tools/call: \"name\" is missing, or is no text: give it"));
    const auto& name = named.get_ref<const std::string&>();
    const Json arguments = request.params.value("arguments", Json::object());
    const auto tool = std::ranges::find_if(tools, [&](const auto& entry) { return name == entry.first; });
    if (tool == tools.end()) {
        std::vector<std::string> names;
        for (const auto& entry : tools) names.push_back(entry.first);
        return answer(request,
                      Fault(kWrongParameters, "there is no tool " + inQuotes(name) +
                                                  meant(name, names, ": there are " + listed(names))));
    }
    if (!arguments.is_object())
        return answer(request, Fault(kWrongParameters, "tools/call: \"arguments\" is an object"));
    const auto task = std::make_shared<Task>();
    task->request = std::move(request);
    const auto meta = task->request.params.find("_meta");
    if (meta != task->request.params.end() && meta->is_object() && meta->contains("progressToken"))
        // It must grow: each part begins where the one before ended, at most.
        task->tell = seldom([this, token = meta->at("progressToken"), parts = 0.0, last = 0.0](
                                const char* part, double done) mutable {
            if (done == 0.0) parts = std::ceil(last + 1e-9);
            last = std::max(last + 1e-6, parts + done);
            wire.send(notificationLine("notifications/progress",
                                       {{"progressToken", token}, {"progress", last}, {"message", part}}));
        });
    {
        const std::lock_guard lock(mutex);
        if (tasks.size() < kMostWaiting) {
            tasks.push_back(task);
        } else {
            return answer(task->request, Fault(kTooMuch, "too many calls wait for their answers"));
        }
    }
    queue->add([this, task, arguments, &does = tool->second, named = tool->first] {
        Params params(arguments, named);
        Answer made = task->cancelled ? Answer(cancelledFault()) : asTool(does(*this, params, *task));
        {
            const std::lock_guard lock(mutex);
            std::erase(tasks, task);
        }
        // Nobody waits any more for what was cancelled.
        if (!task->cancelled) answer(task->request, made);
    });
}

void Assistant::cancel(const Request& request) {
    const auto id = request.params.find("requestId");
    if (id == request.params.end()) return;
    const std::lock_guard lock(mutex);
    for (const TaskPtr& task : tasks)
        if (task->request.answered && task->request.id == *id) task->cancelled.request();
}

Answer Assistant::listNodes(Params& params) {
    std::vector<std::string> names;
    for (int i = 0; i < kCategories; ++i) names.emplace_back(categoryName(Category(i)));
    const std::string wanted = params.oneOf("category", names, "");
    if (std::optional<Fault> fault = params.fault()) return *fault;
    std::string text;
    for (int i = 0; i < kCategories; ++i) {
        if (!wanted.empty() && wanted != names[std::size_t(i)]) continue;
        text += "## " + names[std::size_t(i)] + "\n";
        for (const NodeType& type : nodeTypes()) {
            if (type.category != Category(i)) continue;
            std::string inputs;
            for (const InputSpec& input : type.inputs) inputs += (inputs.empty() ? "" : ", ") + input.name;
            text += type.id + " (" + inputs + "): " + firstSentence(type.doc) + "\n";
        }
    }
    return said(std::move(text));
}

Answer Assistant::nodeHelp(Params& params) {
    const Json* types = params.any("types");
    if (!types || !types->is_array() || types->empty() || types->size() > 64)
        params.refuse("types", "is an array of the names of node types, 64 at most");
    if (std::optional<Fault> fault = params.fault()) return *fault;
    std::string text;
    for (const Json& entry : *types) {
        const std::string name = entry.is_string() ? entry.get<std::string>() : inLine(entry);
        const NodeType* type = findNodeType(name);
        const std::string near = type ? "" : nearestNodeType(name);
        text += type ? nodeMarkdown(*type)
                     : "There is no node type " + inQuotes(name) +
                           (near.empty() ? "" : ": did you mean " + inQuotes(near) + "?") + "\n\n";
    }
    return said(std::move(text));
}

Answer Assistant::writeGraph(Params& params) {
    const std::string path = params.text("path", "");
    const Json* given = params.any("graph");
    params.need("path");
    if (!path.ends_with(kGraphEnding) || path.size() == kGraphEnding.size())
        params.refuse("path", "is the name of a graph file: it ends in " + std::string(kGraphEnding));
    if (!given || (!given->is_object() && !given->is_string()))
        params.refuse("graph", "is the graph, as an object or as its text");
    if (std::optional<Fault> fault = params.fault()) return *fault;
    std::vector<Error> findings;
    const Result<Graph> graph =
        parseGraph(given->is_string() ? given->get<std::string>() : inLine(*given), path, &findings);
    if (!graph) return Fault(graph.error());
    if (const Done saved = saveGraph(*graph, path); !saved) return Fault(saved.error());
    // As it lies there now: with the places of that file.
    const Result<Graph> written = readGraph(path, nullptr);
    if (!written) return Fault(written.error());
    for (Error& finding : check(*written, true)) findings.push_back(std::move(finding));
    const bool sound =
        std::ranges::find(findings, Error::Severity::error, &Error::severity) == findings.end();
    Reply reply = said(
        "Written to " + path + ". " +
        (findings.empty() ? "Nothing is wrong with it." : "What is to be said of it:\n" + words(findings)));
    if (!sound) reply.result["isError"] = true;
    return reply;
}

Document& Assistant::documentOf(const std::string& path) {
    const auto found = std::ranges::find(kept, path, &Kept::path);
    if (found != kept.end()) {
        kept.splice(kept.begin(), kept, found);
    } else {
        if (kept.size() == kKeptGraphs) kept.pop_back();
        kept.push_front({path, "", std::make_unique<Document>(openDevice)});
    }
    return *kept.front().document;
}

std::optional<Fault> Assistant::readAnew(const std::string& path, Task& task) {
    Kept& file = kept.front();
    const Result<std::string> text = readGraphText(path);
    if (!text) return Fault(text.error());
    if (file.text == *text) return std::nullopt;
    file.text.clear();  // what it was before is of no use if this fails
    const Answer answer =
        asked(*file.document, &Document::open, {{"graph", *text}, {"path", path}}, "open", task);
    if (const Fault* fault = std::get_if<Fault>(&answer)) return *fault;
    file.text = *text;
    return std::nullopt;
}

Answer Assistant::with(Params& params, Task& task, const std::function<Answer(Document&)>& work) {
    params.need("path");
    const std::string path = params.text("path", "");
    const Json* given = params.any("values");
    if (given && !given->is_object()) params.refuse("values", "is an object: {\"name\": number}");
    const double seconds = params.number("time", 0.0, -1e9, 1e9);
    if (std::optional<Fault> fault = params.fault()) return *fault;
    Document& document = documentOf(path);
    return guarded(document, [&]() -> Answer {
        if (std::optional<Fault> fault = readAnew(path, task)) return *fault;
        Json values = Json::object();
        for (const Json& parameter : document.parameters())
            if (!parameter.at("animated").get<bool>() && parameter.contains("default"))
                values[parameter.at("name").get<std::string>()] = parameter.at("default");
        if (given) values.update(*given);
        if (!values.empty())
            if (Answer set = asked(document, &Document::set, {{"values", values}}, "set", task); failed(set))
                return set;
        if (Answer time = asked(document, &Document::time, {{"seconds", seconds}}, "time", task);
            failed(time))
            return time;
        return work(document);
    });
}

Answer Assistant::checkGraph(Params& params, Task& task) {
    params.need("path");
    const std::string path = params.text("path", "");
    if (std::optional<Fault> fault = params.fault()) return *fault;
    std::vector<Error> findings;
    const Result<Graph> graph = readGraph(path, &findings);
    if (!graph) return Fault(graph.error());
    for (Error& finding : check(*graph, true)) findings.push_back(std::move(finding));
    std::string text = findings.empty() ? "Nothing is wrong with it.\n" : words(findings);
    Document& document = documentOf(path);
    guarded(document, [&]() -> Answer {  // of one that cannot be opened, what is wrong is told already
        if (std::optional<Fault> fault = readAnew(path, task)) return *fault;
        for (const Json& parameter : document.parameters()) text += "parameter " + inLine(parameter) + "\n";
        return Reply{};
    });
    return said(std::move(text));
}

Answer Assistant::look(Params& params, Task& task) {
    static const std::vector<std::string> sides = {"three_quarters", "front", "back",  "left",
                                                   "right",          "top",   "bottom"};
    const std::string from = params.oneOf("from", sides, "");
    Json wish = taken(params, {"camera", "view", "resolution"});
    if (!from.empty() && !wish.contains("camera")) wish["from"] = from;
    wish["width"] = params.whole("width", 640, 16, 1024);
    wish["height"] = params.whole("height", 480, 16, 1024);
    wish["samples"] = 4, wish["format"] = "png";
    return with(params, task, [&](Document& document) -> Answer {
        Answer answer = asked(document, &Document::picture, wish, "look", task);
        Reply* reply = std::get_if<Reply>(&answer);
        if (!reply) return answer;
        Reply shown;
        shown.result["content"] = Json::array(
            {{{"type", "image"}, {"data", base64(reply->blobs.at(0).bytes)}, {"mimeType", "image/png"}}});
        if (reply->result.contains("why"))
            shown.result["content"].push_back(
                {{"type", "text"},
                 {"text", "A draft, of the mesh alone: " + reply->result["why"].get<std::string>()}});
        return shown;
    });
}

Answer Assistant::measure(Params& params, Task& task) {
    const Json wish = taken(params, {"resolution"});
    return with(params, task, [&](Document& document) -> Answer {
        Answer answer = asked(document, &Document::measure, wish, "measure", task);
        const Reply* reply = std::get_if<Reply>(&answer);
        return reply ? Answer(said(reply->result.dump(1))) : answer;
    });
}

Answer Assistant::exportMesh(Params& params, Task& task) {
    Json wish = taken(params, {"resolution", "for"});
    params.need("output");
    wish["path"] = params.text("output", "");
    return with(params, task, [&](Document& document) -> Answer {
        Answer answer = asked(document, &Document::exportMesh, wish, "export", task);
        const Reply* reply = std::get_if<Reply>(&answer);
        return reply ? Answer(said("Written: " + inLine(reply->result))) : answer;
    });
}

}  // namespace fw::serve
