// BoxContractor: narrows boxes to the part that can hold a solid.
//
// contract() answers: where within this box can f(p) <= level be? The answer is a box that contains every
// such point; it may be larger than needed, never smaller. It starts from any box, infinite ones included, so
// it bounds a solid without a search over space: a ball at (4, 2, 3) is bounded by going backwards from
// length(p - (4, 2, 3)) - 1 <= 0 to the coordinates.
//
// Rules:
// * A minimum is a union: each operand is contracted alone, and the result is the hull. A maximum is an
//   intersection: its operands are contracted one after the other. |f| <= a, -f <= a, f + c <= a, conditional
//   values and blends are taken apart in the same way; a smooth minimum of width k is at most k / 4 below
//   the sharp one, a chain of them at most k.
// * Everything else goes forwards and backwards through its operations on intervals (projections.h).
// * A sum that must be small is taken apart if that bounds nothing: each term by the least values of the
//   others; else at least one of n terms is at most its n-th part, as of a sum of metaballs.
// * Two values that are a rotation of two others by a varying angle, x cos(a) + y sin(a) and
//   y cos(a) - x sin(a), have the same length as those: so twisted and bent solids are bounded.
// * The coordinates beside a spline bound the distance to it.
// * b - a is evaluated as -(a - b) where both occur: a cut needs only one of them.
// * Systems of linear combinations are solved for their unbounded terms (linear_forms.h): so turned solids
//   are bounded.
// * Where all this leaves the box unbounded, minima, maxima and choices within an expression are tried
//   case by case, and every value gets the hull of its intervals in the cases (constructive disjunction).
//   Terms of linear combinations that are piecewise linear, as |x|, are replaced by each of their pieces: so
//   mirrored solids are bounded.
// * Where three values stand between a part of the expression and the position, as the coordinates of a moved
//   solid do (frame_cut.h), that part is bounded in their space first; then the three are. Such values may
//   also be linear forms of the position, of which others are combinations, or replace only some coordinates.
//   Frames nest: contractExhaustively() tries one, then two, up to four within each other.
// * A blend of any form is taken apart by its operands: where its intervals prove a quadrant a > c, b > c
// free,
//   a <= c or b <= c holds elsewhere.
// * What is still unbounded is proven empty from kFarthest inwards, shell by shell: so solids of polynomials
//   are bounded. Beyond kFarthest nothing is known of these.
//
// Points where f is not a number are outside, as for the mesher. A minimum ignores a second operand that is
// NaN, as on the CPU, and a comparison with NaN is false; so nothing is concluded there from operands that
// may be NaN in some volume of space, as 0 / max(x, 0) is. Single points and surfaces where a field is NaN
// hold no solid.
//
// Lifetime: belongs to one thread and one Ir, which must outlive it.
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <span>
#include <stop_token>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "graph/base/box.h"
#include "graph/bounds/frame_cut.h"
#include "graph/bounds/linear_forms.h"
#include "graph/bounds/projections.h"
#include "graph/ir/ir.h"

namespace fw {

/// Up to this coordinate solids are searched for that only a search over space bounds, in units of the
/// document.
inline constexpr double kFarthest = 1e8;
/// Half the sides of the cubes around the origin between which searches over space look, descending.
std::vector<double> shellSizes();
/// A search that finds no bounds within this coordinate is taken for one that lacks proof: solids are rarely
/// so far out.
inline constexpr double kFarShell = 2e5;

/// All of space; its ends stand for infinity, as those of intervals.
inline constexpr Box kAllSpace{{-kHuge, -kHuge, -kHuge}, {kHuge, kHuge, kHuge}};
/// Whether no side of the box is at infinity; and whether it is also of a size that solids have. Bounds that
/// are finite only because numbers are rounded are longer.
bool isFinite(const Box& box);
bool isBounded(const Box& box);
inline constexpr double kLongestSide = 1e12;  ///< of bounded boxes
inline Interval sideOf(const Box& box, std::size_t axis) { return {box.lo[axis], box.hi[axis]}; }

class BoxContractor {
  public:
    /// `parameters`: intervals of the live parameters' values, in their slots. A result holds for all values
    /// in them.
    BoxContractor(const Ir& ir, std::span<const Interval> parameters);
    BoxContractor(const BoxContractor&) = delete;
    BoxContractor& operator=(const BoxContractor&) = delete;

