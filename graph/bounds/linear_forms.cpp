#include "graph/bounds/linear_forms.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fw {

namespace {

constexpr std::size_t kMaxRows = 24, kMaxColumns = 12;
constexpr double kSmallestPivot = 1e-5;  ///< of rows scaled to a largest factor of 1
constexpr double kZeroFactor = 1e-13, kFormSlack = 1e-9;
constexpr double kAsGood = 0.999, kNearerScale = 0.9;
constexpr double kFactorSlack = 1e-11;  ///< of a form of a basis

struct Row {
    std::array<double, kMaxColumns> factors{};   ///< of the unbounded atoms
    std::array<double, kMaxRows> multipliers{};  ///< of the given forms, whose sum this row is
};

void addMultiple(Row& to, const Row& from, double factor) {
    for (std::size_t i = 0; i < kMaxColumns; ++i) to.factors[i] += factor * from.factors[i];
    for (std::size_t i = 0; i < kMaxRows; ++i) to.multipliers[i] += factor * from.multipliers[i];
}
void scale(Row& row, double factor) {
    for (double& value : row.factors) value *= factor;
    for (double& value : row.multipliers) value *= factor;
}

}  // namespace

LinearForm sum(const LinearForm& a, const LinearForm& b, double factorOfB) {
    LinearForm result{.terms = {}, .constant = a.constant + factorOfB * b.constant};
    auto i = a.terms.begin(), j = b.terms.begin();
    while (i != a.terms.end() || j != b.terms.end()) {
        if (j == b.terms.end() || (i != a.terms.end() && i->atom < j->atom)) {
            result.terms.push_back(*i++);
        } else if (i == a.terms.end() || j->atom < i->atom) {
            result.terms.push_back({j->atom, factorOfB * j->factor});
            ++j;
        } else {
            const double factor = i->factor + factorOfB * j->factor;
            // What cancels but for rounding is nothing.
            if (std::abs(factor) > 1e-14 * std::abs(i->factor)) result.terms.push_back({i->atom, factor});
            ++i, ++j;
        }
    }
    return result;
}

LinearForm substitute(const LinearForm& form, std::span<const Replacement> replacements) {
    LinearForm result{.terms = {}, .constant = form.constant};
    for (const LinearForm::Term& term : form.terms) {
        const auto found = std::ranges::find(replacements, term.atom, &Replacement::first);
        const LinearForm own{.terms = {{term.atom, 1.0}}, .constant = 0.0};
        result = sum(result, found == replacements.end() ? own : found->second, term.factor);
    }
    return result;
}

Interval rangeOver(const LinearForm& form, std::span<const Interval> atoms) {
    Interval total{form.constant, form.constant};
    double lowerSize = std::abs(form.constant), upperSize = lowerSize;
    for (const LinearForm::Term& term : form.terms) {
        const Interval part = Interval{term.factor, term.factor} * atoms[term.atom];
        total = total + part;
        lowerSize += std::abs(part.lo), upperSize += std::abs(part.hi);
    }
    return {total.lo > -kHuge ? total.lo - kFactorSlack * lowerSize : -kHuge,
            total.hi < kHuge ? total.hi + kFactorSlack * upperSize : kHuge};
}

Interval solveForTerm(const LinearForm& form, IrId atom, Interval range, std::span<const Interval> atoms) {
    LinearForm rest{.terms = {}, .constant = form.constant};
    double factor = 1.0;
    for (const LinearForm::Term& term : form.terms) {
        if (term.atom == atom)
            factor = term.factor;
        else
            rest.terms.push_back(term);
    }
    const Interval result = (range - rangeOver(rest, atoms)) / Interval{factor, factor};
    return {result.lo > -kHuge ? result.lo - kFactorSlack * std::abs(result.lo) : -kHuge,
            result.hi < kHuge ? result.hi + kFactorSlack * std::abs(result.hi) : kHuge};
}

