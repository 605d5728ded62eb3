// Fluids as particles, with positions for unknowns.
//
// After Macklin and Müller, "Position Based Fluids" (ACM TOG 32(4), 2013): each step first moves every
// particle as if it were alone; then, some times over, moves all of them so that no density is above that at
// rest; the velocity is what led from the old place to the new one. Chosen over solvers of forces (the
// talk's, WCSPH) since it is stable at steps of a sixtieth of a second, where those need some forty: a step
// is never longer than what it moves. The price: it gives no pressures, and what it moves wrongly in one turn
// is lost as energy.
//
// Deviations from the paper: one kernel, Wendland's C2, for density and gradient, so that pairs do not clump
// and no artificial pressure is needed; walls count as full of fluid, by the integral of the kernel beyond
// their plane, so that there is no gap before them and no particles' boundary to place; lists of neighbours
// are made once a step. Densities below that at rest are left alone: a fluid does not pull. Everything that
// two particles do to one another is equal and opposite, so that momentum is kept to rounding; sums run in
// the order of a stable sort, so that the same particles give the same bytes on every run.
//
// Units: metres, seconds, densities in units of that at rest. Lifetime: kernels serve one obstacle; buffers
// grow.
#pragma once

#include <glm/vec3.hpp>
#include <string_view>

#include "runtime/counting_sort.h"
#include "runtime/field_buffers.h"

namespace fw {

struct FluidKernels {
    CountingSort sort;
    Pipeline predict, reorder, neighbours, densityError, giveWay, velocity, smoothVelocity;
};
/// `obstacle` is the text that answers #include "field.glsl": the field that the fluid stays out of; empty
/// for none.
FluidKernels createFluidKernels(const Device& device, std::string_view obstacle);

struct FluidConfig {
    float spacing = 0.05f;          ///< of particles at rest
    glm::vec3 lo{-1.0f}, hi{1.0f};  ///< the tank
    glm::vec3 gravity{0.0f, -9.81f, 0.0f};
    float viscosity = 0.02f;  ///< share of the difference of velocities that a step takes away, 0 to 1
    float tension = 0.0f;     ///< 1/s^2: how fast neighbours draw nearer for each metre between them
    int iterations = 4;
    FieldBuffers field = {};  ///< what the obstacle reads
};

struct FluidParticles {
    uint32_t count = 0;
    Buffer places, velocities;  ///< four floats each, in the order of cells after a step
    Buffer densities;           ///< of the last step, before its last turn
    Buffer guesses, planes, sortedPlaces, sortedGuesses, sortedPlanes, weighed;
    Buffer keys, order, lists, counts;
    CountingSortBuffers cells;
};

/// The side of a particle's share of the fluid times this is the support of the kernel: some 65 neighbours.
inline constexpr float kFluidSupport = 2.5f;

/// Particles at even spacing in a box, at rest.
std::vector<glm::vec3> fluidBlock(const glm::vec3& lo, const glm::vec3& hi, float spacing);

void setFluid(const Device& device, FluidParticles& fluid, const std::vector<glm::vec3>& places,
              const std::vector<glm::vec3>& velocities);

/// Records one step of so many seconds. Errors: a tank of so many cells, or so many particles, that the
/// device cannot bind what belongs to them.
Done recordFluidStep(Commands& commands, const FluidKernels& kernels, FluidParticles& fluid,
                     const FluidConfig& config, float step);

}  // namespace fw
