#include "graph/evaluate/tape.h"

#include <algorithm>

namespace fw {

namespace {

/// The operand that the step's result equals all over the box, or the result itself.
IrId decided(const TapeStep& step, const std::vector<Interval>& intervals) {
    const Interval a = intervals[step.operands[0]], b = intervals[step.operands[1]];
    switch (step.op) {
        case Op::minimum:
            if (a.hi < b.lo) return step.operands[0];
            if (b.hi < a.lo) return step.operands[1];
            break;
        case Op::maximum:
            if (a.lo > b.hi) return step.operands[0];
            if (b.lo > a.hi) return step.operands[1];
            break;
        case Op::smoothMinimum:
            if (a.hi + intervals[step.operands[2]].hi < b.lo) return step.operands[0];
            if (b.hi + intervals[step.operands[2]].hi < a.lo) return step.operands[1];
            break;
        case Op::select:
            if (a.lo == 1.0) return step.operands[1];
            if (a.hi == 0.0) return step.operands[2];
            break;
        default: break;
    }
    return step.result;
}

}  // namespace

Tape makeTape(const Ir& ir, IrId root) {
    std::vector<bool> needed(root + 1);
    needed[root] = true;
    for (IrId id = root + 1; id-- > 0;)
        for (int i = 0; needed[id] && i < opInfo(ir[id].op).arity; ++i) needed[ir[id].operands[i]] = true;
    Tape tape;
    tape.root = root;
    for (IrId id = 0; id <= root; ++id) {
        const int arity = opInfo(ir[id].op).arity;
        if (!needed[id] || arity == 0) continue;
        TapeStep& step =
            tape.steps.emplace_back(TapeStep{ir[id].op, ir[id].positions, id, {}, ir.layer(ir[id])});
        for (int i = 0; i < kMaxArity; ++i) step.operands[i] = ir[id].operands[i < arity ? i : 0];
    }
    return tape;
}

TapeMachine::TapeMachine(const Ir& ir, std::span<const double> parameters)
    : intervals(ir.size()),
      values(ir.size() * kBatch),
      derivatives(ir.size() * kBatch),
      alias(ir.size()),
      needed(ir.size()) {
    for (IrId id = 0; id < ir.size(); ++id) {
        alias[id] = id;
        if (opInfo(ir[id].op).arity != 0 || id < 3) continue;
        const double value =
            ir[id].op == Op::parameter ? parameters[std::size_t(ir[id].number)] : ir[id].number;
        intervals[id] = {value, value};
        std::fill_n(&values[id * kBatch], kBatch, value);
    }
}

Interval TapeMachine::interval(const Tape& tape, const Box& box) {
    for (int axis = 0; axis < 3; ++axis) intervals[axis] = {box.lo[axis], box.hi[axis]};
    for (const TapeStep& step : tape.steps) {
        Interval operands[kMaxArity];
        for (int i = 0; i < kMaxArity; ++i) operands[i] = intervals[step.operands[i]];
        intervals[step.result] = opInfo(step.op).interval(operands, step.layer);
    }
    return intervals[tape.root];
}

Tape TapeMachine::shortened(const Tape& tape) {
    for (const TapeStep& step : tape.steps) {
        const IrId taken = decided(step, intervals);
        alias[step.result] = taken == step.result ? taken : alias[taken];
        needed[step.result] = false;
    }
    Tape result;
    result.root = alias[tape.root];
    needed[result.root] = true;
    for (auto step = tape.steps.rbegin(); step != tape.steps.rend(); ++step) {
        if (!needed[step->result] || alias[step->result] != step->result) continue;
        TapeStep& kept = result.steps.emplace_back(*step);
        for (IrId& operand : kept.operands) needed[operand = alias[operand]] = true;
    }
    std::ranges::reverse(result.steps);
    return result;
}

const double* TapeMachine::value(const Tape& tape, std::size_t count, uint8_t moved) {
    for (const TapeStep& step : tape.steps) {
        if (!(step.positions & moved) && moved != kAllAxes) continue;
        const double* operands[kMaxArity];
        for (int i = 0; i < kMaxArity; ++i) operands[i] = &values[step.operands[i] * kBatch];
        opInfo(step.op).values(operands, &values[step.result * kBatch], count, step.layer);
    }
    return &values[tape.root * kBatch];
}

const double* TapeMachine::slope(const Tape& tape, std::size_t count) {
    for (const TapeStep& step : tape.steps) {
        const double *operands[kMaxArity], *slopes[kMaxArity];
        for (int i = 0; i < kMaxArity; ++i) {
            operands[i] = &values[step.operands[i] * kBatch];
            slopes[i] = &derivatives[step.operands[i] * kBatch];
        }
        double* result = &derivatives[step.result * kBatch];
        opInfo(step.op).gradients(operands, &values[step.result * kBatch], slopes, result, count, step.layer);
    }
    return &derivatives[tape.root * kBatch];
}

}  // namespace fw
