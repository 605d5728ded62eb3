// Repetitions: what repeat, polar_repeat and scatter claim about their fields, and the warning of copies that
// do not fit.
//
// A repetition samples the surface only for the copies near a point. On the plane where it drops one copy for
// another the field is continuous only if the dropped copy is nowhere nearer than those that are kept.
//
// repeat, polar_repeat. Let the solid S of the surface f fit into its cell, |x| <= P / 2 along each repeated
// axis, or in its sector, |angle| <= pi / n. Let p be between the centres of the copies 0 and 1: x in [0, P].
// For each point s of S, p is at least as near to s of copy 0 or of copy 1 as to s of any other copy: |x - s|
// <= x + P - s, since s <= P / 2 and x >= 0; the other side and the other axes likewise, one by one. In a
// sector the distance to the turned s grows with the difference of the angles, to which the same applies. So
// the nearest copy is always one of those that are sampled. If f is exact outside, f is this distance, and
// the sampled minimum is the distance to all copies: exact outside. Where a copy is dropped, its value is no
// less than that of a kept one, so the field is continuous there; a continuous field that is piecewise the
// minimum of k-Lipschitz functions is k-Lipschitz. Inside a copy all others are positive, so the same holds.
//
// If f is only a bound this proves nothing: f may be small far from S on one side and large on the other, so
// that a dropped copy has the least value although it is not the nearest. A thin cap of a large ball is such
// a surface. Nothing is claimed then, unless f is its own mirror image across the plane: in an endless row or
// a full circle the copy that is dropped then has the value of the copy that is added, whatever f is, and the
// field is continuous. Up to four copies around an axis are all sampled: their minimum is k-Lipschitz always.
//
// scatter caps each copy at `reach`, half the least period. The minimum over the sampled copies is continuous
// if each copy has at least that value where it is dropped, which is where p is a period away from its cell:
// along x at least (1.5 - jitter / 2) P from the copy's centre, for the centre is within jitter P / 2 of the
// cell's middle. If f is exact outside and S is within R of the origin (around y, for copies are turned), the
// value is at least (1.5 - jitter / 2) P - R. Any other f is shown to have the value by a box around {size f
// < reach}.
#pragma once

#include "graph/library/node_type.h"

namespace fw {

Exactness repeatExactness(const ExactnessArguments& node);
Exactness polarRepeatExactness(const ExactnessArguments& node);
Exactness scatterExactness(const ExactnessArguments& node);

}  // namespace fw
