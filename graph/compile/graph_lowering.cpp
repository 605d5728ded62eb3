#include "graph/compile/graph_lowering.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "graph/base/words.h"
#include "graph/compile/solid_query.h"
#include "graph/document/input_value.h"
#include "graph/document/named_parameters.h"
#include "graph/document/unit.h"
#include "graph/language/lower.h"

namespace fw {

using language::Value;

Type flowsAs(Type type) { return type == Type::mesh ? Type::surface : type; }

const Value& inputOf(const std::vector<NodeInput>& inputs, std::string_view name) {
    return std::ranges::find_if(inputs, [&](const NodeInput& input) { return input.spec->name == name; })
        ->value;
}

GraphLowering::GraphLowering(const Graph& graph_, const CompileOptions& options_)
    : graph(graph_), options(options_) {
    state.graphPath = graph.path;
    state.metre = 1 / unitOf(graph).metres;
    if (options.costByNode) state.ir.keepOriginsApart();
    if (options.live.contains("time")) {
        state.time = state.ir.parameter(0);
        live.push_back({"time", 0, options.time});
    } else {
        state.time = state.ir.constant(options.time);
    }
}

const LoweredNodes& GraphLowering::lowerAll(const std::vector<Node>& nodes, const std::string& prefix,
                                            const Lowered* groupInput,
                                            const std::vector<const Node*>& targets) {
    std::unordered_map<std::string_view, const Node*> byId;
    for (const Node& node : nodes) byId[node.id] = &node;
    LoweredNodes& done = lowered[prefix];
    done.clear();
    std::vector<const Node*> pending(targets);
    while (!pending.empty()) {
        const Node* node = pending.back();
        bool ready = true;
        if (!done.contains(node->id))
            for (const auto& [name, input] : node->inputs)
                if (const Link* link = std::get_if<Link>(&input.value))
                    if (const auto source = byId.find(link->node);
                        source != byId.end() && !done.contains(link->node))
                        pending.push_back(source->second), ready = false;
        if (!ready) continue;
        pending.pop_back();
        if (done.contains(node->id)) continue;
        const NodeType* type = findNodeType(node->type);
        Lowered made = type ? lower({*node, *type, prefix, done, groupInput}) : failure({});
        const auto surface = std::ranges::find(made.outputs, Type::surface, &NodeOutput::type);
        if (surface != made.outputs.end() && !state.opaquePart)
            exactness[prefix + node->id] = {surface->exactness, surface->spoiledBy};
        done.emplace(node->id, std::move(made));
    }
    return done;
}

Lowered GraphLowering::lowerOpaque(const Node& target) {
    whole = std::move(lowered);
    lowered.clear();
    state.opaquePart = true;
    const std::vector<Error> known = findings;  // they would be found again
    Lowered made = lowerAll(graph.nodes, "", nullptr, {&target}).at(target.id);
    if (!made.failed) findings = known;
    state.opaquePart = false;
    return made;
}

const LoweredNodes* GraphLowering::nodesIn(const std::string& prefix) const {
    const auto found = lowered.find(prefix);
    return found == lowered.end() ? nullptr : &found->second;
}

Lowered GraphLowering::lower(const NodeAt& at) {
    if (state.ir.size() > 2 * kMaxIrOperations) return failure({});
    if (state.opaquePart) {
        const auto beside = whole.find(at.prefix);
        if (beside != whole.end())
            if (const auto same = beside->second.find(at.node.id);
                same != beside->second.end() && !same->second.transmits)
                return same->second;
    }
    const std::size_t transmissions = state.transmissions;
    const auto [origin, first] = originOf.try_emplace(at.path(), uint32_t(origins.size()));
    if (first) origins.push_back(at.path());
    const uint32_t outer = state.ir.setOrigin(origin->second);
    const auto [painter, unknown] = painterOf.try_emplace(&at.node, uint32_t(painters.size()));
    if (unknown) painters.push_back(at.node.label.empty() ? at.node.id : at.node.label);
    const uint32_t outerPainter = std::exchange(state.painter, painter->second);
    Lowered made = at.node.muted && !at.type.open && !at.type.outputs.empty() ? passOn(at, &at.type.outputs)
                   : at.type.lower                                            ? at.type.lower(*this, at)
                                                                              : lowerBody(at);
    if (state.opaquePart && state.transmissions != transmissions)
        for (NodeOutput& output : made.outputs) language::leaveOpaquePart(state, output.value);
    state.ir.setOrigin(outer);
    state.painter = outerPainter;
    // Particles are what they are, whatever they were put into.
    const bool simulated = std::ranges::any_of(
        made.outputs, [](const NodeOutput& output) { return output.type == Type::particles; });
    made.transmits =
        !simulated && (made.transmits || state.transmissions != transmissions || receivesTransmission(at));
    return made;
}

bool GraphLowering::receivesTransmission(const NodeAt& at) {
    return std::ranges::any_of(at.node.inputs, [&](const auto& input) {
        const Link* link = std::get_if<Link>(&input.second.value);
        const auto source = link ? at.done.find(link->node) : at.done.end();
        return source != at.done.end() && source->second.transmits;
    });
}

Lowered GraphLowering::lowerBody(const NodeAt& at) {
    const std::optional<std::vector<NodeInput>> given = inputs(at);
    return given ? lowerBody(at, *given) : failure(at.type.outputs);
}

Lowered GraphLowering::lowerBody(const NodeAt& at, const std::vector<NodeInput>& given) {
    std::vector<Value> values;
    for (const NodeInput& input : given) values.push_back(input.value);
    Result<std::vector<Value>> made = language::lowerNode(state, at.type, std::move(values));
    for (std::string& remark : std::exchange(state.remarks, {})) warn(at, "", std::move(remark));
    if (!made) {
        Error error = made.error();
        error.codeLine = error.codeColumn = 0;
        report(at, "", error);
        return failure(at.type.outputs);
    }
    Lowered result;
    for (std::size_t i = 0; i < at.type.outputs.size(); ++i) {
        NodeOutput& output = result.outputs.emplace_back(
            NodeOutput{at.type.outputs[i].name, at.type.outputs[i].type, std::move((*made)[i])});
        if (output.type == Type::surface) classify(at, given, output);
    }
    return result;
}

const IrNode* movingIn(const Ir& ir, IrId root) {
    std::vector<bool> needed(root + 1);
    needed[root] = true;
    for (IrId id = root + 1; id-- > 0;) {
        if (!needed[id]) continue;
        const IrNode& node = ir[id];
        if (node.op == Op::parameter || (node.op == Op::volume && !ir.layer(node).volume->volume->made()))
            return &node;
        for (int i = 0; i < opInfo(node.op).arity; ++i) needed[node.operands[std::size_t(i)]] = true;
    }
    return nullptr;
}

// ---- findings

void GraphLowering::report(const NodeAt& at, std::string_view input, Error error) {
    error.file = graph.path;
    error.node = at.path();
    error.input = input;
    const InputValue* value = input.empty() ? nullptr : at.node.input(input);
    const TextPosition place = error.codeLine > 0 ? at.node.codePlace : value ? value->at : at.node.place;
    error.line = place.line, error.column = place.column;
    findings.push_back(std::move(error));
}

void GraphLowering::warn(const NodeAt& at, std::string_view input, std::string message) {
    report(at, input, {.message = std::move(message), .severity = Error::Severity::warning});
}

Lowered GraphLowering::failure(const std::vector<OutputSpec>& outputs) {
    Lowered result{.failed = true};
    for (const OutputSpec& output : outputs)
        result.outputs.push_back({output.name, flowsAs(output.type),
                                  language::defaultValue(state, {"", flowsAs(output.type), {}})});
    if (outputs.empty())
        result.outputs.push_back({"value", Type::scalar, language::constantValue(state, Type::scalar, {})});
    return result;
}

// ---- inputs

const NodeOutput* GraphLowering::linked(const NodeAt& at, const Link& link, bool& failed) const {
    const auto found = at.done.find(link.node);
    if (found == at.done.end()) return nullptr;
    failed |= found->second.failed;
    for (const NodeOutput& output : found->second.outputs)
        if (link.output.empty() || output.name == link.output) return &output;
    return nullptr;
}

/// The slot of a live input's component, made at its first use.
IrId GraphLowering::liveComponent(const std::string& name, int component, double value) {
    for (std::size_t slot = 0; slot < live.size(); ++slot)
        if (live[slot].name == name && live[slot].component == component)
            return state.ir.parameter(static_cast<uint32_t>(slot));
    live.push_back({name, component, value});
    return state.ir.parameter(static_cast<uint32_t>(live.size() - 1));
}

/// The name under which this input is live; empty if it is folded.
std::string GraphLowering::liveName(const NodeAt& at, const std::string& input) const {
    if (options.live.contains(at.path() + "." + input)) return at.path() + "." + input;
    if (!options.liveExposed) return {};
    if (at.prefix.empty())
        for (const ExposedParameter& parameter : graph.parameters)
            if (parameter.node == at.node.id && parameter.input == input) return parameter.name;
    return input == "value" ? std::string(parameterName(at.node)) : std::string();
}

Value GraphLowering::literal(const NodeAt& at, const InputSpec& spec, const InputValue* given, bool folded) {
    Value value = language::defaultValue(state, spec);
    std::vector<double> numbers;
    if (spec.value.kind == InputDefault::Kind::numbers) numbers = spec.value.numbers;
    if (given) {
        if (const auto* number = std::get_if<double>(&given->value)) numbers = {*number};
        if (const auto* flag = std::get_if<bool>(&given->value)) numbers = {*flag ? 1.0 : 0.0};
        if (const auto* list = std::get_if<std::vector<double>>(&given->value)) numbers = *list;
    }
    const bool ordered = spec.type == Type::stops || spec.ordered;
    const bool mayBeLive =
        (spec.type == Type::scalar || spec.type == Type::vec2 || spec.type == Type::vec3 || ordered) &&
        !numbers.empty() && !folded;
    if (mayBeLive && canBeLive) canBeLive->push_back(at.path() + "." + spec.name);
    const std::string name = mayBeLive ? liveName(at, spec.name) : std::string();
    if (!name.empty() && ordered) {
        value.points = std::make_shared<const std::vector<double>>(numbers);
        for (std::size_t i = 0; i < numbers.size(); ++i)
            value.livePoints.push_back(liveComponent(name, int(i), numbers[i]));
        return value;
    }
    if (!name.empty()) {
        // Its numbers are no constants of the program: the code is the same whatever they are.
        language::Lowering apart;
        const Value now = language::constantValue(apart, spec.type, numbers);
        for (int i = 0; i < componentCount(spec.type); ++i)
            value.ids[i] = liveComponent(name, i, apart.ir.number(now.ids[i]));
        return value;
    }
    if (!given) return value;
    if (const auto* words = std::get_if<std::string>(&given->value)) {
        value.text = *words;
        if (spec.type == Type::image) {
            Value path{Type::string};
            path.text = *words;
            if (const Result<Value> image = language::convert(state, path, Type::image))
                value = *image;
            else
                report(at, spec.name, image.error());
        }
    }
    if (entrySize(spec.type) > 0)
        value.points = std::make_shared<const std::vector<double>>(numbers);
    else if (componentCount(spec.type) > 0 && !numbers.empty())
        value = spec.type == Type::surface
                    ? *language::convert(state, language::constantValue(state, Type::scalar, numbers),
                                         Type::surface)
                    : language::constantValue(state, spec.type, numbers);
    return value;
}

std::optional<Value> GraphLowering::linkedValue(const NodeAt& at, const InputSpec& spec,
                                                const NodeOutput& from) {
    const Result<Value> converted = language::convert(state, from.value, flowsAs(spec.type));
    if (!converted) {
        report(at, spec.name, converted.error());
        return std::nullopt;
    }
    bool fine = true;
    Value value = *converted;
    if (spec.type == Type::scalar || spec.type == Type::vec2 || spec.type == Type::vec3)
        keepInRange(at, spec, value, fine);
    return fine ? std::optional(std::move(value)) : std::nullopt;
}

/// The range of an input holds for what comes by a wire as it does for what is written: a constant beyond it
/// is an error. Where an input must be above 0, for else its node has no meaning, what may not be so
/// somewhere is brought back there, with a warning.
void GraphLowering::keepInRange(const NodeAt& at, const InputSpec& spec, Value& value, bool& fine) {
    constexpr double kFar = 16384.0;  // metres: as far as a region is looked for
    const Box everywhere{{-kFar, -kFar, -kFar}, {kFar, kFar, kFar}};
    std::vector<double> values;
    for (const LiveParameter& parameter : live) values.push_back(parameter.value);
    bool brought = false;
    for (int i = 0; i < componentCount(value.type) && fine; ++i) {
        IrId& id = value.ids[i];
        if (state.ir.isConstant(id)) {
            const auto problem = rangeProblem(spec, state.ir.number(id));
            if (problem) report(at, spec.name, {.message = *problem});
            fine = !problem;
        } else if (spec.positive && state.ir[id].positions != 0 &&
                   evaluateInterval(state.ir, id, values, everywhere).lo <= 0.0) {
            id = state.ir.add(Op::maximum, id, state.ir.constant(kLeastPositive));
            brought = true;
        }
    }
    if (brought)
        warn(at, spec.name,
             "what is linked here varies over space and may be 0 or less, which has no meaning: at least " +
                 shortNumber(kLeastPositive) + " is taken");
}

namespace {
constexpr std::string_view kKnownOnly =
    "takes one number, known when the graph is compiled: it cannot depend on the place, nor be live";
}

std::optional<std::vector<NodeInput>> GraphLowering::inputs(const NodeAt& at) {
    std::vector<NodeInput> all;
    bool fine = true;
    for (const InputSpec& spec : at.type.inputs) {
        const InputValue* given = at.node.input(spec.name);
        const Link* link = given ? std::get_if<Link>(&given->value) : nullptr;
        bool failed = false;
        const bool asWhole = spec.whole && state.opaquePart && whole.contains(at.prefix);
        const NodeAt source{at.node, at.type, at.prefix, asWhole ? whole.at(at.prefix) : at.done,
                            at.groupInput};
        const NodeOutput* from = link ? linked(source, *link, failed) : nullptr;
        const bool shape = flowsAs(spec.type) == Type::surface;
        NodeInput& input = all.emplace_back(NodeInput{&spec, {}, from});
        input.value = shape ? language::emptySurface(state) : language::defaultValue(state, spec);
        if (from) {
            fine &= !failed;
            std::optional<Value> value = linkedValue(at, spec, *from);
            fine &= value.has_value();
            if (value) input.value = std::move(*value);
            if (spec.known && !state.ir.isConstant(input.value.id())) {
                report(at, spec.name, {.message = std::string(kKnownOnly)});
                fine = false;
            }
            if (shape) input.exactness = from->type == Type::surface ? from->exactness : distorted();
        } else if (spec.type != Type::mesh) {
            // What a simulation reads is read anew at each step.
            const bool stepped =
                at.type.category == Category::particles && spec.value.kind == InputDefault::Kind::numbers;
            input.value = literal(at, spec, given, spec.known || (at.type.body.empty() && !stepped));
        }
    }
    return fine ? std::optional(std::move(all)) : std::nullopt;
}

std::optional<double> GraphLowering::knownNumber(const NodeAt& at, const std::vector<NodeInput>& inputs,
                                                 std::string_view name, int component) {
    const IrId id = inputOf(inputs, name).ids[static_cast<std::size_t>(component)];
    if (!state.ir.isConstant(id)) {
        report(at, name, {.message = std::string(kKnownOnly)});
        return std::nullopt;
    }
    // One that is written was checked where it stands; here one may come from a wire.
    const InputSpec& spec = at.type.inputs[static_cast<std::size_t>(inputIndex(at.type, name))];
    const double number = state.ir.number(id);
    if (spec.type != Type::integer && spec.type != Type::scalar) return number;
    const auto problem = valueProblem(spec.type, &spec, {number});
    if (!problem) return number;
    report(at, name, {.message = *problem});
    return std::nullopt;
}

void GraphLowering::classify(const NodeAt& at, const std::vector<NodeInput>& inputs, NodeOutput& surface) {
    if (!at.type.exactness) return;
    bool plain = true;  // the position is the context's and no number varies over space
    bool inputsExact = true;
    for (const NodeInput& input : inputs) {
        if (flowsAs(input.spec->type) == Type::surface) {
            inputsExact &= input.exactness.exact();
            if (input.from && surface.spoiledBy.empty()) surface.spoiledBy = input.from->spoiledBy;
            continue;
        }
        const bool isPosition = input.spec->value.kind == InputDefault::Kind::position;
        for (int i = 0; i < componentCount(input.spec->type); ++i)
            plain &= isPosition ? input.value.ids[i] == state.ir.position(i)
                                : state.ir[input.value.ids[i]].positions == 0;
    }
    const auto named = [&](std::string_view name) -> const NodeInput* {
        const int index = inputIndex(at.type, name);
        return index < 0 ? nullptr : &inputs[static_cast<std::size_t>(index)];
    };
    ExactnessArguments arguments;
    arguments.surface = [&](std::string_view name) {
        const NodeInput* input = named(name);
        return input ? input->exactness : kExact;
    };
    arguments.constant = [&](std::string_view name, int component) -> std::optional<double> {
        const NodeInput* input = named(name);
        if (!input || component >= componentCount(input->value.type)) return std::nullopt;
        const IrId id = input->value.ids[component];
        return state.ir.isConstant(id) ? std::optional(state.ir.number(id)) : std::nullopt;
    };
    arguments.varies = [&](std::string_view name, int axis) {
        const NodeInput* input = named(name);
        return input && (state.ir[input->value.ids[distanceComponent]].positions >> axis & 1) != 0;
    };
    arguments.option = [&](std::string_view name) {
        const NodeInput* input = named(name);
        return input ? input->value.text : std::string();
    };
    arguments.within = [&](std::string_view name, const Point& normal, double offset) {
        const NodeInput* input = named(name);
        return input && isWithin(state.ir, input->value.ids[distanceComponent], normal, offset);
    };
    arguments.bounds = [&](std::string_view name, double level) {
        const NodeInput* input = named(name);
        return input ? levelBounds(state.ir, input->value.ids[distanceComponent], level) : std::nullopt;
    };
    arguments.mirrored = [&](std::string_view name, int axis) {
        const NodeInput* input = named(name);
        return input && isMirrored(state.ir, input->value.ids[distanceComponent], axis);
    };
    surface.exactness = plain ? at.type.exactness(arguments) : distorted();
    if (surface.exactness.exact())
        surface.spoiledBy.clear();
    else if (inputsExact || surface.spoiledBy.empty())
        surface.spoiledBy = at.path();
}

Lowered GraphLowering::passOn(const NodeAt& at, const std::vector<OutputSpec>* outputs) {
    const NodeOutput* from = nullptr;
    bool failed = false;
    for (const auto& [name, input] : at.node.inputs) {
        const Link* link = std::get_if<Link>(&input.value);
        bool candidateFailed = false;
        const NodeOutput* candidate = link ? linked(at, *link, candidateFailed) : nullptr;
        if (!candidate ||
            (outputs && !language::convert(state, candidate->value, flowsAs((*outputs)[0].type))))
            continue;
        from = candidate, failed = candidateFailed;
        break;
    }
    if (!from) return failure(outputs ? *outputs : std::vector<OutputSpec>{});
    Lowered result{.failed = failed};
    const std::vector<OutputSpec> own{{"value", from->value.type}};
    for (const OutputSpec& output : outputs ? *outputs : own) {
        const Type type = flowsAs(output.type);
        const Result<Value> value = language::convert(state, from->value, type);
        result.outputs.push_back({output.name, type,
                                  value ? *value : language::defaultValue(state, {"", type, {}}),
                                  from->exactness, from->spoiledBy});
    }
    return result;
}

}  // namespace fw
