// Spray, foam and bubbles: particles of their own, which a fluid gives off where it is torn, and which do
// nothing to it.
//
// After Ihmsen, Akinci, Akinci and Teschner, "Unified Spray, Foam and Bubbles for Particle-Based Fluids" (The
// Visual Computer 28, 2012). In each step a particle of the fluid gives off as many as
// amount energy (air + wave): by how fast it is, by how fast its neighbours come towards it, which traps
// air, and by how bent the surface is where it moves along its normal, which is a crest. How much fluid there
// is about a particle of foam then says what it is: spray, with little, flies; bubbles, inside, rise against
// a drag; foam, between, is carried along. Only as foam does it age.
//
// Deviations: one speed gives all thresholds, so that an ocean and a glass differ by one number; energy is
// by mass; only what is steep enough counts as a surface; what particles are is told by the fluid's density,
// walls left out of the ball that it is measured in, and not by how many neighbours they have; bubbles come
// to their speed of rising, 0.25 m/s under the earth's gravity, exactly; lives vary between a half and three
// halves of the lifetime. Spray dies at the tank's walls and in the obstacle, where it would be water again;
// foam and bubbles stay out of them. The fluid's cells are those from before its particles moved apart, which
// matters at the kernel's rim alone.
//
// A step is as long as the whole step of the simulation, however many parts the fluid takes it in. Where
// particles of foam come from, what they are and which slots they take is decided by prefix sums and by
// chances that the seed, the step and the places in the fluid's order give: the same steps give the same
// bytes. Slots without a particle have a place that is not a number.
//
// Units: metres, seconds. Lifetime: kernels serve one obstacle; buffers grow.
#pragma once

#include <string_view>

#include "runtime/gpu/counting_sort.h"
#include "runtime/particles/fluid.h"

namespace fw {

struct FoamKernels {
    KeyCounting counting;
    Pipeline normals, torn, vacant, free, births, move, shown;
};
/// With the text that answers #include "field.glsl" of what the fluid stays out of, or none.
FoamKernels createFoamKernels(const Device& device, std::string_view obstacle);

struct FoamConfig {
    float amount = 50.0f;   ///< 1/s: particles that one of the fluid gives off where it is torn
    float speed = 1.0f;     ///< m/s: below it, water is not torn; at three times as much, most
    float lifetime = 3.0f;  ///< s, as foam
    uint32_t seed = 0;
    uint32_t step = 0;  ///< its number: what else chances follow from
};

/// The state is `places`, each followed by the seconds as foam, `velocities`, by the kind and a chance, and
/// `ids`, of foamIdBytes().
struct FoamParticles {
    uint32_t slots = 0;
    Buffer places, velocities;
    Buffer ids;  ///< the number of each slot's particle; behind them how many there were, by a step's parity
    Buffer shown;  ///< places of one kind
    Buffer numbers, normals, given, before, sums, vacant, vacantBefore, vacantSums, free;
};

inline uint64_t foamIdBytes(uint32_t slots) { return 4ull * (slots + 2ull); }

/// Makes so many slots, all of them empty: as many as there may be particles at a time. The device must not
/// be using it.
void clearFoam(const Device& device, FoamParticles& foam, uint32_t slots);

/// Makes room for so many slots, whose state is then undefined. The device must not be using it.
void reserveFoam(const Device& device, FoamParticles& foam, uint32_t slots);

/// Records one step of so many seconds, which must follow a step of the fluid, with nothing added or taken
/// away since: births, and then how all move. There must be a slot.
void recordFoamStep(Commands& commands, const FoamKernels& kernels, FoamParticles& foam,
                    const FoamConfig& config, FluidParticles& fluid, const FluidConfig& flowing, float step);

/// Records that `shown` gets the places of one kind, from 0 in the order of FOAM_SPRAY and the others
/// (shaders/particles/foam.h).
void recordFoamShown(Commands& commands, const FoamKernels& kernels, FoamParticles& foam, int kind);

}  // namespace fw