    /// The part of a solid that one operand of a union makes.
    struct Part {
        IrId root;  ///< the solid is where any part's root is <= 0
        Box box;    ///< contains the part
    };
    /// The solid root <= 0 as parts, the operands of its outermost minimum. Empty parts are omitted: an empty
    /// list proves that `within` contains no solid.
    std::vector<Part> parts(IrId root, const Box& within = kAllSpace);

    /// A box that contains all points of `box` where root <= level; nothing if no such point exists.
    std::optional<Box> contract(IrId root, double level, const Box& box);

    /// The same by all rules, also where fewer bound the box: it may be tighter, and takes some times as
    /// long.
    std::optional<Box> contractThoroughly(IrId root, double level, const Box& box);
    /// The same, with cuts of cuts and blends of any form, within `steps` more steps.
    std::optional<Box> contractExhaustively(IrId root, double level, const Box& box, std::size_t steps);

    /// Whether an operation that `root` is computed from may be NaN in some volume of space. The intervals of
    /// a tape say nothing of such values.
    bool mayBeUndefined(IrId root);

    /// Operations evaluated on intervals so far, forwards and backwards. Once there are more than `limit`
    /// contract() returns the box that it was given, which is right but of no use.
    std::size_t steps() const { return stepCount; }
    void setLimit(std::size_t limit) { stepLimit = limit; }
    /// Ends a search in the same way once a stop is requested.
    void setStop(std::stop_token token) { stop = std::move(token); }

  private:
    struct Goal {
        IrId id;
        bool above;  ///< value >= level is wanted, in place of value <= level
        double level;
    };
    struct Constraint {
        IrId id;
        Interval range;
    };
    /// The values that meet a goal.
    static Interval wantedBy(bool above, double level) {
        return above ? Interval{level, kHuge} : Interval{-kHuge, level};
    }
    static constexpr int kMaxDepth = 400;  ///< of nested goals
    /// simple: goals are taken apart. thorough: one cut and shells, too. all: cuts of cuts, of all kinds.
    enum class Rules : unsigned char { simple, thorough, all };
    /// What propagate() does about a box that stays unbounded.
    enum class Effort : unsigned char { quick, cases };
    /// A term of a sum.
    struct Summand {
        IrId id;
        double factor;
    };
    /// The sum of the terms is at most the level.
    struct Sum {
        std::vector<Summand> terms;
        double level;
    };
    /// p = x cos(a) +- y sin(a) and q = y cos(a) -+ x sin(a).
    struct Rotation {
        IrId p, q, x, y;
    };
    /// The channels of one spline at one place that the Ir reads.
    struct SplineUse {
        const SplineTable* table;
        std::array<IrId, kSplineChannels> channels;  ///< 0: is not read
        std::array<IrId, 3> place;
        Box box;  ///< of the spline
    };

    /// Goals that were bounded before, with their boxes; nothing where no point meets the goal.
    using KnownGoals = std::map<std::tuple<IrId, bool, double, int>, std::optional<Box>>;
    /// What expressions are read as functions of: the position, or values that stand between it and them.
    struct Frame {
        std::array<IrId, 3> variables{0, 1, 2};
        std::size_t count = 3;  ///< of variables
        /// Where searches over space look, from outside, each box within the one before; the first ones are
        /// of all frames the images of the same cubes.
        std::vector<Box> shells = {};
        /// Values that are evaluated as linear forms of the variables, in place of their operations.
        std::map<IrId, LinearForm> derived = {};
        LinearForms forms = {};
        std::vector<bool> isAtom = {};  ///< of linear forms
        KnownGoals throughCuts = {}, fromOutside = {};
    };

    /// Values that may become the variables of a frame; empty if no such values exist.
    struct Cut {
        std::vector<IrId> values;
        std::map<IrId, LinearForm> derived = {};  ///< Frame
    };

