// HullRefinement: shrinks the bounding box of a solid by dropping cells that are provably empty.
//
// The solid is given as parts, each with a box that contains it. The hull of all boxes is refined in rounds:
// cells that touch a face of the hull are halved across their longest side, and halves that an interval
// proves empty are dropped. A face of the hull stays where it is as long as one cell there is left, so only
// one cell a face is looked at; the others wait, and catch up on the rounds that they missed once that one is
// gone. Each cell has a tape that is simplified for its box (tape.h). Cells that a discontinuity runs
// through, as those between the copies of a repetition, are tested case by case (jump_cases.h).
//
// Deviation from a plain octree search: the hulls are those of an octree that is refined everywhere.
#pragma once

#include <memory>
#include <optional>
#include <queue>
#include <span>
#include <stop_token>
#include <vector>

#include "graph/bounds/box_contractor.h"
#include "graph/evaluate/interval_gradient.h"
#include "graph/evaluate/tape.h"

namespace fw {

/// Whether the value at the box's centre proves that the field is positive in all of it. `lipschitz`: of the
/// field; infinite if unknown.
bool isProvenOutside(TapeMachine<double>& machine, const Tape& tape, const Box& box, double lipschitz);

/// The limits of a search.
struct RefinementEffort {
    std::size_t cells, steps;  ///< steps of tapes and of contractions
    int patience;              ///< rounds in a row without progress; three rounds halve the cells
    bool isThorough;           ///< cells are contracted, and tested by the mean value form
};

class HullRefinement {
  public:
    /// `lipschitz`: of the field `root` as a whole, infinite if unknown: then cells are also tested by the
    /// value at their centre.
    /// `contractor` is of the same Ir and parameters, and outlives this. Once a `stop` is requested refine()
    /// returns what it has.
    HullRefinement(const Ir& ir, IrId root, std::span<const double> parameters, double lipschitz,
                   BoxContractor& contractor, std::stop_token stop);

    /// A box that contains all parts, at most their hull; nothing if the parts are proven empty.
    std::optional<Box> refine(std::span<const BoxContractor::Part> parts);

    /// Whether samples of the solid reach so far towards the faces of the hull that its longest side is at
    /// most `ratio` times as long as theirs, and all sides at most `sideRatio` times.
    bool isCloseToSamples(double ratio, double sideRatio);

    std::size_t steps() const { return machine.intervalSteps() + pointSteps; }

  private:
    struct Cell {
        Box box;
        std::size_t rounds = 0;                 ///< that it has been through
        IrId part = 0;                          ///< whose tape it has, until there is `tape`
        std::shared_ptr<const Tape> tape = {};  ///< of the part, within the box
        bool isSplit = false;
        /// The part has no NaN in a volume, of which intervals of the tape say nothing.
        bool isDefined = true;
        enum class Centre : unsigned char { unknown, inside, outside } centre = Centre::unknown;
        std::size_t first = 0, last = 0;  ///< the halves that are left, from `first` to before `last`
    };

    void start(std::span<const BoxContractor::Part> parts);
    bool refine(const RefinementEffort& effort);
    std::optional<double> settle(std::size_t face);
    bool advance();
    bool isTight(std::size_t axis, Cell& cell);
    void split(std::size_t number);
    void shave(Cell cell);
    void test(Cell cell);
    const Tape& wholeTape();
    void enter(std::size_t face, std::size_t number);
    bool canSplit() const {
        return cellCount + 2 <= maxCells && steps() < maxSteps && !stop.stop_requested();
    }
    const Box& hull() const { return hulls.back(); }

    const Ir& ir;
    IrId root;
    std::vector<double> parameters;
    double lipschitz;
    BoxContractor& contractor;
    std::stop_token stop;
    bool isThorough = false;  ///< RefinementEffort
    bool isSettled = false;   ///< all faces are tight
    TapeMachine<double> machine;
    IntervalGradientMachine gradients;
    std::optional<Tape> whole;  ///< of the root, for values at centres
    std::size_t pointSteps = 0, cellCount = 0, splitCount = 0, maxCells = 0, maxSteps = 0;
    std::vector<Box> hulls;  ///< before each round
    std::vector<Cell> cells;
    /// Cells by how far out they are at each of the hull's faces; of those at one place the last first, as it
    /// has been through the most rounds. Halves replace their cell once it is the first.
    std::array<std::priority_queue<std::pair<double, std::size_t>>, 6> faces;
};

}  // namespace fw
