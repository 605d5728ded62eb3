// Random edits of a graph, as a person at the canvas might do them; the same for the same seed.
#pragma once

#include <random>
#include <string>
#include <vector>

#include "editor/document/edits.h"
#include "graph/check/check.h"
#include "graph/document/json.h"

namespace fw::editor::test {

class RandomEdits {
  public:
    explicit RandomEdits(uint32_t seed) : random(seed) {}

    /// The graph after some edit; its name in `name`.
    Graph next(const Graph& graph, std::string& name);

  private:
    std::size_t below(std::size_t n) { return n == 0 ? 0 : random() % n; }
    bool chance(double p) { return std::uniform_real_distribution<double>()(random) < p; }
    double number() { return std::round(std::uniform_real_distribution<double>(-500.0, 500.0)(random)); }

    std::string scopeOf(const Graph& graph);
    const Node* nodeOf(const Graph& graph, const std::string& scope);
    NodeIds someOf(const Graph& graph, const std::string& scope);
    Plug inputOf(const Graph& graph, const std::string& scope, const Node& node);
    Plug outputOf(const Graph& graph, const std::string& scope, const Node& node);
    Graph wire(const Graph& graph, const std::string& scope);
    Graph paste(const Graph& graph, const std::string& scope, const NodeIds& some, Position at);
    Graph value(const Graph& graph, const std::string& scope);

    std::mt19937 random;
};

/// The errors of checkStructure() as text, without those that only say that something is still missing:
/// an output, code, a mesh.
std::vector<std::string> structuralErrors(const Graph& graph);

/// Graphs to edit: the samples, and random ones.
std::vector<Graph> graphsToEdit(int randomOnes);

}  // namespace fw::editor::test
