// The plain C++ program that the fluid is measured against: the same steps as runtime/particles/fluid.h, on
// two threads.
//
// Written as a competent programmer would on a first day, and no further: particles sorted by cells as wide
// as the kernel, a list of neighbours each, two passes over the lists an iteration. No intrinsics; the
// compiler has -O3 -march=native. Buffers stay allocated between steps. Without an obstacle, surface tension,
// and far averages.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "runtime/particles/fluid.h"

namespace fw::bench {

struct FluidBaselineTimes {
    double sortMs = 0, neighboursMs = 0, densityMs = 0, velocityMs = 0;
    double totalMs() const { return sortMs + neighboursMs + densityMs + velocityMs; }
};

/// The fluid of a tank with its buffers.
class FluidBaseline {
  public:
    FluidBaseline(const FluidConfig& config, std::vector<glm::vec3> places,
                  std::vector<glm::vec3> velocities);
    FluidBaselineTimes step(float seconds);

    std::vector<glm::vec3> places, velocities;  ///< in the order of cells after a step

  private:
    void sort(float seconds);
    void list(std::size_t first, std::size_t last);
    void weigh(std::size_t first, std::size_t last);
    void giveWay(std::size_t first, std::size_t last);
    void smooth(std::size_t first, std::size_t last, float seconds);
    float energyAt(const glm::vec3& p, float squaredSpeed) const;
    float left(const glm::vec3& off) const;
    float weightAt(float u) const;
    float slopeAt(float u) const;
    float wallsAt(const glm::vec3& p, glm::vec3& gradient) const;

    FluidConfig config;
    float support, weight, slope, soft;
    glm::ivec3 cells;
    std::vector<uint32_t> keys, starts, order, lists, counts;
    std::vector<glm::vec3> guesses, shifted, sortedPlaces, sortedVelocities, sortedGuesses;
    std::vector<float> lambdas, far, energies, sortedEnergies;
};

}  // namespace fw::bench
