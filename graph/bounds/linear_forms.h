// Linear combinations in an expression, and what bounds on them say about their terms.
//
// Interval arithmetic looks at one operation at a time, so it cannot see that |0.8 x + 0.6 y| <= 1 and
// |0.8 y - 0.6 x| <= 1 together bound x and y. Here every value of an Ir is written as a linear combination
// of *atoms*, which are the position's coordinates and the results of operations that are not linear. A
// system of bounded combinations is solved for its unbounded atoms by Gaussian elimination.
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "graph/base/interval.h"
#include "graph/ir/ir.h"

namespace fw {

/// constant + the sum of factor * value(atom).
struct LinearForm {
    struct Term {
        IrId atom;
        double factor;
    };
    std::vector<Term> terms;  ///< ascending atoms, factors not 0
    double constant = 0.0;

    bool isAtom(IrId id) const {
        return terms.size() == 1 && terms[0].atom == id && terms[0].factor == 1.0 && constant == 0.0;
    }
};

/// a + factorOfB * b.
LinearForm sum(const LinearForm& a, const LinearForm& b, double factorOfB);

/// rangeOver() is the range of a form over intervals of its atoms; solveForTerm() is the range of one atom
/// for a range of the form. The factors may be rounded: both are widened for that.
Interval rangeOver(const LinearForm& form, std::span<const Interval> atoms);
Interval solveForTerm(const LinearForm& form, IrId atom, Interval range, std::span<const Interval> atoms);

/// An atom that is written as another form.
using Replacement = std::pair<IrId, LinearForm>;
LinearForm substitute(const LinearForm& form, std::span<const Replacement> replacements);

/// The linear forms of an Ir's values. A form has at most kMaxTerms terms: a longer sum is an atom.
class LinearForms {
  public:
    static constexpr std::size_t kMaxTerms = 6;

    /// Computes the forms of `ids`, which ascend and hold all operands of each other; known ones are kept.
    /// `values`: an interval for each operation; those of a single point are numbers. `isAtom`: operations
    /// that stay atoms, though they may be linear.
    void add(const Ir& ir, std::span<const IrId> ids, std::span<const Interval> values,
             const std::vector<bool>& isAtom);

    void set(IrId id, LinearForm form);

    /// Requires an id that was added or set.
    const LinearForm& operator[](IrId id) const { return forms[id]; }

  private:
    std::vector<LinearForm> forms;
    std::vector<bool> isKnown;
};

/// Up to three of the forms, as a basis of which all forms are linear combinations; and all forms as forms of
/// the basis, whose atoms are indices of the basis. Empty if the forms span more than three dimensions.
/// `atoms`: all that the forms have.
struct LinearBasis {
    std::vector<std::size_t> chosen;  ///< indices of forms
    std::vector<LinearForm> forms;
};
LinearBasis basisOf(std::span<const LinearForm> forms, std::span<const IrId> atoms);

/// Solves forms that are bounded on one or both sides for their unbounded atoms: givenBounds[i] contains
/// given[i]. `atoms` has the current interval of each atom, by id; those that are unbounded are narrowed
/// where the system determines them. Returns the atoms that were narrowed to a bounded interval.
///
/// In exact arithmetic the result is a proof. The factors of the forms are rounded, to some 1e-15 of
/// themselves; the intervals are widened by 1e-9 of their size for that, and systems are rejected whose
/// elimination loses more.
std::vector<IrId> solveForUnbounded(std::span<const LinearForm> given, std::span<const Interval> givenBounds,
                                    std::span<Interval> atoms);

}  // namespace fw
