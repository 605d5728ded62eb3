#include "editor/document/clipboard.h"

#include <algorithm>
#include <cmath>

#include "editor/document/brought_groups.h"
#include "editor/document/layout.h"
#include "editor/document/soundness.h"
#include "editor/document/wiring.h"
#include "graph/document/json.h"
#include "graph/document/json_tokens.h"

namespace fw::editor {

namespace {

constexpr const char* kSource = "clipboard";  ///< the file that errors name

/// Takes off all wires that come from none of the nodes. `wiring` is of the graph that they were in.
void unlinkOutside(std::vector<Node>& nodes, const Wiring& wiring) {
    std::set<std::string> inside;
    for (const Node& node : nodes) inside.insert(node.id);
    for (Node& node : nodes) {
        const auto inputs = node.inputs;
        for (const auto& [name, value] : inputs) {
            const Link* link = std::get_if<Link>(&value.value);
            if (!link || inside.contains(link->node)) continue;
            const std::optional<Socket> fed = wiring.output({link->node, link->output});
            unlink(node, name, fed ? fed->type : std::nullopt);
        }
    }
}

/// The text as a whole graph: with what stands around its nodes in a file.
struct Wrapped {
    std::string text;
    int shift = 0;  ///< columns by which one of its lines has moved
    int line = 1;   ///< that one
};

/// Blanks, each byte for itself so that all keeps its place, for what pages and editors put around or into a
/// copied text: a byte order mark, spaces that do not break, the fences of a code block.
std::string cleaned(std::string_view given) {
    std::string text(given);
    const auto blank = [&](std::string_view what) {
        for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at))
            text.replace(at, what.size(), what.size(), ' ');
    };
    blank("\xEF\xBB\xBF");
    blank("\xC2\xA0");
    for (std::size_t line = 0; line < text.size();) {
        const std::size_t end = std::min(text.find('\n', line), text.size());
        const std::size_t first = text.find_first_not_of(" \t", line);
        if (first < end && text.compare(first, 3, "```") == 0)
            text.replace(line, end - line, end - line, ' ');
        line = end + 1;
    }
    return text;
}

Result<Wrapped> wrapped(const std::string& text) {
    const std::size_t last = text.find_last_not_of(" \t\r\n");
    if (last == std::string::npos)
        return Error{.message = "there is no text to paste: copy nodes or a graph file first"};
    const auto around = [](const std::string& before, std::string_view content, const char* after) {
        return Wrapped{before + std::string(content) + after, static_cast<int>(before.size())};
    };
    const std::string nodes = "{\"fieldwright\": 1, \"nodes\": ";
    const Result<JsonTokens> tokens = tokenize(text, kSource);
    if (!tokens) {  // nodes one after the other, as they are copied from the middle of a file
        const std::string_view content =
            std::string_view(text).substr(0, text[last] == ',' ? last : text.size());
        const std::string list = "[" + std::string(content) + "]";
        return tokenize(list, kSource) ? Result(around(nodes + "[", content, "]}")) : tokens.error();
    }
    const JsonToken& root = tokens->list[0];
    if (root.kind == JsonToken::Kind::array) return around(nodes, text, "}");
    bool isNode = false, hasNodes = false;
    if (root.kind == JsonToken::Kind::object)
        for (uint32_t i = 1; i < root.next; i = tokens->list[i].next) {
            const std::string_view key = tokens->list[i].text;
            if (key == "fieldwright") return Wrapped{text, 0};
            hasNodes = hasNodes || key == "nodes";
            isNode = isNode || key == "id" || key == "type";
        }
    if (hasNodes) {
        const std::string version = "\"fieldwright\": 1, ";
        Wrapped whole{text, static_cast<int>(version.size()), root.at.line};
        whole.text.insert(text.find('{') + 1, version);
        return whole;
    }
    if (isNode) return around(nodes + "[", text, "]}");
    return Error{.message =
                     "this is no part of a graph: expected a graph file, {\"nodes\": [...]}, a list of "
                     "nodes or a node such as {\"id\": \"ball\", \"type\": \"sphere\"}",
                 .file = kSource,
                 .line = root.at.line,
                 .column = root.at.column};
}

/// The error with its place in the text as it was given.
Error placed(Error error, const Wrapped& whole) {
    if (error.line == whole.line) error.column = std::max(1, error.column - whole.shift);
    return error;
}

/// Moves the nodes so that the middle of them is at `at`.
void moveTo(std::vector<Node>& nodes, const Scope& scope, Position at) {
    Position low{}, high{};
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Position size = aboutSize(scope, scope.byId.at(nodes[i].id));
        for (int axis = 0; axis < 2; ++axis) {
            const double begin = (*nodes[i].at)[axis], end = begin + size[axis];
            low[axis] = i == 0 ? begin : std::min(low[axis], begin);
            high[axis] = i == 0 ? end : std::max(high[axis], end);
        }
    }
    for (Node& node : nodes)
        for (int axis = 0; axis < 2; ++axis)
            (*node.at)[axis] += at[axis] - std::round(0.5 * (low[axis] + high[axis]));
}

}  // namespace

std::string copyNodes(const Graph& graph, std::string_view scope, std::span<const std::string> nodes) {
    const std::set<std::string_view> chosen(nodes.begin(), nodes.end());
    Graph part;
    for (const Node& node : nodesOf(graph, scope))
        if (chosen.contains(node.id)) part.nodes.push_back(node);
    unlinkOutside(part.nodes, Wiring(graph, scope));
    part.groups = groupsFor(part.nodes, graph.groups);
    return writeGraph(part);
}

Result<Edited> pasteNodes(const Graph& graph, std::string_view scope, std::string_view text, Position at) {
    const Result<Wrapped> whole = wrapped(cleaned(text));
    if (!whole) return whole.error();
    Result<Graph> parsed = parseGraph(whole->text, kSource, nullptr);
    if (!parsed) return placed(parsed.error(), *whole);

    Graph part = placeAll(*parsed);
    std::set<std::string_view> standing;  // types of which there is one
    std::erase_if(part.nodes, [&](const Node& node) {
        const NodeType* type = findNodeType(node.type);
        const bool once = roleOf(node.type) == NodeRole::output || roleOf(node.type) == NodeRole::groupOutput;
        return type && (!canAdd(graph, scope, *type) || (once && !standing.insert(type->id).second));
    });
    const Wiring former(*parsed, "");
    unlinkOutside(part.nodes, former);
    if (part.nodes.empty())
        return Error{.message = "the text has no nodes that can stand here", .file = kSource};
    const Graph measured = part;  // moveTo() changes the nodes
    moveTo(part.nodes, Wiring(measured, "").scope(), at);
    part.groups = groupsFor(part.nodes, part.groups);

    Edited result{graph, {}};
    addGroups(part, result.graph);
    std::vector<Node>& nodes = nodesOf(result.graph, scope);
    FreshIds ids(nodes);
    std::unordered_map<std::string, std::string> renamed;
    for (const Node& node : part.nodes) {
        result.nodes.push_back(ids.next(node.id));
        renamed.emplace(node.id, result.nodes.back());
    }
    for (std::size_t i = 0; i < part.nodes.size(); ++i) {
        Node& node = part.nodes[i];
        node.id = result.nodes[i];
        for (auto& [name, value] : node.inputs)
            if (Link* link = std::get_if<Link>(&value.value)) link->node = renamed.at(link->node);
        nodes.push_back(std::move(node));
    }
    if (auto error = newError(graph, result.graph)) {
        error->file = kSource;
        return placed(*error, *whole);
    }
    return result;
}

}  // namespace fw::editor
