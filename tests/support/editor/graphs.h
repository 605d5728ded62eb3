// Graphs of tests, from text, and what is wrong with them.
#pragma once

#include <gtest/gtest.h>

#include "graph/check/check.h"
#include "graph/document/json.h"

namespace fw::editor::test {

/// The graph of a whole file's text.
inline Graph parsed(const std::string& text) {
    const Result<Graph> graph = parseGraph(text, "a.field.json", nullptr);
    EXPECT_TRUE(graph) << format(graph.error());
    return graph ? *graph : Graph{};
}

/// A graph from the inside of its "nodes", and what follows them.
inline Graph graphOf(const std::string& nodes, const std::string& rest = "") {
    return parsed("{\"fieldwright\": 1, \"nodes\": [" + nodes + "]" + rest + "}");
}

/// The messages of errors, one a line.
inline std::string errorsOf(const Graph& graph) {
    std::string all;
    for (const Error& finding : check(graph))
        if (finding.severity == Error::Severity::error) all += format(finding) + "\n";
    return all;
}

}  // namespace fw::editor::test
