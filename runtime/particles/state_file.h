// The state of simulated particles after a step, as a file of a particle cache
// (graph/assets/particle_cache.h): all that the steps behind it follow from, bit for bit.
//
// A file is the header below and then what the device's buffers hold; its name is the step's number,
// "000120.state". It appears whole (runtime/system/output_file.h) and is marked with the simulation's key:
// one of another simulation, of an older form, or cut off counts as not there. Words are little-endian.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "graph/compile/particle_recipe.h"

namespace fw {

struct ParticleState {
    uint32_t step = 0, slots = 0;
    double born = 0.0;                  ///< how many were, as far as the simulation counts them
    double drift[3] = {0.0, 0.0, 0.0};  ///< of what flows in, metres
    std::vector<char> bytes = {};       ///< of the buffers, one behind the other
};

/// The path of a step's file.
std::string statePath(const CachedStates& of, int step);

/// Whether it is there, whole as far as its length tells.
bool stateIsThere(const CachedStates& of, int step);

/// The steps up to that one whose files have the right names, the last first.
std::vector<int> statesUpTo(const CachedStates& of, int step);

/// Errors, with the file and a remedy: it cannot be read, or what it holds is not what was written.
Result<ParticleState> readState(const CachedStates& of, int step);

/// Into its folder, which is there. Errors: as OutputFile.
Done writeState(const CachedStates& of, const ParticleState& state);

}  // namespace fw
