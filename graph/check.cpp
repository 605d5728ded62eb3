#include "graph/check.h"

#include "graph/check_parts.h"
#include "graph/check_value.h"
#include "graph/compile.h"
#include "graph/language/lower.h"
#include "graph/named_parameters.h"
#include "graph/timeline.h"

namespace fw {

namespace {

constexpr std::size_t kMaxCompared =
    50'000'000;  // pairs of letters, in all hints together: tenths of a second
constexpr std::size_t kLongestHinted = 64;

void checkCounts(const Graph& graph, Findings& findings) {
    std::size_t count = graph.nodes.size();
    for (const Group& group : graph.groups) count += group.nodes.size();
    if (count > kMaxNodes)
        findings.error({}, "the graph has " + std::to_string(count) + " nodes, more than the limit of " +
                               std::to_string(kMaxNodes) +
                               ": put what repeats into a group or a repeat node");
}

void checkParameter(const ExposedParameter& parameter, const Scope& top, Findings& findings) {
    const Place place{parameter.place, parameter.node, parameter.input};
    const std::string label = "parameter " + inQuotes(parameter.name);
    if (parameter.name.empty() || parameter.name.find('=') != std::string::npos)
        findings.error(place, label + ": a name is not empty and has no '='");
    if (parameter.min && parameter.max && !(*parameter.min <= *parameter.max))
        findings.error(place, label + ": its min " + shortNumber(*parameter.min) + " is above its max " +
                                  shortNumber(*parameter.max));
    const auto found = top.byId.find(parameter.node);
    if (found == top.byId.end()) {
        const std::string hint = findings.full() ? "" : findings.hint(parameter.node, idsOf(top));
        return findings.error(place, label + ": there is no node " + inQuotes(parameter.node) + hint);
    }
    const uint32_t i = found->second;
    if (!hasKnownSockets(top, i)) return;
    const InputValue* value = top.nodes[i].input(parameter.input);
    const std::optional<Socket> socket = settableSocket(top, i, parameter.input);
    if (!socket) {
        const std::vector<std::string> names = inputNames(top, i);
        return findings.error(
            place, label + ": node " + inQuotes(parameter.node) + " has no input " +
                       inQuotes(parameter.input) +
                       findings.hint(parameter.input, names,
                                     names.empty() ? "; it has none" : "; it has " + listed(names)));
    }
    if (value && std::holds_alternative<Link>(value->value))
        return findings.warning(place, label + " has no effect: the input is linked");
    if (socket->type && (componentCount(*socket->type) == 0 || *socket->type == Type::surface))
        return findings.error(place, label + ": an input of type " + std::string(typeName(*socket->type)) +
                                         " cannot be a parameter");
    if (const double* number = value ? std::get_if<double>(&value->value) : nullptr)
        if (*number < parameter.min.value_or(*number) || *number > parameter.max.value_or(*number))
            findings.warning(place, label + ": the input's value " + shortNumber(*number) +
                                        " is outside of the parameter's range");
}

bool sameFinding(const Error& a, const Error& b) {
    return a.node == b.node && a.codeLine == b.codeLine && a.codeColumn == b.codeColumn &&
           a.message == b.message;
}

/// Leaves out divisions that are by zero only at 0 s or with the file's value of what the timeline moves or
/// the graph exposes: whoever asks for a time and values is told then.
void dropPassingZeros(const Graph& graph, const Timeline& timeline, std::vector<Error>& errors) {
    const auto isZero = [](const Error& error) { return error.message == language::kDivisionByZero; };
    if (std::none_of(errors.begin(), errors.end(), isZero)) return;
    CompileOptions moving;
    moving.live = animatedInputs(graph, timeline);
    moving.live.insert("time");
    std::vector<Error> lasting = compileErrors(graph, moving);
    for (const NamedParameter& parameter : namedParameters(graph))
        moving.live.insert(parameter.node + "." + parameter.input);
    std::vector<Error> ofAny = compileErrors(graph, moving);
    // Code that must know a parameter says so, and then what follows from it is not known.
    if (std::all_of(ofAny.begin(), ofAny.end(), isZero)) lasting = std::move(ofAny);
    std::erase_if(errors, [&](const Error& error) {
        return isZero(error) && std::none_of(lasting.begin(), lasting.end(),
                                             [&](const Error& other) { return sameFinding(error, other); });
    });
}

}  // namespace

void Findings::add(const Place& place, std::string message, Error::Severity severity) {
    if (full()) {
        ++beyond;
        errorBeyond = errorBeyond || severity == Error::Severity::error;
        return;
    }
    list.push_back({.message = std::move(message),
                    .file = file,
                    .node = place.node,
                    .input = place.input,
                    .line = place.at.line,
                    .column = place.at.column,
                    .severity = severity});
}

bool Findings::mayCompare(std::string_view name, std::size_t count) {
    const std::size_t cost = count * (name.size() + 1) * (name.size() + 1);  // near names are about as long
    if (full() || name.size() > kLongestHinted || compared + cost > kMaxCompared) return false;
    compared += cost;
    return true;
}

std::string Findings::hint(std::string_view name, std::span<const std::string> names, std::string otherwise) {
    if (!mayCompare(name, names.size())) return otherwise;
    const std::string near = nearestName(name, names);
    return near.empty() ? otherwise : "; did you mean " + inQuotes(near) + "?";
}

std::string Findings::hintType(std::string_view name) {
    const std::string near = mayCompare(name, nodeTypes().size()) ? nearestNodeType(name) : std::string();
    return near.empty() ? "; 'fieldwright nodes' lists all" : "; did you mean '" + near + "'?";
}

std::vector<Error> Findings::take() {
    if (beyond > 0) {
        const bool error = errorBeyond || list.back().severity == Error::Severity::error;
        list.back() = {.message = "there are " + std::to_string(beyond + 1) +
                                  " more findings: correct those above first",
                       .file = file,
                       .severity = error ? Error::Severity::error : Error::Severity::warning};
    }
    return std::move(list);
}

std::string firstInLine(const TextPosition& at) {
    return at.line > 0 ? ", the first in line " + std::to_string(at.line) : std::string();
}

void checkParameters(const Graph& graph, const Scope& top, Findings& findings) {
    std::unordered_map<std::string_view, const ExposedParameter*> byName;
    for (const ExposedParameter& parameter : graph.parameters) {
        const auto [present, added] = byName.try_emplace(parameter.name, &parameter);
        if (!added)
            findings.error({parameter.place, parameter.node, parameter.input},
                           "two parameters are named " + inQuotes(parameter.name) +
                               firstInLine(present->second->place) + ": rename one");
        checkParameter(parameter, top, findings);
    }
}

std::vector<Error> checkStructure(const Graph& graph) {
    Findings findings(graph.path);
    const Groups groups(graph);
    const Scope top(groups, graph.nodes, nullptr);
    checkCounts(graph, findings);
    checkNodes(top, findings);
    checkEnds(top, findings);
    checkGroups(graph, groups, findings);
    for (const GroupSockets& group : groups.list) {
        const Scope inside(groups, group.group->nodes, &group);
        checkNodes(inside, findings);
        checkEnds(inside, findings);
    }
    checkParameters(graph, top, findings);
    checkTimeline(graph, top, findings);
    return findings.take();
}

bool hasErrors(const std::vector<Error>& findings) {
    return std::any_of(findings.begin(), findings.end(),
                       [](const Error& finding) { return finding.severity == Error::Severity::error; });
}

std::vector<Error> check(const Graph& graph) {
    std::vector<Error> findings = checkStructure(graph);
    if (hasErrors(findings)) return findings;
    const Result<Timeline> timeline = readTimeline(graph);
    std::vector<Error> errors = compileErrors(graph);
    dropPassingZeros(graph, *timeline, errors);
    for (Error& error : errors) findings.push_back(std::move(error));
    if (hasErrors(findings) || timeline->tracks.empty()) return findings;
    CompileOptions playing;  // code can ask for constants where the timeline has values that move
    playing.live = animatedInputs(graph, *timeline);
    playing.live.insert("time");
    for (Error& error : compileErrors(graph, playing)) findings.push_back(std::move(error));
    return findings;
}

}  // namespace fw
