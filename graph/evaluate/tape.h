// A field as a list of steps that gets shorter where space is smaller.
//
// Over a box, intervals often decide which side of a minimum, a maximum or a choice is taken everywhere. What
// was not taken is then needed no longer, and the box has a tape of its own, mostly much shorter than the
// field's: of two hundred shapes in a union a brick of the grid meets a few. So a field can be sampled at
// once, without compiling it, at a cost that hardly grows with the graph. Theory: Keeter, "Massively Parallel
// Rendering of Complex Closed-Form Implicit Surfaces" (SIGGRAPH 2020), where a GPU interprets the tapes; here
// the host does, one step over a batch of points at a time. A shortened tape has bit for bit the values of
// the full one within its box, so samples that two boxes share agree.
//
// Lifetime: a Tape is a value; it refers to an Ir by ids. A TapeMachine belongs to one thread and must not
// outlive the Ir.
#pragma once

#include <vector>

#include "graph/evaluate/evaluate.h"

namespace fw {

struct TapeStep {
    Op op;
    uint8_t positions;  ///< PositionMask
    IrId result;
    std::array<IrId, kMaxArity> operands;  ///< all valid; those beyond the arity repeat the first
    SampledLayer layer;
};

/// Steps in the order in which they are computed. Leaves have none: a machine holds them.
struct Tape {
    std::vector<TapeStep> steps;
    IrId root = 0;
};

Tape makeTape(const Ir& ir, IrId root);

class TapeMachine {
  public:
    static constexpr std::size_t kBatch = 96;  ///< points at most
    static constexpr uint8_t kAllAxes = dependsOnX | dependsOnY | dependsOnZ;

    TapeMachine(const Ir& ir, std::span<const double> parameters);

    /// An interval that contains every value of the tape over the box.
    Interval interval(const Tape& tape, const Box& box);
    /// The tape for the box of the last call of interval(), which was for this tape.
    Tape shortened(const Tape& tape);

    /// Where to write the batch's positions along an axis, kBatch numbers.
    double* position(int axis) { return &values[axis * kBatch]; }
    /// Where to write the direction, point by point, that slopes() goes along.
    double* direction(int axis) { return &derivatives[axis * kBatch]; }

    /// Values at `count` points. Steps that depend on none of the `moved` axes keep their results of the last
    /// call for the same tape.
    const double* value(const Tape& tape, std::size_t count, uint8_t moved = kAllAxes);
    /// Derivatives along the directions at the points of the last call of value().
    const double* slope(const Tape& tape, std::size_t count);

  private:
    std::vector<Interval> intervals;          // by id
    std::vector<double> values, derivatives;  // by id, kBatch each
    std::vector<IrId> alias;                  // what stands for an id in the shortened tape
    std::vector<bool> needed;
};

}  // namespace fw
