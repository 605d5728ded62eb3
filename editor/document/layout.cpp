#include "editor/document/layout.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "editor/document/layers.h"
#include "editor/document/wiring.h"

namespace fw::editor {

namespace {

constexpr double kApart = 60.0;  ///< between parts that no wire joins

struct Box {
    uint32_t node;  ///< of the scope
    Position size;
};

Position placeOf(const Scope& scope, uint32_t node) { return scope.nodes[node].at.value_or(Position{}); }

/// Down from a node's top to the middle of an input's or output's row.
double rowOf(const Scope& scope, const Box& box, std::string_view name, bool output) {
    if (box.size[1] <= kTitleHeight) return 0.5 * box.size[1];  // a reroute or a collapsed node
    const uint32_t node = box.node;
    if (!hasKnownSockets(scope, node)) return 0.5 * kTitleHeight;
    const std::vector<std::string> outputs = outputNames(scope, node);
    double y = kTitleHeight + 0.5 * kRowHeight;
    for (const std::string& each : outputs) {
        if (output && (name.empty() || each == name)) return y;
        y += kRowHeight;
    }
    for (const std::string& each : inputNames(scope, node)) {
        if (!output && each == name) break;
        const auto socket = inputSocket(scope, node, each);
        const InputValue* value = scope.nodes[node].input(each);
        const bool linked = value && std::holds_alternative<Link>(value->value);
        const bool given =
            value || (socket && socket->spec && socket->spec->value.kind == InputDefault::Kind::numbers);
        const bool vector = socket && (socket->type == Type::vec2 || socket->type == Type::vec3);
        y += vector && given && !linked ? 2.0 * kRowHeight : kRowHeight;
    }
    return std::min(y, box.size[1]);
}

/// Where the boxes of one connected part go, from (0, 0) down and to the right; its size.
struct Part {
    std::vector<uint32_t> boxes;
    std::vector<Position> places;
    Position size{};
    double formerY = 0.0;
};

/// The boxes in the order of the wires that lead to them, from the last node back: what feeds a higher input
/// comes first.
std::vector<uint32_t> wireOrder(std::size_t count, const std::vector<LayerEdge>& edges) {
    std::vector<std::vector<uint32_t>> sources(count);
    std::vector<char> feeds(count, false), seen(count, false);
    for (const LayerEdge& edge : edges) sources[edge.to].push_back(edge.from), feeds[edge.from] = true;
    std::vector<uint32_t> order, open;
    for (int round = 0; round < 2; ++round)  // at last what stands in a cycle only
        for (uint32_t root = 0; root < count; ++root) {
            if (seen[root] || (round == 0 && feeds[root])) continue;
            open.assign(1, root);
            while (!open.empty()) {
                const uint32_t box = open.back();
                open.pop_back();
                if (seen[box]) continue;
                seen[box] = true;
                order.push_back(box);
                open.insert(open.end(), sources[box].rbegin(), sources[box].rend());
            }
        }
    return order;
}

std::vector<LayerEdge> edgesAmong(const Scope& scope, const std::vector<Box>& boxes) {
    std::vector<uint32_t> boxOf(scope.nodes.size(), ~0u);
    for (uint32_t i = 0; i < boxes.size(); ++i) boxOf[boxes[i].node] = i;
    std::vector<LayerEdge> edges;
    for (uint32_t to = 0; to < boxes.size(); ++to)
        for (const auto& [name, value] : scope.nodes[boxes[to].node].inputs) {
            const Link* link = std::get_if<Link>(&value.value);
            if (!link) continue;
            const auto found = scope.byId.find(link->node);
            if (found == scope.byId.end() || boxOf[found->second] == ~0u) continue;
            const uint32_t from = boxOf[found->second];
            edges.push_back({from, to, rowOf(scope, boxes[from], link->output, true),
                             rowOf(scope, boxes[to], name, false)});
        }
    return edges;
}

/// The boxes of each connected part, those without any wire last and as one.
std::vector<Part> partsOf(std::size_t count, const std::vector<LayerEdge>& edges, bool& lastIsLoose) {
    std::vector<uint32_t> root(count);
    std::iota(root.begin(), root.end(), 0u);
    const auto find = [&](uint32_t i) {
        while (root[i] != i) i = root[i] = root[root[i]];
        return i;
    };
    std::vector<char> wired(count, false);
    for (const LayerEdge& edge : edges) {
        root[find(edge.from)] = find(edge.to);
        wired[edge.from] = wired[edge.to] = true;
    }
    std::vector<Part> parts;
    std::vector<uint32_t> partOf(count, ~0u);
    Part loose;
    for (uint32_t i = 0; i < count; ++i) {
        if (!wired[i]) {
            loose.boxes.push_back(i);
            continue;
        }
        uint32_t& part = partOf[find(i)];
        if (part == ~0u) part = static_cast<uint32_t>(parts.size()), parts.emplace_back();
        parts[part].boxes.push_back(i);
    }
    lastIsLoose = !loose.boxes.empty();
    if (lastIsLoose) parts.push_back(std::move(loose));
    return parts;
}

void placeLayered(Part& part, const std::vector<Box>& boxes, const std::vector<LayerEdge>& all,
                  const std::vector<uint32_t>& order) {
    std::vector<uint32_t> own(boxes.size(), ~0u);
    std::vector<LayerBox> layerBoxes;
    for (uint32_t i = 0; i < part.boxes.size(); ++i) {
        own[part.boxes[i]] = i;
        layerBoxes.push_back({boxes[part.boxes[i]].size[0], boxes[part.boxes[i]].size[1]});
    }
    std::vector<LayerEdge> edges;
    for (const LayerEdge& edge : all)
        if (own[edge.from] != ~0u) edges.push_back({own[edge.from], own[edge.to], edge.fromY, edge.toY});
    std::vector<uint32_t> wish;
    for (const uint32_t box : order)
        if (own[box] != ~0u) wish.push_back(own[box]);
    double top = 0.0;
    const std::vector<LayerPlace> places = layered(layerBoxes, edges, wish);
    for (std::size_t i = 0; i < places.size(); ++i) top = i == 0 ? places[i].y : std::min(top, places[i].y);
    for (std::size_t i = 0; i < places.size(); ++i) {
        part.places.push_back({places[i].x, places[i].y - top});
        part.size = {std::max(part.size[0], places[i].x + layerBoxes[i].width),
                     std::max(part.size[1], places[i].y - top + layerBoxes[i].height)};
    }
}

/// Rows of boxes, as wide as what stands above them, or about square.
void placeInRows(Part& part, const std::vector<Box>& boxes, double width) {
    double area = 0.0;
    for (const uint32_t box : part.boxes)
        area += (boxes[box].size[0] + kApart) * (boxes[box].size[1] + kApart);
    width = std::max({width, 1.3 * std::sqrt(area), double(kWideNodeWidth)});
    double x = 0.0, y = 0.0, row = 0.0;
    for (const uint32_t box : part.boxes) {
        if (x > 0.0 && x + boxes[box].size[0] > width) x = 0.0, y += row + kApart, row = 0.0;
        part.places.push_back({x, y});
        x += boxes[box].size[0] + kApart;
        row = std::max(row, boxes[box].size[1]);
        part.size = {std::max(part.size[0], x - kApart), y + row};
    }
}

/// Places for all boxes, each part below the other, in the order of where they were.
std::vector<Position> placesOf(const Scope& scope, const std::vector<Box>& boxes) {
    const std::vector<LayerEdge> edges = edgesAmong(scope, boxes);
    const bool placed =
        std::ranges::any_of(boxes, [&](const Box& box) { return scope.nodes[box.node].at.has_value(); });
    std::vector<uint32_t> order = wireOrder(boxes.size(), edges);
    if (placed)
        std::ranges::stable_sort(
            order, {}, [&](uint32_t i) { return placeOf(scope, boxes[i].node)[1] + 0.5 * boxes[i].size[1]; });
    bool loose = false;
    std::vector<Part> parts = partsOf(boxes.size(), edges, loose);
    double width = 0.0;
    for (std::size_t i = 0; i + (loose ? 1 : 0) < parts.size(); ++i) {
        Part& part = parts[i];
        placeLayered(part, boxes, edges, order);
        width = std::max(width, part.size[0]);
        for (const uint32_t box : part.boxes)
            part.formerY += placeOf(scope, boxes[box].node)[1] / static_cast<double>(part.boxes.size());
    }
    if (loose) placeInRows(parts.back(), boxes, width);
    std::stable_sort(parts.begin(), parts.end() - (loose ? 1 : 0),
                     [](const Part& a, const Part& b) { return a.formerY < b.formerY; });
    std::vector<Position> places(boxes.size());
    double top = 0.0;
    for (const Part& part : parts) {
        for (std::size_t i = 0; i < part.boxes.size(); ++i)
            places[part.boxes[i]] = {part.places[i][0], part.places[i][1] + top};
        top += part.size[1] + kApart;
    }
    return places;
}

struct Bounds {
    Position low{}, high{};
    bool empty = true;

