// Particles over time: what a recipe (graph/compile/particle_recipe.h) says, in steps of a sixtieth of a
// second.
//
// The state after so many steps is a pure function of the recipe and of the live values at the times of all
// steps before. Going forward takes the steps in between, for none of which the host waits; a step that was
// taken before is fetched, or starts from the last checkpoint before: copies of the state on the device, of
// which each step keeps one, and every second is dropped whenever they take too much memory. Where a live
// value was changed by hand, the particles go on from where they are, and the past is as the new values have
// it once it is played again.
//
// A fluid takes a step in parts, in each of which an obstacle that moves with the time has gone on.
//
// What flows into a fluid stands on a lattice that drifts with its speed: a place of it that was outside of
// the inflow a step ago and is inside now is a particle, so that they come as dense as at rest, and as many
// as the speed and the inflow's cross-section ask for. The host counts what comes, and asks how many the
// outflow took: with either it waits for each step.
//
// Emitted particles are numbered in the order of their births; number n stands in slot n % slots, so that the
// last ones that were born are there. A slot whose particle has died, or that never had one, has a place that
// is not a number.
//
// Where a cache keeps states of the simulation (runtime/particles/state_file.h), a step that it has is read
// from there, and one that it lacks starts from the last that is before, if none nearer is known. All numbers
// but the states' own follow from the live values anew, so that what goes on from a state goes on to the same
// bytes. A live value that was changed by hand leaves the cache aside until recipes come that know of the
// change.
//
// A sequence of files is not simulated: a time is the file that is shown then.
//
// Every particle has a number that stays its own: of a file the one that it has there, or its place; else
// that of its birth, from 0, modulo 2^32.
//
// Recipes that differ in their foam alone, or of which some have none, are simulated as one: the fluid flows
// once, and each foam goes along.
//
// simulation.cpp has the steps, and particles that are emitted or moved; simulation_fluid.cpp fluids and
// foam; simulation_states.cpp what is kept of states.
//
// Lifetime: a simulation belongs to one device and its recipes; buffers grow.
#pragma once

#include <deque>
#include <functional>
#include <glm/vec3.hpp>

#include "graph/compile/particle_recipe.h"
#include "runtime/gpu/field_buffers.h"
#include "runtime/particles/foam.h"
#include "runtime/particles/state_file.h"

namespace fw {

inline constexpr double kMostSimulated = 36'000.0;     ///< seconds
inline constexpr uint32_t kMostParticles = 4'000'000;  ///< at a time

/// The live parameters' values at a time.
using ValuesAt = std::function<std::vector<double>(double seconds)>;

/// A field that particles meet, on the device.
struct Obstacle {
    std::shared_ptr<const Program> program;
    Buffer parameters = {}, images = {}, volumes = {};
    FieldBuffers buffers() const { return {&parameters, &images, &volumes}; }
};
/// Sets the parameters of an obstacle from the live values. Those that it knows of are the first ones: others
/// may have been added since, and taken away those that it does not read.
void setParameters(Commands& commands, const Obstacle& obstacle, const std::vector<double>& values);

class Simulation {
  public:
    /// Of recipes with the same source (ParticleField::sourceHash), at least one.
    Simulation(const Device& device, std::vector<ParticleFieldPtr> recipes);
    Simulation(const Device& on, ParticleFieldPtr recipe) : Simulation(on, std::vector{std::move(recipe)}) {}

    /// Goes to the last step at or before so many seconds, or to the start. `progress`,
    /// which may be empty, is told how many steps there are and how many are done, and ends the work by
    /// returning false; the start alone is no step. Returns whether the particles are others now. Errors:
    /// more particles than there may be, a time beyond kMostSimulated, and that it was ended.
    Result<bool> goTo(double seconds, const ValuesAt& values,
                      const std::function<bool(int done, int all)>& progress = {});
    /// Of live values that changed otherwise than with the time: what was kept is out of date.
    void valuesChanged();
    /// Takes the same recipes again, whose caches may be others.
    void takeAgain(const std::vector<ParticleFieldPtr>& recipes);

    /// Where those of a recipe are: four floats each, the place and, of those that are born, the age.
    const Buffer& places(std::size_t recipe = 0) const;
    /// How fast they are, likewise, metres per second; null if nothing moves them.
    const Buffer* velocities(std::size_t recipe = 0) const;
    uint32_t slots(std::size_t recipe = 0) const;
    /// The number of each slot's particle, on the host; of a slot without one any.
    std::vector<uint32_t> ids(std::size_t recipe = 0) const;
    const std::vector<ParticleFieldPtr>& recipes() const { return fields; }

