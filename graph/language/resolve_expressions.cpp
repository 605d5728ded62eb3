#include <algorithm>
#include <cctype>
#include <numbers>

#include "graph/base/words.h"
#include "graph/language/resolver.h"

namespace fw::language {

using Kind = Instruction::Kind;

const std::string kSurfaceMembers =
    "distance, base_color, roughness, metallic, emission, transmission, ior and absorption";

std::optional<std::pair<int, Type>> surfaceMember(std::string_view name) {
    if (name == "distance") return std::pair(int(distanceComponent), Type::scalar);
    if (name == "base_color") return std::pair(int(baseColorComponent), Type::vec3);
    if (name == "roughness") return std::pair(int(roughnessComponent), Type::scalar);
    if (name == "metallic") return std::pair(int(metallicComponent), Type::scalar);
    if (name == "emission") return std::pair(int(emissionComponent), Type::vec3);
    if (name == "transmission") return std::pair(int(transmissionComponent), Type::scalar);
    if (name == "ior") return std::pair(int(iorComponent), Type::scalar);
    if (name == "absorption") return std::pair(int(absorptionComponent), Type::vec3);
    return std::nullopt;
}

std::optional<int> swizzleOf(std::string_view name, int width) {
    if (name.empty() || name.size() > 3) return std::nullopt;
    int packed = 0;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const std::size_t at = std::string_view("xyzrgbuv").find(name[i]);
        if (at == std::string_view::npos || int(at % 3) >= width) return std::nullopt;
        packed |= int(at % 3) << (2 * i);
    }
    return packed;
}

void Resolver::error(Place place, std::string message) {
    if (errors.size() < kMaxCodeErrors) errors.push_back(codeError(place, std::move(message)));
}

int Resolver::emit(Instruction instruction) {
    made().instructions.push_back(instruction);
    return static_cast<int>(made().instructions.size()) - 1;
}

Operand Resolver::pop() {
    Operand top = std::move(operands.back());
    operands.pop_back();
    return top;
}

Operand Resolver::expression(Range range) {
    for (int i = range.first; i < range.last; ++i) element(tree.expressions[std::size_t(i)]);
    return pop();
}

void Resolver::element(const Expr& e) {
    switch (e.kind) {
        case Expr::Kind::number: {
            const Type numberType = e.integer ? Type::integer : Type::scalar;
            emit({.kind = Kind::number, .type = numberType, .place = e.place, .number = e.number});
            return push(numberType, e.place);
        }
        case Expr::Kind::text:
            emit({.kind = Kind::text, .index = static_cast<int>(code.texts.size()), .place = e.place});
            code.texts.push_back(e.text);
            return push(Type::string, e.place);
        case Expr::Kind::name: return name(e);
        case Expr::Kind::member: return member(e);
        case Expr::Kind::index: return index(e);
        case Expr::Kind::call: return call(e);
        case Expr::Kind::unary: return unary(e);
        case Expr::Kind::binary: return binary(e);
        case Expr::Kind::then:
            condition(pop());
            ends.emplace_back();
            ends.back().push_back(emit({.kind = Kind::then, .place = e.place}));
            return;
        case Expr::Kind::otherwise: {
            const int at = emit({.kind = Kind::otherwise, .place = e.place});
            made().instructions[std::size_t(ends.back()[0])].target = at + 1;
            ends.back() = {at};
            return;
        }
        case Expr::Kind::conditional: return conditional(e);
    }
}

// ---- names

std::optional<Type> Resolver::inputType(std::string_view wanted, int* index) const {
    const auto found = inputIndices.find(wanted);
    *index = found == inputIndices.end() ? -1 : found->second;
    return *index < 0 ? std::nullopt : declared.inputs[std::size_t(*index)].second;
}

bool Resolver::pushNamed(std::string_view wanted, Place place) {
    if (const int slot = names.find(wanted); slot >= 0) {
        emit({.kind = Kind::slot, .index = slot, .place = place});
        const std::optional<Type> own = slotType(slot);
        push(own, place, own == Type::scalar ? std::vector<int>{slotBase + slot} : std::vector<int>{});
        return true;
    }
    int input = -1;
    if (const std::optional<Type> own = inputType(wanted, &input); input >= 0) {
        emit({.kind = Kind::input, .index = input, .place = place});
        push(own, place);
        return true;
    }
    if (wanted == "pos") return pushNamed("p", place);
    if (wanted == "p") {
        emit({.kind = Kind::position, .place = place});
        push(Type::vec3, place);
        return true;
    }
    if (wanted == "time") {
        emit({.kind = Kind::time, .place = place});
        push(Type::scalar, place);
        return true;
    }
    const auto constant = [&](Type own, double number) {
        emit({.kind = Kind::number, .type = own, .place = place, .number = number});
        push(own, place);
        return true;
    };
    if (wanted == "PI" || wanted == "pi") return constant(Type::scalar, std::numbers::pi);
    if (wanted == "TAU" || wanted == "tau") return constant(Type::scalar, 2.0 * std::numbers::pi);
    if (wanted == "true" || wanted == "false") return constant(Type::boolean, wanted == "true" ? 1.0 : 0.0);
    return false;
}

