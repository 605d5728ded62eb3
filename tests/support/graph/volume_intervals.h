// Whether what a volume says of boxes is true of the places in them.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "graph/assets/volume.h"

namespace fw::test {

/// Looks at random boxes of all sizes, as far as `beyond` times its size from the grid. Returns the width of
/// the narrowest range.
inline double expectIntervalsContain(const FieldVolume& volume, int boxes, double beyond,
                                     std::mt19937& random) {
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const auto place = [&] { return glm::dvec3(unit(random), unit(random), unit(random)); };
    const glm::dvec3 lo = volume.grid.origin, size = volume.grid.place(volume.grid.size - 1) - lo;
    double narrowest = 1e9;
    for (int n = 0; n < boxes; ++n) {
        const glm::dvec3 centre = lo + size * ((1.0 + 2.0 * beyond) * place() - beyond);
        double half = 0.25 * size.x * unit(random) * unit(random) * unit(random);
        if (beyond == 0.0)
            for (int axis = 0; axis < 3; ++axis)
                half = std::min({half, centre[axis] - lo[axis], lo[axis] + size[axis] - centre[axis]});
        Interval box[3];
        for (int axis = 0; axis < 3; ++axis) box[axis] = {centre[axis] - half, centre[axis] + half};
        for (const VolumeLayer& layer : volume.layers) {
            if (layer.channel >= redChannel) continue;
            const Interval range = sampleVolume(layer, box);
            narrowest = std::min(narrowest, range.hi - range.lo);
            for (int i = 0; i < 40; ++i) {
                const double value = sampleVolume(layer, centre + half * (2.0 * place() - 1.0)).value;
                EXPECT_GE(value, range.lo);
                EXPECT_LE(value, range.hi);
            }
        }
    }
    return narrowest;
}

}  // namespace fw::test
