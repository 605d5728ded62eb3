// Fluids as particles, with positions for unknowns.
//
// After Macklin and Müller, "Position Based Fluids" (ACM TOG 32(4), 2013): each step first moves every
// particle as if it were alone; then, some times over, moves all of them so that no density is above that at
// rest; the velocity is what led from the old place to the new one. Chosen over solvers of forces (the
// talk's, WCSPH) since it is stable at steps of a sixtieth of a second, where those need some forty. The
// price: it gives no pressures, and what a turn moves wrongly is lost as energy.
//
// Deviations from the paper: one kernel, Wendland's C2, for density and gradient, so that pairs do not clump
// and no artificial pressure is needed; walls count as full of fluid, by the integral of the kernel beyond
// their plane, so that there is no gap before them and no particles' boundary to place; lists of neighbours
// are made once a step; a turn makes a share of the correction (kFluidRelaxation), without which turns
// diverge; the kernel is scaled so that a lattice has the density at rest. Densities below that at rest are
// left alone: a fluid does not pull. Everything that two particles do to one another is equal and opposite,
// so that momentum is kept to rounding; sums run in the order of a stable sort, so that the same particles
// give the same bytes on every run. A particle feels 64 others at most: momentum is not kept where there are
// more, twice as dense as at rest.
//
// Swirls can be fed by vorticity confinement, as in the paper. What two particles then do to each other is
// not opposite: momentum is kept no more than about.
//
// Surface tension is the gradient of an energy, so that it makes none: E = sum over pairs of Phi(r) +
// share support^3 / 2 sum |grad density|^2, in units of the greatest force of Phi. Phi is that of the
// cohesion of Akinci, Akinci and Teschner, "Versatile Surface Tension and Adhesion for SPH Fluids" (ACM TOG
// 32(6), 2013). The second sum is that of a diffuse interface (He et al., "Robust Simulation of Sparsely
// Sampled Thin Features in SPH-Based Free Surface Flows", ACM TOG 34(1), 2014); it stands for Akinci's
// differences of normals, which are no gradient. Without it bars stay bars; without cohesion the fluid
// evaporates. Drops swing as Rayleigh has it ("On the Capillary Phenomena of Jets", 1879), which gives the
// scale. What is left is of a solid: a drop at rest may stay some per cent from round. Walls count as full of
// fluid for densities, and attract nothing: drops meet them at about a right angle. Tension above
// kFluidMostTension is cut: it would blow up.
//
// Far neighbours are felt once a step, as they were when it began (FluidConfig::farOnce). Swoboda ("Advanced
// Procedural Rendering in DirectX 11", GDC 2012) takes them for the mean of their cell, which pays where
// cells hold many. With some 33 neighbours they do not: with cells of half the support nearly as many means
// are left, and with cells as wide as the support the density is far off. fluid_test.cpp has the figures of
// both.
//
// An obstacle that moves has gone its way by each step's end, and pushes out what it then holds. Velocities
// come of places, so that what lies on it gets the speed of its surface along the normal; along the surface
// it drags nothing. It should move by half a spacing a step at most: through a wall that is thinner than its
// way particles pass.
//
// Turns end, where that is asked for, at a mean error (FluidConfig::error). The device finds it while it
// weighs densities, and the groups of all turns behind are read from where it then writes none: the host
// waits for nothing. Errors are added up as whole numbers, so that every run takes the same turns.
//
// What is too dense is pushed apart within a step, however far, and its speed would be what that took: single
// drops would leap several times as high as they fell from. So where there is gravity a particle's energy,
// kinetic and potential, is cut where it is more than the greatest that a neighbour had when the step began,
// and than a gradient of the pressure as great as the fluid's weight adds to its own (FLUID_MOST_PRESSURE),
// by which dams break and fluid climbs walls. Where something is cut, momentum is not kept. Without gravity
// nothing leaps, and nothing is cut.
//
// Particles may be added and taken away between steps. Those in an outflow are sorted behind the others,
// which keep their order: by their numbers' blocks, so that no key has more than the sort puts in order. How
// many are left, the host asks.
//
// Turns begin from nothing. From a share of the last step's corrections (a warm start) there are fewer, a
// third at a share of 0.7; but what no longer holds of them becomes speed, and a column that breaks gains
// several times the energy that it had.
//
// What a turn can mend reaches as far as the kernel: in a step a particle should fall or fly no farther than
// half a spacing, and what is deep, in particles, wants shorter steps or more turns, or it is too dense at
// the bottom.
//
// Units: metres, seconds, densities in units of that at rest. Lifetime: kernels serve one obstacle; buffers
// grow.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <string_view>

#include "runtime/gpu/counting_sort.h"
#include "runtime/gpu/field_buffers.h"