void Resolver::name(const Expr& e) {
    if (pushNamed(e.text, e.place)) return;
    unknown(e, "name");
    push(std::nullopt, e.place);
}

void Resolver::unknown(const Expr& e, std::string_view what) {
    if (errors.size() >= kMaxCodeErrors) return;
    if (!tree.errors.empty()) return;  // it may be what could not be read that declares it
    std::vector<std::string> near = what == "name" ? std::vector<std::string>{"time", "pos"} : builtinNames();
    names.collect(near);
    for (const auto& [input, own] : declared.inputs) near.push_back(input);
    if (what == "function") {
        for (const NodeType& each : nodeTypes()) near.push_back(each.id);
        for (const Function& each : tree.functions) near.push_back(each.name);
    }
    const std::string meant = nearestName(e.text, near);
    error(e.place, "unknown " + std::string(what) + " " + inQuotes(e.text) +
                       (meant.empty() ? "" : ": did you mean '" + meant + "'?"));
}

// ---- parts

void Resolver::member(const Expr& e) {
    const Operand whole = pop();
    if (!whole.type) return push(std::nullopt, e.place);
    if (*whole.type == Type::surface) {
        const auto part = surfaceMember(e.text);
        if (!part) {
            error(e.place, "a surface has no " + inQuotes(e.text) + ": it has " + kSurfaceMembers);
            return push(std::nullopt, e.place);
        }
        emit({.kind = Kind::part,
              .count = uint8_t(componentCount(part->second)),
              .type = part->second,
              .index = part->first,
              .place = e.place});
        return push(part->second, e.place);
    }
    const int width = isVector(*whole.type) || isNumber(*whole.type) ? componentCount(*whole.type) : 0;
    const auto packed = swizzleOf(e.text, width);
    if (!packed) {
        const bool single = e.text.size() == 1 && width > 0;
        error(e.place, aType(*whole.type) + " has no " +
                           (single ? "component " + inQuotes(e.text) : inQuotes("." + e.text)));
        return push(std::nullopt, e.place);
    }
    const Type made_ = e.text.size() == 3 ? Type::vec3 : e.text.size() == 2 ? Type::vec2 : Type::scalar;
    emit({.kind = Kind::swizzle,
          .count = uint8_t(e.text.size()),
          .type = made_,
          .index = *packed,
          .place = e.place});
    push(made_, e.place);
}

void Resolver::index(const Expr& e) {
    const Operand at = pop(), whole = pop();
    if (!at.type || !whole.type) return push(std::nullopt, e.place);
    if (*at.type != Type::integer && *at.type != Type::scalar) {
        error(at.place, "expected an index, a whole number, found " + aType(*at.type));
        return push(std::nullopt, e.place);
    }
    if (*whole.type != Type::points && !isVector(*whole.type)) {
        error(e.place, "expected points or a vector before '[', found " + aType(*whole.type));
        return push(std::nullopt, e.place);
    }
    const Type element_ = *whole.type == Type::points ? Type::vec2 : Type::scalar;
    emit({.kind = Kind::element, .type = element_, .place = e.place});
    push(element_, e.place);
}

// ---- operators

void Resolver::condition(const Operand& operand) {
    if (operand.type && *operand.type != Type::boolean)
        error(operand.place, "expected a condition, which is a comparison, found " + aType(*operand.type));
}

void Resolver::unary(const Expr& e) {
    const Operand operand = pop();
    if (e.text == "!") {
        if (operand.type && *operand.type != Type::boolean)
            error(e.place, "expected a comparison behind '!', found " + aType(*operand.type));
        emit({.kind = Kind::logicalNot, .place = e.place});
        return push(Type::boolean, e.place);
    }
    if (!operand.type) return push(std::nullopt, e.place);
    const TypeResult result = arithmeticType(Type::integer, *operand.type, '-');
    if (std::holds_alternative<TypeProblem>(result)) {
        error(e.place, "expected a number or a vector behind '-', found " + aType(*operand.type));
        return push(std::nullopt, e.place);
    }
    emit({.kind = Kind::negate, .place = e.place});
    push(std::get<Type>(result), e.place);
}

