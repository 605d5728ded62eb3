#include "graph/language/lower.h"
#include "graph/base/words.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <numbers>
#include <optional>
#include <set>
#include <unordered_map>

#include "graph/language/builtins.h"

namespace fw::language {

namespace {

struct Failure {
    Error error;
};

struct Variable {
    std::string name;
    Value value;
    bool constant = false;  ///< declared const: may not be assigned to
};

/// Conditions under which a loop's body was left early.
struct Loop {
    IrId left, skipped;
};

/// One running function or body.
struct Frame {
    std::vector<Variable> variables;  ///< later ones hide earlier ones
    IrId live = 0;                    ///< boolean: the statement counts
    std::optional<Value> result;
    std::string lastTarget;  ///< of the last assignment
    std::optional<Value> lastValue;
    Loop* loop = nullptr;
};

int swizzleIndex(char c) {
    switch (c) {
        case 'x':
        case 'r':
        case 'u': return 0;
        case 'y':
        case 'g':
        case 'v': return 1;
        case 'z':
        case 'b': return 2;
        default: return -1;
    }
}

class Run {
  public:
    Run(Lowering& state_, const Tree& tree_, const Scope& scope_)
        : state(state_), ir(state_.ir), tree(tree_), scope(scope_) {
        for (const Stmt& s : tree.statements)
            if (s.kind == Stmt::Kind::assign && !s.declares) {
                assignedTargets.insert(s.target);
                if (s.target == "pos") assignedTargets.insert("p");
            }
    }

    std::vector<Value> outputs() {
        Frame frame = newFrame();
        for (StmtId id : tree.body) statement(frame, id);

        const Place end{1, 1};
        std::vector<Value> values;
        if (scope.outputs.size() > 1) {
            for (const OutputSpec& output : scope.outputs) {
                const Value* value = find(frame, output.name);
                if (!value) fail(end, "the code assigns no " + inQuotes(output.name));
                values.push_back(converted(*value, output.type, end));
            }
            return values;
        }
        std::optional<Value> result = lastAssigned(frame);
        if (frame.result) {
            if (!ir.isConstant(frame.live, 0.0)) {
                if (!result)
                    fail(end, "the code does not return on every path: end it with a return outside the if");
                // Some paths return and others fall through to the last assignment.
                result = checked(choose(state, frame.live, *result, *frame.result), end);
            } else {
                result = frame.result;
            }
        }
        if (!result) fail(end, "the code has no result: end it with 'return …;' or assign the result last");
        if (scope.anyResult) {
            if (componentCount(result->type) == 0)
                fail(end,
                     "the code returns a " + std::string(typeName(result->type)) + ", which no node can use");
            return {*result};
        }
        return {converted(*result, scope.outputs[0].type, end)};
    }

  private:
    [[noreturn]] static void fail(Place place, const std::string& message,
                                  Error::Code code = Error::Code::other) {
        Error error = codeError(place, message);
        error.code = code;
        throw Failure{error};
    }

    Value checked(Result<Value> result, Place place) {
        if (result) return *result;
        Error error = result.error();
        if (error.codeLine == 0) error.codeLine = place.line, error.codeColumn = place.column;
        throw Failure{error};
    }
    Value converted(const Value& value, Type type, Place place) {
        return checked(convert(state, value, type), place);
    }

