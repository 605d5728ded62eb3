#include "editor/document/soundness.h"

#include <algorithm>
#include <set>
#include <tuple>

#include "graph/check/check.h"

namespace fw::editor {

namespace {

std::size_t nodeCount(const Graph& graph) {
    std::size_t count = graph.nodes.size();
    for (const Group& group : graph.groups) count += group.nodes.size();
    return count;
}

/// Whether the finding leaves the form of the graph as it must be: something is not there yet, or a file is
/// another.
bool isPassing(const Error& finding) {
    return finding.code == Error::Code::unfinished || finding.code == Error::Code::wrongFile;
}

}  // namespace

std::optional<Error> newError(const Graph& graph, const Graph& next) {
    std::multiset<std::tuple<std::string, std::string, std::string>> former;
    const auto key = [](const Error& error) { return std::tuple(error.node, error.input, error.message); };
    for (const Error& finding : checkStructure(graph)) former.insert(key(finding));
    for (const Error& finding : checkStructure(next)) {
        if (finding.severity != Error::Severity::error || isPassing(finding)) continue;
        const auto known = former.find(key(finding));
        if (known == former.end()) return finding;
        former.erase(known);
    }
    return {};
}

std::size_t errorCount(const Graph& graph) {
    const std::vector<Error> findings = checkStructure(graph);
    return static_cast<std::size_t>(std::ranges::count_if(findings, [](const Error& finding) {
        return finding.severity == Error::Severity::error && !isPassing(finding);
    }));
}

bool outgrows(const Graph& graph, const Graph& next) {
    if (nodeCount(next) > std::max(kMaxNodes, nodeCount(graph))) return true;
    return !next.groups.empty() && newError(graph, next);
}

}  // namespace fw::editor
