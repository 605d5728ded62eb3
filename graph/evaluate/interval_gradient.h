// Interval differentiation of tapes: intervals that contain every slope of a field within a box.
//
// IntervalGradientMachine runs a tape forwards over a box. Each value has its interval and an interval for
// each partial derivative. For all points p and q of the box that differ in one coordinate i,
//     f(p) - f(q) is in gradient[i] * (p[i] - q[i])
// and so by a path along the axes f(p) - f(q) is in sum gradient[i] * (p[i] - q[i]) for any p and q. It
// also holds where f has corners: minima, maxima and choices give the hull of their branches, which contains
// Clarke's generalised gradient at all points inside the box. On its faces, and in a box without a volume,
// the bounds are those of f restricted to the box: |x| over [0, 1] has the slope 1. `norm` bounds the length
// of the gradients, and is a Lipschitz constant because a box is convex. All bounds are rounded outwards.
// They hold for f up to its rounding errors.
//
// Operations that may jump within the box get unbounded partial derivatives: floor and its relatives,
// remainders, atan2 at its cut, quotients by 0, and choices whose branches are not proven to meet
// (switching_set.h).
//
// The slopes of noises and of tricubic volumes are bounded by the constants of noise.h and volume.cpp, which
// were found by search, not proven.
//
// Two rules keep bounds tight in practice. A root of a sum of squares is the length of a vector, whose slope
// is bounded at 0 too: d |a| = (a . da) / |a|. And norms are propagated next to the components, since a sum
// over components is up to sqrt(3) times too large: of a length, the norm is at most the spectral norm of
// the rows da, bounded through their Gram matrix by Collatz and Wielandt's quotient.
//
// Theory: Moore, "Interval Analysis" (1966); Clarke, "Optimization and Nonsmooth Analysis" (1983); for fields
// Duff, "Interval Arithmetic and Recursive Subdivision for Implicit Functions" (SIGGRAPH 1992), and Galin,
// Guérin, Paris, Peytavie, "Segment Tracing Using Local Lipschitz Bounds" (2020).
//
// Lifetime: a machine belongs to one thread, serves any tape, and keeps its memory between calls: about 120
// bytes a step.
#pragma once

#include <array>
#include <vector>

#include "graph/base/box.h"
#include "graph/base/interval.h"
#include "graph/evaluate/slopes.h"
#include "graph/evaluate/switching_set.h"
#include "graph/evaluate/tape.h"

namespace fw {

struct IntervalGradient {
    Interval value;
    std::array<Interval, 3> gradient;  ///< along x, y, z; ends at ±kHuge are unbounded
    double norm;                       ///< Lipschitz constant over the box; infinity where none is proven
};

class IntervalGradientMachine {
  public:
    /// The value and the derivatives of the tape's first root.
    IntervalGradient evaluate(const Tape& tape, const Box& box);

    /// An interval that contains every value of the first root over the box: the mean value form around the
    /// box's centre and the plain interval, intersected. The form wins where the box is small, since its
    /// excess shrinks with the square of the box's size.
    Interval meanValue(const Tape& tape, const Box& box);

    /// Bytes that this takes in addition to the tapes.
    std::size_t bytes() const;

  private:
    void setInputs(const Tape& tape, const TapeStep& step, std::size_t number, int arity);
    bool readsFold(const Tape& tape, uint32_t name, uint32_t& folded) const;
    void root(const Tape& tape, uint32_t name, Slopes& result) const;
    void choose(const Tape& tape, uint32_t name, const Slopes* const* slopes, Slopes& result);
    const Slopes& slopesOf(uint32_t name) const;

    TapeValues values;            // by value: 0, 1, 2 are the position, step i is 3 + i
    std::vector<Slopes> slopes_;  // by value
    std::vector<uint32_t> names;  // by register: the value in it
    SwitchingSet switching;
    TapeMachine<double> centre;
};

}  // namespace fw
