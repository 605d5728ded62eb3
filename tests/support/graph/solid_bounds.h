// The bounds of a solid f < 0, found from inside by evaluating f at points.
//
// This is an oracle for the region search, and shares nothing with it: no intervals, no Lipschitz constants,
// no octree. It evaluates f on jittered grids around given anchors and at random points at all scales. Then
// it climbs from the inside points along +-x, +-y and +-z with random and tangential steps of adaptive
// length.
//
// Every reported bound is touched by a point with f < 0. So the box is never larger than the true one, and an
// inside point outside a claimed region disproves that region. The box can be too small where the solid has
// parts that no sample hits.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "graph/base/box.h"
#include "graph/ir/ir.h"
#include "tests/support/graph/random_scene.h"

namespace fw::test {

struct SolidBoundsOptions {
    int gridCells = 16;     ///< samples along each side of an anchor's cube
    int farSamples = 1000;  ///< random points over all space
    int climbRounds = 30;   ///< of each climb
    int slabSamples = 800;  ///< points between a bound and the claimed one
    std::uint32_t seed = 1;
};

struct SolidBounds {
    bool found = false;  ///< whether any inside point was found
    Box box;             ///< the smallest box around the inside points
    /// Inside points on the sides of the box: -x, +x, -y, +y, -z, +z.
    std::array<Point, 6> extremes{};
    /// By axis: the climbs converged, and samples up to the claimed bounds found nothing further out.
    std::array<bool, 3> reliable{};
    std::size_t evaluations = 0;
};

/// Samples the solid `root` < 0 of `ir`. `claimed` is the region to be tested; the sampler looks between its
/// own bounds and those, so that it does not call a region loose which is not.
SolidBounds sampleSolid(const Ir& ir, IrId root, std::span<const double> parameters,
                        std::span<const SceneAnchor> anchors, const std::optional<Box>& claimed,
                        const SolidBoundsOptions& options = {});

/// How far the point is outside of the box, along the axis where it is farthest; negative inside.
double distanceOutside(const Box& box, const Point& point);

}  // namespace fw::test
