// The edits of wires.
#include <algorithm>
#include <cassert>
#include <limits>

#include "editor/document/edits.h"
#include "editor/document/references.h"
#include "editor/document/wiring.h"
#include "graph/document/input_value.h"

namespace fw::editor {

namespace {

/// The node put into the wire that feeds `input`; nothing if it has no sockets for it.
std::optional<Graph> threaded(const Graph& graph, std::string_view scope, const Plug& input,
                              std::string_view node) {
    const Wiring wiring(graph, scope);
    const Link* source = wiring.source(input);
    if (!source || source->node == node || input.node == node) return {};
    const Plug from{source->node, source->output};
    const auto entry = wiring.fittingInput(from, node);
    if (!entry) return {};
    const Graph entered = connect(graph, scope, from, *entry);
    const auto exit = fittingOutput(entered, scope, node, input);
    return exit ? std::optional(connect(entered, scope, *exit, input)) : std::nullopt;
}

}  // namespace

Graph connect(const Graph& graph, std::string_view scope, const Plug& output, const Plug& input) {
    const Wiring wiring(graph, scope);
    assert(wiring.refusal(output, input).empty());
    Graph result = graph;
    nodesOf(result, scope)[*wiring.find(input.node)].set(input.name, {wiring.linkFrom(output)});
    return result;
}

Graph disconnect(const Graph& graph, std::string_view scope, const Plug& input) {
    const Wiring wiring(graph, scope);
    const Link* link = wiring.source(input);
    if (!link) return graph;
    const std::optional<Socket> fed = wiring.output({link->node, link->output});
    Graph result = graph;
    unlink(nodesOf(result, scope)[*wiring.find(input.node)], input.name, fed ? fed->type : std::nullopt);
    dropLost(result, graph);
    return result;
}

Edited insertOnWire(const Graph& graph, std::string_view scope, const Plug& input, std::string_view type,
                    Position at) {
    const Edited added = addNode(graph, scope, type, at);
    if (added.nodes.empty()) return {graph, {}};
    const auto result = threaded(added.graph, scope, input, added.nodes[0]);
    return result ? Edited{*result, added.nodes} : Edited{graph, {}};
}

Graph dropOnWire(const Graph& graph, std::string_view scope, const Plug& input, std::string_view node) {
    return threaded(graph, scope, input, node).value_or(graph);
}

Edited addReroute(const Graph& graph, std::string_view scope, const Plug& input, Position at) {
    return insertOnWire(graph, scope, input, "reroute", at);
}

Graph swapInputs(const Graph& graph, std::string_view scope, std::string_view node) {
    const Wiring wiring(graph, scope);
    const auto at = wiring.find(node);
    if (!at || !hasKnownSockets(wiring.scope(), *at)) return graph;
    const std::vector<std::string> names = inputNames(wiring.scope(), *at);
    const auto kind = [](const Socket& socket) {
        return socket.spec ? socket.spec->value.kind : InputDefault::Kind::none;
    };
    for (std::size_t i = 0; i < names.size(); ++i)
        for (std::size_t k = i + 1; k < names.size(); ++k) {
            const Plug a{std::string(node), names[i]}, b{std::string(node), names[k]};
            const Socket first = *wiring.input(a), second = *wiring.input(b);
            if (first.type != second.type || kind(first) != kind(second)) continue;
            const InputValue *inA = wiring.scope().nodes[*at].input(a.name),
                             *inB = wiring.scope().nodes[*at].input(b.name);
            const std::optional<InputValue> toB = inA ? std::optional(*inA) : std::nullopt,
                                            toA = inB ? std::optional(*inB) : std::nullopt;
            Graph result = setInput(setInput(graph, scope, a, toA), scope, b, toB);
            const Node& swapped = nodesOf(result, scope)[*at];
            const auto holds = [&](const Plug& plug, const std::optional<InputValue>& value) {
                const InputValue* held = swapped.input(plug.name);
                return held ? value && *held == *value : !value;
            };
            return holds(a, toA) && holds(b, toB) ? result : graph;
        }
    return graph;
}

}  // namespace fw::editor