namespace fw {

namespace gpu {
struct FluidPush;
}

struct FluidKernels {
    CountingSort sort;
    Pipeline predict, reorder, neighbours, nearNeighbours, densityError, addedError, enough, giveWay,
        velocity, curl, confine, smoothVelocity, densityGradient, drawTogether;
    std::optional<Pipeline> drain = {};
};
/// Texts that answer #include "field.glsl", empty for none: of the field that the fluid stays out of, and of
/// that in which it is taken away.
FluidKernels createFluidKernels(const Device& device, std::string_view obstacle,
                                std::string_view outflow = {});

struct FluidConfig {
    float spacing = 0.05f;          ///< of particles at rest
    glm::vec3 lo{-1.0f}, hi{1.0f};  ///< the tank
    glm::vec3 gravity{0.0f, -9.81f, 0.0f};
    float viscosity = 2.0f;  ///< 1/s: how fast the velocities of neighbours draw level
    float tension = 0.0f;    ///< m^3/s^2: of the surface, over the density: 7.3e-5 for water
    int iterations = 4;      ///< turns of a step, at most
    float vorticity = 0.0f;  ///< 1/s: how fast swirls gain what a spacing of them has of speed
    float error = 0.0f;   ///< at which turns end: the mean of how far densities exceed that at rest; 0: never
    bool farOnce = true;  ///< whether neighbours beyond kFluidNear are felt as they were when the step began
    FieldBuffers field = {};  ///< what the obstacle reads
};

struct FluidParticles {
    uint32_t count = 0;
    /// Four floats each, in the order of cells after a step. The fourth of a place has no meaning then; that
    /// of a velocity is the bits of the particle's number, which stays its own.
    Buffer places, velocities;
    Buffer densities;  ///< one each, as they were before the last turn of the step
    Buffer guesses, planes, sortedPlaces, sortedGuesses, sortedPlanes, weighed;
    Buffer keys, order, lists, counts, far;
    CountingSortBuffers cells;
    Buffer curls;          ///< with vorticity: four floats each, the curl of the velocity and its length, 1/s
    Buffer errors, turns;  ///< where turns end at an error (FluidTurns)
};

/// Whose step one submission is at most, or whose steps: a tenth of a second on two cores.
inline constexpr uint64_t kParticlesSentTogether = 200'000;

/// The support of the kernel, in spacings: some 33 neighbours.
inline constexpr float kFluidSupport = 2.0f;
/// Share of the support within which neighbours are listed: three of four. With less, deep columns gain
/// energy.
inline constexpr float kFluidNear = 0.9f;
/// Share of each turn's correction that is made. All particles move at once, so that neighbours together
/// make more of a correction than each asked for, more than twice as much in a full lattice: then turns with
/// a whole share diverge.
inline constexpr float kFluidRelaxation = 0.6f;

/// The greatest tension that a step can take, times its square, in cubed spacings.
inline constexpr float kFluidMostTension = 0.04f;
/// Tension over the greatest acceleration that two particles give each other by it, in squared spacings: what
/// gives drops the period of Rayleigh.
inline constexpr float kTensionOfPairs = 2.9f;

/// What the kernels of a step are told of a fluid with so many particles.
gpu::FluidPush fluidPush(const FluidConfig& config, uint32_t count, float step);

/// What the solver knows of particles at rest: a cubic lattice of spacing 1.
struct FluidLattice {
    float weight;  ///< of the kernel at distance 0, for the lattice's density to be 1
    float soft;    ///< a hundredth of the squared gradients that a particle's neighbours have of its density:
                   ///< what keeps lone particles still
};
FluidLattice fluidLattice();

/// Particles at even spacing in a box, at rest.
std::vector<glm::vec3> fluidBlock(const glm::vec3& lo, const glm::vec3& hi, float spacing);

/// Makes room for so many particles, whose places and velocities are then undefined. The device must not be
/// using the fluid.
void reserveFluid(const Device& device, FluidParticles& fluid, uint32_t count);

/// Sets all there is of the state: what was read from `places` and `velocities` goes on to the same bytes. No
/// velocities: all at rest. All numbers are 0. The device must not be using it.
void setFluid(const Device& device, FluidParticles& fluid, const std::vector<glm::vec3>& places,
              const std::vector<glm::vec3>& velocities);

/// Adds particles behind all others, numbered from `firstId` on. The device must not be using the fluid.
void addToFluid(const Device& device, FluidParticles& fluid, const std::vector<glm::vec3>& places,
                const std::vector<glm::vec3>& velocities, uint32_t firstId);
/// Velocities as the device has them, each with the next number.
std::vector<glm::vec4> numbered(const std::vector<glm::vec3>& velocities, uint32_t firstId);

/// Takes away what is in the outflow that the kernels were made with, which reads `outflow`; the others keep
/// their order. Ends the recording and waits for it.
void drainFluid(Commands& commands, const FluidKernels& kernels, FluidParticles& fluid,
                const FieldBuffers& outflow);

/// Records one step of so many seconds; of many particles it is sent in parts. Errors: sizes or a step that
/// are not greater than 0; more cells or particles than the device can bind what belongs to.
Done recordFluidStep(Commands& commands, const FluidKernels& kernels, FluidParticles& fluid,
                     const FluidConfig& config, float step);

/// Records so many steps, sent some at a time. `ahead`, which may be empty, records what goes ahead of each,
/// by its number from 0: how an obstacle has moved. Errors as above.
Done recordFluidSteps(Commands& commands, const FluidKernels& kernels, FluidParticles& fluid,
                      const FluidConfig& config, float step, int count,
                      const std::function<void(int)>& ahead = {});

/// Records how particles that were just set settle, without weight, and come to rest: a lattice that fills a
/// corner is too dense by 5 % beside each wall, and would spring apart. Errors as recordFluidStep().
Done recordSettling(Commands& commands, const FluidKernels& kernels, FluidParticles& fluid,
                    FluidConfig config);

}  // namespace fw
