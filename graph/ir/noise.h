// Lattice noises in double, the reference of shaders/lib/noise.glsl: same lattice, same hash, so that the CPU
// and the GPU agree up to float rounding.
//
// gradientNoise: Perlin, "Improving Noise" (2002), quintic fade; gradients are twelve edge directions chosen
// by a
//   PCG-style integer hash (Jarzynski & Olano 2020) instead of a permutation table.
// simplexNoise: the same gradients on the simplex lattice, kernel (1/2 - r²)^4 (Gustavson 2005).
// worleyNoise: distance to the nearest of one feature point in each unit cell (Worley 1996, F1). The point of
//   the own cell is at most sqrt(3) away, cells three off are at least 2 away, so none beyond the 125 cells
//   around can be nearest. Beyond the 27 it takes a point farther than their border to look: between 1 and
//   1.5 away, and few places are that far from all points.
// cellHash: a uniform number in [0, 1) for each unit cell.
#pragma once

#include <array>
#include <cstdint>

namespace fw {

/// Value and its partial derivatives by x, y, z.
struct NoiseSample {
    double value;
    std::array<double, 3> gradient;
};

NoiseSample gradientNoise(double x, double y, double z, double seed);
NoiseSample simplexNoise(double x, double y, double z, double seed);
NoiseSample worleyNoise(double x, double y, double z, double seed);
double cellHash(double x, double y, double z, double seed);
/// The feature point of the unit cell with this least corner.
std::array<double, 3> worleyPoint(double x, double y, double z, double seed);

/// Greatest slope and magnitude of each noise, by which intervals are bounded. The slopes of the first two
/// were found by maximising |gradient| over 10^7 positions and rounded up; worley is a distance to a set, so
/// its slope is 1.
inline constexpr double kGradientNoiseSlope = 3.7, kGradientNoiseRange = 1.1;
inline constexpr double kSimplexNoiseSlope = 7.2, kSimplexNoiseRange = 1.1;
inline constexpr double kWorleyNoiseRange = 1.7320508075688773;

}  // namespace fw
