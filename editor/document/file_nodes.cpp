#include "editor/document/file_nodes.h"

#include <algorithm>

#include "editor/document/layout.h"
#include "editor/document/wiring.h"

namespace fw::editor {

namespace {

constexpr double kBetween = 60.0, kBelow = 40.0;  // canvas units: two nodes side by side, two of them below

/// The first node that makes a surface of what flows as `type`, and the input for that.
std::optional<FileInput> surfaceOf(Type type) {
    for (const NodeType& node : nodeTypes()) {
        const auto input = std::ranges::find(node.inputs, type, &InputSpec::type);
        if (input != node.inputs.end() && !node.outputs.empty() && node.outputs[0].type == Type::surface)
            return FileInput{&node, &*input};
    }
    return {};
}

/// The node that stands behind that of a file, if that is no function of position.
std::optional<FileInput> nextOf(const NodeType& type) {
    const Type made = type.outputs[0].type;
    return componentCount(made) > 0 ? std::nullopt : surfaceOf(made);
}

double heightOf(const NodeType& type) {
    return kTitleHeight + double(type.inputs.size() + 1) * kRowHeight + kFoot;
}

/// Width and height of one file's nodes.
Position sizeOf(const std::string& path) {
    const NodeType& type = *fileInputFor(path)->type;
    const std::optional<FileInput> next = nextOf(type);
    if (!next) return {kNodeWidth, heightOf(type)};
    return {2 * kNodeWidth + kBetween, std::max(heightOf(type), heightOf(*next->type))};
}

/// The graph with the surface at its output, if that has neither a surface nor a mesh yet.
Graph shownAtFreeOutput(const Graph& graph, const Plug& surface) {
    const Wiring wiring(graph, "");
    for (const Node& node : graph.nodes) {
        const Plug input{node.id, "surface"};
        if (roleOf(node.type) == NodeRole::output && !wiring.source(input) &&
            !wiring.source({node.id, "mesh"}) && wiring.refusal(surface, input).empty())
            return connect(graph, "", surface, input);
    }
    return graph;
}

}  // namespace

std::optional<FileInput> fileInputFor(std::string_view path) {
    for (const NodeType& type : nodeTypes())
        for (const InputSpec& input : type.inputs)
            if (input.file && !input.file->apart && endsAs(*input.file, path) && !type.outputs.empty())
                return FileInput{&type, &input};
    return {};
}

std::vector<const FileKind*> fileKindsOfNodes() {
    std::vector<const FileKind*> kinds;
    for (const NodeType& type : nodeTypes())
        for (const InputSpec& input : type.inputs)
            if (input.file && !input.file->apart && std::ranges::find(kinds, input.file) == kinds.end())
                kinds.push_back(input.file);
    return kinds;
}

std::size_t fileNodeCount(std::span<const std::string> paths) {
    std::size_t count = 0;
    for (const std::string& path : paths) count += nextOf(*fileInputFor(path)->type) ? 2 : 1;
    return count;
}

Position sizeOfFileNodes(std::span<const std::string> paths) {
    Position all{0, -kBelow};
    for (const std::string& path : paths) {
        const Position size = sizeOf(path);
        all = {std::max(all[0], size[0]), all[1] + size[1] + kBelow};
    }
    return all;
}

Edited addFileNodes(const Graph& graph, std::string_view scope, std::span<const std::string> paths,
                    Position at) {
    Edited all{graph, {}};
    for (const std::string& path : paths) {
        const FileInput reader = *fileInputFor(path);
        const Edited file = addNode(all.graph, scope, reader.type->id, at);
        if (file.nodes.empty()) break;
        Graph next = setInput(file.graph, scope, {file.nodes[0], reader.input->name}, InputValue{path});
        Plug shown{file.nodes[0], reader.type->outputs[0].name};
        NodeIds made = file.nodes;
        if (const std::optional<FileInput> behind = nextOf(*reader.type)) {
            const Edited both =
                addNode(next, scope, behind->type->id, {at[0] + kNodeWidth + kBetween, at[1]});
            if (both.nodes.empty()) break;
            next = connect(both.graph, scope, shown, {both.nodes[0], behind->input->name});
            shown = {both.nodes[0], behind->type->outputs[0].name};
            made.push_back(both.nodes[0]);
        }
        if (scope.empty() && all.nodes.empty()) next = shownAtFreeOutput(next, shown);
        all.graph = std::move(next);
        all.nodes.insert(all.nodes.end(), made.begin(), made.end());
        at[1] += sizeOf(path)[1] + kBelow;
    }
    return all;
}

}  // namespace fw::editor
