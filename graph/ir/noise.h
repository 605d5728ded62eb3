// Lattice noises, the reference of shaders/lib/noise.glsl: same lattice, same hash, so that the CPU and the
// GPU agree up to rounding.
//
// The first two are templates without branches or tables, so that the loops of kernels.h over them become
// vectors; what a caller does not use of a sample is not computed.
//
// gradientNoise: Perlin, "Improving Noise" (2002), quintic fade; gradients are twelve edge directions chosen
// by a
//   PCG-style integer hash (Jarzynski & Olano 2020) instead of a permutation table.
// simplexNoise: the same gradients on the simplex lattice, kernel (1/2 - r²)^4 (Gustavson 2005).
// worleyNoise: distance to the nearest of one feature point in each unit cell (Worley 1996, F1). The point of
//   the own cell is at most sqrt(3) away, cells three off are at least 2 away, so none beyond the 125 cells
//   around can be nearest. Beyond the 27 it takes a point farther than their border to look: between 1 and
//   1.5 away, and few places are that far from all points.
// cellWall: distance to the nearest wall of the Voronoi diagram of one point in each unit cell, cut off at
//   0.15: the least distance to the planes half way between the nearest point and others, which is exact
//   from inside the (convex) region of the nearest point. Points stay a tenth off their cell's sides, so none
//   beyond the 125 cells around matters: they are at least 2.1 away and the nearest at most 0.9 sqrt(3), the
//   plane between is at least half the difference away, 0.27.
// cellHash: a uniform number in [0, 1) for each unit cell.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace fw {

/// Value and its partial derivatives by x, y, z.
template <class T>
struct NoiseOf {
    T value;
    std::array<T, 3> gradient;
};
using NoiseSample = NoiseOf<double>;

NoiseSample worleyNoise(double x, double y, double z, double seed);
double cellHash(double x, double y, double z, double seed);
/// The feature point of the unit cell with this least corner; of cellWall it is 0.1 + 0.8 times as far in.
std::array<double, 3> worleyPoint(double x, double y, double z, double seed);

/// Greatest slope and magnitude of each noise, by which intervals are bounded. The slopes of the first two
/// were found by maximising |gradient| over 10^7 positions and rounded up; worley is a distance to a set, so
/// its slope is 1.
inline constexpr double kGradientNoiseSlope = 3.7, kGradientNoiseRange = 1.1;
inline constexpr double kSimplexNoiseSlope = 7.2, kSimplexNoiseRange = 1.1;
inline constexpr double kWorleyNoiseRange = 1.7320508075688773, kCellWallRange = 0.15;

namespace noise {

/// Three 32-bit words from a lattice point: PCG3D of Jarzynski & Olano, "Hash Functions for GPU Rendering"
/// (2020).
inline std::array<uint32_t, 3> latticeHash(int32_t x, int32_t y, int32_t z, uint32_t seed) {
    uint32_t a = static_cast<uint32_t>(x) + seed * 0x9E3779B9u, b = static_cast<uint32_t>(y),
             c = static_cast<uint32_t>(z);
    a = a * 1664525u + 1013904223u, b = b * 1664525u + 1013904223u, c = c * 1664525u + 1013904223u;
    a += b * c, b += c * a, c += a * b;
    a ^= a >> 16, b ^= b >> 16, c ^= c >> 16;
    a += b * c, b += c * a, c += a * b;
    return {a, b, c};
}

template <class T>
int32_t lattice(T x) {
    const T least = x < T(-2e9) ? T(-2e9) : x;
    return static_cast<int32_t>(least > T(2e9) ? T(2e9) : least);
}
/// A call, so that it leaves loops over places with one seed, which would not become vectors around it.
template <class T>
[[gnu::noinline, gnu::const]] uint32_t seedBits(T seed) {
    return static_cast<uint32_t>(lattice(std::floor(seed)));
}

template <class T>
T unit(uint32_t bits) {
    return T(int32_t(bits >> 8)) * T(1.0 / 16777216.0);
}

/// One of the twelve directions from a cube's centre to its edges: (±1, ±1, 0) and its rotations.
template <class T>
std::array<T, 3> edgeDirection(uint32_t bits) {
    const uint32_t word = bits >> 16, axis = word - 3u * (word * 43691u >> 17);  // word % 3
    const T u = T(int32_t(bits << 1 & 2u) - 1), v = T(int32_t(bits & 2u) - 1);
    return {axis == 0 ? T(0) : u, axis == 0 ? u : axis == 1 ? T(0) : v, axis == 2 ? T(0) : v};
}

}  // namespace noise

