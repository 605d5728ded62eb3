// Where particles come from, what moves them, and how they become a field: plain values that the particle
// nodes of a graph compile to, and that a simulation runs by (runtime/particles/simulation.h).
//
// A recipe is a chain of stages, the source first. Its numbers are values of the graph like any other, read
// anew at each step, so that they can be live, animated or wired; only what gives the field's grid its shape
// is known when the graph is compiled.
//
// Lifetime: recipes are shared and never change.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/vec3.hpp>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "graph/assets/particle_file.h"
#include "graph/assets/volume.h"
#include "graph/evaluate/evaluate.h"
#include "graph/ir/ir.h"

namespace fw {

struct Program;

inline constexpr double kSimulationStep = 1.0 / 60.0;  ///< seconds

/// Where the states of a simulation are kept (graph/assets/particle_cache.h).
struct CachedStates {
    std::string folder;
    uint64_t key = 0;
    bool operator==(const CachedStates&) const = default;
};

/// One node of the chain.
struct ParticleStage {
    enum class Kind : unsigned char { emitter, file, dynamics, fluid, foam } kind = Kind::emitter;
    std::string node = {};  ///< its id, with those of the groups that it is in
    /// By the input's name: its components in the recipe's `ir`.
    std::map<std::string, std::array<IrId, 3>, std::less<>> numbers = {};
    std::map<std::string, std::string, std::less<>> words = {};  ///< choices, and a file's path
    /// By the input's name: those that are connected. Their live slots are the first ones of the graph's
    /// program.
    std::map<std::string, std::shared_ptr<const Program>, std::less<>> fields = {};
    ParticlePlacesPtr places = {};      ///< of a file
    ParticleSequencePtr sequence = {};  ///< of a sequence of files, which have none
    std::optional<CachedStates> cached =
        {};  ///< of what comes out of it, if there are any; not of the recipe
};

/// Behind a fluid there may be foam, which does nothing to it.
struct ParticleRecipe {
    std::vector<ParticleStage> stages;
    std::string cache = {};  ///< the path that the last node which names one has
    bool endsInFoam() const { return stages.back().kind == ParticleStage::Kind::foam; }
    /// The last stage before foam: what comes out of it is simulated.
    ParticleStage& simulated() { return stages[stages.size() - (endsInFoam() ? 2 : 1)]; }
    const ParticleStage& simulated() const { return stages[stages.size() - (endsInFoam() ? 2 : 1)]; }
};

enum class DensityMethod : unsigned char { blur, exact, proxies };
inline constexpr const char* kDensityMethodNames[] = {"blur", "exact", "proxies"};

enum class ParticleSurface : unsigned char { blobs, average, anisotropic };
inline constexpr const char* kParticleSurfaceNames[] = {"blobs", "average", "anisotropic"};

inline constexpr const char* kFoamKinds[] = {"all", "spray", "foam", "bubbles"};

/// Particles as a field: samples on a grid, of a surface about the particles.
struct ParticleField {
    Ir ir;  ///< of all numbers: of the stages, and of the node that makes the field
    ParticleRecipe particles;
    ParticleStage toField;  ///< the numbers of that node
    ParticleSurface surface = ParticleSurface::blobs;
    DensityMethod method = DensityMethod::blur;  ///< of blobs
    bool trueDistance = false;                   ///< everywhere, and not near the surface alone
    std::string node;                            ///< of the particles_to_field
    uint64_t hash = 0;                           ///< equal for equal recipes, whatever the live values
    /// The same of the stages alone, and of those but the foam: what equals can be simulated as one.
    uint64_t stagesHash = 0, sourceHash = 0;
};
using ParticleFieldPtr = std::shared_ptr<const ParticleField>;

/// Of a grid whose cells are chosen, at most: few devices bind fewer texels than 128 MiB of them, and other
/// fields want some.
inline constexpr double kMostChosenTexels = 7.8e6;
inline constexpr int kMostChosenMebibytes = int(kTexelBytes * kMostChosenTexels) >> 20;

inline constexpr int kLeastParticleResolution = 8, kMostParticleResolution = 512;

/// A stage's numbers, with the live parameters' values. Must not outlive the stage. Whatever is wired to an
/// input, they are fit to be reckoned with as floats: what is not a number counts as 0, and what is beyond
/// 1e30 either way as that.
class StageNumbers {
  public:
    StageNumbers(const Ir& ir, const ParticleStage& stage, std::span<const double> parameters) {
        std::vector<IrId> roots;
        for (const auto& [input, components] : stage.numbers) {
            places.emplace(input, roots.size());
            roots.insert(roots.end(), components.begin(), components.end());
        }
        values = evaluate(ir, roots, parameters, {});
    }
    double scalar(std::string_view input) const { return component(input, 0); }
    glm::dvec3 vector(std::string_view input) const {
        return {component(input, 0), component(input, 1), component(input, 2)};
    }

  private:
    double component(std::string_view input, std::size_t i) const {
        constexpr double kMost = 1e30;
        const double value = values[places.find(input)->second + i];
        return std::isnan(value) ? 0.0 : std::clamp(value, -kMost, kMost);
    }
    std::map<std::string_view, std::size_t> places;  // in `values`, of an input's first component
    std::vector<double> values;
};

/// The volume of particles on cubic cells, so many along the longest side of the region, without samples.
/// `ir` is that of the recipe's numbers and of those of the particles_to_field. Errors, with a message only:
/// a region without extent.
Result<FieldVolumePtr> particleVolume(const Ir& ir, const ParticleRecipe& recipe,
                                      const ParticleStage& toField, const Box& region, int resolution);

/// Metres, but for the threshold.
struct SurfaceNumbers {
    double radius, threshold;  ///< of blobs: how far a density reaches, and what it is at the surface
    double drop;  ///< radius of the surface about a particle alone; a fifth of `radius` where blobs have none
    bool operator==(const SurfaceNumbers&) const = default;
};
/// What the surface of particles is made with, of a particles_to_field that names no `drop` too.
SurfaceNumbers surfaceNumbers(const Ir& ir, const ParticleRecipe& recipe, const ParticleStage& toField,
                              std::span<const double> parameters);

/// Where the particles can be: the box of a file's places, a fluid's tank, which its foam does not leave, or
/// what an emitter's particles reach in their lives under the gravity behind it, with nothing in their way;
/// enlarged by `radius`.
Box particleBounds(const Ir& ir, const ParticleRecipe& recipe, std::span<const double> parameters,
                   double radius);

}  // namespace fw
