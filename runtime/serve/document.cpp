#include "runtime/serve/document.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <new>
#include <set>

#include "graph/check/check.h"
#include "graph/document/json.h"
#include "graph/document/named_parameters.h"
#include "graph/document/unit.h"
#include "runtime/play/mesh_program.h"

namespace fw::serve {

namespace {

Json numbersJson(const std::vector<double>& numbers) {
    return numbers.size() == 1 ? Json(numbers[0]) : Json(numbers);
}

/// A fault that has all that was found, of which there is an error.
Fault unsound(std::vector<Error> findings) {
    const auto first = std::ranges::find(findings, Error::Severity::error, &Error::severity);
    Fault fault(*first);
    fault.findings = std::move(findings);
    return fault;
}

bool isSound(const std::vector<Error>& findings) {
    return std::ranges::find(findings, Error::Severity::error, &Error::severity) == findings.end();
}

/// One number, or several.
std::optional<std::vector<double>> numbersOf(const Json& value) {
    if (value.is_number()) return std::vector{value.get<double>()};
    if (!value.is_array() || value.empty() || value.size() > 3) return std::nullopt;
    std::vector<double> numbers;
    for (const Json& entry : value) {
        if (!entry.is_number()) return std::nullopt;
        numbers.push_back(entry.get<double>());
    }
    return numbers;
}

}  // namespace

const std::vector<std::pair<std::string, Document::Method>>& Document::methods() {
    static const std::vector<std::pair<std::string, Method>> all = {
        {"set", &Document::set},         {"time", &Document::time},        {"check", &Document::check},
        {"mesh", &Document::mesh},       {"picture", &Document::picture},  {"eval", &Document::eval},
        {"measure", &Document::measure}, {"export", &Document::exportMesh}};
    return all;
}

std::variant<Graph, Fault> Document::read(Params& params, std::vector<Error>& findings) const {
    const std::string path = params.text("path", "");
    const Json* text = params.any("graph");
    if (!text && path.empty()) params.refuse("path", "is missing: give it, or the \"graph\" itself");
    if (text && !text->is_string() && !text->is_object())
        params.refuse("graph", "is the text of a graph file, or the object that it holds");
    if (std::optional<Fault> fault = params.fault()) return *fault;
    // Places in an object are not those of any text that the client has.
    const std::string content = !text               ? std::string()
                                : text->is_string() ? text->get<std::string>()
                                                    : inLine(*text);
    Result<Graph> graph = text ? parseGraph(content, path, &findings) : readGraph(path, &findings);
    const auto withoutPlace = [&](Error& error) {
        if (text && text->is_object()) error.line = error.column = 0;
    };
    for (Error& finding : findings) withoutPlace(finding);
    if (graph) return std::move(*graph);
    Error error = graph.error();
    withoutPlace(error);
    findings.push_back(std::move(error));
    return unsound(std::move(findings));
}

Answer Document::open(Params& params, Task& task) {
    std::vector<Error> findings;
    std::variant<Graph, Fault> named = read(params, findings);
    if (Fault* fault = std::get_if<Fault>(&named)) return std::move(*fault);
    Graph& graph = std::get<Graph>(named);
    for (Error& finding : fw::check(graph)) findings.push_back(std::move(finding));
    if (!isSound(findings)) return unsound(std::move(findings));
    const Result<Timeline> timeline = readTimeline(graph);
    if (!timeline) return Fault(timeline.error());
    defaults.clear();
    for (const NamedParameter& parameter : namedParameters(graph))
        if (const Node* node = graph.node(parameter.node))
            defaults.emplace(parameter.name, inputNumbers(*node, parameter.input));
    tape.reset();
    now = &task;
    stop = task.cancelled.token();
    if (player) {
        if (const Done made = player->reload(std::move(graph)); !made) return Fault(made.error());
    } else {
        document = std::move(graph);
    }
    changed();
    Reply reply;
    reply.result = {{"parameters", parameters()},
                    {"unit", unitOf(this->graph()).name},
                    {"moves", !timeline->tracks.empty()},
                    {"timeline",
                     {{"length", timeline->length},
                      {"framesPerSecond", timeline->framesPerSecond},
                      {"endless", timeline->endless}}},
                    {"findings", findingsJson(findings)}};
    return reply;
}

Answer Document::set(Params& params, Task& task) {
    const Json* values = params.any("values");
    if (!values || !values->is_object()) params.refuse("values", "is an object: {\"name\": number, …}");
    if (std::optional<Fault> fault = params.fault()) return *fault;
    // All of them on a copy first: either all are set, or none.
    std::vector<std::pair<std::string, std::vector<double>>> wanted;
    Graph copy = graph();
    for (const auto& [name, value] : values->items()) {
        std::optional<std::vector<double>> numbers = numbersOf(value);
        if (!numbers) {
            params.refuse("values", "has for " + inQuotes(name) + " no number, and no array of up to three");
            return *params.fault();
        }
        if (const Done fits = setParameter(copy, name, *numbers); !fits) return Fault(fits.error());
        wanted.emplace_back(name, std::move(*numbers));
    }
    now = &task;
    stop = {};  // all values are set, or none
    tape.reset();
    if (player) {
        for (const auto& [name, numbers] : wanted)
            if (const Done done = player->set(name, numbers); !done) return Fault(done.error());
    } else {
        std::vector<Error> findings = fw::check(copy);
        if (!isSound(findings)) return unsound(std::move(findings));
        document = std::move(copy);
    }
    changed();
    Reply reply;
    reply.result["parameters"] = parameters();
    return reply;
}

Answer Document::time(Params& params, Task& task) {
    params.need("seconds");
    const double to = params.number("seconds", 0.0, -1e9, 1e9);
    if (std::optional<Fault> fault = params.fault()) return *fault;
    now = &task;
    tape.reset();
    seconds = to;
    if (player) player->seek(seconds);
    const Result<Timeline> timeline = readTimeline(graph());
    Reply reply;
    reply.result = {{"seconds", seconds},
                    {"timelineSeconds", timeline ? timelineTime(*timeline, seconds) : seconds}};
    return reply;
}

Answer Document::check(Params& params, Task&) {
    std::vector<Error> findings;
    if (params.has("path") || params.has("graph") || !isOpen()) {
        std::variant<Graph, Fault> read = this->read(params, findings);
        if (Fault* fault = std::get_if<Fault>(&read)) {
            if (fault->findings.empty()) return std::move(*fault);
            findings = std::move(fault->findings);
        } else {
            for (Error& finding : fw::check(std::get<Graph>(read), true))
                findings.push_back(std::move(finding));
        }
    } else {
        if (std::optional<Fault> fault = params.fault()) return *fault;
        findings = fw::check(graph(), true);
    }
    Reply reply;
    reply.result = {{"sound", isSound(findings)}, {"findings", findingsJson(findings)}};
    return reply;
}

std::optional<Fault> Document::play(int resolution, std::optional<MeshMethod> method, Task& task) {
    now = &task;
    stop = task.cancelled.token();
    PlayerOptions wanted = playing;
    if (resolution > 0) wanted.resolution = resolution;
    if (method) wanted.method = method;
    if (player) {
        if (wanted.resolution == playing.resolution && wanted.method == playing.method) return std::nullopt;
        if (const Done made = player->reload(player->graph(), wanted); !made) return Fault(made.error());
        playing = wanted;
        return std::nullopt;
    }
    task.progress("device", 0);
    Result<Device> device = openDevice();
    if (!device) return Fault(kSystemFault, device.error().message);
    if (task.cancelled) return cancelledFault();
    task.progress("compile", 0);
    wanted.baking = [this](double share) { now->progress("bake", share); };
    wanted.simulating = [this](int done, int all) {
        now->progress("simulate", double(done) / all);
        return !now->cancelled;
    };
    wanted.stop = [this] { return stop; };
    Result<Player> made = Player::create(*document, std::move(*device), wanted);
    if (!made) return Fault(made.error());
    player = std::move(*made);
    playing = wanted;
    player->seek(seconds);
    return std::nullopt;
}

void Document::dropDevice() {
    if (!player) return;
    document = player->graph();
    player.reset();
    sketched = lived = {};
}

std::pair<int, std::optional<MeshMethod>> Document::cellsOf(Params& params) {
    static const std::vector<std::string> methods(std::begin(kMeshMethodNames), std::end(kMeshMethodNames));
    const int resolution = params.whole("resolution", 0, 1, kMostServedResolution);
    const std::string method = params.oneOf("method", methods, "");
    return {resolution, method.empty() ? std::nullopt : std::optional(meshMethod(method))};
}

std::optional<Fault> Document::playAs(Params& params, Task& task) {
    const auto [resolution, method] = cellsOf(params);
    if (std::optional<Fault> fault = params.fault()) return fault;
    return play(resolution, method, task);
}

Result<Program> Document::folded(Task& task, CompileOptions options) {
    options.stop = task.cancelled.token();
    options.bake = meshFieldBaker([this] { return player ? &player->device() : nullptr; },
                                  {.progress = [&task](double share) { task.progress("bake", share); }});
    std::optional<Fault> fault;
    Result<Program> program = compileAtTime(
        graph(), seconds, std::move(options),
        [&]() -> const Device* {
            fault = play(0, std::nullopt, task);
            return fault ? nullptr : &player->device();
        },
        [&task](int done, int all) {
            task.progress("simulate", double(done) / all);
            return !task.cancelled;
        });
    if (!program && fault) return fault->error;
    return program;
}

Json Document::parametersJson() const {
    const Result<Timeline> timeline = readTimeline(graph());
    const std::set<std::string> moving =
        timeline ? animatedInputs(graph(), *timeline) : std::set<std::string>();
    Json list = Json::array();
    for (const NamedParameter& parameter : namedParameters(graph())) {
        const Node* node = graph().node(parameter.node);
        if (!node) continue;
        Json entry = {{"name", parameter.name}, {"value", numbersJson(inputNumbers(*node, parameter.input))}};
        if (const auto found = defaults.find(parameter.name); found != defaults.end())
            entry["default"] = numbersJson(found->second);
        if (std::isfinite(parameter.min)) entry["min"] = parameter.min;
        if (std::isfinite(parameter.max)) entry["max"] = parameter.max;
        entry["unit"] = std::string(unitOfInput(*node, parameter.input));
        entry["animated"] = moving.contains(parameter.node + "." + parameter.input);
        entry["node"] = parameter.node, entry["input"] = parameter.input;
        list.push_back(std::move(entry));
    }
    return list;
}

Answer guarded(Document& document, const std::function<Answer()>& work) {
    try {
        try {
            return work();
        } catch (const DeviceLost&) {}
        document.dropDevice();
        return work();
    } catch (const std::bad_alloc&) {
        document.dropDevice();
        return Fault(kSystemFault, "out of memory: lower the resolution, or close documents");
    } catch (const std::exception& error) {  // SystemError, and what libraries throw
        document.dropDevice();
        return Fault(kSystemFault, error.what());
    }
}

void Document::changed() {
    Json list = parametersJson();
    const std::lock_guard lock(showing);
    shown = std::move(list);
}

Json Document::parameters() const {
    const std::lock_guard lock(showing);
    return shown;
}

}  // namespace fw::serve