template <class T>
[[gnu::always_inline]] inline NoiseOf<T> gradientNoise(T x, T y, T z, T seed) {
    const T position[3] = {x, y, z};
    const uint32_t seeded = noise::seedBits(seed);
    T f[3], fade[3], slope[3];
    int32_t at[3][2];
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) {
        const T cell = std::floor(position[i]);
        at[i][0] = noise::lattice(cell), at[i][1] = noise::lattice(cell + T(1));
        const T t = f[i] = position[i] - cell;
        fade[i] = t * t * t * (t * (t * T(6) - T(15)) + T(10));
        slope[i] = T(30) * t * t * (t * (t - T(2)) + T(1));
    }
    NoiseOf<T> sum{T(0), {T(0), T(0), T(0)}};
#pragma GCC unroll 8
    for (int corner = 0; corner < 8; ++corner) {
        const int o[3] = {corner & 1, corner >> 1 & 1, corner >> 2};
        const std::array<T, 3> g =
            noise::edgeDirection<T>(noise::latticeHash(at[0][o[0]], at[1][o[1]], at[2][o[2]], seeded)[0]);
        const T ramp = g[0] * (f[0] - T(o[0])) + g[1] * (f[1] - T(o[1])) + g[2] * (f[2] - T(o[2]));
        T w[3], dw[3];
#pragma GCC unroll 3
        for (int i = 0; i < 3; ++i) {
            w[i] = o[i] ? fade[i] : T(1) - fade[i];
            dw[i] = o[i] ? slope[i] : -slope[i];
        }
        const T weight = w[0] * w[1] * w[2];
        sum.value += weight * ramp;
        sum.gradient[0] += weight * g[0] + dw[0] * w[1] * w[2] * ramp;
        sum.gradient[1] += weight * g[1] + w[0] * dw[1] * w[2] * ramp;
        sum.gradient[2] += weight * g[2] + w[0] * w[1] * dw[2] * ramp;
    }
    return sum;
}

template <class T>
[[gnu::always_inline]] inline NoiseOf<T> simplexNoise(T x, T y, T z, T seed) {
    const uint32_t seeded = noise::seedBits(seed);
    const T skew = (x + y + z) / T(3);
    const T i = std::floor(x + skew), j = std::floor(y + skew), k = std::floor(z + skew);
    const T unskew = (i + j + k) / T(6);
    const T x0 = x - i + unskew, y0 = y - j + unskew, z0 = z - k + unskew;
    // The second and third corner of the simplex: unit steps in order of falling coordinate.
    const bool xy = x0 >= y0, yz = y0 >= z0, xz = x0 >= z0;
    const T steps[4][3] = {{T(0), T(0), T(0)},
                           {T(xy & xz), T(!xy & yz), T(!xz & !yz)},
                           {T(xy | xz), T(!xy | yz), T(!xz | !yz)},
                           {T(1), T(1), T(1)}};
    NoiseOf<T> sum{T(0), {T(0), T(0), T(0)}};
#pragma GCC unroll 4
    for (int corner = 0; corner < 4; ++corner) {
        const T* const o = steps[corner];
        const T back = T(corner) / T(6);
        const T d[3] = {x0 - o[0] + back, y0 - o[1] + back, z0 - o[2] + back};
        const T inside = T(0.5) - d[0] * d[0] - d[1] * d[1] - d[2] * d[2], t = inside > T(0) ? inside : T(0);
        const std::array<T, 3> g = noise::edgeDirection<T>(noise::latticeHash(
            noise::lattice(i + o[0]), noise::lattice(j + o[1]), noise::lattice(k + o[2]), seeded)[0]);
        const T ramp = g[0] * d[0] + g[1] * d[1] + g[2] * d[2];
        const T scale = T(72);  // brings the range to about [-1, 1]
        sum.value += scale * t * t * t * t * ramp;
#pragma GCC unroll 3
        for (int axis = 0; axis < 3; ++axis)
            sum.gradient[axis] += scale * (t * t * t * t * g[axis] - T(8) * t * t * t * d[axis] * ramp);
    }
    // Where coordinates are too large for a place within their cell.
    const T most = T(kSimplexNoiseRange), raised = sum.value < -most ? -most : sum.value;
    sum.value = raised > most ? most : raised;
    return sum;
}

