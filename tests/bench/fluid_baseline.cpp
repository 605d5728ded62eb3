#include "tests/bench/fluid_baseline.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "runtime/system/clock.h"
#include "shaders/shared.h"
#include "tests/bench/two_threads.h"

#include "shaders/particles/fluid.h"

namespace fw::bench {
namespace {

constexpr std::size_t kMostNeighbours = 64;

}  // namespace

FluidBaseline::FluidBaseline(const FluidConfig& given, std::vector<glm::vec3> at, std::vector<glm::vec3> fast)
    : places(std::move(at)), velocities(std::move(fast)), config(given) {
    const FluidLattice lattice = fluidLattice();
    support = kFluidSupport * config.spacing;
    weight = lattice.weight, slope = -20.0f * weight / (support * support);
    soft = lattice.soft / (config.spacing * config.spacing);
    cells = glm::ivec3(glm::ceil((config.hi - config.lo) / support)) + 3;
    const std::size_t count = places.size();
    velocities.resize(count);
    for (auto* each : {&keys, &order, &counts}) each->resize(count);
    for (auto* each : {&guesses, &shifted, &sortedPlaces, &sortedVelocities, &sortedGuesses})
        each->resize(count);
    for (auto* each : {&lambdas, &far, &energies, &sortedEnergies}) each->resize(count);
    lists.resize(kMostNeighbours * count);
}

float FluidBaseline::left(const glm::vec3& off) const {
    return std::max(1.0f - glm::length(off) / support, 0.0f);
}
float FluidBaseline::weightAt(float u) const { return weight * (u * u) * (u * u) * (5.0f - 4.0f * u); }
float FluidBaseline::slopeAt(float u) const { return slope * u * u * u; }

float FluidBaseline::wallsAt(const glm::vec3& p, glm::vec3& gradient) const {
    float density = 0.0f;
    for (int side = 0; side < 6; ++side) {
        const int k = side / 2;
        const float d = side % 2 ? config.hi[k] - p[k] : p[k] - config.lo[k];
        if (d >= support) continue;
        const float u = 1.0f - d / support, u5 = u * u * u * u * u, u6 = u5 * u;
        density += u6 * (3.5f + u * (1.5f * u - 4.5f));
        const float fall = 21.0f / support * (u5 - u6 * (1.5f - 4.0f / 7.0f * u));
        gradient[k] += side % 2 ? fall : -fall;
    }
    return density;
}

void FluidBaseline::sort(float seconds) {
    const std::size_t count = places.size();
    const glm::vec3 first = config.lo - 1.01f * support;
    onTwoThreads([&](int t) {
        for (std::size_t i = t * count / 2; i < (t + 1) * count / 2; ++i) {
            const glm::vec3 velocity = velocities[i] + seconds * config.gravity;
            guesses[i] = glm::clamp(places[i] + seconds * velocity, config.lo, config.hi);
            const glm::vec3 pushed = (guesses[i] - places[i]) / seconds;
            energies[i] =
                energyAt(guesses[i], std::max(glm::dot(velocity, velocity), glm::dot(pushed, pushed)));
            const glm::ivec3 c((guesses[i] - first) / support);
            keys[i] = uint32_t((c.z * cells.y + c.y) * cells.x + c.x);
        }
    });
    starts.assign(std::size_t(cells.x) * cells.y * cells.z + 2, 0);
    for (const uint32_t key : keys) ++starts[key + 2];
    for (std::size_t k = 1; k < starts.size(); ++k) starts[k] += starts[k - 1];
    for (uint32_t i = 0; i < count; ++i) order[starts[keys[i] + 1]++] = i;
    onTwoThreads([&](int t) {
        for (std::size_t i = t * count / 2; i < (t + 1) * count / 2; ++i) {
            sortedPlaces[i] = places[order[i]];
            sortedVelocities[i] = velocities[order[i]];
            sortedGuesses[i] = guesses[order[i]];
            sortedEnergies[i] = energies[order[i]];
        }
    });
    places.swap(sortedPlaces), velocities.swap(sortedVelocities), guesses.swap(sortedGuesses);
    energies.swap(sortedEnergies);
}

void FluidBaseline::list(std::size_t from, std::size_t to) {
    const glm::vec3 first = config.lo - 1.01f * support;
    const float near = (config.farOnce ? kFluidNear : 1.0f) * support;
    for (std::size_t i = from; i < to; ++i) {
        const glm::vec3 p = guesses[i];
        const glm::ivec3 own((p - first) / support);
        uint32_t* const list = &lists[kMostNeighbours * i];
        uint32_t found = 0;
        float farther = 0.0f;
        for (int z = own.z - 1; z <= own.z + 1; ++z)
            for (int y = own.y - 1; y <= own.y + 1; ++y) {
                const std::size_t row = std::size_t((z * cells.y + y) * cells.x + own.x);
                for (uint32_t j = starts[row - 1]; j < starts[row + 2]; ++j) {
                    const glm::vec3 off = p - guesses[j];
                    const float apart = glm::dot(off, off);
                    if (apart >= support * support || j == i) continue;
                    if (apart >= near * near) {
                        farther += weightAt(left(off));
                    } else if (found < kMostNeighbours) {
                        list[found++] = j;
                    }
                }
            }
        counts[i] = found, far[i] = farther;
    }
}

void FluidBaseline::weigh(std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
        const glm::vec3 p = guesses[i];
        glm::vec3 gradient(0.0f);
        float density = weight + far[i] + wallsAt(p, gradient), squares = 0.0f;
        for (uint32_t k = 0; k < counts[i]; ++k) {
            const glm::vec3 off = p - guesses[lists[kMostNeighbours * i + k]];
            const float u = left(off);
            const glm::vec3 own = slopeAt(u) * off;
            density += weightAt(u);
            squares += glm::dot(own, own);
            gradient += own;
        }
        lambdas[i] = -kFluidRelaxation * std::max(density - 1.0f, 0.0f) /
                     (squares + glm::dot(gradient, gradient) + soft);
    }
}

