// Branches, loops and ?: of checked code, and what they do with its variables.
#include <algorithm>
#include <unordered_map>

#include "graph/language/run.h"

namespace fw::language {

using Kind = Instruction::Kind;

void Run::conditional(Frame& frame, const Instruction& i) {
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
        if (ir.isConstant(condition)) {
            // What was taken is as wide as what was not; a float may stand for a surface.
            if (i.type != Type::surface)
                stack.back() = checked(convert(state, stack.back(), i.type), i.place);
            return;
        }
        const Value no = pop(), yes = pop();
        stack.push_back(checked(choose(state, condition, yes, no), i.place));
    }
}

Structure* Run::innermost(Frame& frame) {
    for (auto s = frame.structures.rbegin(); s != frame.structures.rend(); ++s)
        if (!s->known) return &*s;
    return nullptr;
}

void Run::assign(Frame& frame, int slot, std::optional<Value> value) {
    const auto at = std::size_t(slot);
    Structure* inside = innermost(frame);
    if (inside && frame.function->slots[at].depth < inside->depth &&
        frame.logged[at] < static_cast<int>(inside->log)) {
        frame.log.push_back({slot, frame.slots[at], frame.logged[at]});
        frame.logged[at] = static_cast<int>(frame.log.size()) - 1;
    }
    frame.slots[at] = std::move(value);
}

std::vector<Change> Run::takeChanges(Frame& frame, std::size_t from) {
    std::vector<Change> changes(std::make_move_iterator(frame.log.begin() + std::ptrdiff_t(from)),
                                std::make_move_iterator(frame.log.end()));
    frame.log.resize(from);
    for (auto change = changes.rbegin(); change != changes.rend(); ++change)
        frame.logged[std::size_t(change->slot)] = change->logged;
    return changes;
}

void Run::store(Frame& frame, const Instruction& i) {
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
    if (i.kind == Kind::storePart && i.index == transmissionComponent)
        state.transmissions += !state.ir.isConstant(whole.ids[transmissionComponent], 0.0);
    assign(frame, slot, std::move(whole));
}

void Run::skipUnreached(Frame& frame, const Instruction& i) {
    if (ir.isConstant(frame.live, 0.0)) frame.at = std::size_t(i.target);
}

void Run::branch(Frame& frame, const Instruction& i) {
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

void Run::join(Frame& frame, const Structure& done, Place place) {
    const bool firstEnds = ir.isConstant(done.firstLive, 0.0), secondEnds = ir.isConstant(frame.live, 0.0);
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

Structure& Run::loopOf(Frame& frame) {
    return *std::find_if(frame.structures.rbegin(), frame.structures.rend(),
                         [](const Structure& s) { return s.loops; });
}

void Run::loop(Frame& frame, const Instruction& i) {
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
            fail(i.place,
                 "the loop's bounds must be known when the graph is compiled: numbers, or inputs that are "
                 "not linked or live");
        own.firstBegan = frame.live;
        own.departures = own.left.size() + frame.returns;
        if (ir.isConstant(condition, 0.0)) frame.at = std::size_t(i.target);
    } else if (i.kind == Kind::step) {
        const std::vector<Exit> skipped = std::move(own.skipped);
        own.skipped.clear();
        rejoin(frame, own, skipped, i.place);
        if (!skipped.empty() && own.departures == own.left.size() + frame.returns)
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

void Run::rejoin(Frame& frame, const Structure& own, const std::vector<Exit>& exits, Place place) {
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
            if (!then)
                fail(place,
                     "some places leave the loop before it gives a result: end the code with a return");
            step(place);
            now = alone || !now ? *then : checked(choose(state, exit.condition, *then, *now), place);
        }
        frame.live = ir.add(Op::logicalOr, frame.live, exit.condition);
    }
}

void Run::depart(Frame& frame, const Instruction& i) {
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
            step(i.place), step(i.place);  // values are large
            exit.values.emplace_back(slot, *frame.slots[std::size_t(slot)]);
        }
        (i.kind == Kind::leave ? loop.left : loop.skipped).push_back(std::move(exit));
    }
    frame.live = ir.constant(0.0);
    frame.at = std::size_t(i.target);
}

}  // namespace fw::language
