#include "graph/language/lower.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <stdexcept>
#include <unordered_map>

#include "graph/base/words.h"
#include "graph/language/resolve.h"
#include "graph/language/run.h"

namespace fw::language {

using Kind = Instruction::Kind;

/// Bytes of a text that are moved in a step.
constexpr std::size_t kTextStep = 64;

std::vector<Value> Run::outputs() {
    enter(0, {1, 1});
    while (true) {
        Frame& frame = frames.back();
        if (frame.at < frame.function->instructions.size()) {
            const Instruction& instruction = frame.function->instructions[frame.at++];
            step(instruction.place);
            run(frame, instruction);
        } else if (frames.size() > 1) {
            leave();
        } else {
            return results(frame);
        }
    }
}

void Run::fail(Place place, const std::string& message, Error::Code code) {
    Error error = codeError(place, message);
    error.code = code;
    throw Failure{error};
}

Value Run::checked(Result<Value> result, Place place) {
    if (result) return std::move(*result);
    Error error = result.error();
    if (error.codeLine == 0) error.codeLine = place.line, error.codeColumn = place.column;
    throw Failure{error};
}

Value Run::stored(const Value& value, Type type, Place place) {
    Value made = checked(convert(state, value, type), place);
    if (type == Type::integer && value.type != Type::integer) made.ids[0] = ir.add(Op::truncate, made.ids[0]);
    return made;
}

void Run::step(Place place) {
    if (++state.steps > kMaxSteps)
        fail(place, "the code runs more than " + std::to_string(kMaxSteps) + " steps: shorten its loops");
    if (ir.size() > 2 * kMaxIrOperations)
        fail(place, "the field has more than " + std::to_string(kMaxIrOperations) +
                        " operations: use fewer copies or shorter loops");
}

// ---- functions

void Run::enter(int index, Place place) {
    Frame frame{&code.functions[std::size_t(index)]};
    frame.live = ir.constant(1.0);
    state.steps += frame.function->slots.size();
    frame.slots.resize(frame.function->slots.size());
    frame.logged.assign(frame.slots.size(), -1);
    const std::size_t count = frame.function->parameters.size();
    for (std::size_t i = 0; i < count; ++i)
        frame.slots[i] = stored(stack[stack.size() - count + i], frame.function->parameters[i], place);
    stack.resize(stack.size() - count);
    frame.operands = stack.size();
    for (const auto& [slot, input] : frame.function->captured)
        frame.slots[std::size_t(slot)] = input < 0 ? positionValue() : inputs[std::size_t(input)];
    frames.push_back(std::move(frame));
}

void Run::leave() {
    const Frame frame = std::move(frames.back());
    frames.pop_back();
    if (!frame.result || !ir.isConstant(frame.live, 0.0))
        fail(frame.function->place,
             "the function " + inQuotes(frame.function->name) + " does not return on every path");
    stack.resize(frame.operands);
    stack.push_back(stored(*frame.result, frame.function->result, frame.function->place));
}

std::vector<Value> Run::results(const Frame& frame) {
    const Place end{1, 1};
    if (!code.outputs.empty()) {
        std::vector<Value> values;
        for (std::size_t i = 0; i < code.outputs.size(); ++i) {
            const std::optional<Value>& value = frame.slots[std::size_t(code.outputs[i])];
            if (!value) fail(end, "the code assigns no " + inQuotes(options.outputs[i].name));
            values.push_back(checked(convert(state, *value, options.outputs[i].type), end));
        }
        return values;
    }
    std::optional<Value> result = frame.result;
    if (!ir.isConstant(frame.live, 0.0)) {
        const std::optional<Value> last = code.last < 0 ? std::nullopt : frame.slots[std::size_t(code.last)];
        if (!last) fail(end, "the code does not return on every path: end it with a return outside the if");
        // Some paths return and others fall through to the last assignment.
        result = result ? checked(choose(state, frame.live, *last, *result), end) : last;
    }
    if (!options.outputs.empty()) result = checked(convert(state, *result, options.outputs[0].type), end);
    return {*result};
}

Value Run::positionValue() const {
    Value value{Type::vec3};
    for (int i = 0; i < 3; ++i) value.ids[i] = ir.position(i);
    return value;
}

// ---- instructions

void Run::push(const Value& value) {
    state.steps += value.text.size() / kTextStep;
    stack.push_back(value);
}

Value Run::pop() {
    Value top = std::move(stack.back());
    stack.pop_back();
    return top;
}

void Run::run(Frame& frame, const Instruction& i) {
    switch (i.kind) {
        case Kind::number: stack.push_back(constantValue(state, i.type, std::array{i.number})); return;
        case Kind::text: {
            Value value{Type::string};
            value.text = code.texts[std::size_t(i.index)];
            return push(value);
        }
        case Kind::slot: return push(*frame.slots[std::size_t(i.index)]);
        case Kind::input: return push(inputs[std::size_t(i.index)]);
        case Kind::position: stack.push_back(positionValue()); return;
        case Kind::time: stack.push_back(Value{Type::scalar, {state.time}}); return;
        case Kind::negate: {
            const Value zero{Type::integer, {ir.constant(0.0)}};
            stack.back() = arithmetic(state, '-', zero, stack.back());
            return;
        }
        case Kind::logicalNot: stack.back() = boolean(ir.add(Op::logicalNot, stack.back().ids[0])); return;
        case Kind::arithmetic:
        case Kind::compare:
        case Kind::logical: return joined(i);
        case Kind::part:
        case Kind::swizzle: stack.back() = part(stack.back(), i); return;
        case Kind::element: return element(i);
        case Kind::builtin:
        case Kind::node: return call(i);
        case Kind::function: return enter(i.index, i.place);
        case Kind::elsewhere: return elsewhere(i);
        case Kind::then:
        case Kind::otherwise:
        case Kind::chosen: return conditional(frame, i);
        case Kind::declare:
        case Kind::store:
        case Kind::storePart:
        case Kind::storeSwizzle: return store(frame, i);
        case Kind::branch:
        case Kind::otherSide:
        case Kind::joined: return branch(frame, i);
        case Kind::loop:
        case Kind::test:
        case Kind::step:
        case Kind::repeat:
        case Kind::looped: return loop(frame, i);
        case Kind::result:
        case Kind::leave:
        case Kind::next: return depart(frame, i);
    }
}

void Run::joined(const Instruction& i) {
    const Value b = pop(), a = pop();
    if (i.kind == Kind::arithmetic) {
        if (i.symbol == '/' || i.symbol == '%') refuseZero(b, i.place);
        stack.push_back(arithmetic(state, i.symbol, a, b));
    } else if (i.kind == Kind::logical) {
        stack.push_back(
            boolean(ir.add(i.symbol == '&' ? Op::logicalAnd : Op::logicalOr, a.ids[0], b.ids[0])));
    } else {
        stack.push_back(boolean(compared(i.symbol, a, b)));
    }
}

IrId Run::compared(char symbol, const Value& a, const Value& b) {
    if (symbol == '=' || symbol == '!') {
        IrId same = ir.constant(1.0);
        if (a.type == Type::string) {
            same = ir.constant(a.text == b.text ? 1.0 : 0.0);
        } else {
            const int width = isVector(a.type) ? componentCount(a.type) : 1;
            for (int k = 0; k < width; ++k)
                same = ir.add(Op::logicalAnd, same, ir.add(Op::equal, a.ids[k], b.ids[k]));
        }
        return symbol == '=' ? same : ir.add(Op::logicalNot, same);
    }
    const IrId x = a.ids[0], y = b.ids[0];
    switch (symbol) {
        case '<': return ir.add(Op::less, x, y);
        case '>': return ir.add(Op::less, y, x);
        case 'l': return ir.add(Op::lessEqual, x, y);
        default: return ir.add(Op::lessEqual, y, x);
    }
}

void Run::refuseZero(const Value& divisor, Place place) {
    if (!options.refusesZeroDivision) return;
    const int width = isVector(divisor.type) ? componentCount(divisor.type) : 1;
    for (int k = 0; k < width; ++k)
        if (ir.isConstant(divisor.ids[k], 0.0)) fail(place, "division by zero", Error::Code::divisionByZero);
}

Value Run::part(const Value& whole, const Instruction& i) {
    Value made{i.type};
    if (i.kind == Kind::part) {
        const Value surface = *convert(state, whole, Type::surface);
        std::copy_n(surface.ids.begin() + i.index, i.count, made.ids.begin());
    } else {
        for (int k = 0; k < i.count; ++k) made.ids[k] = whole.ids[(i.index >> (2 * k)) & 3];
    }
    return made;
}

void Run::element(const Instruction& i) {
    const Value index = pop(), whole = pop();
    if (!ir.isConstant(index.ids[0])) fail(i.place, "an index must be known when the graph is compiled");
    const double at = ir.number(index.ids[0]);
    const bool isPoints = whole.type == Type::points;
    const std::size_t count = isPoints ? whole.points->size() / 2 : std::size_t(componentCount(whole.type));
    if (at != std::trunc(at)) fail(i.place, "an index is a whole number, not " + shortNumber(at));
    if (!(at >= 0.0 && at < double(count)))
        fail(i.place, "index " + shortNumber(at) + " is outside 0 to " +
                          std::to_string(static_cast<long long>(count) - 1));
    const auto k = static_cast<std::size_t>(at);
    if (isPoints)
        stack.push_back(Value{
            Type::vec2, {ir.constant((*whole.points)[2 * k]), ir.constant((*whole.points)[2 * k + 1])}});
    else
        stack.push_back(Value{Type::scalar, {whole.ids[k]}});
}

// ---- calls

void Run::call(const Instruction& i) {
    const auto first = stack.end() - i.count;
    if (i.kind == Kind::builtin) {
        const Builtin& builtin = *code.builtins[std::size_t(i.index)];
        if (builtin.name == "mod" || builtin.name == "fmod") refuseZero(stack.back(), i.place);
        Value result = checked(builtin.lower(state, std::span(first, stack.end())), i.place);
        stack.erase(first, stack.end());
        stack.push_back(std::move(result));
        return;
    }
    const NodeType& type = *code.nodes[std::size_t(i.index)];
    std::vector<Value> given;
    for (std::size_t k = 0; k < type.inputs.size(); ++k) {
        const InputSpec& input = type.inputs[k];
        if (k >= i.count) {
            given.push_back(defaultValue(state, input));
            continue;
        }
        given.push_back(checked(convert(state, *(first + std::ptrdiff_t(k)), input.type), i.place));
        requireRange(type, k, given.back(), i.place);
    }
    stack.erase(first, stack.end());
    Result<std::vector<Value>> values = lowerNode(state, type, std::move(given));
    if (!values) {
        Error error = values.error();  // the place inside the library's body means nothing to the user
        error.codeLine = error.codeColumn = 0;
        checked(error, i.place);
    }
    stack.push_back(std::move(values->front()));
}

void Run::requireRange(const NodeType& type, std::size_t index, const Value& value, Place place) {
    const InputSpec& input = type.inputs[index];
    const std::string which =
        "argument " + std::to_string(index + 1) + " of '" + type.id + "' is its " + input.name + ": ";
    if (!input.options.empty() && std::ranges::find(input.options, value.text) == input.options.end())
        fail(place, which + inQuotes(value.text) + " is not one of its choices");
    if (value.type != Type::scalar && value.type != Type::integer && !isVector(value.type)) return;
    for (int k = 0; k < componentCount(value.type); ++k)
        if (ir.isConstant(value.ids[k]))
            if (const auto problem = rangeProblem(input, ir.number(value.ids[k])))
                fail(place, which + *problem);
}

void Run::elsewhere(const Instruction& i) {
    // The position was pushed before the field that it is for.
    const Value field = pop();
    const Value q = *convert(state, pop(), Type::vec3);
    Value result = field;
    for (int k = 0; k < componentCount(field.type); ++k) {
        step(i.place);
        result.ids[k] = ir.substitute(field.ids[k], {q.ids[0], q.ids[1], q.ids[2]});
        if (ir.substituted() > kMaxSubstituted)
            fail(i.place, "the graph moves its fields " + std::to_string(kMaxSubstituted) +
                              " operations' worth: use fewer or less nested copies, repeats and moves");
    }
    stack.push_back(std::move(result));
}

namespace {

/// The checked body of a library node; a body that is wrong is a bug.
std::shared_ptr<const Code> bodyOf(const NodeType& type) {
    static std::mutex mutex;
    static std::unordered_map<const NodeType*, std::shared_ptr<const Code>> bodies;
    const std::lock_guard lock(mutex);
    std::shared_ptr<const Code>& body = bodies[&type];
    if (!body) {
        Declared declared{.outputs = type.outputs};
        for (const InputSpec& input : type.inputs) declared.inputs.emplace_back(input.name, input.type);
        const Resolved resolved = resolve(type.body, declared);
        if (!resolved.code)
            throw std::logic_error("node type '" + type.id + "': " + format(resolved.errors.front()));
        body = resolved.code;
    }
    return body;
}

}  // namespace

Result<std::vector<Value>> lower(Lowering& state, const Code& code, std::vector<Value> inputs,
                                 const LowerOptions& options) {
    try {
        return Run(state, code, std::move(inputs), options).outputs();
    } catch (const Failure& failure) { return failure.error; }
}

Result<std::vector<Value>> lowerNode(Lowering& state, const NodeType& type, std::vector<Value> inputs) {
    return lower(state, *bodyOf(type), std::move(inputs), {.outputs = type.outputs});
}

Result<Value> lowerText(Lowering& state, std::string_view text,
                        const std::vector<std::pair<std::string, Value>>& inputs) {
    Declared declared;
    std::vector<Value> values;
    for (const auto& [name, value] : inputs) {
        declared.inputs.emplace_back(name, value.type);
        values.push_back(value);
    }
    const Resolved resolved = resolve(text, declared);
    if (!resolved.code) return resolved.errors.front();
    Result<std::vector<Value>> lowered =
        lower(state, *resolved.code, std::move(values), {.refusesZeroDivision = true});
    if (!lowered) return lowered.error();
    return convert(state, lowered->front(), resolved.type);
}

}  // namespace fw::language
