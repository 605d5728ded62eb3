#include "graph/evaluate/tape.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <utility>

#include "graph/evaluate/jump_cases.h"

namespace fw {

namespace {

// In a draft, step i makes value 3 + i, and the position is the values 0, 1, 2. A name is a value, or a
// number's place with this bit.
constexpr uint32_t kNumber = 1u << 31, kNone = ~0u;

/// So many jumps are split in one box; more meet only where it is large.
constexpr int kMostSplits = 6;

/// Arities alone, without the rest of the rows, for the loops over steps.
using Arities = std::array<uint8_t, std::size_t(Op::count)>;
const Arities& arities() {
    static const Arities all = [] {
        Arities each{};
        for (const OpInfo& info : opTable()) each[std::size_t(info.op)] = uint8_t(info.arity);
        return each;
    }();
    return all;
}

uint8_t positionsOf(const std::vector<TapeStep>& draft, uint32_t name) {
    if (name & kNumber) return 0;
    return name < 3 ? uint8_t(1 << name) : draft[name - 3].positions;
}

SampledLayer layerOf(const Tape& tape, const TapeStep& step) {
    return samplesLayer(step.op) ? tape.numbers->layers[step.operands[kMaxArity - 1]] : SampledLayer{};
}

/// Adds a step that puts a number into a register.
uint32_t addNumber(std::vector<TapeStep>& draft, uint32_t name) {
    const uint32_t place = name & ~kNumber;
    draft.push_back({Op::constant, 1, 0, 0, {place, place, place, place}});
    return uint32_t(draft.size() + 2);
}

/// Whether there is no kernel of the operation for these operands, one bit each, as numbers.
bool lacksForm(Op op, int numbers) {
    return numbers != 0 &&
           (numbers >= OpKernels<double>::kForms || !opKernels<double>()[std::size_t(op)]->values[numbers]);
}

/// Adds a step whose operands are names, and gives its value.
uint32_t addStep(std::vector<TapeStep>& draft, Op op, std::array<uint32_t, kMaxArity> operands, int arity) {
    uint8_t numbers = 0, positions = 0;
    for (int i = 0; i < arity; ++i) {
        if (operands[i] & kNumber) numbers |= uint8_t(1 << i);
        positions |= positionsOf(draft, operands[i]);
    }
    if (numbers != 0) {
        for (int i = 0; i < arity && lacksForm(op, numbers); ++i)
            if (numbers >> i & 1) operands[i] = addNumber(draft, operands[i]), numbers &= uint8_t(~(1 << i));
        for (int i = 0; i < arity; ++i) operands[i] &= ~kNumber;
    }
    draft.push_back({op, numbers, positions, 0, operands});
    return uint32_t(draft.size() + 2);
}

/// Gives registers to a draft's values, backwards from the roots. What none of them needs gets none.
class Allocation {
  public:
    Allocation(const std::vector<TapeStep>& draft_, std::vector<uint32_t>& registers_)
        : draft(draft_), registers(registers_) {}

    /// `roots` are values. With `partedByZ`, steps that do not depend on z come first.
    void run(Tape& tape, std::span<const uint32_t> roots, bool partedByZ) {
        registers.assign(draft.size() + 3, kNone);
        for (uint32_t axis = 0; axis < 3; ++axis) registers[axis] = axis;
        free.clear();
        placed.resize(draft.size());
        at = draft.size();
        count = 3;
        tape.roots.clear();
        for (uint32_t root : roots) {
            if (registers[root] == kNone) registers[root] = count++;
            tape.roots.push_back(registers[root]);
        }
        if (partedByZ) sweep(dependsOnZ, true);
        const std::size_t moving = at;
        sweep(0, false);
        tape.steps.assign(placed.begin() + std::ptrdiff_t(at), placed.end());
        tape.still = partedByZ ? uint32_t(moving - at) : 0;
        tape.registers = count;
    }

    /// Bytes that this thread keeps for the next run.
    static std::size_t keptBytes() {
        return free.capacity() * sizeof(uint32_t) + placed.capacity() * sizeof(TapeStep);
    }

