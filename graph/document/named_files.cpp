#include "graph/document/named_files.h"

#include <nlohmann/json.hpp>
#include <set>
#include <type_traits>
#include <utility>

#include "graph/document/sockets.h"

namespace fw {

namespace {

/// What the scene names as its sky's picture; null if it names none. Any is a Json or a const one.
template <class Any>
auto* skyImage(Any& scene) {
    using Text = std::conditional_t<std::is_const_v<Any>, const std::string, std::string>;
    Text* none = nullptr;
    if (!scene.is_object() || !scene.contains("sky")) return none;
    Any& sky = scene.at("sky");
    return sky.is_object() && sky.contains("image") ? sky.at("image").template get_ptr<Text*>() : none;
}

/// Calls visit(path, kind) for each input that names a file; Any is a Graph or a const one.
template <class Any, class Visit>
void eachFile(Any& graph, const Visit& visit) {
    const auto seen = [&](const FileKind* kind, auto& value) {
        if (auto* path = std::get_if<std::string>(&value.value); kind && path && !path->empty())
            visit(*path, *kind);
    };
    const Groups groups(graph);
    const auto within = [&](auto& nodes, const GroupSockets* group) {
        const Scope scope(groups, nodes, group);
        for (uint32_t i = 0; i < nodes.size(); ++i)
            if (hasKnownSockets(scope, i))
                for (auto& [name, value] : nodes[i].inputs)
                    if (const std::optional<Socket> socket = inputSocket(scope, i, name))
                        seen(fileKind(*socket), value);
    };
    if (auto* path = skyImage(*graph.scene); path && !path->empty()) visit(*path, kEnvironmentFile);
    within(graph.nodes, nullptr);
    for (std::size_t i = 0; i < graph.groups.size(); ++i) {
        for (auto& input : graph.groups[i].inputs)
            if (input.value) seen(fileKind({typeNamed(input.type)}), *input.value);
        within(graph.groups[i].nodes, &groups.list[i]);
    }
}

}  // namespace

std::vector<NamedFile> namedFiles(const Graph& graph) {
    std::vector<NamedFile> files;
    std::set<std::pair<std::string_view, const FileKind*>> known;
    eachFile(graph, [&](const std::string& path, const FileKind& kind) {
        if (known.emplace(path, &kind).second) files.push_back({path, &kind});
    });
    return files;
}

void renameFiles(Graph& graph, const std::function<std::string(const NamedFile&)>& to) {
    eachFile(graph, [&](std::string& path, const FileKind& kind) { path = to({path, &kind}); });
}

}  // namespace fw
