#include "graph/document/part_behind.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "graph/document/timeline.h"
#include "graph/library/node_type.h"

namespace fw {

namespace {

const InputSpec* specOf(const Node& node, const std::string& input) {
    const NodeType* type = findNodeType(node.type);
    const int index = type ? inputIndex(*type, input) : -1;
    return index < 0 ? nullptr : &type->inputs[std::size_t(index)];
}

bool isDefault(const InputSpec& spec, const InputValue& value) {
    if (spec.value.kind == InputDefault::Kind::text) {
        const auto* text = std::get_if<std::string>(&value.value);
        return text && *text == spec.value.text;
    }
    if (spec.value.kind != InputDefault::Kind::numbers) return false;
    if (const auto* number = std::get_if<double>(&value.value))
        return spec.value.numbers == std::vector{*number};
    const auto* numbers = std::get_if<std::vector<double>>(&value.value);
    return numbers && spec.value.numbers == *numbers;
}

Node bare(const Node& node) {
    Node made;
    made.id = node.id, made.type = node.type, made.muted = node.muted;
    made.code = node.code, made.group = node.group;
    for (const auto& [name, value] : node.inputs) {
        const InputSpec* spec = specOf(node, name);
        if (spec && (spec->file == &kParticleCacheFile || isDefault(*spec, value))) continue;
        made.inputs.emplace_back(name, InputValue{.value = value.value, .entry = value.entry});
    }
    std::ranges::sort(made.inputs, {}, [](const auto& input) { return input.first; });
    return made;
}

std::vector<Node> bare(const std::vector<Node>& nodes) {
    std::vector<Node> made;
    for (const Node& node : nodes) made.push_back(bare(node));
    std::ranges::sort(made, {}, &Node::id);
    return made;
}

Group bare(const Group& group) {
    Group made;
    made.id = group.id;
    for (const GroupInput& input : group.inputs) {
        GroupInput& kept = made.inputs.emplace_back();
        kept.name = input.name, kept.type = input.type;
        if (input.value) kept.value = InputValue{.value = input.value->value, .entry = input.value->entry};
    }
    for (const GroupOutput& output : group.outputs) {
        GroupOutput& kept = made.outputs.emplace_back();
        kept.name = output.name, kept.type = output.type;
    }
    made.nodes = bare(group.nodes);
    return made;
}

void addGroups(const Graph& graph, const std::vector<Node>& nodes, std::set<std::string>& groups) {
    for (const Node& node : nodes)
        if (const Group* group = graph.group(node.group); group && groups.insert(group->id).second)
            addGroups(graph, group->nodes, groups);
}

/// The tracks that move the nodes, with the parameters by which they do.
void addTracks(const Graph& graph, const Timeline& timeline, const std::set<std::string>& nodes,
               Graph& part) {
    Json tracks = Json::array();
    for (std::size_t i = 0; i < timeline.tracks.size(); ++i) {
        const Track& track = timeline.tracks[i];
        const std::optional<AnimatedInput> moved = animatedInput(graph, track);
        if (!moved || !nodes.contains(moved->node)) continue;
        tracks.push_back(graph.timeline->at("tracks").at(i));
        for (const ExposedParameter& each : graph.parameters) {
            if (track.target != Track::Target::parameter || each.name != track.name) continue;
            ExposedParameter& kept = part.parameters.emplace_back();
            kept.name = each.name, kept.node = each.node, kept.input = each.input;
            kept.min = each.min, kept.max = each.max;
        }
    }
    if (tracks.empty()) return;
    part.timeline = Json{{"length", timeline.length},
                         {"loop", loopNames().at(std::size_t(timeline.loop))},
                         {"tracks", std::move(tracks)}};
}

}  // namespace

Graph partBehind(const Graph& graph, std::string_view node) {
    const Result<Timeline> timeline = readTimeline(graph);
    const Graph whole = timeline ? atTime(graph, *timeline, 0.0) : graph;
    std::set<std::string> needed;
    std::vector<const Node*> open{whole.node(node)};
    std::vector<Node> kept;
    while (!open.empty()) {
        const Node* next = open.back();
        open.pop_back();
        if (!next || !needed.insert(next->id).second) continue;
        kept.push_back(*next);
        for (const auto& [name, value] : next->inputs)
            if (const auto* link = std::get_if<Link>(&value.value)) open.push_back(whole.node(link->node));
    }
    Graph part;
    part.nodes = bare(kept);
    std::set<std::string> groups;
    addGroups(whole, kept, groups);
    for (const std::string& id : groups) part.groups.push_back(bare(*whole.group(id)));
    if (timeline) addTracks(graph, *timeline, needed, part);
    return part;
}

namespace {

std::string wordsFor(const InputValue* value) {
    if (!value) return "its default";
    if (const auto* link = std::get_if<Link>(&value->value)) return "a link from " + inQuotes(link->node);
    Json json;
    if (const auto* numbers = std::get_if<std::vector<double>>(&value->value))
        json = *numbers;
    else if (const auto* number = std::get_if<double>(&value->value))
        json = *number;
    else if (const auto* flag = std::get_if<bool>(&value->value))
        json = *flag;
    else
        json = std::get<std::string>(value->value);
    return inOneLine(json.dump(), 40);
}

std::string differenceOf(const Node& was, const Node& is) {
    const std::string name = "node " + inQuotes(is.id);
    for (const auto& [input, value] : is.inputs)
        if (const InputValue* before = was.input(input); !before || !(*before == value))
            return name + " has " + input + " " + wordsFor(&value) + ", and had " + wordsFor(before);
    for (const auto& [input, value] : was.inputs)
        if (!is.input(input))
            return name + " has " + input + " " + wordsFor(nullptr) + ", and had " + wordsFor(&value);
    return name + " is another";
}

}  // namespace

std::string differenceOf(const Graph& was, const Graph& is) {
    for (const Node& node : is.nodes) {
        const Node* before = was.node(node.id);
        if (!before) return "node " + inQuotes(node.id) + " is new";
        if (!(*before == node)) return differenceOf(*before, node);
    }
    for (const Node& node : was.nodes)
        if (!is.node(node.id)) return "node " + inQuotes(node.id) + " is gone";
    for (const Group& group : is.groups)
        if (const Group* before = was.group(group.id); !before || !(*before == group))
            return "group " + inQuotes(group.id) + " is another";
    if (!(was == is)) return "the timeline moves it in another way";
    return "a file that it reads is another";
}

}  // namespace fw
