#include "graph/document/graph.h"

#include <algorithm>

namespace fw {

namespace {

/// Pointer to the entry whose `id` is this one. A template for the const and the plain case, nodes and
/// groups.
template <class Entries>
auto find(Entries& entries, std::string_view id) -> decltype(entries.data()) {
    const auto found =
        std::find_if(entries.begin(), entries.end(), [&](const auto& e) { return e.id == id; });
    return found == entries.end() ? nullptr : &*found;
}

bool isLower(char c) { return c >= 'a' && c <= 'z'; }
bool isLetter(char c) { return isLower(c) || (c >= 'A' && c <= 'Z') || c == '_'; }
bool isDigit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

const InputValue* Node::input(std::string_view name) const {
    for (const auto& [key, value] : inputs)
        if (key == name) return &value;
    return nullptr;
}

void Node::set(std::string_view name, InputValue value) {
    for (auto& [key, present] : inputs)
        if (key == name) return void(present = std::move(value));
    inputs.emplace_back(name, std::move(value));
}

const Node* Graph::node(std::string_view id) const { return find(nodes, id); }
Node* Graph::node(std::string_view id) { return find(nodes, id); }
const Group* Graph::group(std::string_view id) const { return find(groups, id); }

const Node* findNode(const std::vector<Node>& nodes, std::string_view id) { return find(nodes, id); }

bool isId(std::string_view text) {
    const auto fits = [](char c) { return isLower(c) || isDigit(c) || c == '_'; };
    return !text.empty() && isLower(text[0]) && std::all_of(text.begin(), text.end(), fits);
}

bool isName(std::string_view text) {
    const auto fits = [](char c) { return isLetter(c) || isDigit(c); };
    return !text.empty() && isLetter(text[0]) && std::all_of(text.begin(), text.end(), fits);
}

Error errorAt(const Graph& graph, const Node* node, std::string message) {
    Error error;
    error.message = std::move(message);
    error.file = graph.path;
    if (node) error.node = node->id, error.line = node->place.line, error.column = node->place.column;
    return error;
}

Error warningAt(const Graph& graph, const std::string& path, std::string message) {
    Error warning = errorAt(graph, graph.node(path.substr(0, path.find('/'))), std::move(message));
    warning.node = path;
    warning.severity = Error::Severity::warning;
    return warning;
}

}  // namespace fw