LinearBasis basisOf(std::span<const LinearForm> forms, std::span<const IrId> atoms) {
    constexpr std::size_t kDimensions = 3;
    if (atoms.size() > kDimensions) return {};
    using Row = std::array<double, kDimensions>;
    const auto rowOf = [&](const LinearForm& form) {
        Row row{};
        for (const LinearForm::Term& term : form.terms)
            row[std::size_t(std::ranges::find(atoms, term.atom) - atoms.begin())] = term.factor;
        return row;
    };
    const auto dot = [](const Row& a, const Row& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
    // Gram-Schmidt: each time the form with the largest share outside the span so far.
    std::vector<Row> rows, rests;
    double longest = 0.0;
    for (const LinearForm& form : forms) {
        rows.push_back(rowOf(form));
        longest = std::max(longest, std::sqrt(dot(rows.back(), rows.back())));
    }
    rests = rows;
    LinearBasis basis;
    std::vector<Row> units;
    while (units.size() < atoms.size()) {
        std::size_t best = 0;
        double largest = kSmallestPivot, bestScale = 0.0;
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const double length = std::sqrt(dot(rows[i], rows[i])),
                         share = std::sqrt(dot(rests[i], rests[i])) / length;
            // Factors that are only rounding errors are no direction. Among equally good forms the scale
            // decides, as searches through boxes need sides of one scale.
            const double scale = std::abs(std::log(length));
            if (length <= kSmallestPivot * longest || share <= kAsGood * largest) continue;
            if (share < largest / kAsGood && scale >= kNearerScale * bestScale) continue;
            largest = std::max(share, largest), bestScale = scale, best = i;
        }
        if (largest == kSmallestPivot) break;
        const double length = std::sqrt(dot(rests[best], rests[best]));
        Row unit = rests[best];
        for (double& value : unit) value /= length;
        units.push_back(unit);
        basis.chosen.push_back(best);
        for (Row& rest : rests) {
            const double along = dot(rest, unit);
            for (std::size_t i = 0; i < kDimensions; ++i) rest[i] -= along * unit[i];
        }
    }
    // In the units the chosen rows are triangular.
    for (std::size_t f = 0; f < forms.size(); ++f) {
        LinearForm form{.terms = {}, .constant = forms[f].constant};
        Row left = rows[f];
        for (std::size_t k = units.size(); k-- > 0;) {
            const Row& chosen = rows[basis.chosen[k]];
            const double factor = dot(left, units[k]) / dot(chosen, units[k]);
            const double share = std::abs(factor) * std::sqrt(dot(chosen, chosen) / dot(rows[f], rows[f]));
            if (share < kZeroFactor) continue;
            for (std::size_t i = 0; i < kDimensions; ++i) left[i] -= factor * chosen[i];
            form.terms.insert(form.terms.begin(), {IrId(k), factor});
            form.constant -= factor * forms[basis.chosen[k]].constant;
        }
        if (std::sqrt(dot(left, left) / dot(rows[f], rows[f])) > kZeroFactor * 10.0) return {};
        basis.forms.push_back(std::move(form));
    }
    return basis;
}

void LinearForms::set(IrId id, LinearForm form) {
    if (forms.size() <= id) forms.resize(id + 1), isKnown.resize(id + 1);
    forms[id] = std::move(form);
    isKnown[id] = true;
}

void LinearForms::add(const Ir& ir, std::span<const IrId> ids, std::span<const Interval> values,
                      const std::vector<bool>& isAtom) {
    if (forms.size() < values.size()) forms.resize(values.size()), isKnown.resize(values.size());
    const auto isNumber = [&](IrId id) { return values[id].isPoint() && ir[id].positions == 0; };
    const auto formOf = [&](IrId id) {
        if (id < 3 || isAtom[id]) return LinearForm{.terms = {{id, 1.0}}, .constant = 0.0};
        if (ir[id].positions == 0 && !values[id].isPoint())
            return LinearForm{.terms = {{id, 1.0}}, .constant = 0.0};
        return isNumber(id) ? LinearForm{.terms = {}, .constant = values[id].lo} : forms[id];
    };
    for (const IrId id : ids) {
        if (isKnown[id]) continue;
        isKnown[id] = true;
        const IrNode& node = ir[id];
        const IrId a = node.operands[0], b = node.operands[1];
        LinearForm form;
        switch (isAtom[id] ? Op::count : node.op) {
            case Op::negate: form = sum({}, formOf(a), -1.0); break;
            case Op::add: form = sum(formOf(a), formOf(b), 1.0); break;
            case Op::subtract: form = sum(formOf(a), formOf(b), -1.0); break;
            case Op::multiply:
                if (isNumber(a) && values[a].lo != 0.0) form = sum({}, formOf(b), values[a].lo);
                if (isNumber(b) && values[b].lo != 0.0) form = sum({}, formOf(a), values[b].lo);
                break;
            case Op::divide:
                if (isNumber(b) && values[b].lo != 0.0) form = sum({}, formOf(a), 1.0 / values[b].lo);
                break;
            default: break;
        }
        if (form.terms.empty() || form.terms.size() > kMaxTerms)
            form = {.terms = {{id, 1.0}}, .constant = 0.0};
        forms[id] = std::move(form);
    }
}

