#include "graph/check/check.h"

#include <algorithm>
#include <utility>

#include "graph/assets/environment.h"
#include "graph/compile/compile.h"
#include "graph/document/named_parameters.h"
#include "graph/document/scene.h"
#include "graph/document/sockets.h"
#include "graph/document/timeline.h"
#include "graph/language/resolve.h"
#include "graph/library/node_type.h"

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

/// What is wrong with the code of expressions whatever they are linked to: of a graph that cannot be
/// compiled.
void checkCode(const Graph& graph, const std::vector<Node>& nodes, const std::string& prefix,
               std::vector<Error>& findings) {
    for (const Node& node : nodes) {
        if (roleOf(node.type) != NodeRole::expression || node.muted || node.code.empty()) continue;
        language::Declared declared;
        for (const auto& [name, input] : node.inputs) declared.inputs.emplace_back(name, typeOfValue(input));
        for (Error& error : language::resolve(node.code, declared).errors) {
            error.file = graph.path;
            error.node = prefix + node.id;
            error.line = node.codePlace.line, error.column = node.codePlace.column;
            findings.push_back(std::move(error));
        }
    }
}

/// Whether the scene's environment map can be read.
void checkSky(const Graph& graph, std::vector<Error>& findings) {
    const Result<Scene> scene = readScene(graph.scene, graph.scenePlaces);
    if (!scene || !scene->sky || scene->sky->image.empty()) return;
    const Result<EnvironmentMapPtr> map = readEnvironment(graph.path, scene->sky->image);
    if (map) return;
    Error error = map.error();
    error.message = "the scene's sky.image: " + error.message;
    error.file = graph.path;
    const TextPosition place = skyPlace(graph.scene, graph.scenePlaces);
    error.line = place.line, error.column = place.column;
    findings.push_back(std::move(error));
}

}  // namespace

std::vector<Error> check(const Graph& graph, bool pictures) {
    std::vector<Error> findings = checkStructure(graph);
    if (hasErrors(findings)) {
        checkCode(graph, graph.nodes, "", findings);
        for (const Group& group : graph.groups) checkCode(graph, group.nodes, group.id + "/", findings);
        return findings;
    }
    checkSky(graph, findings);
    const Result<Timeline> timeline = readTimeline(graph);
    std::vector<Error> errors = compileErrors(graph, {.warnOfPictures = pictures});
    dropPassingZeros(graph, *timeline, errors);
    std::ranges::stable_sort(errors, [](const Error& a, const Error& b) {
        return std::pair(a.line, a.column) < std::pair(b.line, b.column);
    });
    for (Error& error : errors) findings.push_back(std::move(error));
    if (hasErrors(findings) || timeline->tracks.empty()) return findings;
    CompileOptions playing;  // code can ask for constants where the timeline has values that move
    playing.live = animatedInputs(graph, *timeline);
    playing.live.insert("time");
    for (Error& error : compileErrors(graph, playing)) findings.push_back(std::move(error));
    return findings;
}

}  // namespace fw
