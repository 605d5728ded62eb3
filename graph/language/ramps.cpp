#include "graph/language/ramps.h"

#include <algorithm>

#include "graph/base/words.h"

namespace fw::language {

namespace {

constexpr double kLeastWidth = 1e-12;  // that a piece is divided by

/// A list of stops or points as ids, and the arithmetic on them.
struct Ramp {
    Ir& ir;
    IrId x;  ///< what the ramp is asked for
    std::size_t size, count;
    std::vector<IrId> numbers = {};

    Ramp(Lowering& state, const Value& at, const Value& list)
        : ir(state.ir),
          x(at.ids[0]),
          size(std::size_t(entrySize(list.type))),
          count(list.points->size() / size),
          numbers(list.livePoints) {
        if (numbers.empty())
            for (const double number : *list.points) numbers.push_back(ir.constant(number));
    }

    IrId at(std::size_t i) const { return numbers[size * i]; }
    IrId value(std::size_t i, std::size_t channel) const { return numbers[size * i + 1 + channel]; }
    IrId number(double value) const { return ir.constant(value); }
    IrId add(IrId a, IrId b) const { return ir.add(Op::add, a, b); }
    IrId minus(IrId a, IrId b) const { return ir.add(Op::subtract, a, b); }
    IrId times(IrId a, IrId b) const { return ir.add(Op::multiply, a, b); }
    IrId least(IrId a, IrId b) const { return ir.add(Op::minimum, a, b); }
    IrId most(IrId a, IrId b) const { return ir.add(Op::maximum, a, b); }
    IrId choose(IrId condition, IrId a, IrId b) const { return ir.add(Op::select, condition, a, b); }
    IrId isBefore(IrId place) const { return ir.add(Op::less, x, place); }

    /// Whether the piece that begins at this stop is known to be a jump.
    bool jumps(std::size_t i) const {
        return ir.isConstant(at(i)) && ir.isConstant(at(i + 1)) && ir.number(at(i)) == ir.number(at(i + 1));
    }
    /// Of the piece that begins at this stop, never 0.
    IrId width(std::size_t i) const { return most(minus(at(i + 1), at(i)), number(kLeastWidth)); }

    /// How far along its piece x is: 0 at this stop and before, 1 at the next and behind.
    IrId share(std::size_t i) const {
        const IrId t = ir.isConstant(width(i))
                           ? times(minus(x, at(i)), ir.add(Op::divide, number(1.0), width(i)))
                           : ir.add(Op::divide, minus(x, at(i)), width(i));
        return least(most(t, number(0.0)), number(1.0));
    }

    /// What the jump that begins at this stop gives: it is the first piece, the last, or the only one.
    IrId jump(std::size_t i, std::size_t channel) const {
        if (count == 2) return choose(isBefore(at(i)), value(i, channel), value(i + 1, channel));
        return value(i == 0 ? i : i + 1, channel);
    }

    /// Of those pieces the one that x lies in; each ends where the stop behind it lies.
    template <class Piece>
    IrId oneOf(std::span<const std::size_t> those, const Piece& piece) const {
        if (those.size() == 1) return piece(those[0]);
        const std::size_t half = (those.size() + 1) / 2;
        const IrId before = oneOf(those.first(half), piece), after = oneOf(those.subspan(half), piece);
        return choose(isBefore(at(those[half - 1] + 1)), before, after);
    }
    /// The piece that x lies in, of so many. Those of no width are left out, for a box about the place would
    /// count them; but not the ends.
    template <class Piece>
    IrId pieces(std::size_t all, const Piece& piece) const {
        std::vector<std::size_t> those;
        for (std::size_t i = 0; i < all; ++i)
            if (i == 0 || i + 1 == all || !jumps(i)) those.push_back(i);
        return oneOf(std::span<const std::size_t>(those), piece);
    }

    IrId constant(std::size_t channel) const {
        return pieces(count, [&](std::size_t i) { return value(i, channel); });
    }

    /// Straight from stop to stop; `eased` begins and ends slowly, `endless` goes on beyond the ends.
    IrId linear(std::size_t channel, bool eased, bool endless) const {
        if (count == 1) return value(0, channel);
        return pieces(count - 1, [&](std::size_t i) {
            const IrId a = value(i, channel), b = value(i + 1, channel);
            if (a == b) return a;
            if (jumps(i)) return jump(i, channel);
            if (eased) {
                const IrId t = share(i), slow = minus(number(3.0), times(number(2.0), t));
                const IrId s = least(times(ir.add(Op::square, t), slow), number(1.0));
                return add(a, times(minus(b, a), s));
            }
            const IrId steep = ir.add(Op::divide, minus(b, a), width(i));
            const bool first = endless && i == 0, last = endless && i + 2 == count;
            IrId place = x;
            if (last && !first) place = most(place, at(i));
            if (first && !last) place = least(place, at(i + 1));
            const IrId y = add(a, times(steep, minus(place, at(i))));
            // Cut off by what it gives rather than by where it is asked: so it gives just that at the ends.
            return first || last ? y : most(least(y, most(a, b)), least(a, b));
        });
    }

