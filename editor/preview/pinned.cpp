#include "editor/preview/pinned.h"

#include <algorithm>

namespace fw::editor {

Graph showingNode(const Graph& graph, std::string_view node) {
    Graph shown = graph;
    const Node* pinned = shown.node(node);
    if (!pinned || pinned->type == "output") return shown;
    InputValue link;
    link.value = Link{std::string(node), ""};
    const auto output = std::ranges::find(shown.nodes, "output", &Node::type);
    if (output != shown.nodes.end()) {
        output->muted = false;
        output->set("surface", std::move(link));
        return shown;
    }
    Node added;
    added.id = "output";
    while (shown.node(added.id)) added.id += "_";
    added.type = "output";
    added.set("surface", std::move(link));
    shown.nodes.push_back(std::move(added));
    return shown;
}

}  // namespace fw::editor
