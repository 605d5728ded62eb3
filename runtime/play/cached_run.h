// Simulations of a document, run once and written into a particle cache (graph/assets/particle_cache.h).
//
// What is written is read by the same simulations: a run that goes on begins at the last state that is there,
// and comes to the same bytes as one that was never stopped. Which states are kept is for whoever runs it; a
// state between two that are kept is simulated again from the first of them when it is asked for.
//
// Lifetime: belongs to a device.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "graph/assets/particle_cache.h"
#include "graph/compile/live_program.h"
#include "runtime/particles/particle_fields.h"
#include "runtime/play/frames.h"

namespace fw {

/// The error that a document shows nothing which is simulated.
Error nothingSimulated(const Graph& graph);

class CachedRun {
  public:
    /// Compiles the document, in which check() found no error, for a cache in the folder. Errors: those of
    /// compileLive(); nothing that it shows is simulated.
    static Result<CachedRun> open(Graph graph, const std::string& folder, const CompileOptions& options,
                                  const Device& device);

    /// Whether the folder may become this cache: there is none, or none with another simulation of a node.
    /// Errors: it may not; what differs.
    Done fits() const;
    /// Makes the folders and the header, which keeps simulations of other nodes. `anew`: removes the states
    /// that are there. Errors: folder or header cannot be made.
    Done begin(const FrameRange& frames, bool anew);

    /// The steps that these frames show, each once.
    std::vector<int> steps(const FrameRange& frames) const;
    bool isThere(int step) const;
    /// Goes to the step and gives what writes its states, on any thread, for whoever calls it. `progress` and
    /// errors as Simulation::goTo().
    Result<std::function<Done()>> make(int step, const std::function<bool(int done, int all)>& progress = {});

  private:
    CachedRun(std::string folder_, const CompileOptions& compiling_, const Device& device)
        : folder(std::move(folder_)), compiling(compiling_), fields(device) {}
    std::string headerPath() const;
    std::vector<CachedStates> caches() const;

    std::string folder;
    CompileOptions compiling;
    LiveProgram live;
    std::vector<CachedSimulation> simulated;
    ParticleFields fields;
    std::vector<std::shared_ptr<Simulation>> simulations;
};

}  // namespace fw
