// The parts of checkStructure(), and what collects their findings. Not for use outside graph/rules/.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "graph/base/result.h"
#include "graph/document/sockets.h"

namespace fw {

/// What a finding is about.
struct Place {
    TextPosition at;
    std::string node, input;
};

/// Collects findings, and bounds the work that a hostile file can make of them.
class Findings {
  public:
    explicit Findings(std::string path) : file(std::move(path)) {}

    void error(const Place& place, std::string message, Error::Code code = Error::Code::other) {
        add(place, std::move(message), Error::Severity::error, code);
    }
    void warning(const Place& place, std::string message) {
        add(place, std::move(message), Error::Severity::warning, Error::Code::other);
    }

    /// Whether more findings are only counted. Asked before a message that is costly to make.
    bool full() const { return list.size() >= kMaxFindings; }

    /// "; did you mean 'x'?", or with none near `otherwise`. Gives nothing once enough names were compared.
    std::string hint(std::string_view name, std::span<const std::string> names, std::string otherwise = {});
    /// The same among the node types.
    std::string hintType(std::string_view name);

    /// All findings. The last stands for those beyond the limit.
    std::vector<Error> take();

  private:
    static constexpr std::size_t kMaxFindings = 1'000;

    void add(const Place& place, std::string message, Error::Severity severity, Error::Code code);
    bool mayCompare(std::string_view name, std::size_t count);

    std::string file;
    std::vector<Error> list;
    std::size_t beyond = 0;    ///< findings that were only counted
    bool errorBeyond = false;  ///< whether an error is among them
    std::size_t compared = 0;  ///< pairs of letters, in hints
};

/// The declarations of groups, groups that contain themselves, are nested too deep or multiply beyond bounds.
void checkGroups(const Graph& graph, const Groups& groups, Findings& findings);

/// The nodes of one scope: ids, types, inputs, links, cycles.
void checkNodes(const Scope& scope, Findings& findings);

/// The node types of which there is to be one, or none, in this scope.
void checkEnds(const Scope& scope, Findings& findings);

/// The exposed parameters; `top` is the scope of the document's nodes.
void checkParameters(const Graph& graph, const Scope& top, Findings& findings);

/// The scene, and the timeline: its form, what its tracks move, their keys.
void checkTimeline(const Graph& graph, const Scope& top, Findings& findings);

/// ", the first in line 12", or nothing if the line is unknown.
std::string firstInLine(const TextPosition& at);

/// Edges of a directed graph: for each vertex the vertices it leads to, in order.
using Edges = std::vector<std::vector<uint32_t>>;

/// Depth-first walk over all vertices without recursion. closes(stack, edge) is called for an edge that leads
/// back into the stack of vertices under way, which with it form a cycle; finished(vertex) after all that it
/// leads to.
template <class Closes, class Finished>
void walk(const Edges& edges, Closes closes, Finished finished) {
    enum : std::uint8_t { fresh, open, left };
    std::vector<uint8_t> state(edges.size(), fresh);
    std::vector<uint32_t> stack, edge;
    for (uint32_t root = 0; root < edges.size(); ++root) {
        if (state[root] != fresh) continue;
        stack.assign(1, root);
        edge.assign(1, 0);
        state[root] = open;
        while (!stack.empty()) {
            const uint32_t vertex = stack.back();
            if (edge.back() == edges[vertex].size()) {
                state[vertex] = left;
                finished(vertex);
                stack.pop_back();
                edge.pop_back();
                continue;
            }
            const uint32_t i = edge.back()++, next = edges[vertex][i];
            if (state[next] == open) closes(stack, i);
            if (state[next] != fresh) continue;
            state[next] = open;
            stack.push_back(next);
            edge.push_back(0);
        }
    }
}

/// The names around a cycle, from and to the vertex that the last edge leads back to.
template <class NameOf>
std::vector<std::string_view> cycleNames(const std::vector<uint32_t>& stack, uint32_t target, NameOf name) {
    std::vector<std::string_view> names;
    for (auto i = std::find(stack.begin(), stack.end(), target); i != stack.end(); ++i)
        names.push_back(name(*i));
    names.push_back(name(target));
    return names;
}

}  // namespace fw
