#include "graph/library/node_type.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <unordered_map>

#include "graph/base/words.h"

namespace fw {
namespace {

/// Ids and aliases to indices in nodeTypes().
std::unordered_map<std::string_view, std::size_t> indexNames() {
    std::unordered_map<std::string_view, std::size_t> index;
    const std::vector<NodeType>& types = nodeTypes();
    for (std::size_t i = 0; i < types.size(); i++) {
        bool unique = index.emplace(types[i].id, i).second;
        for (const std::string& alias : types[i].aliases) unique = index.emplace(alias, i).second && unique;
        assert(unique && "an id or alias names two node types");
        (void)unique;
    }
    return index;
}

}  // namespace

std::string_view categoryName(Category category) {
    switch (category) {
        case Category::shape: return "Shapes";
        case Category::shape2d: return "2-D shapes";
        case Category::spline: return "Splines";
        case Category::combine: return "Combine";
        case Category::domain: return "Domain";
        case Category::field: return "Fields";
        case Category::maths: return "Maths";
        case Category::material: return "Material";
        case Category::mesh: return "Mesh stages";
        case Category::particles: return "Particles";
        case Category::structure: return "Structure";
    }
    assert(!"every category has a name");
    return "";
}

ExactnessRule always(Exactness exactness) {
    return [exactness](const ExactnessArguments&) { return exactness; };
}

ExactnessRule sameAs(std::string input) {
    return [input = std::move(input)](const ExactnessArguments& node) { return node.surface(input); };
}

const NodeType* findNodeType(std::string_view id) {
    static const std::unordered_map<std::string_view, std::size_t> index = indexNames();
    const auto found = index.find(id);
    return found == index.end() ? nullptr : &nodeTypes()[found->second];
}

int inputIndex(const NodeType& type, std::string_view name) {
    const auto found = std::ranges::find(type.inputs, name, &InputSpec::name);
    return found == type.inputs.end() ? -1 : static_cast<int>(found - type.inputs.begin());
}

int outputIndex(const NodeType& type, std::string_view name) {
    const auto found = std::ranges::find(type.outputs, name, &OutputSpec::name);
    return found == type.outputs.end() ? -1 : static_cast<int>(found - type.outputs.begin());
}

std::string rangeWords(const InputSpec& input) {
    std::string words = input.positive ? "above 0" : "";
    const auto add = [&](const std::string& bound) { words += (words.empty() ? "" : " and ") + bound; };
    if (std::isfinite(input.min) && !(input.positive && input.min <= 0))
        add("at least " + shortNumber(input.min));
    if (std::isfinite(input.max)) add("at most " + shortNumber(input.max));
    return words;
}

std::optional<std::string> rangeProblem(const InputSpec& input, double value) {
    if (input.type == Type::integer && value != std::trunc(value))
        return "the value " + shortNumber(value) + " must be a whole number";
    if (!(input.positive && value <= 0) && value >= input.min && value <= input.max) return {};
    return "the value " + shortNumber(value) + " is out of range: it must be " + rangeWords(input);
}

std::optional<std::string> orderProblem(Type type, std::span<const double> numbers) {
    const bool stops = type == Type::stops;
    const std::string one = stops ? "stop" : "point",
                      entry = stops ? "[position, red, green, blue]" : "[x, y]";
    const auto size = static_cast<std::size_t>(entrySize(type));
    const std::size_t count = numbers.size() / size;
    if (count == 0) return "there is no " + one + ": give at least one, " + entry;
    if (count > kMostStops)
        return std::to_string(count) + " " + one + "s: at most " + std::to_string(kMostStops) +
               " are allowed, remove some";
    for (std::size_t i = 0; i < count; ++i) {
        const std::string which = one + " " + std::to_string(i + 1);
        const double at = numbers[size * i], before = i == 0 ? at : numbers[size * (i - 1)];
        if (at < before)
            return which + " lies at " + shortNumber(at) + ", before the one that precedes it, at " +
                   shortNumber(before) + ": sort them by their first number";
        for (std::size_t c = 1; stops && c < size; ++c)
            if (numbers[size * i + c] < 0.0)
                return "the colour of " + which + " has the component " + shortNumber(numbers[size * i + c]) +
                       ": it must be at least 0";
    }
    return {};
}

NodeRole roleOf(std::string_view id) {
    const NodeType* type = findNodeType(id);
    return type ? type->role : NodeRole::plain;
}

const std::string& idOf(NodeRole role) { return std::ranges::find(nodeTypes(), role, &NodeType::role)->id; }

std::string nearestNodeType(std::string_view id) {
    std::vector<std::string> names;
    for (const NodeType& type : nodeTypes()) {
        names.push_back(type.id);
        names.insert(names.end(), type.aliases.begin(), type.aliases.end());
    }
    const NodeType* type = findNodeType(nearestName(id, names));
    return type ? type->id : std::string();
}

}  // namespace fw