    IrId secant(std::size_t i) const {
        return ir.add(Op::divide, minus(value(i + 1, 0), value(i, 0)), width(i));
    }

    /// Slope of the smooth curve at a point.
    IrId slope(std::size_t i) const {
        const bool left = i > 0 && !jumps(i - 1), right = i + 1 < count && !jumps(i);
        if (!left && !right) return number(0.0);
        if (!left) return secant(i);
        if (!right) return secant(i - 1);
        const IrId a = secant(i - 1), b = secant(i);
        const IrId limit = times(number(3.0), least(ir.add(Op::absolute, a), ir.add(Op::absolute, b)));
        const IrId mean = times(number(0.5), add(a, b));
        const IrId kept = most(least(mean, limit), ir.add(Op::negate, limit));
        return choose(ir.add(Op::less, number(0.0), times(a, b)), kept, number(0.0));
    }

    IrId smooth(bool endless) const {
        if (count == 1) return value(0, 0);
        IrId result = pieces(count - 1, [&](std::size_t i) {
            if (jumps(i)) return jump(i, 0);
            const IrId a = value(i, 0), b = value(i + 1, 0), rise = minus(b, a);
            const IrId m = times(slope(i), width(i)), n = times(slope(i + 1), width(i));
            const IrId second = minus(times(number(3.0), rise), add(add(m, m), n));
            const IrId third = minus(add(m, n), add(rise, rise));
            const IrId t = share(i);
            const IrId y = add(a, times(t, add(m, times(t, add(second, times(t, third))))));
            return most(least(y, most(a, b)), least(a, b));
        });
        if (!endless) return result;
        // The tangents at both ends, each of which is 0 within the curve.
        const IrId below = least(minus(x, at(0)), number(0.0)),
                   above = most(minus(x, at(count - 1)), number(0.0));
        const IrId before = add(value(0, 0), times(slope(0), below)),
                   after = add(value(count - 1, 0), times(slope(count - 1), above));
        return choose(isBefore(at(0)), before, choose(isBefore(at(count - 1)), result, after));
    }
};

/// The text of the node's argument, one of its choices; the first if it was left out.
Result<std::string> choiceOf(std::string_view node, std::span<const Value> arguments, std::size_t index) {
    const std::vector<std::string>& choices = findNodeType(node)->inputs.at(index).options;
    if (index >= arguments.size()) return choices.front();
    const std::string& text = arguments[index].text;
    if (std::ranges::find(choices, text) != choices.end()) return text;
    return Error{.message = "argument " + std::to_string(index + 1) + " of '" + std::string(node) +
                            "': " + inQuotes(text) + " is not one of its choices: " + listed(choices)};
}

std::optional<Error> problemOf(const Value& list) {
    if (auto problem = orderProblem(list.type, *list.points)) return Error{.message = std::move(*problem)};
    return {};
}

}  // namespace

Result<Value> colorRamp(Lowering& state, std::span<const Value> arguments) {
    if (auto problem = problemOf(arguments[1])) return *problem;
    const Result<std::string> how = choiceOf("color_ramp", arguments, 2);
    if (!how) return how.error();
    const Ramp ramp(state, arguments[0], arguments[1]);
    Value result{Type::vec3};
    for (std::size_t c = 0; c < 3; ++c)
        result.ids[c] = *how == "constant" ? ramp.constant(c) : ramp.linear(c, *how == "smooth", false);
    return result;
}

Result<Value> curveThrough(Lowering& state, std::span<const Value> arguments) {
    if (auto problem = problemOf(arguments[1])) return *problem;
    const Result<std::string> how = choiceOf("curve", arguments, 2);
    if (!how) return how.error();
    const Result<std::string> ends = choiceOf("curve", arguments, 3);
    if (!ends) return ends.error();
    const Ramp ramp(state, arguments[0], arguments[1]);
    const bool endless = *ends == "linear";
    Value result{Type::scalar};
    result.ids[0] = *how == "smooth" ? ramp.smooth(endless) : ramp.linear(0, false, endless);
    return result;
}

}  // namespace fw::language
