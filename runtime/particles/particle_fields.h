// The volumes of all particles of a program, at a time: simulated, and made samples.
//
// What begins with the same stages is one simulation: a fluid flows once, whether its own surface is shown,
// its foam, or both.
//
// Lifetime: belongs to one device. A program that takes another's place keeps the simulations of recipes that
// are the same.
#pragma once

#include "graph/compile/live_program.h"
#include "runtime/particles/cloud.h"
#include "runtime/particles/particle_volume.h"
#include "runtime/particles/simulation.h"

namespace fw {

/// Whether particles make a part of the field, of which there are no samples yet.
bool lacksParticles(const Program& program);

/// Of one of the program's volumes, in the buffer of all.
uint32_t firstTexel(const Program& program, std::size_t volume);

struct ParticleChanges {
    bool places = false, fields = false;
};

class ParticleFields {
  public:
    explicit ParticleFields(const Device& device_) : device(&device_) {}

    /// The program whose particles are meant from now on.
    void setProgram(const Program& program);
    /// All simulations, each once.
    std::vector<std::shared_ptr<Simulation>> simulations() const;
    /// Of live values that were changed by hand: Simulation::valuesChanged().
    void valuesChanged();
    /// Brings all particles to a time and writes their samples into `volumes`, the texels of all volumes of
    /// the program: without `surfaces`, those of no particles. Says what changed. Errors as
    /// Simulation::goTo() and recordParticleVolume(), with the node.
    Result<ParticleChanges> make(const Program& program, double seconds, const ValuesAt& values,
                                 const Buffer& volumes, bool surfaces = true,
                                 const std::function<bool(int done, int all)>& progress = {});

    /// The particles, for pictures of them: wherever the program samples their field after moving, turning
    /// or scaling it. What else was done to it, as repeating, they do not follow.
    std::vector<ParticleCloud> clouds(const Program& program) const;
    /// Particles of all simulations: slots, of which some may be empty.
    uint64_t slots() const;

  private:
    struct Part {
        std::size_t volume;  ///< among the program's
        ParticleFieldPtr field;
        std::shared_ptr<Simulation> simulation;  ///< which others may have part in
        std::size_t recipe;                      ///< among its recipes
        SurfaceNumbers numbers{};                ///< that its samples were made with; all 0: there are none
        bool surface = true;                     ///< whether they are of the particles
        bool moved = false;                      ///< whether these are others since
    };
    const Device* device;
    std::optional<ParticleVolumeKernels> kernels;  ///< made when first used
    ParticleVolumeBuffers buffers;
    std::vector<Part> parts;
};

/// The program's volumes of particles with their samples, read back from the texels of all its volumes.
std::vector<FieldVolumePtr> downloadParticles(const Device& device, const Program& program,
                                              const Buffer& volumes);

/// Gives a program samples of its particles, by their nodes, where it lacks some.
void useParticles(Program& program, std::span<const FieldVolumePtr> made);

/// Gives a program that was compiled at a time the samples of its particles, which live in `graph`, on the
/// host, and the notes of the program that is played. Errors as compileLive() and ParticleFields::make().
Done makeParticles(Program& program, const Graph& graph, double seconds, const CompileOptions& options,
                   const Device& device, const std::function<bool(int done, int all)>& progress = {});

}  // namespace fw
