#include "graph/ir/common_form.h"

#include <algorithm>
#include <cmath>

namespace fw {

namespace {

constexpr std::size_t kMostChoices = 4;   // for each a value that is computed for all rows
constexpr std::size_t kLongChoice = 5;    // operations from which on two values are not computed in each row
constexpr std::size_t kMostDepth = 2000;  // of recursion

uint64_t mixed(uint64_t hash, uint64_t word) {
    hash = (hash ^ word) * 0x9e3779b97f4a7c15u;
    return hash ^ hash >> 29;
}

/// The value as scale * base + shift, which are the same bits.
struct Parts {
    IrId base;
    double scale = 1, shift = 0;
};

Parts withoutShift(const Ir& ir, IrId id) {
    const IrNode& node = ir[id];
    if (node.op != Op::add && node.op != Op::subtract) return {id};
    const double sign = node.op == Op::add ? 1 : -1;
    if (ir.isConstant(node.operands[1])) return {node.operands[0], 1, sign * ir.number(node.operands[1])};
    if (ir.isConstant(node.operands[0])) return {node.operands[1], sign, ir.number(node.operands[0])};
    return {id};
}

bool isPowerOfTwo(double x) {
    int exponent;
    return std::abs(std::frexp(x, &exponent)) == 0.5;
}

/// Factors are taken together if all but one only change the exponent.
Parts withoutScale(const Ir& ir, Parts parts) {
    for (;;) {
        const IrNode& node = ir[parts.base];
        if (node.op == Op::negate) {
            parts = {node.operands[0], -parts.scale, parts.shift};
            continue;
        }
        if (node.op != Op::multiply) return parts;
        const int number = ir.isConstant(node.operands[0]) ? 0 : 1;
        if (!ir.isConstant(node.operands[number])) return parts;
        const double factor = ir.number(node.operands[number]);
        if (!isPowerOfTwo(parts.scale) && !isPowerOfTwo(factor)) return parts;
        parts = {node.operands[1 - number], parts.scale * factor, parts.shift};
    }
}

bool isPosition(Op op) { return op == Op::positionX || op == Op::positionY || op == Op::positionZ; }

Likeness likenessOf(const Ir& ir, IrId id, const std::vector<Likeness>& all) {
    constexpr uint64_t kLinear = 1, kNumber = 2;
    const IrNode& node = ir[id];
    if (node.op == Op::constant) return {kNumber, kNumber};
    if (isPosition(node.op)) return {kLinear, mixed(0, uint64_t(node.op)), true};
    const IrId base = withoutScale(ir, withoutShift(ir, id)).base;
    if (base != id) return all[base];
    const auto of = [&](int i) -> const Likeness& { return all[node.operands[i]]; };
    Likeness likeness;
    likeness.loose = likeness.strict = mixed(0, uint64_t(node.op));
    if (ownsNumber(node.op)) likeness.loose = likeness.strict = mixed(likeness.loose, uint64_t(node.number));
    const int arity = opInfo(node.op).arity;
    for (uint64_t Likeness::*kind : {&Likeness::loose, &Likeness::strict}) {
        std::array<uint64_t, kMaxArity> words{};
        for (int i = 0; i < arity; ++i) words[i] = of(i).*kind;
        if (opInfo(node.op).commutative && words[1] < words[0]) std::swap(words[0], words[1]);
        for (int i = 0; i < arity; ++i) likeness.*kind = mixed(likeness.*kind, words[i]);
    }
    likeness.linear = (node.op == Op::add || node.op == Op::subtract) && of(0).linear && of(1).linear;
    if (likeness.linear) likeness.loose = kLinear;
    return likeness;
}

}  // namespace

std::vector<Likeness> likenesses(const Ir& ir, const std::vector<bool>& needed) {
    std::vector<Likeness> all(ir.size());
    for (IrId id = 0; id < ir.size(); ++id)
        if (needed[id]) all[id] = likenessOf(ir, id, all);
    return all;
}

bool CommonFormFinder::find(const std::vector<IrId>& values) {
    const std::optional<IrId> found = form(values);
    if (found) roots.push_back(*found);
    return found.has_value();
}

std::optional<IrId> CommonFormFinder::form(const Row& row) {
    if (std::ranges::all_of(row, [&](IrId id) { return id == row[0]; })) return row[0];
    if (const auto before = forms.find(row); before != forms.end()) return before->second;
    if (steps.size() > mostSteps || depth > kMostDepth) return std::nullopt;
    ++depth;
    std::optional<IrId> found;
    if (std::ranges::all_of(row, [&](IrId id) { return ir.isConstant(id); })) {
        std::vector<double> column;
        for (const IrId id : row) column.push_back(ir.number(id));
        found = numbers(column, ir.origin(row[0]));
    }
    if (!found) found = sum(row);
    if (!found && row.size() >= kMostChoices && isLong(row[0])) found = choice(row, 2);
    if (!found) found = operation(row);
    if (!found) found = choice(row, kMostChoices);
    --depth;
    return forms[row] = found;
}

/// Where some have a factor or a term that is a number: a product and sum of columns.
std::optional<IrId> CommonFormFinder::sum(const Row& row) {
    std::vector<Parts> parts;
    for (const IrId id : row) parts.push_back(withoutShift(ir, id));
    const bool shifted = std::ranges::any_of(parts, [](const Parts& of) { return of.shift != 0; });
    if (!shifted || std::ranges::any_of(parts, [](const Parts& of) { return of.scale != 1; }))
        for (Parts& of : parts) of = withoutScale(ir, of);
    Row bases;
    std::vector<double> scales, shifts;
    for (const Parts& of : parts) {
        bases.push_back(of.base);
        scales.push_back(of.scale);
        shifts.push_back(of.shift);
    }
    if (bases == row) return std::nullopt;
    const auto differs = [](const std::vector<double>& of, double from) {
        return std::ranges::any_of(of, [&](double x) { return x != from; });
    };
    const uint32_t origin = ir.origin(row[0]);
    std::optional<IrId> value = form(bases);
    if (value && differs(scales, 1))
        value = step({Op::multiply, 0, {*value, numbers(scales, origin)}, origin});
    if (!value || !differs(shifts, 0)) return value;
    // As in the first one.
    const bool less = ir[row[0]].op == Op::subtract && ir.isConstant(ir[row[0]].operands[1]);
    if (less)
        for (double& shift : shifts) shift = -shift;
    return step({less ? Op::subtract : Op::add, 0, {*value, numbers(shifts, origin)}, origin});
}

/// The first one's operation, its operands in the order they have there: where a device fuses a product with
/// a sum, that is which.
std::optional<IrId> CommonFormFinder::operation(const Row& row) {
    const IrNode& first = ir[row[0]];
    const int arity = opInfo(first.op).arity;
    if (arity == 0 || std::ranges::any_of(row, [&](IrId id) {
            return ir[id].op != first.op || (ownsNumber(first.op) && ir[id].number != first.number);
        }))
        return std::nullopt;
    std::array<Row, kMaxArity> operands;
    for (const IrId id : row) {
        const std::array<int, kMaxArity> order = orderOf(ir[id]);
        for (int i = 0; i < arity; ++i) operands[i].push_back(ir[id].operands[order[i]]);
    }
    Step made{first.op, ownsNumber(first.op) ? first.number : 0, {}, ir.origin(row[0])};
    for (int i = 0; i < arity; ++i) {
        const std::optional<IrId> operand = form(operands[i]);
        if (!operand) return std::nullopt;
        made.operands[std::size_t(orderOf(first)[std::size_t(i)])] = *operand;
    }
    return step(made);
}

/// One of a few values, by its number.
std::optional<IrId> CommonFormFinder::choice(const Row& row, std::size_t most) {
    if (std::ranges::any_of(row, [&](IrId id) { return opInfo(ir[id].op).boolean; })) return std::nullopt;
    Row among;
    std::vector<double> which;
    for (const IrId id : row) {
        const auto place = std::ranges::find(among, id);
        which.push_back(double(place - among.begin()));
        if (place == among.end()) among.push_back(id);
        if (among.size() > most) return std::nullopt;
    }
    const uint32_t origin = ir.origin(row[0]);
    const IrId column = numbers(which, origin);
    IrId value = among.back();
    for (std::size_t i = among.size() - 1; i-- > 0;) {
        const IrId end = step({Op::constant, double(i) + 0.5, {}, origin});
        value = step({Op::select, 0, {step({Op::less, 0, {column, end}, origin}), among[i], value}, origin});
    }
    return value;
}

/// A column, or the number that is the same in all rows.
IrId CommonFormFinder::numbers(std::span<const double> of, uint32_t origin) {
    std::vector<float> column(of.begin(), of.end());
    if (std::ranges::all_of(column, [&](float x) { return x == column[0]; }))
        return step({Op::constant, of[0], {}, origin});
    const auto same = std::ranges::find(columns, column);
    const auto place = same - columns.begin();
    if (same == columns.end()) columns.push_back(std::move(column));
    return step({Op::column, double(place), {}, origin});
}

IrId CommonFormFinder::step(const Step& of) {
    const auto [entry, isNew] = known.try_emplace(of.key(), IrId(ir.size() + steps.size()));
    if (isNew) steps.push_back(of);
    return entry->second;
}

/// Of a commutative operation, operands that are alike in all rows come at the same place.
std::array<int, kMaxArity> CommonFormFinder::orderOf(const IrNode& node) const {
    const auto rank = [&](int i) {
        const Likeness& of = likeness[node.operands[i]];
        return std::pair(of.loose, of.strict);
    };
    if (opInfo(node.op).commutative && rank(1) < rank(0)) return {1, 0, 2, 3};
    return {0, 1, 2, 3};
}

bool CommonFormFinder::isLong(IrId id) const {
    std::vector<IrId> met{id};
    for (std::size_t i = 0; i < met.size() && met.size() <= 2 * kLongChoice; ++i)
        for (int k = 0; k < opInfo(ir[met[i]].op).arity; ++k) {
            const IrId operand = ir[met[i]].operands[k];
            if (opInfo(ir[operand].op).arity > 0 && std::ranges::find(met, operand) == met.end())
                met.push_back(operand);
        }
    return met.size() >= kLongChoice;
}

/// Which steps the forms that were found need; others are left from tries.
std::vector<bool> CommonFormFinder::used() const {
    std::vector<bool> needed(steps.size());
    const auto need = [&](IrId id) {
        if (id >= ir.size()) needed[id - ir.size()] = true;
    };
    std::ranges::for_each(roots, need);
    for (std::size_t i = steps.size(); i-- > 0;)
        for (int k = 0; needed[i] && k < opInfo(steps[i].op).arity; ++k) need(steps[i].operands[k]);
    return needed;
}

std::size_t CommonFormFinder::size() const {
    const std::vector<bool> needed = used();
    std::size_t count = 0;
    for (std::size_t i = 0; i < steps.size(); ++i) count += needed[i] && opInfo(steps[i].op).arity > 0;
    return count;
}

std::size_t CommonFormFinder::weight() const {
    const std::vector<bool> needed = used();
    std::size_t sum = 0;
    for (std::size_t i = 0; i < steps.size(); ++i)
        if (needed[i]) sum += std::size_t(opInfo(steps[i].op).weight);
    return sum;
}

CommonForm CommonFormFinder::addTo(Ir& to, uint32_t firstColumn) const {
    CommonForm result;
    const IrId before = IrId(ir.size());
    const std::vector<bool> needed = used();
    std::vector<IrId> made(steps.size());
    std::map<double, uint32_t> places;  // of the columns that are needed
    const auto takeIn = [&](IrId id) {
        if (!to.isConstant(id) && std::ranges::find(result.inputs, id) == result.inputs.end())
            result.inputs.push_back(id);
    };
    const uint32_t asker = to.setOrigin(0);
    for (std::size_t i = 0; i < steps.size(); ++i) {
        if (!needed[i]) continue;
        Step of = steps[i];
        if (of.op == Op::column) {
            const auto [entry, isNew] = places.try_emplace(of.number, uint32_t(result.columns.size()));
            if (isNew) result.columns.push_back(columns[std::size_t(of.number)]);
            of.number = firstColumn + entry->second;
        }
        to.setOrigin(of.origin);
        const int arity = opInfo(of.op).arity;
        for (int k = 0; k < arity; ++k) {
            IrId& operand = of.operands[k];
            if (operand >= before)
                operand = made[operand - before];
            else
                takeIn(operand);
        }
        made[i] = of.op == Op::constant
                      ? to.constant(of.number)
                      : to.addAsIs(of.op, of.number, std::span(of.operands).first(std::size_t(arity)));
        if (arity > 0) result.steps.push_back(made[i]);
    }
    to.setOrigin(asker);
    for (const IrId root : roots) {
        if (root < before) takeIn(root);
        result.values.push_back(root >= before ? made[root - before] : root);
    }
    return result;
}

}  // namespace fw