    void add(Position at, Position size) {
        for (int axis = 0; axis < 2; ++axis) {
            low[axis] = empty ? at[axis] : std::min(low[axis], at[axis]);
            high[axis] = empty ? at[axis] + size[axis] : std::max(high[axis], at[axis] + size[axis]);
        }
        empty = false;
    }
    double middle(int axis) const { return 0.5 * (low[axis] + high[axis]); }
};

/// The nodes' boxes, each once.
std::vector<Box> boxesOf(const Scope& scope, std::span<const std::string> nodes) {
    std::vector<Box> boxes;
    std::set<uint32_t> seen;
    for (const std::string& id : nodes)
        if (const auto found = scope.byId.find(id);
            found != scope.byId.end() && seen.insert(found->second).second)
            boxes.push_back({found->second, aboutSize(scope, found->second)});
    return boxes;
}

Graph placeScope(const Graph& graph, std::string_view id) {
    const Wiring wiring(graph, id);
    const Scope& scope = wiring.scope();
    Bounds placed;
    std::vector<Box> boxes;
    for (uint32_t i = 0; i < scope.nodes.size(); ++i) {
        const Position size = aboutSize(scope, i);
        if (scope.nodes[i].at)
            placed.add(*scope.nodes[i].at, size);
        else
            boxes.push_back({i, size});
    }
    if (boxes.empty()) return graph;
    Graph result = graph;
    const Position corner = placed.empty ? Position{} : Position{placed.low[0], placed.high[1] + kApart};
    const std::vector<Position> places = placesOf(scope, boxes);
    std::vector<Node>& nodes = nodesOf(result, id);
    for (std::size_t i = 0; i < boxes.size(); ++i)
        nodes[boxes[i].node].at = {std::round(corner[0] + places[i][0]),
                                   std::round(corner[1] + places[i][1])};
    return result;
}

}  // namespace

Position aboutSize(const Scope& scope, uint32_t node) {
    if (scope.is(node, NodeRole::reroute)) return {2 * kRerouteRadius, 2 * kRerouteRadius};
    const double width = scope.is(node, NodeRole::expression) ? kWideNodeWidth : kNodeWidth;
    if (scope.nodes[node].collapsed) return {width, kTitleHeight};
    const double behindLast = rowOf(scope, {node, {width, 1e9}}, "", false) - 0.5 * kRowHeight;
    return {width, std::max(behindLast, double(kTitleHeight)) + kFoot};
}

Graph layOut(const Graph& graph, std::string_view scopeId, std::span<const std::string> nodes,
             const std::vector<double>& heights) {
    const Wiring wiring(graph, scopeId);
    const Scope& scope = wiring.scope();
    std::vector<Box> boxes = boxesOf(scope, nodes);
    if (heights.size() == nodes.size() && boxes.size() == nodes.size())
        for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i].size[1] = heights[i];
    const std::vector<Position> places = placesOf(scope, boxes);
    Bounds former, now;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        former.add(placeOf(scope, boxes[i].node), boxes[i].size);
        now.add(places[i], boxes[i].size);
    }
    Graph result = graph;
    std::vector<Node>& all = nodesOf(result, scopeId);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        Position at = places[i];
        for (int axis = 0; axis < 2; ++axis)
            at[axis] = std::round(at[axis] + former.middle(axis) - now.middle(axis));
        all[boxes[i].node].at = at;
    }
    return result;
}