void Resolver::binary(const Expr& e) {
    const Operand b = pop(), a = pop();
    if (e.text == "&&" || e.text == "||") {
        for (const Operand* side : {&a, &b})
            if (side->type && *side->type != Type::boolean)
                error(side->place,
                      "expected a comparison beside " + inQuotes(e.text) + ", found " + aType(*side->type));
        emit({.kind = Kind::logical, .symbol = e.text[0], .place = e.place});
        return push(Type::boolean, e.place);
    }
    const bool sums = std::string_view("+-*/%").find(e.text[0]) != std::string_view::npos;
    if (!sums) return comparison(e, a, b);
    if (!a.type || !b.type) return push(std::nullopt, e.place);
    const TypeResult result = arithmeticType(*a.type, *b.type, e.text[0]);
    if (const auto* problem = std::get_if<TypeProblem>(&result)) {
        error(problem->argument == 0 ? a.place : b.place, problem->message);
        return push(std::nullopt, e.place);
    }
    emit({.kind = Kind::arithmetic, .symbol = e.text[0], .place = e.place});
    push(std::get<Type>(result), e.place);
}

void Resolver::comparison(const Expr& e, const Operand& a, const Operand& b) {
    push(Type::boolean, e.place);
    const bool same = e.text == "==" || e.text == "!=";
    emit({.kind = Kind::compare,
          .symbol = e.text == "<="   ? 'l'
                    : e.text == ">=" ? 'g'
                                     : e.text[0],
          .place = e.place});
    if (!a.type || !b.type) return;
    if (isNumber(*a.type) && isNumber(*b.type)) return;
    if (same && (*a.type == Type::boolean || *b.type == Type::boolean))
        return error(e.place, "comparisons cannot be compared: write a && b, or a && !b");
    if (same && *a.type == *b.type && (isVector(*a.type) || *a.type == Type::string)) return;
    const Operand& wrong = isNumber(*a.type) ? b : a;
    if (same)
        return error(b.place, "expected " + aType(*a.type) + " to compare with, found " + aType(*b.type));
    error(wrong.place, "expected a number beside " + inQuotes(e.text) + ", found " + aType(*wrong.type));
}

void Resolver::conditional(const Expr& e) {
    Operand no = pop(), yes = pop();
    const int at = emit({.kind = Kind::chosen, .place = e.place});
    made().instructions[std::size_t(ends.back()[0])].target = at;
    ends.pop_back();
    if (!yes.type || !no.type) return push(std::nullopt, e.place);
    const std::optional<Type> common = commonType(*yes.type, *no.type);
    if (!common)
        error(no.place, "the two sides are of different types: expected " + aType(*yes.type) + ", found " +
                            aType(*no.type));
    else
        made().instructions.back().type = *common;
    yes.sources.insert(yes.sources.end(), no.sources.begin(), no.sources.end());
    push(common, yes.place, std::move(yes.sources));
}

// ---- calls

void Resolver::call(const Expr& e) {
    std::vector<Operand> arguments(std::make_move_iterator(operands.end() - e.count),
                                   std::make_move_iterator(operands.end()));
    operands.resize(operands.size() - std::size_t(e.count));
    if (const auto own = functionIndices.find(e.text); own != functionIndices.end())
        return callFunction(e, own->second, arguments);
    int input = -1;
    const std::optional<Type> ofInput = inputType(e.text, &input);
    const int slot = names.find(e.text);
    if (slot >= 0 || input >= 0) {
        emit({.kind = slot >= 0 ? Kind::slot : Kind::input,
              .index = slot >= 0 ? slot : input,
              .place = e.place});
        callField(e, slot >= 0 ? slotType(slot) : ofInput, arguments);
        if (slot >= 0 && slotType(slot) == Type::scalar) operands.back().sources = {slotBase + slot};
        return;
    }
    if (const Builtin* builtin = findBuiltin(e.text)) return callBuiltin(e, *builtin, std::move(arguments));

    const NodeType* node = findNodeType(e.text);
    if (!node) {
        std::string lower = e.text;  // listings write Box(pos)
        for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        node = findNodeType(lower);
    }
    if (node && !node->body.empty()) return callNode(e, *node, arguments);
    if (node)
        error(e.place, "'" + node->id + "' is a node and no function: add it to the graph and link it");
    else
        unknown(e, "function");
    push(std::nullopt, e.place);
}

