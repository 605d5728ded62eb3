// The particles that a node gives at a time, whether the graph shows them or not.
#pragma once

#include <functional>
#include <string>

#include "graph/compile/compile.h"
#include "runtime/export/points.h"
#include "runtime/gpu/device.h"

namespace fw {

/// The output that is asked for as "node", or "node.output" of a group that has several which give particles.
/// Errors, before any work is done: no such node among the document's own, none that gives particles.
Result<Link> linkToParticles(const Graph& graph, const std::string& asked);

/// What such an output gives, of a graph in which check() found no error, simulated from the start of its
/// timeline. `progress` as Simulation::goTo(). Errors: those of compileLive() and Simulation::goTo().
Result<ParticlePoints> particlesAt(const Graph& graph, const Link& from, double seconds,
                                   const CompileOptions& options, const Device& device,
                                   const std::function<bool(int done, int all)>& progress = {});

}  // namespace fw
