#include "graph/ir/affine_sums.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

namespace fw {

namespace {

constexpr double kCancelled = 1e-15;  ///< of the largest: what rounding leaves of a sum that is nought

/// Factors of x, y and z, and what is added.
using AffineForm = std::array<double, 4>;

class AffineWriter {
  public:
    AffineWriter(Ir& ir_, std::span<const IrId> roots)
        : ir(ir_), count(ir_.size()), needed(count), sums(count), used(count), there(count) {
        for (const IrId root : roots) needed[root] = used[root] = true;
        for (auto id = static_cast<IrId>(count); id-- > 0;)
            if (needed[id])
                for (const IrId operand : operandsOf(id)) needed[operand] = true;
        for (IrId id = 0; id < count; ++id)
            if (needed[id]) sums[id] = formOf(id);
        for (IrId id = 0; id < count; ++id)
            if (needed[id] && !sums[id])
                for (const IrId operand : operandsOf(id)) used[operand] = true;
    }

    void run(std::span<IrId> roots) {
        std::vector<IrId> now(count);
        for (IrId id = 0; id < count; ++id) {
            now[id] = id;
            if (id < 3 || !needed[id]) continue;
            const uint32_t before = ir.setOrigin(ir.origin(id));
            now[id] = isShorter(id) ? write(*sums[id]) : again(id, now);
            ir.setOrigin(before);
        }
        for (IrId& root : roots) root = now[root];
    }

  private:
    std::span<const IrId> operandsOf(IrId id) const {
        return std::span(ir[id].operands).first(std::size_t(opInfo(ir[id].op).arity));
    }

    std::optional<AffineForm> formOf(IrId id) const {
        const IrNode& node = ir[id];
        if (node.op == Op::constant) return AffineForm{0, 0, 0, node.number};
        if (id < 3) return AffineForm{id == 0 ? 1.0 : 0.0, id == 1 ? 1.0 : 0.0, id == 2 ? 1.0 : 0.0, 0};
        const auto known = [&](int i) { return sums[node.operands[std::size_t(i)]]; };
        const auto sum = [](const AffineForm& a, double s, const AffineForm& b, double t) {
            AffineForm result;
            for (std::size_t i = 0; i < 4; ++i) {
                const double p = s * a[i], q = t * b[i];
                result[i] = std::abs(p + q) > kCancelled * std::max(std::abs(p), std::abs(q)) ? p + q : 0.0;
            }
            return result;
        };
        switch (node.op) {
            case Op::negate: return known(0) ? std::optional(sum(*known(0), -1, {}, 0)) : std::nullopt;
            case Op::add:
            case Op::subtract:
                if (!known(0) || !known(1)) return std::nullopt;
                return sum(*known(0), 1, *known(1), node.op == Op::add ? 1 : -1);
            case Op::multiply:
                for (int i : {0, 1})
                    if (known(i) && ir.isConstant(node.operands[std::size_t(1 - i)]))
                        return sum(*known(i), ir.number(node.operands[std::size_t(1 - i)]), {}, 0);
                return std::nullopt;
            default: return std::nullopt;
        }
    }

    /// Whether writing the value out takes fewer operations than those that it is made from and that nothing
    /// before it has asked for. What it then is made from is there for those after it.
    bool isShorter(IrId id) {
        if (!sums[id] || !used[id] || there[id] || ir.isConstant(id)) return false;
        std::vector<IrId> cone{id};
        there[id] = true;
        for (std::size_t i = 0; i < cone.size(); ++i)
            for (const IrId operand : operandsOf(cone[i]))
                if (operand >= 3 && !ir.isConstant(operand) && !there[operand])
                    there[operand] = true, cone.push_back(operand);
        AffineForm linear = *sums[id];
        std::size_t operations = std::exchange(linear[3], 0.0) != 0.0;
        if (!written.contains(linear)) {
            const auto terms = std::ranges::count_if(linear, [](double f) { return f != 0.0; });
            const auto scaled =
                std::ranges::count_if(linear, [](double f) { return f != 0.0 && std::abs(f) != 1.0; });
            operations += std::size_t(terms + scaled - 1);
        }
        const bool finite = std::ranges::all_of(*sums[id], [](double f) { return std::abs(f) < kMaxFactor; });
        if (!finite || operations >= cone.size()) return false;
        for (const IrId left : cone) there[left] = left == id;
        written.insert(linear);
        return true;
    }

    /// Terms are added whatever their signs, so that members of families stay alike.
    IrId write(const AffineForm& form) {
        IrId sum = ir.constant(0.0);
        for (int axis = 0; axis < 3; ++axis)
            sum = ir.add(Op::add, sum,
                         ir.add(Op::multiply, ir.position(axis), ir.constant(form[std::size_t(axis)])));
        return ir.add(Op::add, sum, ir.constant(form[3]));
    }

    /// The operation of `id` on what its operands are now.
    IrId again(IrId id, const std::vector<IrId>& now) {
        const IrNode node = ir[id];
        std::array<IrId, kMaxArity> operands = node.operands;
        const auto arity = std::size_t(opInfo(node.op).arity);
        for (std::size_t i = 0; i < arity; ++i) operands[i] = now[operands[i]];
        if (operands == node.operands) return id;
        return ir.again(id, std::span<const IrId>(operands.data(), arity));
    }

    Ir& ir;
    const std::size_t count;
    std::vector<bool> needed;
    std::vector<std::optional<AffineForm>> sums;  ///< of what is affine
    std::vector<bool> used;                       ///< by what is not
    std::vector<bool> there;
    std::set<AffineForm> written;  ///< without what is added
};

std::size_t operationsOf(const Ir& ir, std::span<const IrId> roots) {
    std::vector<bool> needed(ir.size());
    for (const IrId root : roots) needed[root] = true;
    std::size_t operations = 0;
    for (auto id = static_cast<IrId>(ir.size()); id-- > 0;) {
        if (!needed[id]) continue;
        operations += !ir.isConstant(id);
        for (int i = 0; i < opInfo(ir[id].op).arity; ++i) needed[ir[id].operands[std::size_t(i)]] = true;
    }
    return operations;
}

}  // namespace

void writeOutAffine(Ir& ir, std::span<IrId> roots) {
    std::vector<IrId> after(roots.begin(), roots.end());
    AffineWriter(ir, roots).run(after);
    // Each value alone is made shorter; what it shared with others may have been needed all the same.
    if (operationsOf(ir, after) < operationsOf(ir, roots)) std::ranges::copy(after, roots.begin());
}

}  // namespace fw
