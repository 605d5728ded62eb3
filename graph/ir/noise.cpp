#include "graph/ir/noise.h"

#include <algorithm>
#include <cmath>

namespace fw {

namespace {

using noise::lattice, noise::latticeHash, noise::seedBits;
constexpr auto unit = noise::unit<double>;

}  // namespace

std::array<double, 3> worleyPoint(double x, double y, double z, double seed) {
    const auto bits = latticeHash(lattice(x), lattice(y), lattice(z), seedBits(seed));
    return {x + unit(bits[0]), y + unit(bits[1]), z + unit(bits[2])};
}

NoiseSample worleyNoise(double x, double y, double z, double seed) {
    const double position[3] = {x, y, z};
    const double cell[3] = {std::floor(x), std::floor(y), std::floor(z)};
    const double clear = worleyClear(x, y, z);
    double nearest = 1e30;
    double offset[3] = {0, 0, 0};
    const auto search = [&](int reach) {
        for (int k = -reach; k <= reach; ++k)
            for (int j = -reach; j <= reach; ++j)
                for (int i = -reach; i <= reach; ++i) {
                    const double o[3] = {cell[0] + i, cell[1] + j, cell[2] + k};
                    const auto bits =
                        latticeHash(lattice(o[0]), lattice(o[1]), lattice(o[2]), seedBits(seed));
                    double d[3], squared = 0.0;
                    for (int axis = 0; axis < 3; ++axis) {
                        d[axis] = position[axis] - o[axis] - unit(bits[axis]);
                        squared += d[axis] * d[axis];
                    }
                    if (squared < nearest) nearest = squared, std::copy(d, d + 3, offset);
                }
    };
    search(1);
    if (nearest > clear * clear) search(2);
    const double distance = std::sqrt(nearest), inverse = distance > 0.0 ? 1.0 / distance : 0.0;
    return {distance, {offset[0] * inverse, offset[1] * inverse, offset[2] * inverse}};
}

double cellHash(double x, double y, double z, double seed) {
    return unit(latticeHash(lattice(std::floor(x)), lattice(std::floor(y)), lattice(std::floor(z)),
                            seedBits(seed))[0]);
}

}  // namespace fw