void Resolver::callBuiltin(const Expr& e, const Builtin& builtin, std::vector<Operand> arguments) {
    const int count = static_cast<int>(arguments.size());
    if (count < builtin.least || count > builtin.most) {
        const std::string wanted = builtin.least == builtin.most ? std::to_string(builtin.least)
                                                                 : std::to_string(builtin.least) + " to " +
                                                                       std::to_string(builtin.most);
        error(e.place, "'" + e.text + "' takes " + wanted + " arguments, not " + std::to_string(count));
        return push(std::nullopt, e.place);
    }
    std::vector<Type> types;
    std::vector<int> sources;
    const bool passes = e.text == "min" || e.text == "max" || e.text == "mix" || e.text == "lerp";
    for (Operand& argument : arguments) {
        if (!argument.type) return push(std::nullopt, e.place);
        types.push_back(*argument.type);
        if (passes) sources.insert(sources.end(), argument.sources.begin(), argument.sources.end());
    }
    const TypeResult result = builtin.type(types);
    if (const auto* problem = std::get_if<TypeProblem>(&result)) {
        const bool one = problem->argument >= 0;
        error(one ? arguments[std::size_t(problem->argument)].place : e.place,
              (one ? "argument " + std::to_string(problem->argument + 1) + " of " : "") + inQuotes(e.text) +
                  ": " + problem->message);
        return push(std::nullopt, e.place);
    }
    emit({.kind = Kind::builtin,
          .count = uint8_t(count),
          .index = static_cast<int>(code.builtins.size()),
          .place = e.place});
    code.builtins.push_back(&builtin);
    push(std::get<Type>(result), e.place, std::move(sources));
}

void Resolver::callNode(const Expr& e, const NodeType& node, const std::vector<Operand>& arguments) {
    push(node.outputs[0].type, e.place);
    if (arguments.size() > node.inputs.size())
        return error(e.place, "'" + node.id + "' takes at most " + std::to_string(node.inputs.size()) +
                                  " arguments, not " + std::to_string(arguments.size()));
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        const InputSpec& input = node.inputs[i];
        if (!arguments[i].type || standsFor(*arguments[i].type, input.type)) continue;
        error(arguments[i].place, "argument " + std::to_string(i + 1) + " of '" + node.id + "' is its " +
                                      input.name + ": expected " + aType(input.type) + ", found " +
                                      aType(*arguments[i].type));
    }
    emit({.kind = Kind::node,
          .count = uint8_t(arguments.size()),
          .index = static_cast<int>(code.nodes.size()),
          .place = e.place});
    code.nodes.push_back(&node);
}

void Resolver::callFunction(const Expr& e, int called, const std::vector<Operand>& arguments) {
    const Function& function = tree.functions[std::size_t(called)];
    push(function.result, e.place);
    if (arguments.size() != function.parameters.size())
        return error(e.place, inQuotes(e.text) + " takes " + std::to_string(function.parameters.size()) +
                                  " arguments, not " + std::to_string(arguments.size()));
    for (std::size_t i = 0; i < arguments.size(); ++i)
        if (arguments[i].type && !standsFor(*arguments[i].type, function.parameters[i].first))
            error(arguments[i].place, "argument " + std::to_string(i + 1) + " of " + inQuotes(e.text) +
                                          ": expected " + aType(function.parameters[i].first) + ", found " +
                                          aType(*arguments[i].type));
    callees[current].emplace_back(called + 1, e.place);
    emit({.kind = Kind::function, .type = function.result, .index = called + 1, .place = e.place});
}

void Resolver::callField(const Expr& e, std::optional<Type> field, const std::vector<Operand>& arguments) {
    push(field, e.place);
    if (arguments.size() != 1 || (field && componentCount(*field) == 0))
        return error(e.place, inQuotes(e.text) + " is a field: call it with one position, as in a(p)");
    if (arguments[0].type && !standsFor(*arguments[0].type, Type::vec3))
        return error(arguments[0].place, "expected a position (vec3) to look " + inQuotes(e.text) +
                                             " up, found " + aType(*arguments[0].type));
    // The field was pushed behind its position.
    emit({.kind = Kind::elsewhere, .place = e.place});
}

}  // namespace fw::language
