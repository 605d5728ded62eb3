#include "graph/language/lower.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <unordered_map>

#include "graph/language/resolve.h"

namespace fw::language {

namespace {

using Kind = Instruction::Kind;

struct Failure {
    Error error;
};

/// What a variable was when a structure began, of those that it assigned.
struct Change {
    int slot;
    std::optional<Value> before;
    int logged;  ///< where it stood in the log of changes when this one came; -1: nowhere
};

/// Some places left a loop, or an iteration, under this condition, with these variables.
struct Exit {
    IrId condition;
    std::vector<std::pair<int, Value>> values;
};

/// A branch or a loop that is under way.
struct Structure {
    bool known = false;            ///< a branch whose condition is
    int depth = 0;                 ///< slots that were declared at it or deeper are its own
    std::size_t log = 0;           ///< where its changes begin
    IrId condition = 0, live = 0;  ///< live: before it
    // of a branch: of its first side
    IrId firstLive = 0, firstBegan = 0;
    std::vector<std::pair<int, std::optional<Value>>> first = {};
    // of a loop
    bool loops = false;
    std::vector<Exit> left = {}, skipped = {};  ///< by break; by continue, in this iteration
    std::size_t returns = 0;                    ///< of the frame, when it began
};

/// One running function.
struct Frame {
    const CodeFunction* function;
    std::size_t at = 0;
    IrId live = 0;  ///< boolean: the instruction counts
    std::vector<std::optional<Value>> slots = {};
    std::vector<int> logged = {};  ///< of each slot: its newest entry in the log, -1 if there is none
    std::vector<Change> log = {};
    std::vector<Structure> structures = {};
    std::optional<Value> result = {};
    std::size_t returns = 0;
    std::size_t operands = 0;  ///< on the stack below it
};

class Run {
  public:
    Run(Lowering& state_, const Code& code_, std::vector<Value> inputs_, const LowerOptions& options_)
        : state(state_), ir(state_.ir), code(code_), inputs(std::move(inputs_)), options(options_) {}

