// The region of a solid: a box that is proven to contain all of f < 0.
//
// 1. The solid is split into the operands of its outermost minimum, and each is bounded on its own by going
//    backwards through its expression from all of space (box_contractor.h). A ball far away is bounded no
//    matter how distorted the solid next to it is.
// 2. A part that this cannot bound is proven empty shell by shell, from kFarthest inwards, by the field's
//    Lipschitz constant and by contracting cells of the shells. What shells do not bound is contracted by all
//    rules.
// 3. The hull of all parts is refined by intervals over cells (hull_refinement.h).
//
// Nothing is known by samples, with one exception: points inside the solid at kFarthest tell "unbounded" from
// "unproven".
#pragma once

#include <limits>
#include <span>
#include <stop_token>

#include "graph/base/result.h"
#include "graph/bounds/box_contractor.h"
#include "graph/evaluate/evaluate.h"

namespace fw {

enum class Extent : unsigned char {
    bounded,
    empty,
    unbounded,  ///< solid was found beyond half of kFarthest
    unproven    ///< the search could neither find an end of the solid nor solid beyond it
};

struct Region {
    Extent extent = Extent::bounded;
    /// Contains the solid if `extent` is bounded; not padded.
    Box box;
    Box unproven;  ///< where nothing is proven, within kFarthest
};

/// `lipschitz`: of the distance, infinite where it is not known. `stop`: ends the search soon; the result is
/// then unproven.
Region findRegion(const Ir& ir, IrId distance, std::span<const double> parameters,
                  double lipschitz = std::numeric_limits<double>::infinity(), std::stop_token stop = {});

/// `box` grown on every side by `cells` cells of the grid that has `resolution` cells along the longest side
/// of the result.
Box padded(const Box& box, int resolution, double cells);

}  // namespace fw
