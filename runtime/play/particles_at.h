// The particles that a node gives at a time, whether the graph shows them or not.
#pragma once

#include <functional>
#include <string>

#include "graph/compile/live_program.h"
#include "runtime/export/points.h"
#include "runtime/gpu/device.h"
#include "runtime/particles/simulation.h"

namespace fw {

/// The output that is asked for as "node", or "node.output" of a group that has several which give particles.
/// Errors, before any work is done: no such node among the document's own, none that gives particles.
Result<Link> linkToParticles(const Graph& graph, const std::string& asked);

/// The graph with such an output's particles as all that it shows, in a grid that nobody fills.
Graph showingParticles(Graph graph, const Link& from);

/// What such an output gives at one time after the other, of a graph in which check() found no error,
/// simulated from the start of its timeline, or as a cache has it. Lifetime: belongs to the device.
class NodeParticles {
  public:
    /// Errors: those of compileLive().
    static Result<NodeParticles> open(const Graph& graph, const Link& from, const CompileOptions& options,
                                      const Device& device);

    /// `progress` as Simulation::goTo(). Errors: those of that.
    Result<ParticlePoints> at(double seconds, const std::function<bool(int done, int all)>& progress = {});
    /// What its user should know of its cache.
    std::vector<Error> notes() const;

  private:
    NodeParticles(LiveProgram program, const ParticleFieldPtr& recipe, Link link, const Device& on)
        : live(std::move(program)), simulation(on, recipe), from(std::move(link)), device(&on) {}

    LiveProgram live;
    Simulation simulation;
    Link from;
    const Device* device;
};

}  // namespace fw