/// How far a position is at least from what lies beyond the 27 cells around it.
template <class T>
[[gnu::always_inline]] inline T worleyClear(T x, T y, T z) {
    const T position[3] = {x, y, z};
    T clear = T(1);
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) {
        const T f = position[i] - std::floor(position[i]), side = f < T(1) - f ? f : T(1) - f;
        clear = side < clear ? side : clear;
    }
    return clear + T(1);
}

/// Worley noise of the 27 cells around: what it is where it is no more than worleyClear(); else it takes the
/// whole search. Without branches, as the two above.
template <class T>
[[gnu::always_inline]] inline NoiseOf<T> worleyNearby(T x, T y, T z, T seed) {
    const T position[3] = {x, y, z};
    const uint32_t seeded = noise::seedBits(seed);
    T corner[3][3];
    int32_t at[3][3];
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i)
#pragma GCC unroll 3
        for (int o = 0; o < 3; ++o) {
            corner[i][o] = std::floor(position[i]) + T(o - 1);
            at[i][o] = noise::lattice(corner[i][o]);
        }
    T nearest = T(1e30), offset[3] = {T(0), T(0), T(0)};
#pragma GCC unroll 27
    for (int c = 0; c < 27; ++c) {
        const int o[3] = {c % 3, c / 3 % 3, c / 9};
        const std::array<uint32_t, 3> bits =
            noise::latticeHash(at[0][o[0]], at[1][o[1]], at[2][o[2]], seeded);
        T squared = T(0), d[3];
#pragma GCC unroll 3
        for (int i = 0; i < 3; ++i) {
            d[i] = position[i] - corner[i][o[i]] - noise::unit<T>(bits[i]);
            squared += d[i] * d[i];
        }
#pragma GCC unroll 3
        for (int i = 0; i < 3; ++i) offset[i] = squared < nearest ? d[i] : offset[i];
        nearest = squared < nearest ? squared : nearest;
    }
    const T distance = std::sqrt(nearest), inverse = T(1) / (distance > T(0) ? distance : T(1));
    return {distance, {offset[0] * inverse, offset[1] * inverse, offset[2] * inverse}};
}

template <class T>
NoiseOf<T> cellWall(T x, T y, T z, T seed) {
    const T position[3] = {x, y, z}, cell[3] = {std::floor(x), std::floor(y), std::floor(z)};
    const uint32_t seeded = noise::seedBits(seed);
    // From the position to the point of a cell so many cells off.
    const auto offset = [&](int i, int j, int k) {
        const int step[3] = {i, j, k};
        const T corner[3] = {cell[0] + T(i), cell[1] + T(j), cell[2] + T(k)};
        const auto bits = noise::latticeHash(noise::lattice(corner[0]), noise::lattice(corner[1]),
                                             noise::lattice(corner[2]), seeded);
        std::array<T, 3> off;
        for (std::size_t axis = 0; axis < 3; ++axis)
            off[axis] =
                (cell[axis] - position[axis]) + T(step[axis]) + T(0.1) + T(0.8) * noise::unit<T>(bits[axis]);
        return off;
    };
    const auto dot = [](const std::array<T, 3>& a, const std::array<T, 3>& b) {
        return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    };
    const auto around = [&](int reach, auto visit) {
        for (int k = -reach; k <= reach; ++k)
            for (int j = -reach; j <= reach; ++j)
                for (int i = -reach; i <= reach; ++i) visit(offset(i, j, k));
    };
    const T clear = worleyClear(x, y, z) + T(0.1);
    for (int reach = 1;; ++reach) {
        std::array<T, 3> nearest{};
        T least = T(1e30);
        around(reach, [&](const std::array<T, 3>& off) {
            const T squared = dot(off, off);
            if (squared < least) least = squared, nearest = off;
        });
        NoiseOf<T> found{T(kCellWallRange), {T(0), T(0), T(0)}};
        around(reach, [&](const std::array<T, 3>& off) {
            const std::array<T, 3> way = {off[0] - nearest[0], off[1] - nearest[1], off[2] - nearest[2]};
            const T size = std::sqrt(dot(way, way));
            if (!(size > T(0))) return;
            const T distance = (dot(off, off) - least) / (T(2) * size);
            if (distance < found.value) found = {distance, {-way[0] / size, -way[1] / size, -way[2] / size}};
        });
        const T distance = std::sqrt(least);
        // What lies beyond may be nearer, or its plane.
        if (reach == 2 || (distance <= clear && (clear - distance) * T(0.5) >= found.value)) return found;
    }
}

}  // namespace fw
