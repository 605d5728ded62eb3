// The graph of one expression node, for tests and benchmarks of fields that are written as code.
#pragma once

#include <string>

#include "graph/document/graph.h"

namespace fw::test {

inline Graph expressionGraph(std::string code) {
    Node field, output;
    field.id = "field", field.type = "expression", field.code = std::move(code);
    output.id = "out", output.type = "output";
    output.set("surface", {Link{"field", ""}});
    Graph graph;
    graph.nodes = {std::move(field), std::move(output)};
    return graph;
}

}  // namespace fw::test
