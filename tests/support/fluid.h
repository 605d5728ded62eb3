// A fluid on the test device: its kernels, steps, and what its particles come to.
#pragma once

#include <gtest/gtest.h>

#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "runtime/particles/fluid.h"

namespace fw::test {

/// Tests of the fluid, whose kernels are kept until the last of them.
class Fluid : public testing::Test {
  public:
    static void TearDownTestSuite();
};

/// With an obstacle's text, or none.
const FluidKernels& kernelsFor(const std::string& obstacle = {});

/// What the device holds of each particle in the first three of four numbers.
std::vector<glm::vec3> read(const Buffer& buffer, uint32_t count);

/// So many steps at once, in recordings of some.
void run(FluidParticles& fluid, const FluidConfig& config, int steps, float step,
         const std::string& obstacle = {});

glm::dvec3 mean(const std::vector<glm::vec3>& list);

/// How much denser than at rest particles in a tank are, on average, those that are less dense counting as
/// such at rest: sums over all pairs in double, and walls as if they were full.
double meanError(const std::vector<glm::vec3>& places, const FluidConfig& config);

/// Kinetic and potential, of a kilogramme, above the tank's floor.
double energyOf(const FluidParticles& fluid, const FluidConfig& config);

}  // namespace fw::test
