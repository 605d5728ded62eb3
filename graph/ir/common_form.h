// The common form of values that are the same operations on different numbers (anti-unification: Plotkin, "A
// Note on Inductive Generalization", Machine Intelligence 5, 1970): new operations over columns of numbers,
// which are the value in one row for each.
//
// What folding took out of some is restored: beside x - 2 and 3 - x, x is 1 x + 0, to the same bits (but for
// the sign of a zero). Where values differ in more than numbers and are few, a column chooses among them;
// those, and what is the same value in all, are no part of the form: it takes them in.
//
// Lifetime: refers to the Ir and to what is like what while a form is looked for.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "graph/ir/ir.h"

namespace fw {

/// What a value is like. Of different numbers, and of sums and products with numbers, nothing is seen.
struct Likeness {
    uint64_t loose = 0;   ///< equal too where coordinates are exchanged or mixed, as by turning
    uint64_t strict = 0;  ///< equal for the same operations, on the same coordinates
    bool linear = false;  ///< a combination of coordinates
};

/// Of the values that are needed; none of the others.
std::vector<Likeness> likenesses(const Ir& ir, const std::vector<bool>& needed);

/// A form in an Ir.
struct CommonForm {
    std::vector<IrId> steps;   ///< new operations, in order
    std::vector<IrId> values;  ///< what each list of values became
    std::vector<IrId> inputs;  ///< what the steps take in: values that were there
    std::vector<std::vector<float>> columns;
};

class CommonFormFinder {
  public:
    /// `mostSteps`: forms that are longer are not found.
    CommonFormFinder(const Ir& ir_, std::span<const Likeness> likeness_, std::size_t mostSteps_)
        : ir(ir_), likeness(likeness_), mostSteps(mostSteps_) {}

    /// Seeks a form of the values, one a row. False if there is none.
    bool find(const std::vector<IrId>& values);
    /// How many operations what was found has.
    std::size_t size() const;
    /// What their code weighs (OpInfo::weight).
    std::size_t weight() const;
    /// What was found, as operations of the Ir that was searched; `firstColumn` numbers the columns' leaves.
    CommonForm addTo(Ir& to, uint32_t firstColumn) const;

  private:
    using Row = std::vector<IrId>;  // of the values that some part of the form stands for
    struct Step {
        Op op;
        double number;  // of a constant; of a column its place
        std::array<IrId, kMaxArity> operands;
        uint32_t origin;
        auto key() const { return std::tuple(op, number, operands); }
    };

    std::optional<IrId> form(const Row& row);
    std::optional<IrId> sum(const Row& row);
    std::optional<IrId> operation(const Row& row);
    std::optional<IrId> choice(const Row& row, std::size_t most);
    IrId numbers(std::span<const double> of, uint32_t origin);
    IrId step(const Step& step);
    std::array<int, kMaxArity> orderOf(const IrNode& node) const;
    bool isLong(IrId id) const;
    std::vector<bool> used() const;  // of the steps

    const Ir& ir;
    const std::span<const Likeness> likeness;
    const std::size_t mostSteps;
    std::size_t depth = 0;
    std::vector<Step> steps;  // ids from ir.size() on; operands before users
    std::map<std::tuple<Op, double, std::array<IrId, kMaxArity>>, IrId> known;
    std::map<Row, std::optional<IrId>> forms;
    std::vector<std::vector<float>> columns;
    std::vector<IrId> roots;
};

}  // namespace fw
