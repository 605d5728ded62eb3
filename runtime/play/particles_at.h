// The particles that a node gives at a time, whether the graph shows them or not.
#pragma once

#include <functional>
#include <string>

#include "graph/compile/compile.h"
#include "runtime/export/points.h"
#include "runtime/gpu/device.h"

namespace fw {

/// Of a graph in which check() found no error, simulated from the start of its timeline. `progress` as
/// Simulation::goTo(). Errors: no such node among the document's own, a node that gives no particles; those
/// of compileLive() and Simulation::goTo().
Result<ParticlePoints> particlesAt(const Graph& graph, const std::string& node, double seconds,
                                   const CompileOptions& options, const Device& device,
                                   const std::function<bool(int done, int all)>& progress = {});

/// Says, before any work is done, why particlesAt() can give none of that node.
Done checkGivesParticles(const Graph& graph, const std::string& node);

}  // namespace fw