    std::optional<Box> repeat(const Goal& goal, const Box& box);
    void noteRanges(IrId root, const Box& box);
    /// The operation's interval over the box that contract() was given, or over all of space.
    Interval rangeOf(IrId id) const {
        return notedIn[id] == rangeGeneration && rangeGeneration > 0 ? noted[id] : everywhere[id];
    }
    void trim(const Goal& goal, Box& box, int depth);
    std::optional<Box> reach(const Goal& goal, const Box& box, int depth);
    std::optional<Box> reachTakenApart(const Goal& goal, const Box& box, int depth);
    std::optional<Box> reachThroughCuts(const Goal& goal, const Box& box, int depth);
    std::optional<Box> boundThroughOneCut(const Goal& goal, int depth);
    std::optional<Box> boundThroughCuts(const Goal& goal, int depth);
    std::optional<Box> contractBy(Rules wanted, const Goal& goal, const Box& box);
    std::optional<Box> boundInSpaceOf(const Cut& cut, const Goal& goal, int depth);
    std::optional<Box> boundByOperands(const Cut& cut, const Goal& goal, int depth);
    const Box& limits() const { return frame->shells.front(); }
    std::array<Box, 2> halvesInFrame(const Box& box) const;
    Frame& frameOf(const Cut& cut);
    bool isLinear(IrId id) const;
    Cut linearCut(std::span<const IrId> cone);
    Cut vertexCut(std::span<const IrId> cone, std::span<const IrId> some, CutSide side);
    void deriveLinear(const Goal& goal);
    std::span<const IrId> variables() const { return std::span(frame->variables).first(frame->count); }
    bool isFunctionOfVariables(IrId id);
    /// The variables' ranges over all of space.
    Box rangesOfVariables() const;
    std::optional<Box> reachAny(const Goal& goal, const Box& box, int depth);
    std::optional<Box> reachAll(const Goal& goal, const Box& box, int depth);
    std::optional<Box> reachSelected(const Goal& goal, const Box& box, int depth);
    std::optional<Box> reachLeaf(const Goal& goal, const Box& box, int depth);
    std::optional<Box> reachFromOutside(const Goal& goal, const Box& box, int depth);
    std::optional<Box> boundFromOutside(const Goal& goal, int depth);
    void extendToLimits(Box& box) const;
    /// The part of `box` within what bound() returned for the goal. It is called once for each goal, unless
    /// it ran out of steps, and bounds the goal in all of space.
    template <class Bound>
    std::optional<Box> once(KnownGoals& known, const Goal& goal, int effort, const Box& box,
                            const Bound& bound) {
        const std::tuple key{goal.id, goal.above, goal.level, effort};
        auto found = known.find(key);
        const std::optional<Box> all = found == known.end() ? bound() : found->second;
        if (found == known.end() && !isSpent()) known.emplace(key, all);
        return all ? common(*all, box) : std::nullopt;
    }
    bool isSeenFarAway(const Goal& goal, const Box& box, int samples);
    bool isUnreachable(const Goal& goal, const Box& box, int splits, int depth);
    std::optional<Box> reachCondition(IrId id, bool truth, const Box& box, int depth);
    std::optional<Box> reachSum(const Goal& goal, const Box& box, int depth);
    std::optional<Box> propagate(std::vector<Constraint> constraints, const Box& box, int depth,
                                 Effort effort = Effort::cases, std::vector<Replacement> replacements = {});
    /// One of the ways in which a piecewise linear value can be linear.
    struct Piece {
        std::vector<Constraint> constraints;
        std::vector<Replacement> replacements;
    };
    std::vector<Piece> piecesOfUnbounded(std::span<const IrId> cone,
                                         std::span<const Replacement> replacements);
    /// Goals of whole operations are taken apart: f + 1 <= 0 becomes f <= -1.
    Goal peeled(Goal goal) const;
    bool isUnion(const Goal& goal) const;