    /// The step that goTo() takes it to.
    static int stepAt(double seconds);
    /// Where a cache keeps its states, those of the source and then of each foam; none without a cache.
    const std::vector<CachedStates>& caches() const { return cached; }
    /// The state of each, after the step that it is at.
    std::vector<ParticleState> states() const;

  private:
    struct State {
        int steps = -1;  ///< taken; -1 before the start
        Buffer places, velocities;
        uint32_t slots = 0;
    };
    /// Places, and velocities behind them, of the source and of each foam, from a byte of a buffer that holds
    /// several.
    struct Checkpoint {
        int steps;
        std::vector<uint32_t> slots;
        std::shared_ptr<const Buffer> kept;
        VkDeviceSize at;
    };
    struct StatePart {
        const Buffer* buffer;
        VkDeviceSize bytes;
    };

    struct Fluid {
        FluidKernels kernels;
        std::optional<Obstacle> obstacle, outflow;
        FluidParticles particles;
    };

    /// Of a recipe that has one.
    struct Foam {
        ParticleFieldPtr field;
        int shown;  ///< the kind; negative: all
        FoamParticles particles;
        const ParticleStage& stage() const { return field->particles.stages.back(); }
    };

    const Buffer& sourcePlaces() const { return fluid ? fluid->particles.places : state.places; }
    const Foam* foamOf(std::size_t recipe) const;
    const Buffer& motion() const { return fluid ? fluid->particles.velocities : state.velocities; }
    const ParticleStage& source() const { return field().particles.stages.front(); }
    /// Whether time changes nothing.
    bool rests() const;
    Done start(const std::vector<double>& values);
    Done fill(const std::vector<double>& values);
    void takePoints(ParticlePlacesPtr from);
    Result<bool> show(double seconds, const std::vector<double>& values);
    FluidConfig configOf(Commands& commands, const std::vector<double>& values) const;
    int partsOf(const FluidConfig& config, const std::vector<double>& before,
                const std::vector<double>& now) const;
    Done inflow(const std::vector<double>& before, const std::vector<double>& now);
    void outflow(const std::vector<double>& now);
    Done flow(Commands& commands, const std::vector<double>& now, const ValuesAt& values);
    FoamConfig configOf(const Foam& foam, const std::vector<double>& values) const;
    Result<bool> stepTo(int wanted, const ValuesAt& values,
                        const std::function<bool(int done, int all)>& progress);
    void showFoam();
    Done step(const std::vector<double>& now, const ValuesAt& values);
    void move(Commands& commands, const std::vector<double>& values);
    void emit(Commands& commands, const StageNumbers& emitter, double before, double after);
    Done makeRoom(const StageNumbers& emitter, double born);
    void setSlots(uint32_t slots);
    /// Ends a step.
    Done taken(Commands& commands);
    void keep(Commands& commands);
    std::vector<uint32_t> allSlots() const;
    Checkpoint roomFor(std::vector<uint32_t> slots);
    /// What a state consists of, of the source (0) and each foam behind it, with so many slots.
    std::vector<StatePart> stateParts(std::size_t i, uint32_t slots) const;
    VkDeviceSize bytesOf(const std::vector<uint32_t>& slots) const;
    /// Calls with what a checkpoint holds: a buffer, its first byte there, and its size.
    template <class Call>
    void forParts(const Checkpoint& of, Call call) const;
    void forget();
    void reserveState(const std::vector<uint32_t>& slots);
    void restore(const Checkpoint& from);
    /// The last step up to that one which the cache has; -1: none.
    int lastCached(int step) const;
    Done load(int step, const ValuesAt& values);
    void countBirths(const ValuesAt& values);

    const Device* device;
    const ParticleField& field() const { return *fields.front(); }
    std::vector<ParticleFieldPtr> fields;
    Pipeline births, flight;
    struct Move {
        Pipeline kernel;
        std::optional<Obstacle> obstacle;
    };
    std::vector<Move> moves;  ///< of each stage of dynamics
    std::optional<Fluid> fluid;
    std::optional<FoamKernels> foamKernels;  ///< where there is foam
    std::vector<Foam> foams;
    State state;
    ParticlePlacesPtr points = {};  ///< of a file, or of the sequence's that is shown
    long shown = 0;                 ///< its number
    std::vector<CachedStates> cached = {};
    bool cacheHolds = true;    ///< its states are of the live values
    std::vector<double> born;  ///< how many were, after each step; of a fluid into which more flows, too
    std::vector<glm::dvec3> drifts;      ///< of what flows in, after each step, metres
    std::deque<Checkpoint> checkpoints;  ///< by their steps
    std::vector<Checkpoint> dropped;     ///< whose room is free
    std::shared_ptr<const Buffer> open;  ///< has room from here on
    VkDeviceSize openFrom = 0;
    int apart = 1;  ///< steps between checkpoints
};

}  // namespace fw
