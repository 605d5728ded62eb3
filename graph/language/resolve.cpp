#include "graph/language/resolve.h"

#include <algorithm>
#include <cassert>

#include "graph/language/resolver.h"

namespace fw::language {

using Kind = Instruction::Kind;

namespace {

/// Nothing assigned yet; on some paths another name than on others; one that cannot be seen any more.
constexpr int kNone = -1, kDepends = -2, kGone = -3;  // kGone: its block has ended

constexpr int kMaxCalls = 64;

}  // namespace

// ---- names

void Names::close() {
    for (; added.size() > opened.back(); added.pop_back()) slots[added.back()].pop_back();
    opened.pop_back();
}

void Names::add(std::string_view name, int slot) {
    slots[name].push_back(slot);
    added.push_back(name);
}

int Names::find(std::string_view name) const {
    const auto found = slots.find(name);
    return found == slots.end() || found->second.empty() ? -1 : found->second.back();
}

void Names::collect(std::vector<std::string>& names) const {
    for (const std::string_view name : added) names.emplace_back(name);
}

bool SurfaceSlots::follow(int count) {
    std::vector<std::vector<int>> leads(std::size_t(count) + 1);
    for (const auto& [from, to] : flow) leads[std::size_t(from)].push_back(to);
    std::vector<bool> reached(leads.size());
    for (std::vector<int> pending = given; !pending.empty();) {
        const std::size_t slot = std::size_t(pending.back());
        pending.pop_back();
        if (reached[slot]) continue;
        reached[slot] = true;
        pending.insert(pending.end(), leads[slot].begin(), leads[slot].end());
    }
    known.resize(reached.size());
    const bool more = reached != known;
    known = std::move(reached);
    flow.clear();
    given.clear();
    return more;
}

// ---- functions

Resolver::Resolver(const Tree& tree_, const Declared& declared_, SurfaceSlots& surfaces_)
    : tree(tree_), declared(declared_), surfaces(surfaces_) {
    for (std::size_t i = 0; i < tree.functions.size(); ++i)
        functionIndices.emplace(tree.functions[i].name, static_cast<int>(i));
    for (std::size_t i = 0; i < declared.inputs.size(); ++i)
        inputIndices.emplace(declared.inputs[i].first, static_cast<int>(i));
    code.functions.resize(tree.functions.size() + 1);
    callees.resize(code.functions.size());
    known.resize(code.functions.size());
}

void Resolver::run() {
    function(0, nullptr);
    for (std::size_t i = 0; i < tree.functions.size(); ++i)
        function(static_cast<int>(i) + 1, &tree.functions[i]);
    checkCalls();
}

void Resolver::function(int index, const Function* declaration) {
    if (index > 0) slotBase += static_cast<int>(made().slots.size());
    current = std::size_t(index);
    names = {};
    names.open();
    constants.clear();
    depth = loops = 0;
    ends.assign(1, {});
    ended = false;
    last = lonely = kNone;
    if (declaration) {
        made().name = declaration->name;
        made().result = declaration->result;
        made().place = declaration->place;
        for (const auto& [parameter, name] : declaration->parameters) {
            made().parameters.push_back(parameter);
            names.add(name, newSlot(parameter, nullptr));
        }
    }
    captureInputs(declaration);
    if (declaration) {
        statement(declaration->body);
        names.close();
    } else {
        for (const StmtId id : tree.body) statement(id);
        finish();
    }
    patchEnds(static_cast<int>(made().instructions.size()));
}

/// The inputs, and `p`, that a function assigns to are variables of it from the start: what an if or a loop
/// assigns to them lasts.
void Resolver::captureInputs(const Function* declaration) {
    const auto functionAt = [&](StmtId id) {
        const auto at = std::ranges::upper_bound(tree.functions, id, {}, &Function::first);
        return at == tree.functions.begin() || std::prev(at)->body < id ? nullptr : &*std::prev(at);
    };
    const StmtId begin = declaration ? declaration->first : 0;
    const StmtId stop = declaration ? declaration->body : static_cast<StmtId>(tree.statements.size()) - 1;
    for (StmtId id = begin; id <= stop; ++id) {
        const Stmt& s = tree.statements[std::size_t(id)];
        if (s.kind != Stmt::Kind::assign || s.declares || functionAt(id) != declaration) continue;
        int input = -1;
        std::string_view target = s.target;
        std::optional<Type> own = inputType(target, &input);
        if (target == "pos" && input < 0) {
            target = "p";
            own = inputType(target, &input);
        }
        if ((input < 0 && target != "p") || names.find(target) >= 0) continue;
        const int slot = newSlot(input < 0 ? Type::vec3 : own, nullptr);
        names.add(input < 0 ? "p" : std::string_view(declared.inputs[std::size_t(input)].first), slot);
        made().captured.emplace_back(slot, input);
    }
}

int Resolver::newSlot(std::optional<Type> own, const Operand* value) {
    const int slot = static_cast<int>(made().slots.size());
    const auto number = std::size_t(slotBase + slot);
    if (own == Type::scalar && number < surfaces.known.size() && surfaces.known[number]) own = Type::surface;
    if (own == Type::scalar && value)
        for (const int source : value->sources) surfaces.flow.emplace_back(source, slotBase + slot);
    known[current].push_back(own.has_value());
    made().slots.push_back({own.value_or(Type::scalar), depth});
    return slot;
}

std::optional<Type> Resolver::slotType(int slot) const {
    return known[current][std::size_t(slot)] ? std::optional(made().slots[std::size_t(slot)].type)
                                             : std::nullopt;
}

/// Refuses functions that call themselves, and calls that are nested too deep.
void Resolver::checkCalls() {
    enum : unsigned char { fresh, open, left };
    std::vector<unsigned char> state(callees.size(), fresh);
    std::vector<int> height(callees.size(), 0);
    std::vector<std::pair<int, std::size_t>> stack{{0, 0}};
    for (int root = 0; root < static_cast<int>(callees.size()); ++root) {
        if (state[std::size_t(root)] != fresh) continue;
        stack.assign(1, {root, 0});
        state[std::size_t(root)] = open;
        while (!stack.empty()) {
            const auto at = std::size_t(stack.back().first);
            if (stack.back().second == callees[at].size()) {
                state[at] = left;
                stack.pop_back();
                continue;
            }
            const auto& [callee, place] = callees[at][stack.back().second];
            const auto next = std::size_t(callee);
            if (state[next] == open) {
                error(place, inQuotes(code.functions[next].name) + " calls itself: use a for loop");
                return;
            }
            if (state[next] == fresh) {
                state[next] = open;
                stack.emplace_back(callee, 0);
                continue;
            }
            height[at] = std::max(height[at], height[next] + 1);
            if (height[at] > kMaxCalls) {
                error(place, "calls are nested deeper than " + std::to_string(kMaxCalls) +
                                 ": put some of them together");
                return;
            }
            ++stack.back().second;
        }
    }
}

// ---- structures

/// return, break, continue: what follows in the innermost structure is not reached.
void Resolver::leaveStructure(Kind kind, Place place) {
    ends.back().push_back(emit({.kind = kind, .place = place}));
}

/// What left the innermost structure for its end goes to `target`.
void Resolver::patchEnds(int target) {
    for (const int at : ends.back()) made().instructions[std::size_t(at)].target = target;
    ends.pop_back();
}

void Resolver::statement(StmtId id) {
    const Stmt& s = tree.statements[std::size_t(id)];
    switch (s.kind) {
        case Stmt::Kind::assign: return s.declares ? declaration(s) : assignment(s);
        case Stmt::Kind::branch: return branch(s);
        case Stmt::Kind::loop: return loop(s);
        case Stmt::Kind::result: return returned(s);
        case Stmt::Kind::block: return block(s);
        case Stmt::Kind::leave:
        case Stmt::Kind::next:
            if (loops == 0) return error(s.place, "'break' and 'continue' belong inside a loop");
            return leaveStructure(s.kind == Stmt::Kind::leave ? Kind::leave : Kind::next, s.place);
        case Stmt::Kind::evaluate: {
            Operand value = expression(s.expression);
            if (value.type == Type::integer) value.type = Type::scalar;
            if (lonely < 0 || (depth == 0 && value.type != slotType(lonely))) {
                lonely = newSlot(value.type, &value);
                made().slots.back().depth = 0;
                emit({.kind = Kind::declare, .count = 1, .index = lonely, .place = s.place});
            } else {
                storeInto(lonely, s, value);
            }
            last = lonely;
            return;
        }
    }
}

void Resolver::block(const Stmt& s) {
    if (!s.declares) names.open();
    for (const StmtId inner : s.body) statement(inner);
    if (!s.declares) names.close();
}

void Resolver::branch(const Stmt& s) {
    condition(expression(s.expression));
    const int begin = emit({.kind = Kind::branch, .place = s.place});
    const Side before{last, ended};
    const auto side = [&](std::size_t which) {
        ends.emplace_back();
        names.open();
        last = kNone, ended = before.ended;
        if (which < s.body.size()) statement(s.body[which]);
        names.close();
        const int at = emit({.kind = which == 0 ? Kind::otherSide : Kind::joined, .place = s.place});
        patchEnds(at);
        return std::pair(Side{last, ended}, at);
    };
    ++depth;
    const auto [first, otherSide] = side(0);
    const auto [second, joined] = side(1);
    --depth;
    made().instructions[std::size_t(begin)].target = otherSide + 1;
    made().instructions[std::size_t(otherSide)].target = joined;
    ends.back().push_back(joined);
    ended = first.ended && second.ended;
    last = lastOf(before, first, second);
}

/// What was assigned last behind two sides: what both assign; else what the one that assigns does, if there
/// is a value where the other one was taken.
int Resolver::lastOf(const Side& before, const Side& first, const Side& second) const {
    if (first.last == kNone && second.last == kNone) return before.last;
    if (first.last == second.last) return first.last;
    const auto gone = [&](int slot) { return slot >= 0 && made().slots[std::size_t(slot)].depth > depth; };
    if (gone(first.last) || gone(second.last)) return kGone;
    if (first.last != kNone && second.last != kNone) return kDepends;
    const int one = first.last == kNone ? second.last : first.last;
    if (one < 0) return one;
    if (one == lonely && before.last != lonely) return kDepends;
    return made().slots[std::size_t(one)].depth > depth ? kGone : one;
}

void Resolver::loop(const Stmt& s) {
    names.open();
    const bool endedBefore = ended;
    statement(s.body[0]);
    const int lastBefore = last;
    const int begin = emit({.kind = Kind::loop, .place = s.place});
    ++depth, ++loops;
    ends.emplace_back();
    Place conditionPlace = s.place;
    if (s.expression.empty()) {
        error(s.place, "the loop has no condition: it would not end");
    } else {
        conditionPlace = tree.expressions[std::size_t(s.expression.first)].place;
        condition(expression(s.expression));
    }
    const int test = emit({.kind = Kind::test, .place = conditionPlace});
    names.open();
    last = kNone;
    statement(s.body[2]);
    const int lastInside = last;
    names.close();
    const int step = emit({.kind = Kind::step, .place = s.place});
    patchEnds(step);
    statement(s.body[1]);
    emit({.kind = Kind::repeat, .index = begin + 1, .place = s.place});
    const int end = emit({.kind = Kind::looped, .place = s.place});
    for (const int at : {begin, test, step}) made().instructions[std::size_t(at)].target = end;
    ends.back().push_back(end);
    --depth, --loops;
    names.close();
    ended = endedBefore;
    last = lastInside == kNone ? lastBefore : lastInside;
    if (last >= 0 && made().slots[std::size_t(last)].depth > depth) last = kGone;
}

void Resolver::returned(const Stmt& s) {
    ended = true;
    if (s.expression.empty()) return error(s.place, "expected a value behind 'return', found none");
    const Operand value = expression(s.expression);
    const bool own = current > 0;
    const std::optional<Type> wanted = own ? std::optional(made().result)
                                       : declared.outputs.size() == 1
                                           ? std::optional(declared.outputs[0].type)
                                           : std::nullopt;
    if (value.type && wanted && !standsFor(*value.type, *wanted))
        error(value.place, "expected " + aType(*wanted) + " to return, found " + aType(*value.type));
    if (value.type && !own && componentCount(*value.type) == 0 && wanted != value.type)
        error(value.place, "expected a number, a vector or a surface to return, found " + aType(*value.type));
    else if (value.type && !own && !wanted) {
        const std::optional<Type> common = returnType ? commonType(*returnType, *value.type) : value.type;
        if (!common)
            error(value.place, "expected " + aType(*returnType) + ", as is returned in line " +
                                   std::to_string(returnPlace.line) + ", found " + aType(*value.type));
        if (!returnType) returnPlace = value.place;
        returnType = common ? common : returnType;
    }
    if (!own) code.returns = true;
    ended = true;
    leaveStructure(Kind::result, s.place);
}

// ---- assignments

void Resolver::declaration(const Stmt& s) {
    if (s.expression.empty()) {
        emit({.kind = Kind::number, .type = s.type, .place = s.place});
    } else {
        const Operand value = expression(s.expression);
        if (value.type && !standsFor(*value.type, s.type))
            error(value.place, "expected " + aType(s.type) + " for " + inQuotes(s.target) + ", found " +
                                   aType(*value.type));
    }
    const int slot = newSlot(s.type, nullptr);
    names.add(s.target, slot);
    if (s.constant) constants.push_back(slot);
    emit({.kind = Kind::declare, .type = s.type, .index = slot, .place = s.place});
    last = slot;
}

void Resolver::assignment(const Stmt& s) {
    std::string_view target = s.target;
    if (target == "pos" && names.find(target) < 0) target = "p";
    const int slot = names.find(target);
    if (slot >= 0 && std::ranges::find(constants, slot) != constants.end())
        return error(s.place, inQuotes(target) + " is const: drop the const, or assign to another name");
    if (!s.swizzle.empty() && slot >= 0) return partialStore(slot, s);
    Operand value{std::nullopt, s.place};
    if (s.operation) {
        if (!pushNamed(target, s.place)) {
            error(s.place, inQuotes(target) + " has no value yet");
            push(std::nullopt, s.place);
        }
        if (s.expression.empty()) {
            element({Expr::Kind::number, s.place, "1", 1.0, true});
        } else {
            operands.push_back(expression(s.expression));
        }
        binary({Expr::Kind::binary, s.place, std::string(1, s.operation)});
        value = pop();
    } else {
        value = expression(s.expression);
    }
    if (!s.swizzle.empty())
        return error(s.place, inQuotes(target) + " has no value yet: assign all of it first");
    if (slot >= 0) {
        storeInto(slot, s, std::move(value));
        last = slot;
        return;
    }
    if (value.type == Type::integer) value.type = Type::scalar;
    const int made_ = newSlot(value.type, &value);
    names.add(s.target, made_);
    emit({.kind = Kind::declare, .count = 1, .index = made_, .place = s.place});
    last = made_;
}

void Resolver::storeInto(int slot, const Stmt& s, Operand value) {
    emit({.kind = Kind::store, .index = slot, .place = s.place});
    const std::optional<Type> own = slotType(slot);
    if (!own) {
        known[current][std::size_t(slot)] = value.type.has_value();
        if (value.type) made().slots[std::size_t(slot)].type = *value.type;
        return;
    }
    if (!value.type) return;
    if (*own == Type::scalar) {
        for (const int source : value.sources) surfaces.flow.emplace_back(source, slotBase + slot);
        if (*value.type == Type::surface) surfaces.given.push_back(slotBase + slot);
    }
    const bool fits = *own == Type::surface ? isNumber(*value.type) : standsFor(*value.type, *own);
    if (!fits)
        error(value.place, "expected " + aType(*own) +
                               (s.target.empty() ? std::string() : ", which " + inQuotes(s.target) + " is") +
                               ", found " + aType(*value.type));
}

/// One swizzle, or one member of a surface, of the variable.
void Resolver::partialStore(int slot, const Stmt& s) {
    const std::optional<Type> own = slotType(slot);
    if (s.operation) {
        pushNamed(s.target, s.place);
        member({Expr::Kind::member, s.place, s.swizzle});
        if (s.expression.empty())
            element({Expr::Kind::number, s.place, "1", 1.0, true});
        else
            operands.push_back(expression(s.expression));
        binary({Expr::Kind::binary, s.place, std::string(1, s.operation)});
    } else {
        operands.push_back(expression(s.expression));
    }
    const Operand value = pop();
    last = slot;
    if (!own) return;
    Type part = Type::scalar;
    if (*own == Type::surface) {
        const auto member_ = surfaceMember(s.swizzle);
        if (!member_)
            return error(s.place, "a surface has no " + inQuotes(s.swizzle) + ": it has " + kSurfaceMembers);
        part = member_->second;
        emit({.kind = Kind::storePart,
              .count = uint8_t(componentCount(part)),
              .type = part,
              .index = member_->first,
              .target = slot,
              .place = s.place});
    } else {
        const bool whole = isVector(*own) || *own == Type::scalar;
        for (std::size_t i = 1; i < s.swizzle.size(); ++i)
            if (s.swizzle.find(s.swizzle[i]) < i)
                return error(s.place, inQuotes("." + s.swizzle) +
                                          " names a component twice: it cannot be assigned to");
        const auto packed = swizzleOf(s.swizzle, whole ? componentCount(*own) : 0);
        if (!packed) return error(s.place, aType(*own) + " has no " + inQuotes("." + s.swizzle));
        part = s.swizzle.size() == 3 ? Type::vec3 : s.swizzle.size() == 2 ? Type::vec2 : Type::scalar;
        emit({.kind = Kind::storeSwizzle,
              .count = uint8_t(s.swizzle.size()),
              .type = part,
              .index = *packed,
              .target = slot,
              .place = s.place});
    }
    if (value.type && !standsFor(*value.type, part))
        error(value.place, "expected " + aType(part) + ", found " + aType(*value.type));
}

// ---- results

void Resolver::finish() {
    const Place end{1, 1};
    const bool damaged = !tree.errors.empty();
    if (declared.outputs.size() > 1) {
        for (const OutputSpec& output : declared.outputs) {
            const int slot = names.find(output.name);
            code.outputs.push_back(slot);
            if (slot < 0 && !damaged) error(end, "the code assigns no " + inQuotes(output.name));
            const std::optional<Type> own = slot < 0 ? std::nullopt : slotType(slot);
            if (own && !standsFor(*own, output.type))
                error(end, "expected " + aType(output.type) + " for " + inQuotes(output.name) + ", found " +
                               aType(*own));
        }
        type = declared.outputs[0].type;
        return names.close();
    }
    const bool wantsAny = declared.outputs.empty();
    type = wantsAny ? returnType.value_or(Type::scalar) : declared.outputs[0].type;
    if (ended) return names.close();
    code.last = last >= 0 ? last : -1;
    const std::optional<Type> own = code.last >= 0 ? slotType(code.last) : std::nullopt;
    if (code.last < 0 && !code.returns && !damaged)
        error(end, last == kGone ? "what the code assigns last lives in a block that has ended: declare it "
                                   "before, or end the code "
                                   "with 'return …;'"
                   : last == kDepends
                       ? "the code does not assign one name on every path: end it with 'return …;'"
                       : "the code has no result: end it with 'return …;' or assign the result last");
    if (own) {
        const std::optional<Type> common = !wantsAny    ? (standsFor(*own, type) ? own : std::nullopt)
                                           : returnType ? commonType(*returnType, *own)
                                                        : own;
        if (wantsAny && componentCount(*own) == 0 && !code.returns)
            error(end, "expected a number, a vector or a surface to return, found " + aType(*own));
        else if (!common && !code.returns)
            error(end, "expected " + aType(type) + " as the result, found " + aType(*own));
        if (!common || componentCount(*own) == 0)
            code.last = -1;
        else if (wantsAny)
            type = *common;
    }
    names.close();
}

Resolved resolve(std::string_view text, const Declared& declared) {
    const Tree tree = parse(text);
    SurfaceSlots surfaces;
    Resolved resolved;
    for (int pass = 0; pass < 2; ++pass) {
        Resolver resolver(tree, declared, surfaces);
        resolver.run();
        if (pass == 0 && surfaces.follow(resolver.slotCount())) continue;
        assert(surfaces.given.empty() && "following the flow finds every name of a surface");
        resolved.errors = tree.errors;
        resolved.errors.insert(resolved.errors.end(), resolver.errors.begin(), resolver.errors.end());
        resolved.type = resolver.type;
        if (resolved.errors.empty()) resolved.code = std::make_shared<const Code>(std::move(resolver.code));
        break;
    }
    std::ranges::stable_sort(resolved.errors, [](const Error& a, const Error& b) {
        return std::pair(a.codeLine, a.codeColumn) < std::pair(b.codeLine, b.codeColumn);
    });
    if (resolved.errors.size() > kMaxCodeErrors) resolved.errors.resize(kMaxCodeErrors);
    return resolved;
}

}  // namespace fw::language
