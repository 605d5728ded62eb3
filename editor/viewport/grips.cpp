#include "editor/viewport/grips.h"

#include <algorithm>

#include "graph/document/timeline.h"

namespace fw::editor {

namespace {

using Kind = Handle::Kind;

Tool toolOf(const Handle& handle) {
    switch (handle.kind) {
        case Kind::move: return Tool::move;
        case Kind::turn:
        case Kind::aim: return Tool::turn;
        case Kind::extent: return handle.placing ? Tool::move : Tool::scale;
        case Kind::scale:
        case Kind::angle: break;
    }
    return Tool::scale;
}

Type madeBy(const Node& node) {
    const NodeType* type = findNodeType(node.type);
    return type && !type->outputs.empty() ? type->outputs.front().type : Type::surface;
}

}  // namespace

std::optional<Plug> wireAhead(const std::vector<Node>& nodes, const std::string& node,
                              const std::string& next) {
    const NodeType *from = findNodeType(findNode(nodes, node)->type),
                   *to = findNodeType(findNode(nodes, next)->type);
    const bool makes = from && !from->outputs.empty() && from->outputs.front().type == Type::surface;
    for (const auto& [name, value] : findNode(nodes, next)->inputs) {
        const Link* link = std::get_if<Link>(&value.value);
        const int index = to ? inputIndex(*to, name) : -1;
        if (link && link->node == node &&
            (makes || (index >= 0 && to->inputs[std::size_t(index)].type == Type::surface)))
            return Plug{next, name};
    }
    return std::nullopt;
}

bool passesAlone(const Node& node) {
    const NodeType* type = findNodeType(node.type);
    if (!type || type->role == NodeRole::reroute) return type != nullptr;
    return std::ranges::count(type->inputs, Type::surface, &InputSpec::type) == 1 && placementBy(node);
}

Moment::Moment(const Graph& graph, const std::string& scope, double seconds) : still(&graph) {
    const Result<Timeline> timeline = readTimeline(graph);
    if (!timeline || timeline->tracks.empty()) return;
    if (scope.empty()) animated = animatedInputs(graph, *timeline);
    moved = atTime(graph, *timeline, timelineTime(*timeline, seconds));
}

Grips gripsOf(const Graph& graph, const std::string& scope, const std::string& node,
              const std::string& pinned, double seconds, Tool tool) {
    Grips grips;
    const auto way = wayToShown(graph, scope, node, pinned);
    if (!way) return grips;
    const Moment moment(graph, scope, seconds);
    const Graph& now = moment.graph();
    const std::set<std::string>& animated = moment.animated;
    const std::vector<Node>& nodes = nodesOf(now, scope);
    const Placement outside = placementOf(now, scope, pinned);
    const auto placed = [&](std::span<const std::string> part) {
        const Placement inside = placementAlong(now, scope, part);
        return inside.why.empty() ? inside.then(outside) : inside;
    };
    NodeIds all{node};
    all.insert(all.end(), way->begin(), way->end());
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Node& each = *findNode(nodes, all[i]);
        if (i > 0 && !passesAlone(each)) break;
        // What is made along a spline leaves that where it is.
        const std::size_t next = std::min(i + (madeBy(each) == Type::spline ? 2 : 1), all.size());
        const Placement placement = placed(std::span(all).subspan(next));
        if (i == 0) grips.spline = splines::shownOf(each, placement);
        for (Handle& handle : handlesOf(each, placement, animated)) {
            // What moves particles does not move a surface that they meet.
            if (i > 0 && madeBy(each) != Type::surface) continue;
            grips.tools.insert(toolOf(handle));
            // The first node that has some for the tool has them all.
            if (toolOf(handle) != tool || (!grips.handles.empty() && grips.handles[0].node != each.id))
                continue;
            grips.handles.push_back(std::move(handle));
            grips.why = placement.why;
        }
    }
    if (!way->empty()) grips.ahead = wireAhead(nodes, node, way->front());
    if (!grips.ahead) return grips;
    grips.tools = {Tool::move, Tool::turn, Tool::scale};
    if (!grips.handles.empty()) return grips;
    Node added;
    added.type = typeFor(tool).id;
    const Placement placement = placed(*way);
    grips.handles = handlesOf(added, placement, {});
    grips.why = placement.why;
    return grips;
}

const NodeType& typeFor(Tool tool) {
    return *std::ranges::find_if(nodeTypes(), [&](const NodeType& type) {
        if (type.inputs.size() != 2 || type.inputs[0].type != Type::surface) return false;
        const InputSpec& input = type.inputs[1];
        return tool == Tool::move ? isPlace(input) : tool == Tool::turn ? isAngles(input) : isFactor(input);
    });
}

}  // namespace fw::editor
