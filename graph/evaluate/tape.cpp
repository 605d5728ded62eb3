#include "graph/evaluate/tape.h"

#include <algorithm>
#include <bit>
#include <cassert>

namespace fw {

namespace {

// In a draft, step i makes value 3 + i, and the position is the values 0, 1, 2. A name is a value, or a
// number's place with this bit.
constexpr uint32_t kNumber = 1u << 31, kNone = ~0u;

bool samples(Op op) { return op == Op::image || op == Op::volume; }

int arityOf(Op op) { return opInfo(op).arity; }

uint8_t positionsOf(const std::vector<TapeStep>& draft, uint32_t name) {
    if (name & kNumber) return 0;
    return name < 3 ? uint8_t(1 << name) : draft[name - 3].positions;
}

SampledLayer layerOf(const Tape& tape, const TapeStep& step) {
    return samples(step.op) ? tape.numbers->layers[step.operands[kMaxArity - 1]] : SampledLayer{};
}

/// Adds a step that puts a number into a register.
uint32_t addNumber(std::vector<TapeStep>& draft, uint32_t name) {
    const uint32_t place = name & ~kNumber;
    draft.push_back({Op::constant, 1, 0, 0, {place, place, place, place}});
    return uint32_t(draft.size() + 2);
}

/// Adds a step whose operands are names, and gives its value.
uint32_t addStep(std::vector<TapeStep>& draft, Op op, std::array<uint32_t, kMaxArity> operands, int arity) {
    uint8_t numbers = 0, positions = 0;
    for (int i = 0; i < arity; ++i) {
        if (operands[i] & kNumber) numbers |= uint8_t(1 << i);
        positions |= positionsOf(draft, operands[i]);
    }
    const auto lacks = [op](int form) {
        return form >= OpKernels<double>::kForms || !opKernels<double>()[std::size_t(op)]->values[form];
    };
    for (int i = 0; i < arity && lacks(numbers); ++i)
        if (numbers >> i & 1) operands[i] = addNumber(draft, operands[i]), numbers &= uint8_t(~(1 << i));
    for (int i = 0; i < arity; ++i) operands[i] &= ~kNumber;
    draft.push_back({op, numbers, positions, 0, operands});
    return uint32_t(draft.size() + 2);
}

/// Gives registers to a draft's values, backwards from the roots.
class Allocation {
  public:
    Allocation(std::vector<TapeStep>& draft_, std::vector<uint32_t>& registers_)
        : draft(draft_), registers(registers_) {}

    /// `roots` are values. With `partedByZ`, steps that do not depend on z come first.
    void run(Tape& tape, std::span<const uint32_t> roots, bool partedByZ) {
        registers.assign(draft.size() + 3, kNone);
        std::size_t needed = 0;
        for (uint32_t root : roots) registers[root] = 0;
        for (std::size_t i = draft.size(); i-- > 0;) {
            if (registers[i + 3] == kNone) continue;
            ++needed;
            eachOperand(draft[i], [&](uint32_t& value) { registers[value] = 0; });
        }
        for (std::size_t i = 0; i < draft.size(); ++i)
            draft[i].result = registers[i + 3] == kNone ? kNone : 0;  // what is not needed is left out
        registers.assign(draft.size() + 3, kNone);
        for (uint32_t axis = 0; axis < 3; ++axis) registers[axis] = axis;
        free.clear();
        count = 3;

        tape.steps.resize(needed);
        tape.roots.clear();
        for (uint32_t root : roots) {
            if (registers[root] == kNone) registers[root] = count++;
            tape.roots.push_back(registers[root]);
        }
        std::size_t at = needed;
        if (partedByZ) {
            sweep(
                tape, at, [](const TapeStep& step) { return bool(step.positions & dependsOnZ); }, true);
            tape.still = uint32_t(at);
            sweep(
                tape, at, [](const TapeStep& step) { return !(step.positions & dependsOnZ); }, false);
        } else {
            tape.still = 0;
            sweep(
                tape, at, [](const TapeStep&) { return true; }, false);
        }
        assert(at == 0);
        tape.registers = count;
    }

  private:
    template <class Visit>
    static void eachOperand(TapeStep& step, Visit visit) {
        for (int i = 0; i < arityOf(step.op); ++i)
            if (!(step.numbers >> i & 1)) visit(step.operands[i]);
    }