namespace {

/// A form without its constant, whose first factor is 1.
struct BoundedForm {
    std::vector<LinearForm::Term> terms;
    Interval bounds;
};

bool areEqual(std::span<const LinearForm::Term> a, std::span<const LinearForm::Term> b) {
    return std::ranges::equal(a, b, [](const LinearForm::Term& x, const LinearForm::Term& y) {
        return x.atom == y.atom && std::abs(x.factor - y.factor) <= kZeroFactor * std::abs(x.factor);
    });
}

/// The forms that are bounded on both sides. Forms that are multiples of each other but for their constants
/// are one: so two half-spaces are a slab.
std::vector<BoundedForm> boundedForms(std::span<const LinearForm> forms, std::span<const Interval> bounds) {
    std::vector<BoundedForm> result;
    for (std::size_t i = 0; i < forms.size(); ++i) {
        if (forms[i].terms.empty()) continue;
        BoundedForm form{.terms = forms[i].terms, .bounds = {}};
        const Interval first{form.terms[0].factor, form.terms[0].factor};
        form.bounds = (bounds[i] - Interval{forms[i].constant, forms[i].constant}) / first;
        for (LinearForm::Term& term : form.terms) term.factor /= first.lo;
        const auto same = std::ranges::find_if(
            result, [&](const BoundedForm& other) { return areEqual(form.terms, other.terms); });
        if (same == result.end())
            result.push_back(std::move(form));
        else if (Interval both = same->bounds; intersect(both, form.bounds))
            same->bounds = both;
    }
    std::erase_if(result, [](const BoundedForm& form) { return !isBounded(form.bounds); });
    return result;
}

}  // namespace

std::vector<IrId> solveForUnbounded(std::span<const LinearForm> given, std::span<const Interval> givenBounds,
                                    std::span<Interval> atoms) {
    const std::vector<BoundedForm> forms = boundedForms(given, givenBounds);
    const std::size_t count = std::min(forms.size(), kMaxRows);
    std::vector<IrId> columns;
    for (const BoundedForm& form : std::span(forms).first(count))
        for (const LinearForm::Term& term : form.terms)
            if (!isBounded(atoms[term.atom]) && std::ranges::find(columns, term.atom) == columns.end())
                columns.push_back(term.atom);
    if (columns.empty() || columns.size() > kMaxColumns) return {};
    std::vector<Row> rows(count);
    for (std::size_t i = 0; i < count; ++i) {
        double largest = 0.0;
        rows[i].multipliers[i] = 1.0;
        for (const LinearForm::Term& term : forms[i].terms) {
            const auto found = std::ranges::find(columns, term.atom);
            if (found == columns.end()) continue;
            rows[i].factors[std::size_t(found - columns.begin())] = term.factor;
            largest = std::max(largest, std::abs(term.factor));
        }
        if (largest > 0.0) scale(rows[i], 1.0 / largest);
    }
    // Reduced row echelon form, with full pivoting.
    std::vector<std::size_t> pivotColumns;
    for (std::size_t step = 0; step < count; ++step) {
        std::size_t bestRow = 0, bestColumn = 0;
        double largest = kSmallestPivot;
        for (std::size_t i = step; i < count; ++i)
            for (std::size_t j = 0; j < columns.size(); ++j)
                if (std::abs(rows[i].factors[j]) > largest)
                    largest = std::abs(rows[i].factors[j]), bestRow = i, bestColumn = j;
        if (largest == kSmallestPivot) break;
        std::swap(rows[step], rows[bestRow]);
        scale(rows[step], 1.0 / rows[step].factors[bestColumn]);
        for (std::size_t i = 0; i < count; ++i)
            if (i != step && rows[i].factors[bestColumn] != 0.0)
                addMultiple(rows[i], rows[step], -rows[i].factors[bestColumn]);
        pivotColumns.push_back(bestColumn);
    }
    std::vector<IrId> narrowed;
    for (std::size_t step = 0; step < pivotColumns.size(); ++step) {
        const Row& row = rows[step];
        bool isolated = true;
        for (std::size_t j = 0; j < columns.size(); ++j)
            isolated &= j == pivotColumns[step] || std::abs(row.factors[j]) < kZeroFactor;
        if (!isolated) continue;
        Interval total{0.0, 0.0};
        for (std::size_t i = 0; i < count; ++i) {
            if (row.multipliers[i] == 0.0) continue;
            Interval rest = forms[i].bounds;
            for (const LinearForm::Term& term : forms[i].terms)
                if (std::ranges::find(columns, term.atom) == columns.end())
                    rest = rest - Interval{term.factor, term.factor} * atoms[term.atom];
            total = total + Interval{row.multipliers[i], row.multipliers[i]} * rest;
        }
        const double slack = kFormSlack * absolute(total).hi;
        total = outward(total.lo - slack, total.hi + slack);
        if (!isBounded(total)) continue;
        Interval& atom = atoms[columns[pivotColumns[step]]];
        atom = {std::max(atom.lo, total.lo), std::min(atom.hi, total.hi)};
        narrowed.push_back(columns[pivotColumns[step]]);
    }
    return narrowed;
}

}  // namespace fw
