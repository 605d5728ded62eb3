#include "graph/rules/structure.h"

#include "graph/rules/findings.h"

namespace fw {

namespace {

void checkCounts(const Graph& graph, Findings& findings) {
    std::size_t count = graph.nodes.size();
    for (const Group& group : graph.groups) count += group.nodes.size();
    if (count > kMaxNodes)
        findings.error({}, "the graph has " + std::to_string(count) + " nodes, more than the limit of " +
                               std::to_string(kMaxNodes) +
                               ": put what repeats into a group or a repeat node");
}

}  // namespace

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

}  // namespace fw
