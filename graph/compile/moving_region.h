// The region of a solid that moves: a box that contains it at every time of the timeline.
//
// 1. The solid's region is found at some moments (momentsOf), and the hull of these is taken.
// 2. The space outside the hull is proven empty for all times between two moments: the live parameters are
//    intervals there (LiveProgram::rangesBetween), and a BoxContractor bounds the solid for all values in
//    them. Where that fails the time is halved, then the box; what still may hold solid joins the hull.
//
// So the region may be larger than needed where the proof fails. Where not even a bounded box is proven, the
// region is that of the moments, and `unproven` says between which times it may be too small. Times outside
// the timeline are not looked at.
#pragma once

#include <optional>
#include <stop_token>
#include <utility>

#include "graph/bounds/region.h"
#include "graph/compile/live_program.h"

namespace fw {

struct MovingRegion {
    /// As of findRegion(), for all times; of one that is not bounded: at `time`.
    Region region;
    double time = 0.0;  ///< seconds on the timeline, of a region that is not bounded
    /// Seconds on the timeline, from and to: the first times between which the solid may leave the region.
    std::optional<std::pair<double, double>> unproven = {};
};

/// Searches moments on several threads.
MovingRegion findMovingRegion(const LiveProgram& program, std::stop_token stop = {});

}  // namespace fw
