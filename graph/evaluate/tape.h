// A field as a list of steps over a few registers, which gets shorter where space is smaller.
//
// A tape is made once, of one or several values of an Ir, with the live parameters' values: it holds only the
// operations that these need, and what does not depend on the position is a number in it. Each step names the
// operation, and the registers or numbers that it reads and the register that it writes; registers are given
// by a linear scan backwards over the steps, so there are as many as values are alive at once, not as many as
// operations. One interpreter runs it, with the meanings that the op table's rows give (ir/ops.h): a batch of
// points a step, in single or double precision, with slopes or gradients beside the values, or intervals over
// a box.
//
// Over a box, intervals often decide which side of a minimum, a maximum or a choice is taken everywhere. What
// was not taken is then needed no longer, and the box has a tape of its own, mostly much shorter than the
// field's: of two hundred shapes in a union a brick of the grid meets a few. Its values are bit for bit those
// of the full tape within its box, in the precision of the machine whose intervals decided, so samples that
// two boxes share agree.
//
// Theory: Keeter, "Massively Parallel Rendering of Complex Closed-Form Implicit Surfaces" (SIGGRAPH 2020),
// where a GPU interprets the tapes, and his fidget, whose register allocation runs backwards too. Deviations:
// steps that z does not move come first and keep their registers, so that planes of a grid pay for the rest
// alone; and what is decided is renamed forwards before registers are given anew, so no step only copies.
//
// Lifetime: a Tape is a value; it shares its numbers with those made from it, and keeps the images, volumes,
// outlines and splines that it samples: the Ir may go. A TapeMachine belongs to one thread, and serves any
// tape.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

#include "graph/base/box.h"
#include "graph/ir/ir.h"

namespace fw {

struct TapeStep {
    Op op;              ///< Op::constant puts its number into a register
    uint8_t numbers;    ///< mask of the operands that are places among the numbers, not registers
    uint8_t positions;  ///< PositionMask
    uint32_t result;    ///< a register; none of the operands
    /// Those beyond the arity are 0; but of a step that samples, the last is the layer's place.
    std::array<uint32_t, kMaxArity> operands;
};

/// What the tapes made from one another have in common.
struct TapeNumbers {
    std::vector<double> doubles;
    std::vector<float> floats;  ///< the same
    std::vector<SampledLayer> layers;
    // what these are of
    std::vector<FieldImagePtr> images;
    std::vector<FieldVolumePtr> volumes;
    std::vector<OutlinePtr> outlines;
    std::vector<SplineTablePtr> splines;
};

struct Tape {
    std::shared_ptr<const TapeNumbers> numbers;
    std::vector<TapeStep> steps = {};  ///< in the order in which they are computed
    std::vector<uint32_t> roots = {};  ///< registers in which the values are at the end
    uint32_t registers = 3;            ///< of which the first three hold the position
    uint32_t still = 0;                ///< the first so many steps do not depend on z
};

/// The tape of these values, with `parameters` in their slots.
Tape makeTape(const Ir& ir, std::span<const IrId> roots, std::span<const double> parameters);
Tape makeTape(const Ir& ir, IrId root, std::span<const double> parameters);

/// What runs tapes, in single or double precision. Memory is a row a register, and some bytes a step once
/// intervals are asked for.
template <class T>
class TapeMachine {
  public:
    static constexpr std::size_t kRowBytes = 768;
    /// Points at most, of value(), of slope() and of gradient().
    static constexpr std::size_t kPoints = kRowBytes / sizeof(T), kSlopePoints = kPoints / 2,
                                 kGradientPoints = kPoints / 4;

    TapeMachine() : rows(3) {}

    /// An interval that contains every value of the tape's first root over the box, as this machine computes
    /// it.
    Interval interval(const Tape& tape, const Box& box);
    /// Whether some operation jumped between few values over the box of the last call of interval().
    bool jumps() const { return jumped; }
    /// The first root is at least 0 all over the box in each case of such jumps (jump_cases.h): proven, or
    /// false.
    bool positiveInEachCase(const Tape& tape, const Box& box) requires std::is_same_v<T, double>;
    /// Whether the last call of interval() decided anything.
    bool shortens() const { return decisions > 0; }
    /// So many steps were decided by it.
    std::size_t decidedSteps() const { return decisions; }
    /// So many steps were run on intervals since the machine was made.
    std::size_t intervalSteps() const { return stepsRun; }
    /// The tape for the box of the last call of interval(), which was for this tape.
    Tape shortened(const Tape& tape);
    /// The same for who looks at the first root's sign alone: below, at, or above 0. Of a minimum whose sign
    /// is all that counts, what is above 0 all over the box is left out; of a maximum what is below. Near the
    /// places where the value is 0 it is the full tape's.
    Tape shortenedForSigns(const Tape& tape);

    /// Where to write the batch's positions along an axis, before each evaluation.
    T* position(int axis) { return rows[std::size_t(axis)].numbers; }
    /// Where to write the direction, point by point, that slope() goes along.
    T* direction(int axis) { return position(axis) + kSlopePoints; }

    /// Computes the roots' values at `count` points; the first root's. If z alone has moved since the last
    /// call, which was for the same tape, `onlyZ` saves what does not depend on it.
    const T* value(const Tape& tape, std::size_t count, bool onlyZ = false);
    /// A root's values, after value().
    const T* root(const Tape& tape, std::size_t number) const { return rows[tape.roots[number]].numbers; }

    struct Slopes {
        const T *values, *slopes;
    };
    /// Values of the first root, and derivatives along the directions.
    Slopes slope(const Tape& tape, std::size_t count);

    struct Gradients {
        const T* values;
        std::array<const T*, 3> gradients;  ///< along x, y, z
    };
    Gradients gradient(const Tape& tape, std::size_t count);

    /// Values of the first root at any number of points.
    void evaluate(const Tape& tape, std::span<const Point> points, std::span<double> values);

    /// Bytes that this and its thread take beside the tapes.
    std::size_t bytes() const;

  private:
    struct alignas(64) Row {
        T numbers[kPoints];
    };
    struct Operands {
        const T* rows[kMaxArity];
    };
    void make(const Tape& tape);
    /// Makes room for intervals, and puts the box into its registers.
    void enter(const Tape& tape, const Box& box);
    /// Puts a step's interval into its register, and gives those of its operands.
    void takeInterval(const Tape& tape, const TapeStep& step, const OpInfo* table, Interval* operands);
    bool positiveFrom(const Tape& tape, std::size_t first, int splits);
    Operands operandsOf(const Tape& tape, const TapeStep& step) const;

    std::vector<Row> rows;            // by register
    std::vector<Interval> intervals;  // by register
    /// By step: the operand that its result equals, counted from 1, or 0; and from bit 4 on the one that has
    /// its sign.
    std::vector<uint8_t> taken;
    std::size_t decisions = 0;
    bool jumped = false;
    std::size_t stepsRun = 0;     // on intervals
    std::vector<TapeStep> draft;  // of a shortened tape
    std::vector<uint32_t> names;  // by register, then by value of the draft
};

extern template class TapeMachine<float>;
extern template class TapeMachine<double>;

}  // namespace fw
