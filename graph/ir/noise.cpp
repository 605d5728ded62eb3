#include "graph/ir/noise.h"

#include <algorithm>
#include <cmath>

namespace fw {

namespace {

/// Three 32-bit words from a lattice point: PCG3D of Jarzynski & Olano, "Hash Functions for GPU Rendering"
/// (2020).
std::array<uint32_t, 3> latticeHash(int32_t x, int32_t y, int32_t z, uint32_t seed) {
    uint32_t a = static_cast<uint32_t>(x) + seed * 0x9E3779B9u, b = static_cast<uint32_t>(y),
             c = static_cast<uint32_t>(z);
    a = a * 1664525u + 1013904223u, b = b * 1664525u + 1013904223u, c = c * 1664525u + 1013904223u;
    a += b * c, b += c * a, c += a * b;
    a ^= a >> 16, b ^= b >> 16, c ^= c >> 16;
    a += b * c, b += c * a, c += a * b;
    return {a, b, c};
}

int32_t lattice(double x) { return static_cast<int32_t>(std::clamp(x, -2e9, 2e9)); }
uint32_t seedBits(double seed) {
    return static_cast<uint32_t>(static_cast<int32_t>(std::clamp(std::floor(seed), -2e9, 2e9)));
}
double unit(uint32_t bits) { return (bits >> 8) * (1.0 / 16777216.0); }

/// One of the twelve directions from a cube's centre to its edges: (±1, ±1, 0) and its rotations.
std::array<double, 3> edgeDirection(uint32_t bits) {
    const uint32_t axis = (bits >> 16) % 3u;
    const double u = bits & 1u ? 1.0 : -1.0, v = bits & 2u ? 1.0 : -1.0;
    if (axis == 0) return {0.0, u, v};
    if (axis == 1) return {u, 0.0, v};
    return {u, v, 0.0};
}

}  // namespace

NoiseSample gradientNoise(double x, double y, double z, double seed) {
    const double position[3] = {x, y, z};
    double cell[3], f[3], fade[3], slope[3];
    for (int i = 0; i < 3; ++i) {
        cell[i] = std::floor(position[i]);
        const double t = f[i] = position[i] - cell[i];
        fade[i] = t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
        slope[i] = 30.0 * t * t * (t * (t - 2.0) + 1.0);
    }
    NoiseSample sum{0.0, {0.0, 0.0, 0.0}};
    for (int corner = 0; corner < 8; ++corner) {
        const double o[3] = {double(corner & 1), double(corner >> 1 & 1), double(corner >> 2)};
        const auto g = edgeDirection(latticeHash(lattice(cell[0] + o[0]), lattice(cell[1] + o[1]),
                                                 lattice(cell[2] + o[2]), seedBits(seed))[0]);
        const double ramp = g[0] * (f[0] - o[0]) + g[1] * (f[1] - o[1]) + g[2] * (f[2] - o[2]);
        double w[3], dw[3];
        for (int i = 0; i < 3; ++i) {
            w[i] = o[i] > 0.5 ? fade[i] : 1.0 - fade[i];
            dw[i] = o[i] > 0.5 ? slope[i] : -slope[i];
        }
        const double weight = w[0] * w[1] * w[2];
        sum.value += weight * ramp;
        sum.gradient[0] += weight * g[0] + dw[0] * w[1] * w[2] * ramp;
        sum.gradient[1] += weight * g[1] + w[0] * dw[1] * w[2] * ramp;
        sum.gradient[2] += weight * g[2] + w[0] * w[1] * dw[2] * ramp;
    }
    return sum;
}

NoiseSample simplexNoise(double x, double y, double z, double seed) {
    const double skew = (x + y + z) / 3.0;
    const double i = std::floor(x + skew), j = std::floor(y + skew), k = std::floor(z + skew);
    const double unskew = (i + j + k) / 6.0;
    const double x0 = x - i + unskew, y0 = y - j + unskew, z0 = z - k + unskew;
    // The second and third corner of the simplex: unit steps in order of falling coordinate.
    const bool xy = x0 >= y0, yz = y0 >= z0, xz = x0 >= z0;
    const double a1 = xy && xz, b1 = !xy && yz, c1 = !xz && !yz;
    const double a2 = xy || xz, b2 = !xy || yz, c2 = !xz || !yz;
    const double steps[4][3] = {{0, 0, 0}, {a1, b1, c1}, {a2, b2, c2}, {1, 1, 1}};
    NoiseSample sum{0.0, {0.0, 0.0, 0.0}};
    for (int corner = 0; corner < 4; ++corner) {
        const double* o = steps[corner];
        const double d[3] = {x0 - o[0] + corner / 6.0, y0 - o[1] + corner / 6.0, z0 - o[2] + corner / 6.0};
        const double t = std::max(0.5 - d[0] * d[0] - d[1] * d[1] - d[2] * d[2], 0.0);
        const auto g = edgeDirection(
            latticeHash(lattice(i + o[0]), lattice(j + o[1]), lattice(k + o[2]), seedBits(seed))[0]);
        const double ramp = g[0] * d[0] + g[1] * d[1] + g[2] * d[2];
        const double scale = 72.0;  // brings the range to about [-1, 1]
        sum.value += scale * t * t * t * t * ramp;
        for (int axis = 0; axis < 3; ++axis)
            sum.gradient[axis] += scale * (t * t * t * t * g[axis] - 8.0 * t * t * t * d[axis] * ramp);
    }
    // Where coordinates are too large for a place within their cell.
    sum.value = std::clamp(sum.value, -kSimplexNoiseRange, kSimplexNoiseRange);
    return sum;
}

std::array<double, 3> worleyPoint(double x, double y, double z, double seed) {
    const auto bits = latticeHash(lattice(x), lattice(y), lattice(z), seedBits(seed));
    return {x + unit(bits[0]), y + unit(bits[1]), z + unit(bits[2])};
}

NoiseSample worleyNoise(double x, double y, double z, double seed) {
    const double position[3] = {x, y, z};
    const double cell[3] = {std::floor(x), std::floor(y), std::floor(z)};
    double clear = 1.0;  // how far the position is at least from what lies beyond the 27 cells
    for (int i = 0; i < 3; ++i)
        clear = std::min(clear, std::min(position[i] - cell[i], 1.0 - (position[i] - cell[i])));
    clear += 1.0;
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