Graph placeAll(const Graph& graph) {
    Graph result = placeScope(graph, "");
    for (std::size_t i = 0; i < graph.groups.size();
         ++i)  // by id: of two groups of one id the first is meant
        result = placeScope(result, graph.groups[i].id);
    return result;
}

Graph align(const Graph& graph, std::string_view scopeId, std::span<const std::string> nodes, Alignment how) {
    const Wiring wiring(graph, scopeId);
    const Scope& scope = wiring.scope();
    const std::vector<Box> boxes = boxesOf(scope, nodes);
    Bounds bounds;
    for (const Box& box : boxes) bounds.add(placeOf(scope, box.node), box.size);
    const int axis = how <= Alignment::right ? 0 : 1;
    const double part = how == Alignment::left || how == Alignment::top        ? 0.0
                        : how == Alignment::middle || how == Alignment::centre ? 0.5
                                                                               : 1.0;
    Graph result = graph;
    std::vector<Node>& all = nodesOf(result, scopeId);
    for (const Box& box : boxes) {
        Position at = placeOf(scope, box.node);
        const double line = bounds.low[axis] + part * (bounds.high[axis] - bounds.low[axis]);
        at[axis] = line - part * box.size[axis];
        all[box.node].at = at;
    }
    return result;
}

Graph distribute(const Graph& graph, std::string_view scopeId, std::span<const std::string> nodes,
                 bool along) {
    const Wiring wiring(graph, scopeId);
    const Scope& scope = wiring.scope();
    std::vector<Box> boxes = boxesOf(scope, nodes);
    if (boxes.size() < 3) return graph;
    const int axis = along ? 0 : 1;
    std::ranges::stable_sort(boxes, {}, [&](const Box& box) { return placeOf(scope, box.node)[axis]; });
    double taken = 0.0;
    for (const Box& box : boxes) taken += box.size[axis];
    const double begin = placeOf(scope, boxes.front().node)[axis],
                 end = placeOf(scope, boxes.back().node)[axis] + boxes.back().size[axis];
    const double gap = (end - begin - taken) / static_cast<double>(boxes.size() - 1);
    Graph result = graph;
    std::vector<Node>& all = nodesOf(result, scopeId);
    double next = begin;
    for (std::size_t i = 0; i + 1 < boxes.size(); ++i) {
        Position at = placeOf(scope, boxes[i].node);
        at[axis] = next;
        all[boxes[i].node].at = at;
        next += boxes[i].size[axis] + gap;
    }
    return result;
}

}  // namespace fw::editor
