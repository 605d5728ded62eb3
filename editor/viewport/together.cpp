#include "editor/viewport/together.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include "graph/document/input_value.h"
#include "graph/document/named_parameters.h"

namespace fw::editor {

namespace {

constexpr std::size_t kMostFeatureNodes = 300;
constexpr double kPlaceGrain = 1e-4, kAngleGrain = 1e-3, kFactorGrain = 1e-4;

double grained(double value, double grain) {
    const double parts = std::round(1.0 / grain);
    return std::round(value * parts) / parts + 0.0;  // no -0
}

/// The inputs of a node that moves what comes to it; nothing if it is not of that kind.
std::optional<Placing> placingBy(const Node& node) {
    const NodeType* type = findNodeType(node.type);
    if (!type || node.muted || !placementBy(node) ||
        std::ranges::count(type->inputs, Type::surface, &InputSpec::type) != 1)
        return std::nullopt;
    Placing placing;
    placing.node = node.id;
    for (const InputSpec& input : type->inputs) {
        if (input.type == Type::surface) continue;
        const InputValue* given = node.input(input.name);
        if (given && std::holds_alternative<Link>(given->value)) return std::nullopt;
        if (input.grip) return std::nullopt;
        if (isPlace(input))
            placing.place = input.name;
        else if (isAngles(input))
            placing.angles = input.name;
        else if (isFactor(input))
            placing.factor = input.name;
    }
    return placing;
}

bool serves(const Placing& placing, Tool tool) {
    return !placing.place.empty() && (tool != Tool::turn || !placing.angles.empty()) &&
           (tool != Tool::scale || !placing.factor.empty());
}

bool isMoved(const Placing& placing, const std::set<std::string>& animated) {
    for (const std::string* input : {&placing.place, &placing.angles, &placing.factor})
        if (animated.contains(placing.node + "." + *input)) return true;
    return false;
}

/// The node type that moves, turns and scales, and does nothing else.
const NodeType& typeForAll() {
    return *std::ranges::find_if(nodeTypes(), [](const NodeType& type) {
        return type.inputs.size() == 4 && type.inputs[0].type == Type::surface && isPlace(type.inputs[1]) &&
               isAngles(type.inputs[2]) && isFactor(type.inputs[3]);
    });
}

glm::dmat3 unitAxes(const glm::dmat3& linear) {
    const glm::dvec3 x = glm::normalize(linear[0]);
    const glm::dvec3 y = glm::normalize(linear[1] - x * glm::dot(x, linear[1]));
    return {x, y, glm::cross(x, y)};
}

void stand(Placing& placing, const Node& node, const Placement& outside) {
    placing.outside = outside;
    placing.at =
        outside.of(placing.place.empty() ? glm::dvec3(0.0) : vectorOf(inputNumbers(node, placing.place)));
    const glm::dmat3 own =
        placing.angles.empty() ? glm::dmat3(1.0) : turned(vectorOf(inputNumbers(node, placing.angles)));
    placing.axes = unitAxes(outside.linear * own);
}

Graph withNumbers(const Graph& graph, const std::string& scope, const Plug& input, glm::dvec3 value,
                  double grain) {
    std::vector<double> numbers;
    for (int i = 0; i < 3; ++i) {
        if (!std::isfinite(value[i])) return graph;  // it stands behind a factor of 0
        numbers.push_back(grained(value[i], grain));
    }
    return setInput(graph, scope, input, numbersValue(numbers));
}

}  // namespace

glm::dvec3 anglesOf(const glm::dmat3& m, const glm::dvec3& near) {
    const auto about = [&](const glm::dvec3& angles) {
        glm::dvec3 result = angles;
        for (int i = 0; i < 3; ++i) result[i] = near[i] + std::remainder(angles[i] - near[i], 360.0);
        return result;
    };
    const double level = std::hypot(m[0][0], m[0][1]);
    if (level < 1e-9) {  // x and z turn about the same: x stays
        const double y = m[0][2] < 0.0 ? 90.0 : -90.0, x = glm::radians(near.x);
        const double sum = std::atan2(-m[1][0], m[1][1]);
        return about({near.x, y, glm::degrees(y > 0.0 ? sum + x : sum - x)});
    }
    const glm::dvec3 one = glm::degrees(
        glm::dvec3(std::atan2(m[1][2], m[2][2]), std::atan2(-m[0][2], level), std::atan2(m[0][1], m[0][0])));
    // The same rotation in other words.
    const glm::dvec3 a = about(one), b = about({one.x + 180.0, 180.0 - one.y, one.z + 180.0});
    return glm::distance(a, near) <= glm::distance(b, near) ? a : b;
}

std::vector<Placing> placingsOf(const Graph& graph, const std::string& scope,
                                const std::set<std::string>& selection, const std::string& pinned,
                                double seconds, Tool tool) {
    const Moment moment(graph, scope, seconds);
    const Graph& now = moment.graph();
    const std::vector<Node>& nodes = nodesOf(now, scope);
    const Placement outside = placementOf(now, scope, pinned);
    const auto placed = [&](std::span<const std::string> part) {
        const Placement inside = placementAlong(now, scope, part);
        return inside.why.empty() ? inside.then(outside) : inside;
    };
    std::vector<Placing> placings;
    std::set<std::string> taken;
    for (const std::string& id : selection) {
        if (!findNode(nodes, id)) continue;
        const auto way = wayToShown(now, scope, id, pinned);
        if (!way) continue;
        NodeIds all{id};
        all.insert(all.end(), way->begin(), way->end());
        std::optional<Placing> found;
        bool along = false;  // another selected one moves it
        for (std::size_t i = 0; i < all.size(); ++i) {
            const Node& each = *findNode(nodes, all[i]);
            if (i > 0 && !passesAlone(each)) break;
            const std::optional<Placing> by = placingBy(each);
            if (i > 0 && by && !by->place.empty() && selection.contains(all[i])) along = true;
            if (found || !by || !serves(*by, tool) || isMoved(*by, moment.animated)) continue;
            found = by;
            stand(*found, each, placed(std::span(all).subspan(i + 1)));
        }
        if (along) continue;
        if (!found && !way->empty()) {
            found.emplace().ahead = wireAhead(nodes, id, way->front());
            if (!found->ahead) continue;
            stand(*found, Node{}, placed(*way));
        }
        if (!found || (!found->node.empty() && !taken.insert(found->node).second)) continue;
        found->selected = id;
        placings.push_back(std::move(*found));
    }
    return placings;
}

std::optional<Graph> withPlacings(const Graph& graph, const std::string& scope,
                                  std::vector<Placing>& placings) {
    Graph result = graph;
    for (Placing& placing : placings) {
        if (!placing.node.empty()) continue;
        const NodeType& type = typeForAll();
        const Node *from = findNode(nodesOf(result, scope), placing.selected),
                   *to = findNode(nodesOf(result, scope), placing.ahead->node);
        // Above the wire: there it hides neither of the two.
        constexpr double kRise = 140.0;
        std::array<double, 2> place = {0, 0};
        if (from && to && from->at && to->at)
            place = {0.5 * ((*from->at)[0] + (*to->at)[0]), std::min((*from->at)[1], (*to->at)[1]) - kRise};
        Edited added = insertOnWire(result, scope, *placing.ahead, type.id, place);
        if (added.nodes.empty()) return std::nullopt;
        result = std::move(added.graph);
        placing.node = added.nodes.front();
        placing.place = type.inputs[1].name, placing.angles = type.inputs[2].name,
        placing.factor = type.inputs[3].name;
    }
    return result;
}

Graph moved(const Graph& graph, const std::string& scope, const std::vector<Placing>& placings,
            const Motion& motion) {
    Graph result = graph;
    for (const Placing& placing : placings) {
        const Node* node = findNode(nodesOf(graph, scope), placing.node);
        if (!node) continue;
        const glm::dmat3& linear = placing.outside.linear;
        const glm::dvec3 about = motion.about.value_or(placing.at);
        const glm::dvec3 at = about + motion.turn * ((placing.at - about) * motion.factor) + motion.shift;
        if (glm::distance(at, placing.at) > 1e-9)
            result = withNumbers(result, scope, {placing.node, placing.place},
                                 glm::inverse(linear) * (at - placing.outside.shift), kPlaceGrain);
        if (motion.turn != glm::dmat3(1.0) && !placing.angles.empty()) {
            const glm::dvec3 before = vectorOf(inputNumbers(*node, placing.angles));
            const glm::dmat3 after = unitAxes(glm::inverse(linear) * motion.turn * linear * turned(before));
            result = withNumbers(result, scope, {placing.node, placing.angles}, anglesOf(after, before),
                                 kAngleGrain);
        }
        if (motion.factor != 1.0 && !placing.factor.empty()) {
            std::vector<double> numbers = inputNumbers(*node, placing.factor);
            for (double& number : numbers)
                number = std::max(grained(number * motion.factor, kFactorGrain), kFactorGrain);
            result = setInput(result, scope, {placing.node, placing.factor}, numbersValue(numbers));
        }
    }
    return result;
}

Handle handleTogether(const std::vector<Placing>& placings, const std::string& active, Tool tool, AxesOf axes,
                      PivotAt pivot, const glm::dvec3& point) {
    const auto chosen = std::ranges::find(placings, active, &Placing::selected);
    const Placing& first = chosen == placings.end() ? placings.front() : *chosen;
    glm::dvec3 middle(0.0);
    for (const Placing& placing : placings) middle += placing.at / double(placings.size());
    Handle handle;
    handle.kind = tool == Tool::move   ? Handle::Kind::move
                  : tool == Tool::turn ? Handle::Kind::turn
                                       : Handle::Kind::scale;
    handle.numbers = tool == Tool::scale ? std::vector<double>{1.0} : std::vector<double>{0.0, 0.0, 0.0};
    handle.origin = pivot == PivotAt::own     ? first.at
                    : pivot == PivotAt::world ? glm::dvec3(0.0)
                    : pivot == PivotAt::point ? point
                                              : middle;
    handle.axes = axes == AxesOf::own       ? first.axes
                  : axes == AxesOf::numbers ? unitAxes(first.outside.linear)
                                            : glm::dmat3(1.0);
    return handle;
}

Motion motionOf(const Handle& handle, int axis, const std::vector<double>& numbers, PivotAt pivot) {
    Motion motion;
    if (pivot != PivotAt::own) motion.about = handle.origin;
    switch (handle.kind) {
        case Handle::Kind::move: motion.shift = handle.axes * vectorOf(numbers); break;
        case Handle::Kind::turn:
            motion.turn = glm::dmat3(
                glm::rotate(glm::dmat4(1.0), glm::radians(numbers[std::size_t(axis)]), handle.axes[axis]));
            break;
        default: motion.factor = numbers[0]; break;
    }
    return motion;
}

std::vector<glm::dvec3> featuresOf(const Graph& graph, const std::string& scope,
                                   const std::set<std::string>& except, const std::string& pinned,
                                   double seconds) {
    const Moment moment(graph, scope, seconds);
    const Graph& now = moment.graph();
    const Placement outside = placementOf(now, scope, pinned);
    std::vector<glm::dvec3> features;
    const std::vector<Node>& nodes = nodesOf(now, scope);
    for (std::size_t i = 0; i < std::min(nodes.size(), kMostFeatureNodes); ++i) {
        const Node& node = nodes[i];
        if (except.contains(node.id)) continue;
        const auto way = wayToShown(now, scope, node.id, pinned);
        // What moves along with what is held is no place to go to.
        if (!way || std::ranges::any_of(*way, [&](const std::string& id) { return except.contains(id); }))
            continue;
        const Placement placement = placementAlong(now, scope, *way).then(outside);
        const NodeType* type = findNodeType(node.type);
        if (type && type->category == Category::shape) features.push_back(placement.of(glm::dvec3(0.0)));
        for (const Handle& handle : handlesOf(node, placement, {})) {
            if (handle.kind == Handle::Kind::move) features.push_back(handle.origin);
            if (handle.kind != Handle::Kind::extent) continue;
            for (int axis = 0; axis < std::min(handle.count, int(handle.numbers.size())); ++axis) {
                features.push_back(handle.tip(axis, 0.0));
                if (handle.count > 1) features.push_back(2.0 * handle.base(axis) - handle.tip(axis, 0.0));
            }
            if (handle.count == 3 && handle.least.x == 0.0)  // the corners of a box about the middle
                for (int corner = 0; corner < 8; ++corner) {
                    glm::dvec3 at = handle.origin;
                    for (int axis = 0; axis < 3; ++axis)
                        at += handle.axes[axis] * handle.numbers[std::size_t(axis)] *
                              (corner >> axis & 1 ? 1.0 : -1.0);
                    features.push_back(at);
                }
        }
    }
    return features;
}

}  // namespace fw::editor