    std::vector<Value> outputs() {
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

  private:
    [[noreturn]] static void fail(Place place, const std::string& message) {
        throw Failure{codeError(place, message)};
    }
    Value checked(Result<Value> result, Place place) {
        if (result) return std::move(*result);
        Error error = result.error();
        if (error.codeLine == 0) error.codeLine = place.line, error.codeColumn = place.column;
        throw Failure{error};
    }
    /// `value` as a variable of `type` holds it: an int truncates.
    Value stored(const Value& value, Type type, Place place) {
        Value made = checked(convert(state, value, type), place);
        if (type == Type::integer && value.type != Type::integer)
            made.ids[0] = ir.add(Op::truncate, made.ids[0]);
        return made;
    }
    void step(Place place) {
        if (++state.steps > kMaxSteps)
            fail(place, "the code runs more than " + std::to_string(kMaxSteps) + " steps: shorten its loops");
        if (ir.size() > 2 * kMaxIrOperations)
            fail(place, "the field has more than " + std::to_string(kMaxIrOperations) +
                            " operations: use fewer copies or shorter loops");
    }

    // ---- functions

    void enter(int index, Place place) {
        Frame frame{&code.functions[std::size_t(index)]};
        frame.live = ir.constant(1.0);
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

    void leave() {
        const Frame frame = std::move(frames.back());
        frames.pop_back();
        if (!frame.result || !ir.isConstant(frame.live, 0.0))
            fail(frame.function->place,
                 "the function " + inQuotes(frame.function->name) + " does not return on every path");
        stack.resize(frame.operands);
        stack.push_back(stored(*frame.result, frame.function->result, frame.function->place));
    }

    std::vector<Value> results(const Frame& frame) {
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
            const std::optional<Value> last =
                code.last < 0 ? std::nullopt : frame.slots[std::size_t(code.last)];
            if (!last)
                fail(end, "the code does not return on every path: end it with a return outside the if");
            // Some paths return and others fall through to the last assignment.
            result = result ? checked(choose(state, frame.live, *last, *result), end) : last;
        }
        if (!options.outputs.empty()) result = checked(convert(state, *result, options.outputs[0].type), end);
        return {*result};
    }

    Value positionValue() const {
        Value value{Type::vec3};
        for (int i = 0; i < 3; ++i) value.ids[i] = ir.position(i);
        return value;
    }
    static Value boolean(IrId id) { return Value{Type::boolean, {id}}; }

    // ---- instructions

    Value pop() {
        Value top = std::move(stack.back());
        stack.pop_back();
        return top;
    }

    void run(Frame& frame, const Instruction& i) {
        switch (i.kind) {
            case Kind::number: stack.push_back(constantValue(state, i.type, std::array{i.number})); return;
            case Kind::text:
                stack.push_back(Value{Type::string});
                stack.back().text = code.texts[std::size_t(i.index)];
                return;
            case Kind::slot: stack.push_back(*frame.slots[std::size_t(i.index)]); return;
            case Kind::input: stack.push_back(inputs[std::size_t(i.index)]); return;
            case Kind::position: stack.push_back(positionValue()); return;
            case Kind::time: stack.push_back(Value{Type::scalar, {state.time}}); return;
            case Kind::negate: {
                const Value zero{Type::integer, {ir.constant(0.0)}};
                stack.back() = arithmetic(state, '-', zero, stack.back());
                return;
            }
            case Kind::logicalNot:
                stack.back() = boolean(ir.add(Op::logicalNot, stack.back().ids[0]));
                return;
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

    void joined(const Instruction& i) {
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

    IrId compared(char symbol, const Value& a, const Value& b) {
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

    /// An Error where a divisor of the user's code is the constant 0.
    void refuseZero(const Value& divisor, Place place) {
        if (!options.refusesZeroDivision) return;
        const int width = isVector(divisor.type) ? componentCount(divisor.type) : 1;
        for (int k = 0; k < width; ++k)
            if (ir.isConstant(divisor.ids[k], 0.0)) fail(place, std::string(kDivisionByZero));
    }

    Value part(const Value& whole, const Instruction& i) {
        Value made{i.type};
        if (i.kind == Kind::part) {
            const Value surface = *convert(state, whole, Type::surface);
            std::copy_n(surface.ids.begin() + i.index, i.count, made.ids.begin());
        } else {
            for (int k = 0; k < i.count; ++k) made.ids[k] = whole.ids[(i.index >> (2 * k)) & 3];
        }
        return made;
    }

    void element(const Instruction& i) {
        const Value index = pop(), whole = pop();
        if (!ir.isConstant(index.ids[0])) fail(i.place, "an index must be known when the graph is compiled");
        const double at = ir.number(index.ids[0]);
        const bool isPoints = whole.type == Type::points;
        const std::size_t count =
            isPoints ? whole.points->size() / 2 : std::size_t(componentCount(whole.type));
        if (!(at >= 0.0 && at < double(count))) {
            char text[32];
            std::snprintf(text, sizeof text, "%.15g", at);
            fail(i.place, "index " + std::string(text) + " is outside 0 to " +
                              std::to_string(static_cast<long long>(count) - 1));
        }
        const auto k = static_cast<std::size_t>(at);
        if (isPoints)
            stack.push_back(Value{
                Type::vec2, {ir.constant((*whole.points)[2 * k]), ir.constant((*whole.points)[2 * k + 1])}});
        else
            stack.push_back(Value{Type::scalar, {whole.ids[k]}});
    }

    // ---- calls

    void call(const Instruction& i) {
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

    /// The choices and ranges of a node's input hold for arguments as they do for what a document gives.
    void requireRange(const NodeType& type, std::size_t index, const Value& value, Place place) {
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

    void elsewhere(const Instruction& i) {
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

    // ---- structures

    void conditional(Frame& frame, const Instruction& i) {
        if (i.kind == Kind::then) {
            const IrId condition = pop().ids[0];
            choices.push_back(condition);
            if (ir.isConstant(condition, 0.0)) frame.at = std::size_t(i.target);
        } else if (i.kind == Kind::otherwise) {
            if (ir.isConstant(choices.back()) && !ir.isConstant(choices.back(), 0.0))
                frame.at = std::size_t(i.target);
        } else {
            const IrId condition = choices.back();
            choices.pop_back();
            if (ir.isConstant(condition)) return;
            const Value no = pop(), yes = pop();
            stack.push_back(checked(choose(state, condition, yes, no), i.place));
        }
    }

    /// The innermost structure whose changes are kept; nullptr if there is none.
    static Structure* innermost(Frame& frame) {
        for (auto s = frame.structures.rbegin(); s != frame.structures.rend(); ++s)
            if (!s->known) return &*s;
        return nullptr;
    }

    static void assign(Frame& frame, int slot, std::optional<Value> value) {
        const auto at = std::size_t(slot);
        Structure* inside = innermost(frame);
        if (inside && frame.function->slots[at].depth < inside->depth &&
            frame.logged[at] < static_cast<int>(inside->log)) {
            frame.log.push_back({slot, frame.slots[at], frame.logged[at]});
            frame.logged[at] = static_cast<int>(frame.log.size()) - 1;
        }
        frame.slots[at] = std::move(value);
    }

    /// Takes the structure's changes off the log, oldest first.
    static std::vector<Change> takeChanges(Frame& frame, std::size_t from) {
        std::vector<Change> changes(std::make_move_iterator(frame.log.begin() + std::ptrdiff_t(from)),
                                    std::make_move_iterator(frame.log.end()));
        frame.log.resize(from);
        for (auto change = changes.rbegin(); change != changes.rend(); ++change)
            frame.logged[std::size_t(change->slot)] = change->logged;
        return changes;
    }

    void store(Frame& frame, const Instruction& i) {
        Value value = pop();
        if (i.kind == Kind::declare) {
            if (i.count == 0) value = stored(value, i.type, i.place);
            if (i.count == 1 && value.type == Type::integer) value.type = Type::scalar;
            return assign(frame, i.index, std::move(value));
        }
        const int slot = i.kind == Kind::store ? i.index : i.target;
        const std::optional<Value>& old = frame.slots[std::size_t(slot)];
        const Type own = frame.function->slots[std::size_t(slot)].type;
        if (i.kind == Kind::store) {
            if (own == Type::surface && old && old->type == Type::surface && value.type != Type::surface) {
                Value kept = *old;
                kept.ids[0] = value.ids[0];
                value = std::move(kept);
            } else if (own != Type::surface) {
                value = stored(value, own, i.place);
            }
            return assign(frame, slot, std::move(value));
        }
        const Value made = checked(convert(state, value, i.type), i.place);
        Value whole = i.kind == Kind::storePart ? *convert(state, *old, Type::surface) : *old;
        for (int k = 0; k < i.count; ++k)
            whole.ids[i.kind == Kind::storePart ? i.index + k : (i.index >> (2 * k)) & 3] = made.ids[k];
        assign(frame, slot, std::move(whole));
    }

    /// At the end of a structure: whoever is not reached goes on behind the one around.
    void skipUnreached(Frame& frame, const Instruction& i) {
        if (ir.isConstant(frame.live, 0.0)) frame.at = std::size_t(i.target);
    }

    void branch(Frame& frame, const Instruction& i) {
        if (i.kind == Kind::branch) {
            const IrId condition = pop().ids[0];
            Structure structure{.known = ir.isConstant(condition)};
            if (structure.known) {
                frame.structures.push_back(std::move(structure));
                if (ir.isConstant(condition, 0.0)) frame.at = std::size_t(i.target);
                return;
            }
            structure.depth = depthOf(frame) + 1;
            structure.log = frame.log.size();
            structure.condition = condition;
            structure.live = frame.live;
            structure.firstBegan = frame.live = ir.add(Op::logicalAnd, frame.live, condition);
            frame.structures.push_back(std::move(structure));
            if (ir.isConstant(frame.live, 0.0)) frame.at = std::size_t(i.target) - 1;
            return;
        }
        Structure& structure = frame.structures.back();
        if (i.kind == Kind::otherSide) {
            if (structure.known) {
                frame.at = std::size_t(i.target);
                return;
            }
            for (Change& change : takeChanges(frame, structure.log)) {
                std::optional<Value>& now = frame.slots[std::size_t(change.slot)];
                structure.first.emplace_back(change.slot, std::move(now));
                now = std::move(change.before);
            }
            structure.firstLive = frame.live;
            frame.live = ir.add(Op::logicalAnd, structure.live, ir.add(Op::logicalNot, structure.condition));
            if (ir.isConstant(frame.live, 0.0)) frame.at = std::size_t(i.target);
            return;
        }
        const Structure done = std::move(frame.structures.back());
        frame.structures.pop_back();
        if (!done.known) join(frame, done, i.place);
        skipUnreached(frame, i);
    }

    /// Both sides of a branch come together.
    void join(Frame& frame, const Structure& done, Place place) {
        const bool firstEnds = ir.isConstant(done.firstLive, 0.0),
                   secondEnds = ir.isConstant(frame.live, 0.0);
        std::vector<Change> changes = takeChanges(frame, done.log);
        const auto both = [&](int slot, const std::optional<Value>& first, const std::optional<Value>& second,
                              const std::optional<Value>& before) {
            std::optional<Value> merged =
                firstEnds || !first ? second
                : secondEnds || !second
                    ? first
                    : std::optional(checked(choose(state, done.condition, *first, *second), place));
            if (firstEnds && secondEnds) merged = before;
            frame.slots[std::size_t(slot)] = before;
            assign(frame, slot, std::move(merged));
        };
        std::unordered_map<int, const std::optional<Value>*> beforeSecond;
        for (const Change& change : changes) beforeSecond.emplace(change.slot, &change.before);
        for (const auto& [slot, first] : done.first) {
            const auto changed = beforeSecond.find(slot);
            const std::optional<Value> second = frame.slots[std::size_t(slot)];
            both(slot, first, second, changed == beforeSecond.end() ? second : *changed->second);
            if (changed != beforeSecond.end()) beforeSecond.erase(changed);
        }
        for (const Change& change : changes)
            if (beforeSecond.contains(change.slot))
                both(change.slot, change.before, std::optional(frame.slots[std::size_t(change.slot)]),
                     change.before);
        const IrId secondBegan = ir.add(Op::logicalAnd, done.live, ir.add(Op::logicalNot, done.condition));
        if (firstEnds) return;
        if (secondEnds)
            frame.live = done.firstLive;
        else
            frame.live = done.firstLive == done.firstBegan && frame.live == secondBegan
                             ? done.live
                             : ir.add(Op::logicalOr, done.firstLive, frame.live);
    }

    static int depthOf(const Frame& frame) { return static_cast<int>(frame.structures.size()); }

    Structure& loopOf(Frame& frame) {
        return *std::find_if(frame.structures.rbegin(), frame.structures.rend(),
                             [](const Structure& s) { return s.loops; });
    }

    void loop(Frame& frame, const Instruction& i) {
        if (i.kind == Kind::loop) {
            frame.structures.push_back({.depth = depthOf(frame) + 1,
                                        .log = frame.log.size(),
                                        .live = frame.live,
                                        .loops = true,
                                        .returns = frame.returns});
            return;
        }
        Structure& own = frame.structures.back();
        if (i.kind == Kind::test) {
            const IrId condition = pop().ids[0];
            if (!ir.isConstant(condition))
                fail(
                    i.place,
                    "the loop's bounds must be known when the graph is compiled: numbers, or inputs that are "
                    "not linked or live");
            own.firstBegan = frame.live;
            own.condition = IrId(own.left.size() + frame.returns);
            if (ir.isConstant(condition, 0.0)) frame.at = std::size_t(i.target);
        } else if (i.kind == Kind::step) {
            const std::vector<Exit> skipped = std::move(own.skipped);
            own.skipped.clear();
            rejoin(frame, own, skipped, i.place);
            if (!skipped.empty() && own.condition == own.left.size() + frame.returns)
                frame.live = own.firstBegan;
            skipUnreached(frame, i);
        } else if (i.kind == Kind::repeat) {
            frame.at = std::size_t(i.index);
        } else {
            Structure done = std::move(own);
            frame.structures.pop_back();
            rejoin(frame, done, done.left, i.place);
            if (!done.left.empty() && frame.returns == done.returns) frame.live = done.live;
            for (Change& change : takeChanges(frame, done.log)) {
                std::optional<Value> now = std::move(frame.slots[std::size_t(change.slot)]);
                frame.slots[std::size_t(change.slot)] = std::move(change.before);
                assign(frame, change.slot, std::move(now));
            }
            skipUnreached(frame, i);
        }
    }

    /// Whoever left comes back: each variable that the loop changed is, for them, what it was when they left.
    void rejoin(Frame& frame, const Structure& own, const std::vector<Exit>& exits, Place place) {
        for (const Exit& exit : exits) {
            const bool alone = ir.isConstant(frame.live, 0.0);
            std::unordered_map<int, const Value*> values;
            for (const auto& [slot, value] : exit.values) values.emplace(slot, &value);
            for (std::size_t at = own.log; at < frame.log.size(); ++at) {
                const int slot = frame.log[at].slot;
                std::optional<Value>& now = frame.slots[std::size_t(slot)];
                const auto found = values.find(slot);
                const Value* then = found != values.end()  ? found->second
                                    : frame.log[at].before ? &*frame.log[at].before
                                                           : nullptr;
                if (!then) continue;
                step(place);
                now = alone || !now ? *then : checked(choose(state, exit.condition, *then, *now), place);
            }
            frame.live = ir.add(Op::logicalOr, frame.live, exit.condition);
        }
    }

    void depart(Frame& frame, const Instruction& i) {
        if (i.kind == Kind::result) {
            const Value value = pop();
            frame.result =
                frame.result ? checked(choose(state, frame.live, value, *frame.result), i.place) : value;
            ++frame.returns;
        } else {
            Structure& loop = loopOf(frame);
            Exit exit{frame.live, {}};
            std::unordered_map<int, bool> seen;
            for (std::size_t at = loop.log; at < frame.log.size(); ++at) {
                const int slot = frame.log[at].slot;
                if (!seen.emplace(slot, true).second || !frame.slots[std::size_t(slot)]) continue;
                step(i.place);
                exit.values.emplace_back(slot, *frame.slots[std::size_t(slot)]);
            }
            (i.kind == Kind::leave ? loop.left : loop.skipped).push_back(std::move(exit));
        }
        frame.live = ir.constant(0.0);
        frame.at = std::size_t(i.target);
    }

    Lowering& state;
    Ir& ir;
    const Code& code;
    std::vector<Value> inputs;
    const LowerOptions& options;
    std::vector<Frame> frames;
    std::vector<Value> stack;
    std::vector<IrId> choices;  ///< conditions of ?: under way
};

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
