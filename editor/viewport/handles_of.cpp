// The handles of a node, read off its type's entry: what an input is by its unit and range, and its Grip.
#include <algorithm>
#include <glm/geometric.hpp>

#include "editor/splines/edits.h"
#include "editor/viewport/gizmo.h"
#include "graph/document/named_parameters.h"

namespace fw::editor {

namespace {

using Kind = Handle::Kind;

constexpr double kLeastSide = 1e-3;  // metres of a box whose corner is dragged to the other one
constexpr std::size_t kMostKnotHandles = 500;

glm::dvec3 asVector(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

/// As a vector; what is missing is 0.
glm::dvec3 numbersAt(const Node& node, const NodeType& type, std::string_view input) {
    const std::vector<double> numbers = inputNumbers(node, input);
    const int index = inputIndex(type, input);
    if (numbers.size() == 1 && index >= 0 && type.inputs[std::size_t(index)].type == Type::vec3)
        return glm::dvec3(numbers[0]);
    glm::dvec3 result(0.0);
    for (std::size_t i = 0; i < std::min<std::size_t>(numbers.size(), 3); ++i) result[int(i)] = numbers[i];
    return result;
}

/// Along which a length lies, of unit length.
glm::dvec3 alongOf(const Node& node, const NodeType& type, const Grip& grip) {
    if (grip.with.empty()) return asVector(grip.along);
    const glm::dvec3 given = numbersAt(node, type, grip.with);
    return glm::length(given) > 0.0 ? glm::normalize(given) : glm::dvec3(0, 1, 0);
}

/// Where the grip of this input begins, and where it ends, in the node's space.
glm::dvec3 gripBase(const Node& node, const NodeType& type, const InputSpec& input);
glm::dvec3 gripEnd(const Node& node, const NodeType& type, const InputSpec& input) {
    const glm::dvec3 numbers = numbersAt(node, type, input.name);
    switch (input.grip.kind) {
        case Grip::Kind::none: return numbers;  // a place
        case Grip::Kind::length:
            return gripBase(node, type, input) + numbers.x * alongOf(node, type, input.grip);
        case Grip::Kind::sizes: return gripBase(node, type, input) + numbers * asVector(input.grip.along);
        default: return gripBase(node, type, input);
    }
}
glm::dvec3 gripBase(const Node& node, const NodeType& type, const InputSpec& input) {
    const std::string& from = input.grip.from;
    const bool opposite = from.starts_with('-');
    const int index = inputIndex(type, std::string_view(from).substr(opposite ? 1 : 0));
    if (index < 0) return glm::dvec3(0.0);
    const glm::dvec3 end = gripEnd(node, type, type.inputs[std::size_t(index)]);
    return opposite ? -end : end;
}

std::optional<Kind> kindOf(const InputSpec& input) {
    switch (input.grip.kind) {
        case Grip::Kind::length:
        case Grip::Kind::sizes:
        case Grip::Kind::corner: return Kind::extent;
        case Grip::Kind::angle: return Kind::angle;
        case Grip::Kind::direction: return Kind::aim;
        case Grip::Kind::none: break;
    }
    if (isPlace(input)) return Kind::move;
    if (isAngles(input)) return Kind::turn;
    if (isFactor(input)) return Kind::scale;
    if (isExtent(input)) return Kind::extent;
    return std::nullopt;
}

/// Puts the handle where the input's grip is.
void grip(Handle& handle, const Node& node, const NodeType& type, const InputSpec& input,
          const Placement& placement) {
    const Grip& grip = input.grip;
    if (!grip) return;  // it is where its unit and range say
    const glm::dvec3 base = gripBase(node, type, input);
    handle.origin = placement.of(base);
    switch (grip.kind) {
        case Grip::Kind::none: return;
        case Grip::Kind::length:
            handle.count = 1;
            handle.axes[0] = placement.linear * alongOf(node, type, grip);
            handle.placing = !grip.with.empty();
            return;
        case Grip::Kind::sizes:
            handle.count = input.type == Type::vec2 ? 2 : 3;
            for (int i = 0; i < 3; ++i) handle.axes[i] *= grip.along[std::size_t(i)];
            return;
        case Grip::Kind::angle: {
            handle.count = 1;
            handle.origin = placement.of(base + asVector(grip.middle));
            const double reach = grip.with.empty() ? 1.0 : numbersAt(node, type, grip.with).x;
            // A length of 0 leaves nothing to turn about.
            const glm::dmat3 arm = placement.linear * std::max(reach, kLeastSide);
            handle.axes[0] = arm * asVector(grip.along), handle.axes[1] = arm * asVector(grip.towards);
            return;
        }
        case Grip::Kind::direction: handle.count = 1; return;
        case Grip::Kind::corner: {
            const glm::dvec3 other = numbersAt(node, type, grip.with), own = vectorOf(handle.numbers);
            for (int i = 0; i < 3; ++i) {
                glm::dvec3 face = 0.5 * (own + other);
                face[i] = 0.0;
                handle.bases[i] = placement.linear * face;
                const bool lower = grip.with.ends_with("max");
                (lower ? handle.most : handle.least)[i] = other[i] + (lower ? -kLeastSide : kLeastSide);
            }
            return;
        }
    }
}

bool hasHandles(const NodeType& type) {
    if (type.outputs.empty()) return false;
    const Type made = type.outputs.front().type;
    return made == Type::surface || made == Type::particles || made == Type::mesh || made == Type::spline;
}

/// One for each of the node's knots, to be moved across the view.
void addKnots(const Node& node, const Placement& placement, std::vector<Handle>& handles) {
    const std::optional<splines::Knots> knots = splines::knotsOf(node);
    for (std::size_t i = 0; knots && i < std::min(knots->count(), kMostKnotHandles); ++i) {
        const glm::dvec3 at = knots->at(i);
        Handle handle{.node = node.id, .input = splines::knotsInput(node), .numbers = {at.x, at.y, at.z}};
        handle.count = 0;
        handle.knot = int(i);
        handle.origin = placement.of(at);
        handle.axes = placement.linear;
        if (node.muted) handle.refusal = "The node is muted.";
        handles.push_back(std::move(handle));
    }
}

}  // namespace

std::vector<Handle> handlesOf(const Node& node, const Placement& placement,
                              const std::set<std::string>& animated) {
    const NodeType* type = findNodeType(node.type);
    if (!type || !hasHandles(*type)) return {};
    // What stands about a node's place is turned and scaled there.
    glm::dvec3 centre(0.0);
    const bool moves = std::ranges::count(type->inputs, Type::surface, &InputSpec::type) == 1;
    for (const InputSpec& input : type->inputs)
        if (moves && kindOf(input) == Kind::move) centre = numbersAt(node, *type, input.name);
    std::vector<Handle> handles;
    for (const InputSpec& input : type->inputs) {
        const std::optional<Kind> kind = kindOf(input);
        if (!kind) continue;
        Handle handle{
            .kind = *kind, .node = node.id, .input = input.name, .numbers = inputNumbers(node, input.name)};
        const InputValue* given = node.input(input.name);
        const Link* link = given ? std::get_if<Link>(&given->value) : nullptr;
        if (link)
            handle.numbers = input.value.numbers, handle.refusal = "It is wired: " + link->node + " sets it.";
        if (node.muted) handle.refusal = "The node is muted.";
        if (animated.contains(node.id + "." + input.name))
            handle.refusal = "The timeline moves it: change its keys.";
        if (input.type == Type::vec3 && handle.numbers.size() == 1)
            handle.numbers.resize(3, handle.numbers[0]);
        // Without a default there is nothing to hold until both corners are given.
        const bool corner = input.grip.kind == Grip::Kind::corner;
        if (handle.numbers.empty() || (corner && inputNumbers(node, input.grip.with).empty())) continue;
        const glm::dvec3 numbers = vectorOf(handle.numbers);
        handle.origin = placement.of(handle.kind == Kind::move     ? numbers
                                     : handle.kind == Kind::extent ? glm::dvec3(0.0)
                                                                   : centre);
        handle.axes = placement.linear;
        if (handle.kind == Kind::extent || handle.kind == Kind::angle)
            handle.least = glm::dvec3(input.min), handle.most = glm::dvec3(input.max);
        grip(handle, node, *type, input, placement);
        if (handle.kind == Kind::turn) {
            // Turns about x come first: what follows turns their axis too.
            const glm::dmat3 axes(turned({0, numbers.y, numbers.z})[0], turned({0, 0, numbers.z})[1],
                                  glm::dvec3(0, 0, 1));
            for (int i = 0; i < 3; ++i) handle.axes[i] = glm::normalize(placement.linear * axes[i]);
        }
        handles.push_back(std::move(handle));
    }
    addKnots(node, placement, handles);
    return handles;
}

}  // namespace fw::editor
