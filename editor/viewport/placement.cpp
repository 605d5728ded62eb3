#include "editor/viewport/placement.h"

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <unordered_map>

#include "editor/document/paths.h"
#include "editor/preview/pinned.h"
#include "graph/document/named_parameters.h"

namespace fw::editor {

namespace {

bool isVector(const InputSpec& input) {
    return input.type == Type::vec3 && input.value.kind == InputDefault::Kind::numbers;
}

/// Whether the body looks this surface up at another position. What combines surfaces does so for their
/// slopes alone.
bool looksUpElsewhere(const NodeType& type, const std::string& surface) {
    if (type.category == Category::combine) return false;
    const auto isLetter = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
    for (std::size_t at = type.body.find(surface + "("); at != std::string::npos;
         at = type.body.find(surface + "(", at + 1))
        if (at == 0 || !isLetter(type.body[at - 1])) return true;
    return false;
}

bool isWired(const Node& node, const std::string& input) {
    const InputValue* value = node.input(input);
    return value && std::holds_alternative<Link>(value->value);
}

}  // namespace

bool isPlace(const InputSpec& input) {
    return isVector(input) && input.unit == "m" && !std::isfinite(input.min);
}
bool isAngles(const InputSpec& input) { return isVector(input) && input.unit == "degrees"; }
bool isFactor(const InputSpec& input) {
    return (input.type == Type::scalar || input.type == Type::vec3) && input.unit.empty() && input.positive &&
           input.value.kind == InputDefault::Kind::numbers &&
           std::ranges::count(input.value.numbers, 1.0) == std::ptrdiff_t(input.value.numbers.size());
}
bool isExtent(const InputSpec& input) { return isVector(input) && input.unit == "m" && input.min == 0.0; }

glm::dmat3 turned(const glm::dvec3& degrees) {
    const glm::dvec3 c = glm::cos(glm::radians(degrees)), s = glm::sin(glm::radians(degrees));
    // By columns.
    const glm::dmat3 x(1, 0, 0, 0, c.x, s.x, 0, -s.x, c.x), y(c.y, 0, -s.y, 0, 1, 0, s.y, 0, c.y),
        z(c.z, s.z, 0, -s.z, c.z, 0, 0, 0, 1);
    return z * y * x;
}

glm::dvec3 vectorOf(const std::vector<double>& numbers) {
    if (numbers.size() == 1) return glm::dvec3(numbers[0]);
    return numbers.size() == 3 ? glm::dvec3(numbers[0], numbers[1], numbers[2]) : glm::dvec3(0.0);
}

std::optional<Placement> placementBy(const Node& node) {
    const NodeType* type = findNodeType(node.type);
    if (node.muted || !type || type->role == NodeRole::reroute) return Placement{};
    if (type->role == NodeRole::group || type->role == NodeRole::expression) return std::nullopt;
    Placement result;
    bool elsewhere = false, known = true;
    for (const InputSpec& input : type->inputs) {
        if (input.type == Type::surface) {
            elsewhere |= looksUpElsewhere(*type, input.name);
            continue;
        }
        known &= !isWired(node, input.name);
        const glm::dvec3 numbers = vectorOf(inputNumbers(node, input.name));
        if (isPlace(input))
            result.shift = numbers;
        else if (isAngles(input))
            result.linear = turned(numbers) * result.linear;
        else if (isFactor(input))
            result.linear = result.linear * glm::dmat3(numbers.x, 0, 0, 0, numbers.y, 0, 0, 0, numbers.z);
        else
            known = false;
    }
    if (!elsewhere) return Placement{};
    return known ? std::optional(result) : std::nullopt;
}

std::optional<NodeIds> wayToShown(const Graph& graph, std::string_view scope, const std::string& node,
                                  const std::string& last) {
    std::unordered_map<std::string_view, const Node*> byId;
    for (const Node& each : nodesOf(graph, scope)) byId.emplace(each.id, &each);
    // Backwards from what is shown: what each node feeds on the shortest way.
    std::unordered_map<std::string_view, std::string_view> next;
    std::vector<std::string_view> reached;
    const std::vector<std::string> pinned = pinnedNodes(last);
    const auto isPinned = [&](std::string_view id) { return std::ranges::count(pinned, id) > 0; };
    const bool shown = std::ranges::any_of(byId, [&](const auto& each) { return isPinned(each.first); });
    for (const auto& [id, each] : byId)
        if (shown ? isPinned(id)
                  : roleOf(each->type) == (scope.empty() ? NodeRole::output : NodeRole::groupOutput))
            reached.push_back(id), next[id] = "";
    for (std::size_t i = 0; i < reached.size() && !next.contains(node); ++i)
        for (const auto& [name, value] : byId[reached[i]]->inputs)
            if (const Link* link = std::get_if<Link>(&value.value))
                if (const auto from = byId.find(link->node);
                    from != byId.end() && next.emplace(from->first, reached[i]).second)
                    reached.push_back(from->first);
    if (!next.contains(node)) return std::nullopt;
    NodeIds way;
    for (std::string_view at = next[node]; !at.empty(); at = next[at]) way.emplace_back(at);
    return way;
}

Placement placementAlong(const Graph& graph, std::string_view scope, std::span<const std::string> way) {
    Placement all;
    for (const std::string& id : way) {
        const Node& node = *findNode(nodesOf(graph, scope), id);
        const std::optional<Placement> by = placementBy(node);
        if (!by) {
            const NodeType* type = findNodeType(node.type);
            all.why =
                "before what " + (node.label.empty() && type ? type->label : node.label) + " does to it";
            return all;
        }
        all = all.then(*by);
    }
    return all;
}

Placement placementOf(const Graph& graph, std::string_view scope, const std::string& pinned) {
    Placement all;
    std::string at(scope);
    while (!at.empty() && all.why.empty()) {
        std::vector<std::string> instances = instancesOf(graph, at, "");
        all.why = "where it stands in its group";
        if (instances.size() != 1) return all;
        instances[0].pop_back();  // the slash behind the instance
        const auto [outer, instance] = placeOf(graph, instances[0]);
        const auto way = wayToShown(graph, outer, instance, outer.empty() ? pinned : "");
        if (!way) return all;
        all = all.then(placementAlong(graph, outer, *way));
        at = outer;
    }
    return all;
}

}  // namespace fw::editor
