#include "editor/canvas/boxes.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

namespace fw::editor {

namespace {

constexpr float kInset = 10.0f;       // of a row's text and fields, from the node's sides
constexpr float kFieldGap = 4.0f;     // between the numbers of a vector
constexpr float kLeastBend = 30.0f;   // of a wire's handles
constexpr int kPieces = 16;           // straight ones that a wire is looked at as
constexpr float kFrameTitle = 26.0f;  // height of the strip that a frame is taken hold of by
constexpr float kFrameCorner = 16.0f;

ImVec2 operator+(ImVec2 a, ImVec2 b) { return {a.x + b.x, a.y + b.y}; }
ImVec2 operator-(ImVec2 a, ImVec2 b) { return {a.x - b.x, a.y - b.y}; }
ImVec2 operator*(float s, ImVec2 a) { return {s * a.x, s * a.y}; }
float dot(ImVec2 a, ImVec2 b) { return a.x * b.x + a.y * b.y; }
float cross(ImVec2 a, ImVec2 b) { return a.x * b.y - a.y * b.x; }

/// Numbers of a row that a person may edit in it.
int fieldsOf(const Row& row) {
    if (row.output || row.linked || !row.type) return 0;
    const bool number = *row.type == Type::scalar || *row.type == Type::integer || *row.type == Type::vec2 ||
                        *row.type == Type::vec3;
    const bool choice =
        *row.type == Type::boolean || (*row.type == Type::string && row.spec && !row.spec->options.empty());
    if (choice) return 1;
    // A default that is no number (the position, nothing) is shown in words.
    const bool given = row.value || (row.spec && row.spec->value.kind == InputDefault::Kind::numbers);
    return number && given ? componentCount(*row.type) : 0;
}

/// Why a wire is as wide as it looks: half of what is between its ends, or a loop where it runs backwards.
float bend(ImVec2 from, ImVec2 to) {
    const float across = to.x - from.x;
    return std::max(kLeastBend, across >= 0.0f ? 0.5f * across : std::min(-across, 200.0f));
}

NodeBox boxOf(const Scope& scope, uint32_t index) {
    const Node& node = scope.nodes[index];
    NodeBox box{.node = &node, .type = scope.types[index], .reroute = scope.is(index, NodeRole::reroute)};
    const bool known = hasKnownSockets(scope, index);
    float y = kTitleHeight;
    const auto add = [&](std::string name, bool output) {
        Row row{.name = std::move(name), .output = output};
        const std::optional<Socket> socket = !known   ? std::nullopt
                                             : output ? outputSocket(scope, index, row.name)
                                                      : inputSocket(scope, index, row.name);
        if (socket) row.type = socket->type, row.spec = socket->spec;
        if (!output) row.value = node.input(row.name);
        row.linked = row.value && std::holds_alternative<Link>(row.value->value);
        if (!row.type && row.value && !row.linked) row.type = typeOfValue(*row.value);
        row.fields = fieldsOf(row);
        row.y = y + 0.5f * kRowHeight;
        y += kRowHeight * (row.fields > 1 ? 2.0f : 1.0f);
        box.rows.push_back(std::move(row));
    };
    std::vector<std::string> inputs;
    if (known) {
        for (std::string& name : outputNames(scope, index)) add(std::move(name), true);
        inputs = inputNames(scope, index);
    }
    // What the file gives besides has a row too: it is seen, and can be taken away.
    for (const auto& [name, value] : node.inputs)
        if (std::find(inputs.begin(), inputs.end(), name) == inputs.end()) inputs.push_back(name);
    for (std::string& name : inputs) add(std::move(name), false);

    const ImVec2 at = node.at ? vec(*node.at) : ImVec2(0, 0);
    const float width = box.reroute                             ? 2.0f * kRerouteRadius
                        : scope.is(index, NodeRole::expression) ? kWideNodeWidth
                                                                : kNodeWidth;
    const float height = box.reroute ? width : node.collapsed ? kTitleHeight : y + kFoot;
    if (box.reroute || node.collapsed)
        for (Row& row : box.rows) row.y = 0.5f * height, row.fields = 0;
    box.area = {at, at + ImVec2(width, height)};
    return box;
}

}  // namespace

ImVec2 NodeBox::socket(const Row& row) const {
    if (reroute) return area.centre();
    return {row.output ? area.hi.x : area.lo.x, area.lo.y + row.y};
}

Area NodeBox::field(const Row& row, int component) const {
    const float left = area.lo.x + kInset, right = area.hi.x - kInset;
    const float top = area.lo.y + row.y - 0.5f * kRowHeight + 2.0f, high = kRowHeight - 4.0f;
    // A single field has its label before it; those of a vector stand below it.
    if (row.fields <= 1) return {{0.5f * (left + right), top}, {right, top + high}};
    const float wide = (right - left - kFieldGap * float(row.fields - 1)) / float(row.fields);
    const float x = left + float(component) * (wide + kFieldGap);
    return {{x, top + kRowHeight}, {x + wide, top + kRowHeight + high}};
}

Area thumbnailArea(const NodeBox& box) {
    constexpr float kGap = 4.0f;
    const float bottom = box.area.lo.y - kGap;
    return {{box.area.lo.x, bottom - box.area.width()}, {box.area.hi.x, bottom}};
}

Boxes::Boxes(const Graph& graph, std::string_view scopeId) : frames(framesOf(graph)), scope(scopeId) {
    const Groups groups(graph);
    const auto group = groups.byId.find(scopeId);
    const GroupSockets* inside =
        scopeId.empty() || group == groups.byId.end() ? nullptr : &groups.list[group->second];
    const Scope shown(groups, nodesOf(graph, scopeId), inside);
    nodes.reserve(shown.nodes.size());
    for (uint32_t i = 0; i < shown.nodes.size(); ++i) {
        nodes.push_back(boxOf(shown, i));
        byId.emplace(shown.nodes[i].id, i);
    }
    for (uint32_t to = 0; to < nodes.size(); ++to)
        for (uint32_t toRow = 0; toRow < nodes[to].rows.size(); ++toRow) {
            const Row& row = nodes[to].rows[toRow];
            if (!row.linked) continue;
            const Link& link = std::get<Link>(row.value->value);
            const auto from = byId.find(link.node);
            if (from == byId.end()) continue;
            const std::vector<Row>& rows = nodes[from->second].rows;
            const auto output = std::find_if(rows.begin(), rows.end(), [&](const Row& each) {
                return each.output && (link.output.empty() || each.name == link.output);
            });
            if (output != rows.end())
                wires.push_back({from->second, uint32_t(output - rows.begin()), to, toRow});
        }
}

const NodeBox* Boxes::find(std::string_view id) const {
    const auto found = byId.find(id);
    return found == byId.end() ? nullptr : &nodes[found->second];
}

const Row* Boxes::row(const Plug& plug, bool output) const {
    const NodeBox* box = find(plug.node);
    if (!box) return nullptr;
    for (const Row& row : box->rows)
        if (row.output == output && (row.name == plug.name || (output && plug.name.empty()))) return &row;
    return nullptr;
}

Plug Boxes::output(const Wire& wire) const {
    return {nodes[wire.from].node->id, nodes[wire.from].rows[wire.fromRow].name};
}

Plug Boxes::input(const Wire& wire) const {
    return {nodes[wire.to].node->id, nodes[wire.to].rows[wire.toRow].name};
}

Area Boxes::around(const std::set<std::string>* only) const {
    Area all{{1e30f, 1e30f}, {-1e30f, -1e30f}};
    for (const NodeBox& box : nodes)
        if (!only || only->contains(box.node->id)) all.add(box.area);
    return all.lo.x <= all.hi.x ? all : Area{{-200, -150}, {200, 150}};
}

Curve curve(ImVec2 from, ImVec2 to) {
    const ImVec2 handle(bend(from, to), 0);
    return {{from, from + handle, to - handle, to}};
}

ImVec2 Curve::at(float t) const {
    const float s = 1.0f - t;
    return s * s * s * points[0] + 3 * s * s * t * points[1] +
           (3 * s * t * t * points[2] + t * t * t * points[3]);
}

Area Curve::area() const {
    Area all{points[0], points[0]};
    for (ImVec2 point : points) all.add(point);
    return all;
}

float Curve::distance(ImVec2 p) const {
    float least = 1e30f;
    ImVec2 a = points[0];
    for (int i = 1; i <= kPieces; ++i) {
        const ImVec2 b = at(float(i) / kPieces), along = b - a, off = p - a;
        const float t = std::clamp(dot(off, along) / std::max(dot(along, along), 1e-6f), 0.0f, 1.0f);
        const ImVec2 d = off - t * along;
        least = std::min(least, dot(d, d));
        a = b;
    }
    return std::sqrt(least);
}

std::optional<ImVec2> Curve::crossing(ImVec2 from, ImVec2 to) const {
    const ImVec2 cut = to - from;
    ImVec2 a = points[0];
    for (int i = 1; i <= kPieces; ++i) {
        const ImVec2 b = at(float(i) / kPieces), along = b - a;
        const bool across = (cross(cut, a - from) < 0.0f) != (cross(cut, b - from) < 0.0f);
        if (across && cross(along, from - a) * cross(along, to - a) <= 0.0f)
            return a + (cross(from - a, cut) / cross(along, cut)) * along;
        a = b;
    }
    return std::nullopt;
}

std::vector<bool> wayThrough(const Boxes& boxes, uint32_t wire) {
    std::vector<bool> lit(boxes.wires.size());
    lit[wire] = true;
    const auto follow = [&](uint32_t start, uint32_t Wire::*near, uint32_t Wire::*far) {
        std::vector<std::vector<uint32_t>> at(boxes.nodes.size());
        for (uint32_t i = 0; i < boxes.wires.size(); ++i) at[boxes.wires[i].*near].push_back(i);
        std::vector<uint32_t> open{start};
        while (!open.empty()) {
            const uint32_t node = open.back();
            open.pop_back();
            for (const uint32_t each : std::exchange(at[node], {})) {
                lit[each] = true;
                open.push_back(boxes.wires[each].*far);
            }
        }
    };
    follow(boxes.wires[wire].from, &Wire::to, &Wire::from);
    follow(boxes.wires[wire].to, &Wire::from, &Wire::to);
    return lit;
}

Hit hitTest(const Boxes& boxes, ImVec2 p, float reach) {
    using What = Hit::What;
    for (uint32_t i = uint32_t(boxes.nodes.size()); i-- > 0;) {
        const NodeBox& box = boxes.nodes[i];
        if (!box.area.grown(reach).contains(p)) continue;
        if (box.reroute) {
            // Its middle moves it; wires begin at its right side and end at its left one.
            const float x = p.x - box.area.centre().x;
            const bool output = x > 0.5f * kRerouteRadius;
            if (std::abs(x) <= 0.5f * kRerouteRadius) return {What::title, i};
            for (uint32_t r = 0; r < box.rows.size(); ++r)
                if (box.rows[r].output == output) return {output ? What::output : What::input, i, r};
        }
        if (!box.node->collapsed)
            for (uint32_t r = 0; r < box.rows.size(); ++r) {
                const ImVec2 off = p - box.socket(box.rows[r]);
                if (dot(off, off) > reach * reach) continue;
                return {box.rows[r].output ? What::output : What::input, i, r};
            }
        if (!box.area.contains(p)) continue;
        if (p.y < box.area.lo.y + kTitleHeight) return {What::title, i};
        for (uint32_t r = 0; r < box.rows.size(); ++r)
            for (int c = 0; c < box.rows[r].fields; ++c)
                if (box.field(box.rows[r], c).contains(p)) return {What::field, i, r, c};
        return {What::node, i};
    }
    Hit nearest;
    float least = reach;
    for (uint32_t i = 0; i < boxes.wires.size(); ++i) {
        const Curve wire = curve(boxes.start(boxes.wires[i]), boxes.end(boxes.wires[i]));
        if (!wire.area().grown(reach).contains(p)) continue;
        if (const float d = wire.distance(p); d < least) least = d, nearest = {What::wire, i};
    }
    if (nearest.what == What::wire) return nearest;
    for (uint32_t i = uint32_t(boxes.frames.size()); i-- > 0;) {
        const Frame& frame = boxes.frames[i];
        if (frame.scope != boxes.scope) continue;
        const ImVec2 lo = vec(frame.at), hi = lo + vec(frame.size);
        if (!Area{lo, hi}.contains(p)) continue;
        if (p.x > hi.x - kFrameCorner && p.y > hi.y - kFrameCorner) return {What::frameCorner, i};
        return {p.y < lo.y + kFrameTitle ? What::frameTitle : What::frame, i};
    }
    return {};
}

std::string readable(std::string_view name) {
    std::string text(name);
    std::replace(text.begin(), text.end(), '_', ' ');
    if (!text.empty()) text[0] = char(std::toupper(static_cast<unsigned char>(text[0])));
    return text;
}

std::string titleOf(const NodeBox& box) {
    if (!box.node->label.empty()) return box.node->label;
    if (!box.node->group.empty()) return readable(box.node->group);
    return box.type ? box.type->label : box.node->type;
}

}  // namespace fw::editor