    /// `value` as a variable of `type` holds it: an int truncates.
    Value stored(const Value& value, Type type, Place place) {
        Value made = converted(value, type, place);
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

    // ---- variables
    // -------------------------------------------------------------------------------------------

    /// A frame in which the inputs and `p` that the code assigns to are variables from the start: what an if
    /// or a loop assigns to them lasts.
    Frame newFrame() {
        Frame frame;
        frame.live = ir.constant(1.0);
        for (const std::string& target : assignedTargets)
            if (const Value* input = findInput(target))
                frame.variables.push_back({target, *input});
            else if (target == "p")
                frame.variables.push_back({target, positionValue()});
        return frame;
    }

    static Variable* findVariable(Frame& frame, std::string_view name) {
        for (auto it = frame.variables.rbegin(); it != frame.variables.rend(); ++it)
            if (it->name == name) return &*it;
        return nullptr;
    }
    static Value* find(Frame& frame, std::string_view name) {
        Variable* variable = findVariable(frame, name);
        return variable ? &variable->value : nullptr;
    }
    const Value* findInput(std::string_view name) const {
        for (const auto& [known, value] : scope.inputs)
            if (known == name) return &value;
        return nullptr;
    }
    Value positionValue() const {
        Value value{Type::vec3};
        for (int i = 0; i < 3; ++i) value.ids[i] = ir.position(i);
        return value;
    }

    /// The value a name stands for: variable, input, then the names everybody sees.
    std::optional<Value> named(Frame& frame, std::string_view name) {
        if (const Value* value = find(frame, name)) return *value;
        if (const Value* value = findInput(name)) return *value;
        if (name == "pos") return named(frame, "p");
        if (name == "p") return positionValue();
        if (name == "time") return scalar(state.time);
        if (name == "PI" || name == "pi") return scalar(ir.constant(std::numbers::pi));
        if (name == "TAU" || name == "tau") return scalar(ir.constant(2.0 * std::numbers::pi));
        if (name == "true" || name == "false")
            return Value{Type::boolean, {ir.constant(name == "true" ? 1.0 : 0.0)}};
        return std::nullopt;
    }
    static Value scalar(IrId id) { return Value{Type::scalar, {id}}; }

    std::optional<Value> lastAssigned(Frame& frame) {
        if (const Value* value = find(frame, frame.lastTarget)) return *value;
        return frame.lastValue;
    }

    // ---- statements
    // ------------------------------------------------------------------------------------------

    void statement(Frame& frame, StmtId id) {
        const Stmt& s = tree.statements[id];
        if (ir.isConstant(frame.live, 0.0)) return;  // nothing reaches this statement
        step(s.place);
        switch (s.kind) {
            case Stmt::Kind::assign: assign(frame, s); return;
            case Stmt::Kind::branch: branch(frame, s); return;
            case Stmt::Kind::loop: loop(frame, s); return;
            case Stmt::Kind::evaluate: {
                const Value value = expression(frame, s.expression);
                frame.lastTarget.clear();
                frame.lastValue = value;  // a lone expression is its own result
                return;
            }
            case Stmt::Kind::result: {
                if (s.expression == kNothing) fail(s.place, "'return' needs a value");
                const Value value = expression(frame, s.expression);
                frame.result =
                    frame.result ? checked(choose(state, frame.live, value, *frame.result), s.place) : value;
                frame.live = ir.constant(0.0);
                return;
            }
            case Stmt::Kind::leave:
            case Stmt::Kind::next: {
                if (!frame.loop) fail(s.place, "'break' and 'continue' belong inside a loop");
                IrId& when = s.kind == Stmt::Kind::leave ? frame.loop->left : frame.loop->skipped;
                when = ir.add(Op::logicalOr, when, frame.live);
                frame.live = ir.constant(0.0);
                return;
            }
            case Stmt::Kind::block: {
                const std::size_t outside = frame.variables.size();
                for (StmtId inner : s.body) statement(frame, inner);
                if (!s.declares) frame.variables.resize(outside);
                return;
            }
        }
    }

    void assign(Frame& frame, const Stmt& s) {
        if (s.declares) {
            Value value;
            if (s.expression == kNothing)
                value = constantValue(state, s.type, std::array{0.0, 0.0, 0.0});
            else
                value = stored(expression(frame, s.expression), s.type, s.place);
            frame.variables.push_back({s.target, value, s.constant});
            remember(frame, s.target, value);
            return;
        }
        Value value = expression(frame, s.expression);
        std::string target = s.target;
        if (target == "pos" && !find(frame, target) && !findInput(target)) target = "p";
        Variable* known = findVariable(frame, target);
        if (known && known->constant)
            fail(s.place, inQuotes(target) + " is const: drop the const, or assign to another name");
        Value* variable = known ? &known->value : nullptr;
        std::optional<Value> old;
        if (variable)
            old = *variable;
        else
            old = named(frame, target);
        if (!old && (!s.operation.empty() || !s.swizzle.empty()))
            fail(s.place, inQuotes(target) + " has no value yet");

        if (!s.swizzle.empty()) {
            value = withComponents(*old, s, value);
        } else if (!s.operation.empty()) {
            value = combine(s.operation[0], *old, value, s.place);
        }
        if (variable) {
            if (old->type == Type::surface && value.type != Type::surface) {
                Value kept = *old;
                kept.ids[0] = converted(value, Type::scalar, s.place).ids[0];
                value = kept;
            } else if (old->type == Type::scalar && value.type == Type::surface) {
                // a name declared by a float keeps a surface's material from here on
            } else {
                value = stored(value, old->type, s.place);
            }
            if (frame.loop && !ir.isConstant(frame.live))
                value = checked(choose(state, frame.live, value, *old), s.place);
            *variable = value;
        } else {
            if (value.type == Type::integer) value.type = Type::scalar;
            frame.variables.push_back({target, value});
        }
        remember(frame, target, value);
    }

    static void remember(Frame& frame, const std::string& target, const Value& value) {
        frame.lastTarget = target;
        frame.lastValue = value;
    }

    /// `old` with the components that s.swizzle names replaced.
    Value withComponents(Value old, const Stmt& s, const Value& value) {
        if (old.type == Type::surface) {
            const auto [first, type] = surfaceMember(s.swizzle, s.place);
            Value part{type};
            std::copy_n(old.ids.begin() + first, componentCount(type), part.ids.begin());
            const Value made = s.operation.empty() ? converted(value, type, s.place)
                                                   : combine(s.operation[0], part, value, s.place);
            std::copy_n(converted(made, type, s.place).ids.begin(), componentCount(type),
                        old.ids.begin() + first);
            return old;
        }
        const Value part = swizzled(old, s.swizzle, s.place);
        const Value made = converted(
            s.operation.empty() ? value : combine(s.operation[0], part, value, s.place), part.type, s.place);
        for (std::size_t i = 0; i < s.swizzle.size(); ++i) old.ids[swizzleIndex(s.swizzle[i])] = made.ids[i];
        return old;
    }

    void branch(Frame& frame, const Stmt& s) {
        const Value condition = truth(frame, s.expression);
        if (ir.isConstant(condition.ids[0])) {
            const bool holds = ir.number(condition.ids[0]) != 0.0;
            if (holds || s.body.size() > 1) scoped(frame, s.body[holds ? 0 : 1]);
            return;
        }
        const Frame before = frame;
        frame.live = ir.add(Op::logicalAnd, before.live, condition.ids[0]);
        scoped(frame, s.body[0]);

        Frame other = before;
        other.result = frame.result;  // a return on the first side stands where the second does not return
        other.live = ir.add(Op::logicalAnd, before.live, ir.add(Op::logicalNot, condition.ids[0]));
        if (s.body.size() > 1) scoped(other, s.body[1]);

        const bool firstEnds = ir.isConstant(frame.live, 0.0), secondEnds = ir.isConstant(other.live, 0.0);
        frame.result = other.result;
        for (std::size_t i = 0; i < frame.variables.size(); ++i) {
            Value& mine = frame.variables[i].value;
            const Value& theirs = other.variables[i].value;
            if (firstEnds && !inLoop(frame))
                mine = theirs;
            else if (!(secondEnds && !inLoop(frame)))
                mine = checked(choose(state, condition.ids[0], mine, theirs), s.place);
        }
        if (other.lastTarget != before.lastTarget || !other.lastValue) {
            frame.lastTarget = other.lastTarget;
            frame.lastValue = other.lastValue;
        }
        if (firstEnds)
            frame.live = other.live;
        else if (!secondEnds)
            frame.live = bothContinue(before, frame, other) ? before.live
                                                            : ir.add(Op::logicalOr, frame.live, other.live);
    }

    static bool inLoop(const Frame& frame) { return frame.loop != nullptr; }
    /// Neither side of a branch changed the condition it started with.
    bool bothContinue(const Frame& before, const Frame& first, const Frame& second) {
        const IrNode &a = ir[first.live], &b = ir[second.live];
        if (ir.isConstant(before.live, 1.0))
            return first.live == second.live || ir.add(Op::logicalNot, first.live) == second.live;
        const auto extends = [&](const IrNode& node) {
            return node.op == Op::logicalAnd &&
                   (node.operands[0] == before.live || node.operands[1] == before.live);
        };
        return extends(a) && extends(b);
    }

    void scoped(Frame& frame, StmtId id) {
        const std::size_t outside = frame.variables.size();
        statement(frame, id);
        frame.variables.resize(outside);
    }

    void loop(Frame& frame, const Stmt& s) {
        const std::size_t outside = frame.variables.size();
        statement(frame, s.body[0]);
        Loop own{ir.constant(0.0), ir.constant(0.0)};
        Loop* const outer = frame.loop;
        frame.loop = &own;
        while (!ir.isConstant(frame.live, 0.0)) {
            step(s.place);
            const Value condition = truth(frame, s.expression);
            if (!ir.isConstant(condition.ids[0]))
                fail(s.place,
                     "the loop's bounds must be known when the graph is compiled: numbers, or inputs that "
                     "are not linked or live");
            if (ir.number(condition.ids[0]) == 0.0) break;
            scoped(frame, s.body[2]);
            frame.live = ir.add(Op::logicalOr, frame.live, own.skipped);
            own.skipped = ir.constant(0.0);
            // The step runs on every path that is still in the loop; its variable is the same on all of them.
            const IrId live = frame.live;
            if (!ir.isConstant(live, 0.0)) {
                frame.live = ir.constant(1.0);
                statement(frame, s.body[1]);
                frame.live = live;
            }
        }
        frame.loop = outer;
        frame.live = ir.add(Op::logicalOr, frame.live, own.left);
        frame.variables.resize(outside);
    }

    Value truth(Frame& frame, ExprId id) {
        const Value value = expression(frame, id);
        if (value.type != Type::boolean)
            fail(tree.expressions[id].place,
                 "a condition is a comparison, not a " + std::string(typeName(value.type)));
        return value;
    }

    // ---- expressions
    // -----------------------------------------------------------------------------------------

    Value expression(Frame& frame, ExprId id) {
        const Expr& e = tree.expressions[id];
        step(e.place);
        switch (e.kind) {
            case Expr::Kind::number:
                return Value{e.integer ? Type::integer : Type::scalar, {ir.constant(e.number)}};
            case Expr::Kind::string: {
                Value value{Type::string};
                value.text = e.text;
                return value;
            }
            case Expr::Kind::name: {
                if (const auto value = named(frame, e.text)) return *value;
                unknown(frame, e, "name");
            }
            case Expr::Kind::member: return member(expression(frame, e.arguments[0]), e);
            case Expr::Kind::index:
                return indexed(expression(frame, e.arguments[0]), expression(frame, e.arguments[1]), e.place);
            case Expr::Kind::call: return call(frame, e);
            case Expr::Kind::unary: {
                const Value value = expression(frame, e.arguments[0]);
                if (e.text == "!") {
                    if (value.type != Type::boolean) fail(e.place, "'!' takes a comparison");
                    return Value{Type::boolean, {ir.add(Op::logicalNot, value.ids[0])}};
                }
                const Value zero{Type::integer, {ir.constant(0.0)}};
                return checked(arithmetic(state, '-', zero, value), e.place);
            }
            case Expr::Kind::binary: return binary(frame, e);
            case Expr::Kind::conditional: {
                const Value condition = truth(frame, e.arguments[0]);
                if (ir.isConstant(condition.ids[0]) && ir.number(condition.ids[0]) == 0.0)
                    return expression(frame, e.arguments[2]);
                const Value yes = expression(frame, e.arguments[1]);
                if (ir.isConstant(condition.ids[0])) return yes;
                return checked(choose(state, condition.ids[0], yes, expression(frame, e.arguments[2])),
                               e.place);
            }
        }
        fail(e.place, "this expression has no meaning");
    }

    [[noreturn]] void unknown(Frame& frame, const Expr& e, const std::string& what) {
        std::vector<std::string> names =
            what == "name" ? std::vector<std::string>{"time", "pos"} : builtinNames();
        for (const Variable& variable : frame.variables) names.push_back(variable.name);
        for (const auto& [name, value] : scope.inputs) names.push_back(name);
        if (what == "function")
            for (const NodeType& type : nodeTypes()) names.push_back(type.id);
        const std::string near = nearestName(e.text, names);
        fail(e.place, "unknown " + what + " " + inQuotes(e.text) +
                          (near.empty() ? "" : ": did you mean '" + near + "'?"));
    }

    /// An Error where a divisor of the user's code is the constant 0.
    void refuseZero(const Value& divisor, Place place) {
        if (!scope.refusesZeroDivision) return;
        const int width = divisor.type == Type::surface ? 1 : componentCount(divisor.type);
        for (int i = 0; i < width; ++i)
            if (ir.isConstant(divisor.ids[i], 0.0))
                fail(place, "division by zero", Error::Code::divisionByZero);
    }

    Value combine(char operation, const Value& a, const Value& b, Place place) {
        if (operation == '/' || operation == '%') refuseZero(b, place);
        return checked(arithmetic(state, operation, a, b), place);
    }

    Value binary(Frame& frame, const Expr& e) {
        const Value a = expression(frame, e.arguments[0]), b = expression(frame, e.arguments[1]);
        const auto boolean = [](IrId id) { return Value{Type::boolean, {id}}; };
        if (e.text == "&&" || e.text == "||") {
            if (a.type != Type::boolean || b.type != Type::boolean)
                fail(e.place, inQuotes(e.text) + " joins comparisons");
            return boolean(ir.add(e.text == "&&" ? Op::logicalAnd : Op::logicalOr, a.ids[0], b.ids[0]));
        }
        if (std::string_view("+-*/%").find(e.text) != std::string_view::npos)
            return combine(e.text[0], a, b, e.place);

        if (a.type == Type::string && b.type == Type::string && (e.text == "==" || e.text == "!="))
            return boolean(ir.constant((a.text == b.text) == (e.text == "==") ? 1.0 : 0.0));
        if (e.text == "==" || e.text == "!=") {
            if (a.type == Type::boolean || b.type == Type::boolean)
                fail(e.place, "comparisons cannot be compared: write a && b, or a && !b");
            const int width =
                componentCount(a.type) == 9 || componentCount(b.type) == 9 ? 1 : componentCount(a.type);
            if (width == 0 || (width > 1 && a.type != b.type)) fail(e.place, "these two cannot be compared");
            IrId same = ir.constant(1.0);
            for (int i = 0; i < width; ++i)
                same = ir.add(Op::logicalAnd, same, ir.add(Op::equal, a.ids[i], b.ids[i]));
            return boolean(e.text == "==" ? same : ir.add(Op::logicalNot, same));
        }
        const IrId x = converted(a, Type::scalar, e.place).ids[0],
                   y = converted(b, Type::scalar, e.place).ids[0];
        if (e.text == "<") return boolean(ir.add(Op::less, x, y));
        if (e.text == ">") return boolean(ir.add(Op::less, y, x));
        if (e.text == "<=") return boolean(ir.add(Op::lessEqual, x, y));
        return boolean(ir.add(Op::lessEqual, y, x));
    }

    static std::pair<int, Type> surfaceMember(std::string_view name, Place place) {
        if (name == "distance") return {distanceComponent, Type::scalar};
        if (name == "base_color") return {baseColorComponent, Type::vec3};
        if (name == "roughness") return {roughnessComponent, Type::scalar};
        if (name == "metallic") return {metallicComponent, Type::scalar};
        if (name == "emission") return {emissionComponent, Type::vec3};
        fail(place, "a surface has no " + inQuotes(name) +
                        ": it has distance, base_color, roughness, metallic and emission");
    }

    Value swizzled(const Value& value, std::string_view swizzle, Place place) {
        const int width = std::min(componentCount(value.type), 3);
        if (swizzle.size() > 3 || width == 0 || value.type == Type::surface)
            fail(place, "a " + std::string(typeName(value.type)) + " has no " +
                            inQuotes("." + std::string(swizzle)));
        Value result{swizzle.size() == 3 ? Type::vec3 : swizzle.size() == 2 ? Type::vec2 : Type::scalar};
        for (std::size_t i = 0; i < swizzle.size(); ++i) {
            const int index = swizzleIndex(swizzle[i]);
            if (index < 0 || index >= width)
                fail(place, "a " + std::string(typeName(value.type)) + " has no component '" +
                                std::string(1, swizzle[i]) + "'");
            result.ids[i] = value.ids[index];
        }
        return result;
    }

    Value member(const Value& value, const Expr& e) {
        if (value.type != Type::surface) return swizzled(value, e.text, e.place);
        const auto [first, type] = surfaceMember(e.text, e.place);
        Value part{type};
        std::copy_n(value.ids.begin() + first, componentCount(type), part.ids.begin());
        return part;
    }

    Value indexed(const Value& value, const Value& index, Place place) {
        if (!ir.isConstant(index.ids[0]) || componentCount(index.type) != 1)
            fail(place, "an index must be known when the graph is compiled");
        const double at = ir.number(index.ids[0]);
        const bool isPoints = value.type == Type::points && value.points;
        const double count = isPoints                      ? value.points->size() / 2.0
                             : value.type == Type::surface ? 0
                                                           : componentCount(value.type);
        if (!(at >= 0.0 && at < count)) {
            char text[32];
            std::snprintf(text, sizeof text, "%.15g", at);
            fail(place, "index " + std::string(text) + " is outside 0 to " +
                            std::to_string(static_cast<long long>(count) - 1));
        }
        const auto i = static_cast<std::size_t>(at);
        if (isPoints)
            return Value{Type::vec2,
                         {ir.constant((*value.points)[2 * i]), ir.constant((*value.points)[2 * i + 1])}};
        return scalar(value.ids[i]);
    }

    // ---- calls
    // -----------------------------------------------------------------------------------------------

    Value call(Frame& frame, const Expr& e) {
        std::vector<Value> arguments;
        for (ExprId id : e.arguments) arguments.push_back(expression(frame, id));

        if (const Function* function = tree.function(e.text)) return callFunction(*function, arguments, e);
        const Value* field = find(frame, e.text);
        if (!field) field = findInput(e.text);
        if (field) return atPosition(*field, arguments, e);
        if ((e.text == "mod" || e.text == "fmod") && arguments.size() == 2) refuseZero(arguments[1], e.place);
        if (isBuiltin(e.text)) return checked(callBuiltin(state, e.text, arguments), e.place);

        const NodeType* type = findNodeType(e.text);
        if (!type) {
            std::string lower = e.text;  // listings write Box(pos)
            for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
            type = findNodeType(lower);
        }
        if (type && type->body.empty())
            fail(e.place, "'" + type->id + "' is a node and no function: add it to the graph and link it");
        if (!type) unknown(frame, e, "function");
        return callNode(*type, arguments, e);
    }

    Value atPosition(const Value& field, const std::vector<Value>& arguments, const Expr& e) {
        if (arguments.size() != 1 || componentCount(field.type) == 0)
            fail(e.place, inQuotes(e.text) + " is a field: call it with one position, as in a(p)");
        const Value q = converted(arguments[0], Type::vec3, e.place);
        Value result = field;
        for (int i = 0; i < componentCount(field.type); ++i) {
            step(e.place);
            result.ids[i] = ir.substitute(field.ids[i], {q.ids[0], q.ids[1], q.ids[2]});
            if (ir.substituted() > kMaxSubstituted)
                fail(e.place, "the graph moves its fields " + std::to_string(kMaxSubstituted) +
                                  " operations' worth: use fewer or less nested copies, repeats and moves");
        }
        return result;
    }

    Value callFunction(const Function& function, const std::vector<Value>& arguments, const Expr& e) {
        if (arguments.size() != function.parameters.size())
            fail(e.place, inQuotes(e.text) + " takes " + std::to_string(function.parameters.size()) +
                              " arguments, not " + std::to_string(arguments.size()));
        if (state.calls >= kMaxCalls)
            fail(e.place, inQuotes(e.text) + " calls itself, or calls are nested deeper than " +
                              std::to_string(kMaxCalls));
        Frame frame = newFrame();
        for (std::size_t i = 0; i < arguments.size(); ++i)
            frame.variables.push_back(
                {function.parameters[i].second, stored(arguments[i], function.parameters[i].first, e.place)});
        ++state.calls;
        statement(frame, function.body);
        --state.calls;
        if (!frame.result || !ir.isConstant(frame.live, 0.0))
            fail(function.place,
                 "the function " + inQuotes(function.name) + " does not return on every path");
        return stored(*frame.result, function.result, function.place);
    }

    Value callNode(const NodeType& type, const std::vector<Value>& arguments, const Expr& e) {
        if (arguments.size() > type.inputs.size())
            fail(e.place, "'" + type.id + "' takes at most " + std::to_string(type.inputs.size()) +
                              " arguments, not " + std::to_string(arguments.size()));
        std::vector<Value> inputs;
        for (std::size_t i = 0; i < type.inputs.size(); ++i) {
            const InputSpec& input = type.inputs[i];
            if (i >= arguments.size()) {
                inputs.push_back(defaultValue(state, input));
                continue;
            }
            const Result<Value> value = convert(state, arguments[i], input.type);
            if (!value)
                fail(e.place, "argument " + std::to_string(i + 1) + " of '" + type.id + "' is its " +
                                  input.name + ", a " + std::string(typeName(input.type)) + ", not a " +
                                  std::string(typeName(arguments[i].type)));
            if (!input.options.empty() &&
                std::find(input.options.begin(), input.options.end(), value->text) == input.options.end())
                fail(e.place, inQuotes(value->text) + " is not one of the choices of " + input.name);
            inputs.push_back(*value);
        }
        return checked(firstOf(lowerNode(state, type, std::move(inputs))), e.place);
    }
    static Result<Value> firstOf(Result<std::vector<Value>> values) {
        if (values) return values->front();
        Error error = values.error();
        error.codeLine = error.codeColumn =
            0;  // the place inside the library's body means nothing to the user
        return error;
    }

    Lowering& state;
    Ir& ir;
    const Tree& tree;
    const Scope& scope;
    std::set<std::string> assignedTargets;  ///< of every assignment that is no declaration
};

/// The parsed body of a library node; a body that does not parse is a bug.
std::shared_ptr<const Tree> bodyOf(const NodeType& type) {
    static std::mutex mutex;
    static std::unordered_map<const NodeType*, std::shared_ptr<const Tree>> bodies;
    const std::lock_guard lock(mutex);
    std::shared_ptr<const Tree>& body = bodies[&type];
    if (!body) {
        Result<std::shared_ptr<const Tree>> parsed = parse(type.body);
        if (!parsed) throw std::logic_error("node type '" + type.id + "': " + format(parsed.error()));
        body = *parsed;
    }
    return body;
}

}  // namespace

Result<std::vector<Value>> lower(Lowering& state, const Tree& tree, const Scope& scope) {
    const int calls = state.calls;
    try {
        return Run(state, tree, scope).outputs();
    } catch (const Failure& failure) {
        state.calls = calls;
        return failure.error;
    }
}

Result<std::vector<Value>> lowerNode(Lowering& state, const NodeType& type, std::vector<Value> inputs) {
    Scope scope;
    for (std::size_t i = 0; i < inputs.size(); ++i)
        scope.inputs.emplace_back(type.inputs[i].name, std::move(inputs[i]));
    scope.outputs = type.outputs;
    return lower(state, *bodyOf(type), scope);
}

Value constantValue(Lowering& state, Type type, std::span<const double> numbers) {
    Value value{type};
    for (int i = 0; i < componentCount(type); ++i)
        value.ids[i] = state.ir.constant(i < static_cast<int>(numbers.size()) ? numbers[i]
                                         : numbers.empty()                    ? 0.0
                                                                              : numbers.back());
    return value;
}

Value emptySurface(Lowering& state) {
    Value value{Type::surface};
    value.ids[0] = state.ir.constant(kEmptyDistance);
    for (int i = 0; i < 8; ++i) value.ids[i + 1] = state.ir.constant(kDefaultMaterial[i]);
    return value;
}

Value defaultValue(Lowering& state, const InputSpec& input) {
    Value value{input.type};
    switch (input.value.kind) {
        case InputDefault::Kind::position:
            for (int i = 0; i < componentCount(input.type); ++i) value.ids[i] = state.ir.position(i);
            return value;
        case InputDefault::Kind::text:
            value.text = input.value.text;
            if (input.type == Type::image) value.image = state.ir.addImage(plainImage());
            return value;
        case InputDefault::Kind::numbers:
            if (input.type == Type::points) {
                value.points = std::make_shared<const std::vector<double>>(input.value.numbers);
                return value;
            }
            return constantValue(state, input.type, input.value.numbers);
        case InputDefault::Kind::none: break;
    }
    if (input.type == Type::surface) return emptySurface(state);
    if (input.type == Type::points) value.points = std::make_shared<const std::vector<double>>();
    return componentCount(input.type) > 0 ? constantValue(state, input.type, {}) : value;
}

namespace {

/// The image of a path, read at its first use.
Result<uint32_t> imageAt(Lowering& state, const std::string& path) {
    if (path.empty()) return state.ir.addImage(plainImage());
    const auto known = state.images.find(path);
    if (known != state.images.end()) return state.ir.addImage(known->second);
    const Result<FieldImagePtr> image = readImage(state.graphPath, path);
    if (!image) return image.error();
    std::size_t texels = (*image)->texels.size();
    for (const FieldImagePtr& held : state.ir.images())
        if (held != *image) texels += held->texels.size();
    if (texels * sizeof(uint32_t) >= kMaxImageBytes) {
        return Error{.message = "the pictures of the graph together take " +
                                std::to_string(kMaxImageBytes >> 20) +
                                " MiB or more (4 bytes a pixel): use smaller ones"};
    }
    state.images.emplace(path, *image);
    return state.ir.addImage(*image);
}

}  // namespace

Result<Value> convert(Lowering& state, const Value& value, Type type) {
    if (value.type == type) return value;
    const auto isNumber = [](Type t) {
        return t == Type::scalar || t == Type::integer || t == Type::boolean;
    };
    Value result{type};
    if (value.type == Type::string && type == Type::image) {
        const Result<uint32_t> image = imageAt(state, value.text);
        if (!image) return image.error();
        result.text = value.text;
        result.image = *image;
        return result;
    }
    if (isNumber(value.type) || value.type == Type::surface) {
        IrId id = value.ids[0];
        if (value.type == Type::boolean && type != Type::boolean)
            id = state.ir.add(Op::select, id, state.ir.constant(1.0), state.ir.constant(0.0));
        switch (type) {
            case Type::scalar: result.ids[0] = id; return result;
            case Type::integer:
                if (value.type == Type::surface) break;
                result.ids[0] = id;
                return result;
            case Type::vec2:
            case Type::vec3:
                if (value.type == Type::surface) break;
                for (int i = 0; i < componentCount(type); ++i) result.ids[i] = id;
                return result;
            case Type::surface:
                result = emptySurface(state);
                result.ids[0] = id;
                return result;
            default: break;
        }
    }
    const auto named = [](Type t) {
        const std::string name(typeName(t));
        return (name[0] == 'i' ? "an " : "a ") + name;
    };
    return Error{.message = named(value.type) + " cannot stand for " + named(type)};
}

}  // namespace fw::language
