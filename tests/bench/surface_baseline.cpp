#include "tests/bench/surface_baseline.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <utility>

#include "shaders/shared.h"

#include "shaders/particles/density.h"

namespace fw::bench {

namespace {

constexpr double kPi = 3.14159265358979;

double weightAt(double squared) {
    const double s = std::max(1.0 - squared, 0.0);
    return s * s * s;
}

double smoothstep(double lo, double hi, double x) {
    const double t = std::clamp((x - lo) / (hi - lo), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

/// Of a particle alone, in drops.
double loneReach() { return 1.0 / std::sqrt(1.0 - std::cbrt(ANISOTROPIC_THRESHOLD)); }

/// Eigenvalues and eigenvectors (columns) of a symmetric matrix, by Jacobi's rotations to the end.
void findAxes(glm::dmat3 a, glm::dvec3& values, glm::dmat3& axes) {
    axes = glm::dmat3(1.0);
    for (int sweep = 0; sweep < 12; ++sweep)
        for (int i = 0; i < 2; ++i)
            for (int j = i + 1; j < 3; ++j) {
                if (std::abs(a[i][j]) < 1e-300) continue;
                const double angle = 0.5 * std::atan2(2.0 * a[i][j], a[j][j] - a[i][i]);
                glm::dmat3 turn(1.0);
                turn[i][i] = turn[j][j] = std::cos(angle);
                turn[j][i] = std::sin(angle), turn[i][j] = -std::sin(angle);
                a = glm::transpose(turn) * a * turn;
                axes = axes * turn;
            }
    values = {a[0][0], a[1][1], a[2][2]};
}

}  // namespace

SurfaceBaseline::SurfaceBaseline(std::vector<glm::vec4> particles, double radius, ParticleSurface which)
    : places(std::move(particles)),
      drop(radius),
      reach(radius * (which == ParticleSurface::average ? AVERAGE_REACH : ANISOTROPIC_REACH)),
      surface(which) {
    for (std::size_t i = 0; i < places.size(); ++i) near[bucketOf(places[i])].push_back(i);
    if (surface != ParticleSurface::anisotropic) return;
    for (const glm::vec4& place : places) kernels.push_back(kernelOf(place));
    for (std::size_t i = 0; i < kernels.size(); ++i) centres[bucketOf(kernels[i].centre)].push_back(i);
}

SurfaceBaseline::Bucket SurfaceBaseline::bucketOf(const glm::dvec3& p) const {
    const glm::dvec3 at = glm::floor(p / reach);
    return {int(at.x), int(at.y), int(at.z)};
}

template <class See>
void SurfaceBaseline::lookAround(const Buckets& buckets, const glm::dvec3& p, See&& see) const {
    const Bucket own = bucketOf(p);
    for (int k = 0; k < 27; ++k) {
        const auto found = buckets.find({own[0] + k % 3 - 1, own[1] + k / 3 % 3 - 1, own[2] + k / 9 - 1});
        if (found == buckets.end()) continue;
        for (const std::size_t i : found->second) see(i);
    }
}

SurfaceBaseline::Kernel SurfaceBaseline::kernelOf(const glm::dvec3& place) const {
    const double lone = drop * loneReach(), volume = 4.0 / 3.0 * kPi * drop * drop * drop,
                 integral = 64.0 * kPi / 315.0;
    double weights = 0.0;
    glm::dvec3 mean(0.0), values;
    glm::dmat3 covariance(0.0), axes;
    lookAround(near, place, [&](std::size_t i) {
        const glm::dvec3 off = glm::dvec3(places[i]) - place;
        const double w = weightAt(glm::dot(off, off) / (reach * reach));
        weights += w, mean += w * off, covariance += w * glm::outerProduct(off, off);
    });
    mean /= weights;
    findAxes(covariance / weights - glm::outerProduct(mean, mean), values, axes);
    const double longest = std::max({values.x, values.y, values.z}), many = smoothstep(1.5, 3.0, weights);
    Kernel kernel{place + 0.9 * many * mean, glm::dmat3(0.0), 1.0};
    double product = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
        const double share = std::min(std::max(values[axis], 0.25 * longest) * 11.0 / (reach * reach), 1.0);
        const double half = (1.0 - many) * lone + many * std::max(reach * std::sqrt(share), lone);
        product *= half;
        kernel.shape += glm::outerProduct(axes[axis], axes[axis]) / (half * half);
    }
    kernel.height = 1.0 - many + many * volume / (integral * product);
    return kernel;
}

double SurfaceBaseline::averageAt(const glm::dvec3& p) const {
    double weights = 0.0, squares = 0.0, nearest = reach;
    glm::dvec3 offs(0.0);
    lookAround(near, p, [&](std::size_t i) {
        const glm::dvec3 off = glm::dvec3(places[i]) - p;
        const double squared = glm::dot(off, off), w = weightAt(squared / (reach * reach));
        nearest = std::min(nearest, std::sqrt(squared));
        weights += w, offs += w * off, squares += w * squared;
    });
    if (weights == 0.0) return reach - drop;
    offs /= weights;
    const double variance = std::max(squares / weights - glm::dot(offs, offs), 1e-12 * reach * reach),
                 full = weights * 4.0 / 3.0 * kPi * drop * drop * drop / std::pow(variance, 1.5),
                 together = smoothstep(1.0, 2.0, full),
                 left = std::max(1.0 - glm::dot(offs, offs) / (reach * reach), 0.5),
                 crowd = weights / std::pow(left, 4.0),
                 thin = 0.16 * smoothstep(1.2, 3.2, crowd) * (1.0 - smoothstep(4.0, 4.8, crowd));
    return together * (glm::length(offs) + thin * drop) + (1.0 - together) * nearest - drop;
}

double SurfaceBaseline::anisotropicAt(const glm::dvec3& p) const {
    double density = 0.0;
    lookAround(centres, p, [&](std::size_t i) {
        const glm::dvec3 off = p - kernels[i].centre;
        density += kernels[i].height * weightAt(glm::dot(off, kernels[i].shape * off));
    });
    return drop * (loneReach() * std::sqrt(std::max(1.0 - std::cbrt(density), 0.0)) - 1.0);
}

double SurfaceBaseline::at(const glm::dvec3& p) const {
    return surface == ParticleSurface::average ? averageAt(p) : anisotropicAt(p);
}

}  // namespace fw::bench
