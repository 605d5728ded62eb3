// The nodes that give a graph its structure: groups and their ends, reroutes, expressions.
#include <algorithm>

#include "graph/compile/graph_lowering.h"
#include "graph/compile/mesh_recipe.h"
#include "graph/language/lower.h"
#include "graph/language/resolve.h"

namespace fw {

using language::Value;

Type literalType(const InputValue& input) {
    if (std::holds_alternative<bool>(input.value)) return Type::boolean;
    if (std::holds_alternative<std::string>(input.value)) return Type::string;
    if (const auto* numbers = std::get_if<std::vector<double>>(&input.value))
        return input.entry > 0        ? *listOf(input.entry)
               : numbers->size() > 3  ? Type::points
               : numbers->size() == 2 ? Type::vec2
                                      : Type::vec3;
    return Type::scalar;
}

Lowered defaultsOf(GraphLowering& lowering, const Group& group) {
    Lowered inputs;
    for (const GroupInput& input : group.inputs) {
        const Type type = flowsAs(typeNamed(input.type).value_or(Type::scalar));
        inputs.outputs.push_back(
            {input.name, type, language::defaultValue(lowering.state, {input.name, type, {}}), kExact});
    }
    return inputs;
}

namespace {

/// What the group's nodes receive from this instance; none if something of it failed.
std::optional<Lowered> instanceInputs(GraphLowering& lowering, const NodeAt& at, const Group& group) {
    Lowered inputs = defaultsOf(lowering, group);
    inputs.transmits = GraphLowering::receivesTransmission(at);
    for (std::size_t i = 0; i < group.inputs.size(); ++i) {
        const GroupInput& input = group.inputs[i];
        NodeOutput& output = inputs.outputs[i];
        const InputValue* given = at.node.input(input.name);
        if (!given && input.value) given = &*input.value;
        const Link* link = given ? std::get_if<Link>(&given->value) : nullptr;
        if (!link) {
            output.value = lowering.literal(at, {input.name, output.type, {}}, given);
            continue;
        }
        bool failed = false;
        const NodeOutput* from = lowering.linked(at, *link, failed);
        if (failed) return std::nullopt;
        if (!from) continue;
        const Result<Value> converted = language::convert(lowering.state, from->value, output.type);
        if (!converted) {
            lowering.report(at, input.name, converted.error());
            return std::nullopt;
        }
        output.value = *converted;
        if (output.type != Type::surface) continue;
        output.exactness = from->type == Type::surface ? from->exactness : distorted();
        output.spoiledBy = from->spoiledBy;
    }
    return inputs;
}

}  // namespace

Lowered lowerGroup(GraphLowering& lowering, const NodeAt& at) {
    const Group* group = lowering.graph.group(at.node.group);
    if (!group) return lowering.failure({});
    std::vector<OutputSpec> outputs;
    for (const GroupOutput& output : group->outputs)
        outputs.push_back({output.name, flowsAs(typeNamed(output.type).value_or(Type::scalar))});
    if (at.node.muted) return lowering.passOn(at, &outputs);
    const std::optional<Lowered> inputs = instanceInputs(lowering, at, *group);
    const auto end = std::ranges::find_if(
        group->nodes, [](const Node& node) { return roleOf(node.type) == NodeRole::groupOutput; });
    const std::string inner = at.path() + "/";
    if (!inputs || end == group->nodes.end() || std::ranges::count(inner, '/') > kMaxNesting)
        return lowering.failure(outputs);
    const LoweredNodes& nodes = lowering.lowerAll(group->nodes, inner, &*inputs, {&*end});
    const Lowered& last = nodes.at(end->id);

    Lowered result{.failed = last.failed};
    for (const OutputSpec& output : outputs) {
        NodeOutput& own = result.outputs.emplace_back(NodeOutput{output.name, output.type});
        own.value = language::defaultValue(lowering.state, {"", output.type, {}});
        const auto found = std::ranges::find(last.outputs, output.name, &NodeOutput::name);
        if (found == last.outputs.end()) continue;
        own.exactness = found->type == Type::surface ? found->exactness : distorted();
        own.spoiledBy = found->spoiledBy;
        const Result<Value> converted = language::convert(lowering.state, found->value, output.type);
        if (converted)
            own.value = *converted;
        else
            lowering.report(at, "", converted.error());
    }
    return result;
}

Lowered lowerGroupInput(GraphLowering& lowering, const NodeAt& at) {
    return at.groupInput ? *at.groupInput : lowering.failure({});
}

/// Gathers a group's results under the names of its outputs.
Lowered lowerGroupOutput(GraphLowering& lowering, const NodeAt& at) {
    Lowered result;
    for (const auto& [name, input] : at.node.inputs) {
        const Link* link = std::get_if<Link>(&input.value);
        if (!link) {
            const Type type = literalType(input);
            result.outputs.push_back({name, type, lowering.literal(at, {name, type, {}}, &input)});
            continue;
        }
        const NodeOutput* from = lowering.linked(at, *link, result.failed);
        if (from)
            result.outputs.push_back({name, from->value.type, from->value, from->exactness, from->spoiledBy});
    }
    return result;
}

Lowered lowerReroute(GraphLowering& lowering, const NodeAt& at) { return lowering.passOn(at, nullptr); }

/// Of a comment: nothing.
Lowered lowerNothing(GraphLowering& lowering, const NodeAt&) { return lowering.failure({}); }

Lowered lowerExpression(GraphLowering& lowering, const NodeAt& at) {
    if (at.node.muted) return lowering.passOn(at, nullptr);
    language::Declared declared;
    std::vector<Value> values;
    bool fine = true;
    for (const auto& [name, input] : at.node.inputs) {
        Value value;
        bool failed = false;
        if (const Link* link = std::get_if<Link>(&input.value)) {
            const NodeOutput* from = lowering.linked(at, *link, failed);
            failed |= !from;
            if (!failed) value = from->value;
            if (value.mesh && value.mesh->read) {
                lowering.report(at, name,
                                {.message = "takes a field, and a mesh from a file has none: put "
                                            "mesh_to_field behind the mesh_file"});
                failed = true;
            }
            value.mesh = nullptr;  // what is made of the field is another mesh
        } else {
            value = lowering.literal(at, {name, literalType(input), {}}, &input);
        }
        fine &= !failed;
        declared.inputs.emplace_back(name, failed ? std::nullopt : std::optional(value.type));
        values.push_back(std::move(value));
    }
    std::vector<int> types;
    for (const auto& [name, type] : declared.inputs) types.push_back(type ? int(*type) : -1);
    const auto [found, fresh] = lowering.resolved.try_emplace({&at.node, std::move(types)});
    if (fresh) found->second = language::resolve(at.node.code, declared);
    const language::Resolved& resolved = found->second;
    for (const Error& error : resolved.errors) lowering.report(at, "", error);
    if (!fine || !resolved.code) return lowering.failure({});
    Result<std::vector<Value>> made =
        language::lower(lowering.state, *resolved.code, std::move(values), {.refusesZeroDivision = true});
    const Result<Value> whole =
        made ? language::convert(lowering.state, made->front(), resolved.type) : Result<Value>(made.error());
    if (!whole) {
        lowering.report(at, "", whole.error());
        return lowering.failure({});
    }
    NodeOutput output{"value", resolved.type, *whole, distorted(), at.path()};
    if (output.type == Type::integer) output.type = output.value.type = Type::scalar;
    return {.outputs = {std::move(output)}};
}

}  // namespace fw