    uint32_t take() {
        if (free.empty()) return count++;
        const uint32_t last = free.back();
        free.pop_back();
        return last;
    }

    /// With `keep`, what other steps made has registers that none of these writes.
    template <class Which>
    void sweep(Tape& tape, std::size_t& at, Which which, bool keep) {
        for (std::size_t i = draft.size(); i-- > 0;) {
            if (draft[i].result == kNone || !which(draft[i])) continue;
            TapeStep& step = tape.steps[--at] = draft[i];
            step.result = registers[i + 3];
            eachOperand(step, [&](uint32_t& operand) {
                uint32_t& own = registers[operand];
                if (own == kNone) own = keep && !which(draft[operand - 3]) ? count++ : take();
                operand = own;
            });
            free.push_back(step.result);
        }
    }

    std::vector<TapeStep>& draft;
    std::vector<uint32_t>& registers;  // by value
    std::vector<uint32_t> free;
    uint32_t count = 3;
};

/// The tape of a draft, whose roots are names.
void allocate(Tape& tape, std::vector<TapeStep>& draft, std::vector<uint32_t>& registers,
              std::span<uint32_t> roots) {
    for (uint32_t& root : roots)
        if (root & kNumber) root = addNumber(draft, root);
    Allocation allocation(draft, registers);
    allocation.run(tape, roots, true);
    // Few planes save what many registers cost.
    if (tape.registers > 16 + tape.steps.size() / 6) allocation.run(tape, roots, false);
}

/// The operand that the step's result equals all over the box, counted from 1; or 0.
uint8_t decided(Op op, const Interval* x) {
    switch (op) {
        case Op::minimum: return x[0].hi < x[1].lo ? 1 : x[1].hi < x[0].lo ? 2 : 0;
        case Op::maximum: return x[0].lo > x[1].hi ? 1 : x[1].lo > x[0].hi ? 2 : 0;
        case Op::smoothMinimum: return x[0].hi + x[2].hi < x[1].lo ? 1 : x[1].hi + x[2].hi < x[0].lo ? 2 : 0;
        case Op::select: return x[0].lo == 1.0 ? 2 : x[0].hi == 0.0 ? 3 : 0;
        default: return 0;
    }
}

/// Calls visit(id) for what the roots need, ascending.
template <class Visit>
void eachNeeded(const Ir& ir, std::span<const IrId> roots, Visit visit) {
    const IrId last = std::ranges::max(roots);
    std::vector<uint64_t> needed(last / 64 + 1);
    for (IrId root : roots) needed[root / 64] |= uint64_t(1) << root % 64;
    for (std::size_t word = needed.size(); word-- > 0;)
        for (uint64_t left = needed[word]; left;) {
            const int bit = 63 - std::countl_zero(left);
            const IrNode& node = ir[IrId(word * 64 + std::size_t(bit))];
            for (int i = 0; i < arityOf(node.op); ++i)
                needed[node.operands[i] / 64] |= uint64_t(1) << node.operands[i] % 64;
            left = needed[word] & ((uint64_t(1) << bit) - 1);
        }
    for (std::size_t word = 0; word < needed.size(); ++word)
        for (uint64_t left = needed[word]; left; left &= left - 1)
            visit(IrId(word * 64 + std::size_t(std::countr_zero(left))));
}

}  // namespace

Tape makeTape(const Ir& ir, std::span<const IrId> roots, std::span<const double> parameters) {
    auto pool = std::make_shared<TapeNumbers>();
    std::vector<TapeStep> draft;
    const std::size_t size = std::ranges::max(roots) + 1;
    const auto names = std::make_unique_for_overwrite<uint32_t[]>(size);  // set before they are read
    eachNeeded(ir, roots, [&](IrId id) {
        const IrNode& node = ir[id];
        const int arity = arityOf(node.op);
        if (id < 3) {
            names[id] = id;
        } else if (node.positions == 0) {
            double operands[kMaxArity] = {};
            for (int i = 0; i < arity; ++i) operands[i] = pool->doubles[names[node.operands[i]] & ~kNumber];
            names[id] = uint32_t(pool->doubles.size()) | kNumber;
            pool->doubles.push_back(node.op == Op::parameter ? parameters[std::size_t(node.number)]
                                    : arity == 0             ? node.number
                                                 : opInfo(node.op).value(operands, ir.layer(node)));
        } else {
            std::array<uint32_t, kMaxArity> operands{};
            for (int i = 0; i < arity; ++i) operands[i] = names[node.operands[i]];
            if (samples(node.op)) {
                operands[kMaxArity - 1] = uint32_t(pool->layers.size());
                pool->layers.push_back(ir.layer(node));
            }
            names[id] = addStep(draft, node.op, operands, arity);
        }
    });
    pool->floats.assign(pool->doubles.begin(), pool->doubles.end());
    Tape tape{.numbers = std::move(pool)};
    std::vector<uint32_t> values, registers;
    for (IrId root : roots) values.push_back(names[root]);
    allocate(tape, draft, registers, values);
    return tape;
}

Tape makeTape(const Ir& ir, IrId root, std::span<const double> parameters) {
    return makeTape(ir, std::span(&root, 1), parameters);
}

template <class T>
Interval TapeMachine<T>::interval(const Tape& tape, const Box& box) {
    constexpr bool isSingle = std::is_same_v<T, float>;
    if (intervals.size() < tape.registers) intervals.resize(tape.registers);
    if (taken.size() < tape.steps.size()) taken.resize(tape.steps.size());
    for (std::size_t axis = 0; axis < 3; ++axis) intervals[axis] = {box.lo[axis], box.hi[axis]};
    decisions = 0;
    const auto number = [&](uint32_t place) {
        const double value = isSingle ? double(tape.numbers->floats[place]) : tape.numbers->doubles[place];
        return Interval{value, value};
    };
    for (std::size_t i = 0; i < tape.steps.size(); ++i) {
        const TapeStep& step = tape.steps[i];
        taken[i] = 0;
        if (step.op == Op::constant) {
            intervals[step.result] = number(step.operands[0]);
            continue;
        }
        const OpInfo& info = opInfo(step.op);
        Interval operands[kMaxArity];
        for (int k = 0; k < info.arity; ++k)
            operands[k] = step.numbers >> k & 1 ? number(step.operands[k]) : intervals[step.operands[k]];
        const SampledLayer layer = layerOf(tape, step);
        taken[i] = decided(step.op, operands);
        decisions += taken[i] != 0;
        intervals[step.result] =
            isSingle ? singlePrecisionInterval(info, std::span(operands, std::size_t(info.arity)), layer)
                     : info.interval(operands, layer);
    }
    return intervals[tape.roots[0]];
}

template <class T>
Tape TapeMachine<T>::shortened(const Tape& tape) {
    draft.clear();
    names.assign(tape.registers, kNone);
    for (uint32_t axis = 0; axis < 3; ++axis) names[axis] = axis;
    for (std::size_t i = 0; i < tape.steps.size(); ++i) {
        const TapeStep& step = tape.steps[i];
        const int arity = arityOf(step.op);
        std::array<uint32_t, kMaxArity> operands{};
        for (int k = 0; k < arity; ++k)
            operands[k] = step.numbers >> k & 1 ? step.operands[k] | kNumber : names[step.operands[k]];
        if (samples(step.op)) operands[kMaxArity - 1] = step.operands[kMaxArity - 1];
        names[step.result] = step.op == Op::constant ? step.operands[0] | kNumber
                             : taken[i]              ? operands[taken[i] - 1]
                                                     : addStep(draft, step.op, operands, arity);
    }
    Tape result{.numbers = tape.numbers};
    std::vector<uint32_t> roots;
    for (uint32_t root : tape.roots) roots.push_back(names[root]);
    allocate(result, draft, names, roots);
    return result;
}

template <class T>
void TapeMachine<T>::make(const Tape& tape) {
    if (rows.size() < tape.registers) rows.resize(tape.registers);
}

template <class T>
typename TapeMachine<T>::Operands TapeMachine<T>::operandsOf(const Tape& tape, const TapeStep& step) const {
    const T* const numbers = [&] {
        if constexpr (std::is_same_v<T, float>)
            return tape.numbers->floats.data();
        else
            return tape.numbers->doubles.data();
    }();
    Operands operands{};
    const int most = samples(step.op) ? kMaxArity - 1 : kMaxArity;
    for (int i = 0; i < most; ++i)  // what lies beyond the arity is not read
        operands.rows[i] =
            step.numbers >> i & 1 ? numbers + step.operands[i] : rows[step.operands[i]].numbers;
    return operands;
}

template <class T>
const T* TapeMachine<T>::value(const Tape& tape, std::size_t count, bool onlyZ) {
    make(tape);
    const auto kernels = opKernels<T>();
    for (std::size_t i = onlyZ ? tape.still : 0; i < tape.steps.size(); ++i) {
        const TapeStep& step = tape.steps[i];
        const Operands operands = operandsOf(tape, step);
        T* const result = rows[step.result].numbers;
        if (step.op == Op::constant)
            std::fill_n(result, count, *operands.rows[0]);
        else
            kernels[std::size_t(step.op)]->values[step.numbers](operands.rows, result, count,
                                                                layerOf(tape, step));
    }
    return rows[tape.roots[0]].numbers;
}

template <class T>
typename TapeMachine<T>::Slopes TapeMachine<T>::slope(const Tape& tape, std::size_t count) {
    make(tape);
    const auto kernels = opKernels<T>();
    for (const TapeStep& step : tape.steps) {
        const Operands operands = operandsOf(tape, step);
        T* const result = rows[step.result].numbers;
        if (step.op == Op::constant) {
            std::fill_n(result, count, *operands.rows[0]);
            std::fill_n(result + kSlopePoints, count, T(0));
            continue;
        }
        const T* slopes[kMaxArity];
        for (int i = 0; i < kMaxArity; ++i)  // not read where the operand is a number
            slopes[i] = step.numbers >> i & 1 ? operands.rows[i] : operands.rows[i] + kSlopePoints;
        const OpKernels<T>& own = *kernels[std::size_t(step.op)];
        const SampledLayer layer = layerOf(tape, step);
        own.values[step.numbers](operands.rows, result, count, layer);
        own.slopes[step.numbers](operands.rows, result, slopes, result + kSlopePoints, count, layer);
    }
    const T* const root = rows[tape.roots[0]].numbers;
    return {root, root + kSlopePoints};
}

template <class T>
typename TapeMachine<T>::Gradients TapeMachine<T>::gradient(const Tape& tape, std::size_t count) {
    make(tape);
    const auto kernels = opKernels<T>();
    const auto along = [](auto* row, std::size_t axis) { return row + (axis + 1) * kGradientPoints; };
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::size_t other = 0; other < 3; ++other)
            std::fill_n(along(position(int(axis)), other), count, T(axis == other));
    for (const TapeStep& step : tape.steps) {
        const Operands operands = operandsOf(tape, step);
        T* const result = rows[step.result].numbers;
        const OpKernels<T>& own = *kernels[std::size_t(step.op)];
        const SampledLayer layer = layerOf(tape, step);
        if (step.op == Op::constant)
            std::fill_n(result, count, *operands.rows[0]);
        else
            own.values[step.numbers](operands.rows, result, count, layer);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (!(step.positions >> axis & 1)) {
                std::fill_n(along(result, axis), count, T(0));
                continue;
            }
            const T* slopes[kMaxArity];
            for (int i = 0; i < kMaxArity; ++i)
                slopes[i] = step.numbers >> i & 1 ? operands.rows[i] : along(operands.rows[i], axis);
            own.slopes[step.numbers](operands.rows, result, slopes, along(result, axis), count, layer);
        }
    }
    const T* const root = rows[tape.roots[0]].numbers;
    return {root, {along(root, 0), along(root, 1), along(root, 2)}};
}

template <class T>
void TapeMachine<T>::evaluate(const Tape& tape, std::span<const Point> points, std::span<double> values) {
    assert(values.size() >= points.size());
    for (std::size_t first = 0; first < points.size(); first += kPoints) {
        const std::size_t count = std::min(kPoints, points.size() - first);
        for (int axis = 0; axis < 3; ++axis)
            for (std::size_t k = 0; k < count; ++k)
                position(axis)[k] = T(points[first + k][std::size_t(axis)]);
        std::copy_n(value(tape, count), count, values.begin() + std::ptrdiff_t(first));
    }
}

template <class T>
std::size_t TapeMachine<T>::bytes() const {
    return rows.capacity() * sizeof(Row) + intervals.capacity() * sizeof(Interval) + taken.capacity() +
           draft.capacity() * sizeof(TapeStep) + names.capacity() * sizeof(uint32_t);
}

template class TapeMachine<float>;
template class TapeMachine<double>;

}  // namespace fw