  private:
    /// Places the steps that depend on these axes, of those that are not placed yet. With `keep`, what other
    /// steps make has registers that none of these writes.
    void sweep(uint8_t axes, bool keep) {
        const Arities& arity = arities();
        const auto moves = [&](const TapeStep& step) { return (step.positions & axes) == axes; };
        for (std::size_t i = draft.size(); i-- > 0;) {
            uint32_t& own = registers[i + 3];
            if (own == kNone || own == kPlaced || !moves(draft[i])) continue;
            TapeStep& step = placed[--at] = draft[i];
            step.result = own;
            for (int k = 0; k < arity[std::size_t(step.op)]; ++k) {
                if (step.numbers >> k & 1) continue;
                uint32_t& operand = registers[step.operands[k]];
                if (operand == kNone)
                    operand = keep && !moves(draft[step.operands[k] - 3]) ? count++ : take();
                step.operands[k] = operand;
            }
            own = kPlaced;
            free.push_back(step.result);
        }
    }

    uint32_t take() {
        if (free.empty()) return count++;
        const uint32_t last = free.back();
        free.pop_back();
        return last;
    }

    static constexpr uint32_t kPlaced = kNone - 1;

    const std::vector<TapeStep>& draft;
    std::vector<uint32_t>& registers;  // by value
    std::size_t at = 0;                // the first step that is placed
    uint32_t count = 3;
    // Kept between runs: tapes are made by the thousand.
    static thread_local std::vector<uint32_t> free;
    static thread_local std::vector<TapeStep> placed;
};
thread_local std::vector<uint32_t> Allocation::free;
thread_local std::vector<TapeStep> Allocation::placed;

constexpr std::size_t kMostKept = 512;  // rows of TapeMachine: 384 KiB

/// The tape of a draft, whose roots are names.
void allocate(Tape& tape, std::vector<TapeStep>& draft, std::vector<uint32_t>& registers,
              std::span<uint32_t> roots) {
    for (uint32_t& root : roots)
        if (root & kNumber) root = addNumber(draft, root);
    Allocation allocation(draft, registers);
    allocation.run(tape, roots, true);
    // Few planes save what many registers cost, least of all where caches near the processor do not hold
    // them.
    if (tape.registers > std::min<std::size_t>(16 + tape.steps.size() / 6, kMostKept))
        allocation.run(tape, roots, false);
}

/// Whether intervals can tell which operand counts.
bool decides(Op op) {
    return op == Op::minimum || op == Op::maximum || op == Op::select || op == Op::smoothMinimum;
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

/// The operand that has the sign of the step's result all over the box, counted from 1; or 0.
uint8_t decidedSign(Op op, const Interval* x) {
    if (op == Op::minimum) return x[1].lo > 0.0 ? 1 : x[0].lo > 0.0 ? 2 : 0;
    if (op == Op::maximum) return x[1].hi < 0.0 ? 1 : x[0].hi < 0.0 ? 2 : 0;
    return 0;
}

/// Whether the sign of the result follows from the operands' signs.
bool keepsSigns(Op op) { return op == Op::minimum || op == Op::maximum || op == Op::negate; }

/// Calls visit(id) for what the roots need, ascending.
template <class Visit>
void eachNeeded(const Ir& ir, std::span<const IrId> roots, Visit visit) {
    const Arities& arity = arities();
    const IrId last = std::ranges::max(roots);
    std::vector<uint64_t> needed(last / 64 + 1);
    for (IrId root : roots) needed[root / 64] |= uint64_t(1) << root % 64;
    for (std::size_t word = needed.size(); word-- > 0;)
        for (uint64_t left = needed[word]; left;) {
            const int bit = 63 - std::countl_zero(left);
            const IrNode& node = ir[IrId(word * 64 + std::size_t(bit))];
            for (int i = 0; i < arity[std::size_t(node.op)]; ++i)
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
        const int arity = arities()[std::size_t(node.op)];
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
            if (samplesLayer(node.op)) {
                operands[kMaxArity - 1] = uint32_t(pool->layers.size());
                pool->layers.push_back(ir.layer(node));
            }
            names[id] = addStep(draft, node.op, operands, arity);
        }
    });
    pool->floats.assign(pool->doubles.begin(), pool->doubles.end());
    if (!pool->layers.empty()) {
        pool->images = ir.images(), pool->volumes = ir.volumes();
        pool->outlines = ir.outlines(), pool->splines = ir.splines();
    }
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
void TapeMachine<T>::enter(const Tape& tape, const Box& box) {
    if (intervals.size() < tape.registers) intervals.resize(tape.registers);
    for (std::size_t axis = 0; axis < 3; ++axis) intervals[axis] = {box.lo[axis], box.hi[axis]};
}

template <class T>
[[gnu::always_inline]] inline void TapeMachine<T>::takeInterval(const Tape& tape, const TapeStep& step,
                                                                const OpInfo* table, Interval* operands) {
    constexpr bool isSingle = std::is_same_v<T, float>;
    const auto number = [&](uint32_t place) {
        return isSingle ? double(tape.numbers->floats[place]) : tape.numbers->doubles[place];
    };
    if (step.op == Op::constant) {
        intervals[step.result] = {number(step.operands[0]), number(step.operands[0])};
        return;
    }
    const OpInfo& info = table[std::size_t(step.op)];
    // End by end, as they were written: read as a whole, they would have to wait for the memory.
    for (std::size_t k = 0; k < std::size_t(info.arity); ++k) {
        const uint32_t place = step.operands[k];
        const bool isNumber = step.numbers >> k & 1;
        operands[k].lo = isNumber ? number(place) : intervals[place].lo;
        operands[k].hi = isNumber ? number(place) : intervals[place].hi;
    }
    const SampledLayer layer = layerOf(tape, step);
    intervals[step.result] =
        isSingle && info.rounding != Rounding::none
            ? singlePrecisionInterval(info, std::span(operands, std::size_t(info.arity)), layer)
            : info.interval(operands, layer);
}

template <class T>
Interval TapeMachine<T>::interval(const Tape& tape, const Box& box) {
    enter(tape, box);
    if (taken.size() < tape.steps.size()) taken.resize(tape.steps.size());
    decisions = 0, jumped = false, stepsRun += tape.steps.size();
    const OpInfo* const table = opTable().data();
    for (std::size_t i = 0; i < tape.steps.size(); ++i) {
        const TapeStep& step = tape.steps[i];
        Interval operands[kMaxArity];
        takeInterval(tape, step, table, operands);
        taken[i] = 0;
        if (decides(step.op)) {
            taken[i] = uint8_t(decided(step.op, operands) | decidedSign(step.op, operands) << 4);
            decisions += taken[i] != 0;
        }
        if (std::is_same_v<T, double> && mayJump(step.op) && !jumped)
            jumped = jumpCases(step.op, operands, intervals[step.result]).count > 0;
    }
    return intervals[tape.roots[0]];
}

template <class T>
bool TapeMachine<T>::positiveInEachCase(const Tape& tape, const Box& box) requires std::is_same_v<T, double> {
    enter(tape, box);
    return positiveFrom(tape, 0, kMostSplits);
}

/// Runs the steps from `first` on, in each case of the first jump that is met.
template <class T>
bool TapeMachine<T>::positiveFrom(const Tape& tape, std::size_t first, int splits) {
    const OpInfo* const table = opTable().data();
    for (std::size_t i = first; i < tape.steps.size(); ++i) {
        const TapeStep& step = tape.steps[i];
        Interval operands[kMaxArity];
        takeInterval(tape, step, table, operands);
        ++stepsRun;
        if (splits == 0 || !mayJump(step.op)) continue;
        const JumpCases cases = jumpCases(step.op, operands, intervals[step.result]);
        if (cases.count == 0) continue;
        const std::vector<Interval> before(intervals.begin(), intervals.begin() + tape.registers);
        for (int c = 0; c < cases.count; ++c) {
            std::ranges::copy(before, intervals.begin());
            intervals[step.result] = cases.ranges[std::size_t(c)];
            if (!positiveFrom(tape, i + 1, splits - 1)) return false;
        }
        return true;
    }
    return intervals[tape.roots[0]].lo >= 0.0;
}

template <class T>
Tape TapeMachine<T>::shortened(const Tape& tape) {
    const Arities& all = arities();
    draft.clear();
    draft.reserve(tape.steps.size());
    names.assign(tape.registers, kNone);
    for (uint32_t axis = 0; axis < 3; ++axis) names[axis] = axis;
    for (std::size_t i = 0; i < tape.steps.size(); ++i) {
        const TapeStep& step = tape.steps[i];
        const int arity = all[std::size_t(step.op)];
        std::array<uint32_t, kMaxArity> operands{};
        for (int k = 0; k < arity; ++k)
            operands[k] = step.numbers >> k & 1 ? step.operands[k] | kNumber : names[step.operands[k]];
        if (samplesLayer(step.op)) operands[kMaxArity - 1] = step.operands[kMaxArity - 1];
        const int equal = taken[i] & 15;
        // What has become a number and must stand in a register does so once, for all that read it.
        const auto numbers = [&] {
            int form = 0;
            for (int k = 0; k < arity; ++k) form |= int((operands[k] & kNumber) != 0) << k;
            return form;
        };
        for (int k = 0; k < arity && !equal; ++k) {
            if ((step.numbers >> k & 1) || !(operands[k] & kNumber) || !lacksForm(step.op, numbers()))
                continue;
            const uint32_t read = step.operands[k], kept = addNumber(draft, operands[k]);
            names[read] = kept;
            for (int same = k; same < arity; ++same)
                if (!(step.numbers >> same & 1) && step.operands[same] == read) operands[same] = kept;
        }
        names[step.result] = step.op == Op::constant ? step.operands[0] | kNumber
                             : equal                 ? operands[std::size_t(equal - 1)]
                                                     : addStep(draft, step.op, operands, arity);
    }
    Tape result{.numbers = tape.numbers};
    std::vector<uint32_t> roots;
    for (uint32_t root : tape.roots) roots.push_back(names[root]);
    allocate(result, draft, names, roots);
    return result;
}

template <class T>
Tape TapeMachine<T>::shortenedForSigns(const Tape& tape) {
    const Arities& all = arities();
    // Of each register, whether more than the sign counts of what is in it, seen from the end.
    names.assign(tape.registers, 0);
    for (std::size_t i = 1; i < tape.roots.size(); ++i) names[tape.roots[i]] = 1;
    for (std::size_t i = tape.steps.size(); i-- > 0;) {
        const TapeStep& step = tape.steps[i];
        const bool exact = std::exchange(names[step.result], 0);
        if (!exact && !(taken[i] & 15)) taken[i] >>= 4;
        if (!exact && keepsSigns(step.op)) continue;
        for (int k = 0; k < all[std::size_t(step.op)]; ++k)
            if (!(step.numbers >> k & 1)) names[step.operands[std::size_t(k)]] = 1;
    }
    return shortened(tape);
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
    Operands operands;
    for (int i = 0; i < std::max<int>(arities()[std::size_t(step.op)], 1); ++i)
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
    const Arities& all = arities();
    // Of each register, which components of its gradient are there; the others are 0.
    static constexpr T kZeros[kGradientPoints] = {};
    names.resize(std::max<std::size_t>(names.size(), tape.registers));
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::fill_n(along(position(int(axis)), axis), count, T(1));
        names[axis] = 1u << axis;
    }
    for (const TapeStep& step : tape.steps) {
        const Operands operands = operandsOf(tape, step);
        T* const result = rows[step.result].numbers;
        names[step.result] = step.positions;
        if (step.op == Op::constant) {
            std::fill_n(result, count, *operands.rows[0]);
            continue;
        }
        const OpKernels<T>& own = *kernels[std::size_t(step.op)];
        const SampledLayer layer = layerOf(tape, step);
        own.values[step.numbers](operands.rows, result, count, layer);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (!(step.positions >> axis & 1)) continue;
            const T* slopes[kMaxArity];
            for (int i = 0; i < all[std::size_t(step.op)]; ++i)  // a number's is not read
                slopes[i] = step.numbers >> i & 1                              ? kZeros
                            : names[step.operands[std::size_t(i)]] >> axis & 1 ? along(operands.rows[i], axis)
                                                                               : kZeros;
            own.slopes[step.numbers](operands.rows, result, slopes, along(result, axis), count, layer);
        }
    }
    const uint32_t first = tape.roots[0];
    const T* const root = rows[first].numbers;
    const auto component = [&](std::size_t axis) {
        return names[first] >> axis & 1 ? static_cast<const T*>(along(root, axis)) : kZeros;
    };
    return {root, {component(0), component(1), component(2)}};
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
           draft.capacity() * sizeof(TapeStep) + names.capacity() * sizeof(uint32_t) +
           Allocation::keptBytes();
}

template class TapeMachine<float>;
template class TapeMachine<double>;

}  // namespace fw