void FluidBaseline::giveWay(std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
        const glm::vec3 p = guesses[i];
        glm::vec3 gradient(0.0f);
        wallsAt(p, gradient);
        glm::vec3 shift = lambdas[i] * gradient;
        for (uint32_t k = 0; k < counts[i]; ++k) {
            const uint32_t j = lists[kMostNeighbours * i + k];
            const glm::vec3 off = p - guesses[j];
            shift += (lambdas[i] + lambdas[j]) * slopeAt(left(off)) * off;
        }
        shifted[i] = glm::clamp(p + shift, config.lo, config.hi);
    }
}

float FluidBaseline::energyAt(const glm::vec3& p, float squaredSpeed) const {
    return 0.5f * squaredSpeed - glm::dot(config.gravity, p);
}

void FluidBaseline::smooth(std::size_t from, std::size_t to, float seconds) {
    const float pressure = FLUID_MOST_PRESSURE * seconds * glm::length(config.gravity);
    for (std::size_t i = from; i < to; ++i) {
        glm::vec3 change(0.0f);
        float most = energies[i];
        for (uint32_t k = 0; k < counts[i]; ++k) {
            const uint32_t j = lists[kMostNeighbours * i + k];
            change += weightAt(left(guesses[i] - guesses[j])) * (velocities[j] - velocities[i]);
            most = std::max(most, energies[j]);
        }
        const glm::vec3 v = velocities[i] + config.viscosity * change;
        const float squared = glm::dot(v, v),
                    gained =
                        std::max(energyAt(guesses[i], squared) - most - pressure * std::sqrt(squared), 0.0f);
        sortedVelocities[i] =
            std::sqrt(std::max(squared - 2.0f * gained, 0.0f) / std::max(squared, 1e-30f)) * v;
    }
}

FluidBaselineTimes FluidBaseline::step(float seconds) {
    const std::size_t count = places.size();
    FluidBaselineTimes times;
    auto start = Clock::now();
    const auto lap = [&] {
        const double passed = millisecondsSince(start);
        start = Clock::now();
        return passed;
    };
    const auto halves = [&](auto&& work) {
        onTwoThreads([&](int t) { work(t * count / 2, (t + 1) * count / 2); });
    };
    sort(seconds);
    times.sortMs = lap();
    halves([&](std::size_t from, std::size_t to) { list(from, to); });
    times.neighboursMs = lap();
    for (int i = 0; i < config.iterations; ++i) {
        halves([&](std::size_t from, std::size_t to) { weigh(from, to); });
        halves([&](std::size_t from, std::size_t to) { giveWay(from, to); });
        guesses.swap(shifted);
    }
    times.densityMs = lap();
    halves([&](std::size_t from, std::size_t to) {
        for (std::size_t i = from; i < to; ++i) velocities[i] = (guesses[i] - places[i]) / seconds;
    });
    halves([&](std::size_t from, std::size_t to) { smooth(from, to, seconds); });
    velocities.swap(sortedVelocities);
    places.swap(guesses);
    times.velocityMs = lap();
    return times;
}

}  // namespace fw::bench
