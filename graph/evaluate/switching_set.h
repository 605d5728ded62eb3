// Proofs that the branches of a choice meet: that `condition ? a : b` is continuous within a box.
//
// A condition changes only where a comparison in it changes: where its two sides g and h are equal, if these
// are continuous. The choice is continuous if a - b is 0 at all such points, which is proven for each
// undecided comparison in turn:
// * a and b are expanded into sums of terms with constant factors. If a - b is a multiple of g - h the choice
//   is a minimum, a maximum or a fold along a plane.
// * Otherwise the intervals of g and h are narrowed to their common part and this is propagated backwards
//   through the tape: where max(x, y) = 0, neither is above 0. Then a - b is evaluated again on the narrowed
//   intervals. This proves a shape that is max(q) inside and length(max(q, 0)) outside.
// Coefficients and intervals are compared up to kJumpRounding of the branches' values: the constants of a
// reflection are themselves rounded. A proof that fails says nothing.
//
// Theory: Benhamou et al., "Revising Hull and Box Consistency" (ICLP 1999), the propagation.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "graph/base/interval.h"
#include "graph/evaluate/tape.h"

namespace fw {

/// The values of a tape in static single assignment form: value i < 3 is a coordinate, value 3 + i is the
/// result of step i.
struct TapeValues {
    /// A name with this bit is a place among the tape's numbers, any other is a value.
    static constexpr uint32_t kNumber = 1u << 31;

    std::vector<Interval> intervals;                        ///< by value, over the box
    std::vector<uint8_t> continuous;                        ///< by value, whether it is proven to be
    std::vector<std::array<uint32_t, kMaxArity>> operands;  ///< of step i, names

    Interval interval(const Tape& tape, uint32_t name) const {
        if (!(name & kNumber)) return intervals[name];
        const double number = tape.numbers->doubles[name & ~kNumber];
        return {number, number};
    }
};

/// Largest jump, relative to the branches' values, that counts as rounding; and the largest in metres.
inline constexpr double kJumpRounding = 1e-13, kMaxJump = 1e-12;

class SwitchingSet {
  public:
    /// Whether the choice that value `choice` makes is proven continuous.
    bool branchesMeet(const Tape& tape, const TapeValues& values, uint32_t choice);

  private:
    /// A sum of values with factors, and a constant. `size` bounds the number of terms.
    struct Sum {
        static constexpr int kMaxTerms = 12;
        std::array<uint32_t, kMaxTerms> terms;
        std::array<double, kMaxTerms> factors;
        int count = 0;
        double constant = 0.0;
        bool tooLong = false;
        void add(uint32_t term, double factor);
    };
    void expand(Sum& sum, uint32_t name, double factor, int depth) const;
    bool meetsAlong(uint32_t condition, uint32_t a, uint32_t b, int depth);
    bool meetWhereEqual(uint32_t g, uint32_t h, uint32_t a, uint32_t b);
    bool isSmall(const Sum& sum, double tolerance);
    bool narrow(uint32_t name, Interval to, int depth);
    Interval narrowed(uint32_t name) const;
    Interval again(uint32_t name, int depth);
    const TapeStep* stepOf(uint32_t name) const;

    struct Entry {
        uint32_t name;
        Interval interval;
    };
    Entry* find(uint32_t name);

    const Tape* tape = nullptr;
    const TapeValues* values = nullptr;
    std::vector<Entry> entries;  ///< values with intervals that hold where g = h
    int visits = 0;              ///< left for this proof
};

}  // namespace fw
