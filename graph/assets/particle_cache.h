// What the header of a particle cache says: which simulations a folder keeps, so that nobody takes them for
// others.
//
// A cache is a folder with a header, particles.cache, and a folder for each simulation with a file for each
// step that is kept (runtime/particles/state_file.h). Its header has, of each simulation, the part of the
// document that it was made from, as a graph file of its own: so it is told not only that a cache is of
// another simulation, but also in what. A simulation is its document, not what that compiles to: the same is
// compiled in other ways by an export, a player and the editor.
//
// Lifetime: plain values, shared while somebody holds them (asset_file.h).
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "graph/base/algorithm_version.h"
#include "graph/base/result.h"

namespace fw {

/// The header's name in the cache's folder.
inline constexpr const char* kParticleCacheName = "particles.cache";
inline constexpr int kParticleCacheVersion = 1;

struct CachedSimulation {
    std::string node;   ///< whose particles: its id, with those of the groups that it is in
    std::string part;   ///< of the document that makes them, as the text of a graph file
    uint64_t data = 0;  ///< a hash of what the files hold that it reads
    uint32_t algorithms = kAlgorithmVersion;  ///< of the program that simulated; 0: not recorded
    bool operator==(const CachedSimulation&) const = default;

    /// What its files are marked with.
    uint64_t key() const;
    /// The folder of its files.
    std::string folder() const;
};

struct ParticleCache {
    std::string folder;                         ///< absolute
    std::vector<CachedSimulation> simulations;  ///< by their nodes

    const CachedSimulation* of(const std::string& node) const;
};
using ParticleCachePtr = std::shared_ptr<const ParticleCache>;

/// Reads the header of a kind kParticleCacheFile. `path` is relative to the folder of the file `graphPath`,
/// or absolute. The Error has a message only: as openAsset(), what is no header, one of a newer version.
Result<ParticleCachePtr> readParticleCache(const std::string& graphPath, const std::string& path);

/// The header's text, which also tells seconds of a step, and whatever else in JSON `about` says.
std::string writeParticleCache(const ParticleCache& cache, double step, const std::string& about = "{}");

}  // namespace fw
