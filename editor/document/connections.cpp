#include "editor/document/connections.h"

#include <algorithm>

#include "editor/document/wiring.h"

namespace fw::editor {

namespace {

/// The inputs that a wire may lead to: an expression has one more than it shows.
std::vector<std::string> inputsOf(const Wiring& wiring, uint32_t node) {
    std::vector<std::string> names = inputNames(wiring.scope(), node);
    if (!wiring.scope().is(node, NodeRole::expression)) return names;
    for (const auto& [name, value] : wiring.scope().nodes[node].inputs)
        if (!std::ranges::count(names, name)) names.push_back(name);
    int number = 1;
    std::string fresh = "a";
    while (std::ranges::count(names, fresh)) fresh = "a" + std::to_string(++number);
    names.push_back(fresh);
    return names;
}

}  // namespace

std::vector<Connection> connectionsOf(const Graph& graph, std::string_view scope, std::string_view node,
                                      const std::set<std::string>& near) {
    const Wiring wiring(graph, scope);
    const auto index = wiring.find(node);
    if (!index || !hasKnownSockets(wiring.scope(), *index)) return {};
    std::vector<std::pair<int, Connection>> ranked;
    const auto add = [&](uint32_t from, uint32_t to, const std::string& other) {
        const std::string &source = wiring.scope().nodes[from].id, &target = wiring.scope().nodes[to].id;
        for (const std::string& output : outputNames(wiring.scope(), from))
            for (const std::string& input : inputsOf(wiring, to)) {
                const Connection each{{source, output}, {target, input}};
                const Link* there = wiring.source(each.input);
                if (there && there->node == source && (there->output.empty() || there->output == output))
                    continue;
                // Of types first, which is quicker told.
                const auto type = wiring.output(each.output)->type;
                if (!wiring.typeRefusal(type, each.input).empty() ||
                    !wiring.refusal(each.output, each.input).empty())
                    continue;
                const auto wanted = wiring.input(each.input);
                const bool sameType = wanted && wanted->type == type;
                ranked.emplace_back((near.contains(other) ? 0 : 4) + (sameType ? 0 : 2) + (there ? 1 : 0),
                                    each);
            }
    };
    for (uint32_t i = 0; i < wiring.scope().nodes.size(); ++i) {
        if (i == *index || !hasKnownSockets(wiring.scope(), i)) continue;
        add(*index, i, wiring.scope().nodes[i].id);
        add(i, *index, wiring.scope().nodes[i].id);
    }
    std::ranges::stable_sort(ranked, {}, &std::pair<int, Connection>::first);
    std::vector<Connection> connections;
    for (auto& [rank, each] : ranked) connections.push_back(std::move(each));
    return connections;
}

}  // namespace fw::editor
