// Which of a cache's simulations are those of a recipe.
#pragma once

#include "graph/assets/particle_cache.h"
#include "graph/compile/particle_recipe.h"
#include "graph/document/graph.h"

namespace fw {

/// What a recipe of the document simulates, as a cache has it: what its source comes to, and behind that its
/// foam, if it has some. A file's particles that nothing moves are no simulation.
std::vector<CachedSimulation> simulationsOf(const Graph& graph, const ParticleRecipe& recipe);

/// Tells the recipe's stages where their states are. Errors, with a message and a code: no such cache, or one
/// of other simulations, with what differs.
Done findCached(const Graph& graph, ParticleRecipe& recipe);

/// Whether what the cache has is of this document. Errors: it has nothing that the document simulates, or
/// other simulations, with what differs; not what files hold, which findCached() sees.
Done checkCache(const Graph& graph, const ParticleCache& cache);

/// Whether what this node gives takes a simulation that no cache has; of no node: what the document shows.
bool simulatesAnew(const Graph& graph, std::string_view node = {});

/// How two simulations of one node differ, in words.
std::string differenceOf(const CachedSimulation& was, const CachedSimulation& is);

/// Makes all nodes of the document that simulate read the cache with this header; of an empty path none.
void useCache(Graph& graph, const std::string& header);

}  // namespace fw