    bool forwards(std::span<const IrId> cone, bool narrow);
    bool backwards(std::span<const IrId> cone);
    std::vector<std::vector<Constraint>> casesOf(IrId id) const;
    std::vector<IrId> operandsOf(IrId id, Op op) const;
    std::vector<Summand> summandsOf(IrId id) const;
    std::optional<Sum> sumOf(const Goal& goal) const;
    bool add(Sum& sum, const Summand& term) const;
    double leastOf(const Summand& term) const;
    std::vector<Sum> unfolded(const Sum& sum) const;
    std::optional<Box> reachTerms(const Sum& sum, const Box& box, int depth);
    std::optional<Box> reachTerm(const Summand& term, double most, const Box& box, int depth);
    bool disjoin(IrId id);
    bool narrow(std::span<const IrId> cone, std::span<const Replacement> replacements, int rounds);
    bool projectNode(IrId id);
    bool projectRotations(IrId id);
    bool projectSplines(IrId id);
    std::size_t boundedCount(std::span<const IrId> cone) const;
    bool solveLinear(std::span<const IrId> cone, std::span<const Replacement> replacements, bool& narrowed);
    /// The intervals of all operations over the box.
    std::vector<Interval> evaluateAll(std::span<const Interval> parameters, const Box& box);
    void findAngles();
    void findOpposites();
    void findRotations();
    void findSplines();
    /// The operations that depend on the position, up to those of the constraints, ascending.
    std::vector<IrId> coneOf(std::span<const Constraint> constraints);
    Interval evaluate(IrId id) const;
    bool isNumber(IrId id) const { return ir[id].positions == 0; }
    bool isVariable(IrId id) const { return std::ranges::find(variables(), id) != variables().end(); }
    /// The operation that an id is taken for: none (Op::count) of variables and linear forms of them.
    Op opOf(IrId id) const { return isVariable(id) || derivedForm(id) ? Op::count : ir[id].op; }
    const LinearForm* derivedForm(IrId id) const {
        if (frame->derived.empty()) return nullptr;
        const auto found = frame->derived.find(id);
        return found == frame->derived.end() ? nullptr : &found->second;
    }
    /// The values that a value of the cone is computed from: variables, and others of the cone.
    std::vector<IrId> dependenciesOf(IrId id) const;
    bool projectDerived(IrId id, const LinearForm& form);
    /// The current intervals of the variables; sides beyond their number are a point.
    Box variableBox() const;
    void setVariables(const Box& box);
    /// Whether current[id] belongs to the cone at hand.
    bool isCurrent(IrId id) const { return isNumber(id) || isVariable(id) || evaluatedIn[id] == evaluation; }
    bool isSpent() const { return stepCount > stepLimit || stop.stop_requested(); }

    const Ir& ir;
    std::vector<Interval> everywhere;  ///< of each operation, over all of space
    std::vector<Interval> current;     ///< over the box at hand, where the constraints hold
    std::vector<bool> mayBeNaN;        ///< in some volume of space (undefined.h)
    std::vector<bool> isAngular;       ///< functions of angles (atan2) alone, which bound no coordinate
    std::vector<IrId> opposites;       ///< of b - a: a - b, if that has a smaller id; else 0
    std::vector<uint32_t> stamps;
    uint32_t stamp = 0;
    std::vector<uint32_t> evaluatedIn;  ///< of each operation: the last evaluation of a cone that had it
    uint32_t evaluation = 0;
    std::vector<Interval> noted;    ///< of operations, over the box that noteRanges() was given
    std::vector<uint32_t> notedIn;  ///< when that was
    uint32_t rangeGeneration = 0;
    std::map<std::vector<IrId>, Frame> frames;  ///< by their variables; of no variables: by the position
    Frame* frame = &frames[{}];
    std::unordered_multimap<IrId, Rotation> rotations;  ///< by the smaller of p and q
    std::unordered_map<IrId, SplineUse> splines;        ///< by the smallest id of its channels
    std::size_t farShell = 0;                           ///< the first of a frame's shells within kFarShell
    int caseDepth = 0;                                  ///< of nested cases that backwards() may go through
    Rules rules = Rules::simple;                        ///< of reach()
    int cutsLeft = 0;                                   ///< of nested frames that Rules::all may enter
    std::size_t shellLimit = 0;                         ///< of stepCount, for the shells at hand
    std::size_t caseLimit = 0;                          ///< of stepCount, after which no more cases are tried
    std::size_t stepCount = 0, stepLimit = SIZE_MAX;
    std::stop_token stop;
};

}  // namespace fw
