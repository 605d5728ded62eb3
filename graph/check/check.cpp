#include "graph/check/check.h"

#include <algorithm>

#include "graph/compile/compile.h"
#include "graph/document/named_parameters.h"
#include "graph/document/timeline.h"

namespace fw {

namespace {

bool sameFinding(const Error& a, const Error& b) {
    return a.node == b.node && a.codeLine == b.codeLine && a.codeColumn == b.codeColumn && a.code == b.code;
}

/// Leaves out divisions that are by zero only at 0 s or with the file's value of what the timeline moves or
/// the graph exposes: whoever asks for a time and values is told then.
void dropPassingZeros(const Graph& graph, const Timeline& timeline, std::vector<Error>& errors) {
    const auto isZero = [](const Error& error) { return error.code == Error::Code::divisionByZero; };
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
