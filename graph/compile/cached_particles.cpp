#include "graph/compile/cached_particles.h"

#include <filesystem>
#include <set>

#include "graph/assets/image.h"
#include "graph/assets/triangle_mesh.h"
#include "graph/base/hash.h"
#include "graph/compile/program.h"
#include "graph/document/json.h"
#include "graph/document/part_behind.h"
#include "graph/library/node_type.h"

namespace fw {

namespace {

using Stages = std::span<const ParticleStage>;

/// Of all that the stages read from files.
uint64_t hashOfFiles(Stages stages) {
    std::set<uint64_t> hashes;
    for (const ParticleStage& stage : stages) {
        if (stage.places) hashes.insert(stage.places->hash);
        for (const auto& [input, program] : stage.fields) {
            for (const FieldImagePtr& image : program->ir.images())
                if (!image->file.empty()) hashes.insert(image->hash);
            for (const FieldVolumePtr& volume : program->ir.volumes())
                if (volume->mesh) hashes.insert(volume->mesh->hash);
        }
    }
    uint64_t hash = 0;
    for (const uint64_t each : hashes) hash = mixed(hash, each);
    return hash;
}

/// The part of the document behind a node, whose id may be that of one in a group.
std::string textBehind(const Graph& graph, std::string_view node) {
    return writeGraph(partBehind(graph, node.substr(0, node.find('/'))));
}

CachedSimulation simulationOf(const Graph& graph, Stages stages) {
    const std::string& node = stages.back().node;
    return {.node = node, .part = textBehind(graph, node), .data = hashOfFiles(stages)};
}

/// How a simulation of the present program differs from that of the cache.
std::string differenceOf(const CachedSimulation& was, const std::string& part) {
    if (was.algorithms != kAlgorithmVersion)
        return "it was made by a version of Fieldwright with other algorithms";
    const Result<Graph> before = parseGraph(was.part, "", nullptr), now = parseGraph(part, "", nullptr);
    return before && now ? differenceOf(*before, *now) : "its nodes are others";
}

Error passedOver(const std::string& message) {
    return {.message = message, .code = Error::Code::uselessCache};
}

}  // namespace

std::string differenceOf(const CachedSimulation& was, const CachedSimulation& is) {
    return differenceOf(was, is.part);
}

std::vector<CachedSimulation> simulationsOf(const Graph& graph, const ParticleRecipe& recipe) {
    const Stages stages = recipe.stages;
    const Stages source = stages.first(stages.size() - (recipe.endsInFoam() ? 1 : 0));
    std::vector<CachedSimulation> made;
    if (source.size() > 1 || source.front().kind != ParticleStage::Kind::file)
        made.push_back(simulationOf(graph, source));
    if (recipe.endsInFoam()) made.push_back(simulationOf(graph, stages));
    return made;
}

Done findCached(const Graph& graph, ParticleRecipe& recipe) {
    const Result<ParticleCachePtr> cache = readParticleCache(graph.path, recipe.cache);
    if (!cache) return passedOver(cache.error().message + "; until then it is simulated anew");
    for (const CachedSimulation& wanted : simulationsOf(graph, recipe)) {
        const CachedSimulation* const kept = (*cache)->of(wanted.node);
        const std::string name = "the particle cache " + inQuotes(recipe.cache),
                          remedy = ": simulate again (fieldwright simulate), or else it is simulated anew";
        if (!kept) return passedOver(name + " has no particles of node " + inQuotes(wanted.node) + remedy);
        if (!(*kept == wanted))
            return passedOver(name + " is of another simulation: " + differenceOf(*kept, wanted) + remedy);
    }
    for (const CachedSimulation& wanted : simulationsOf(graph, recipe)) {
        ParticleStage& stage =
            wanted.node == recipe.simulated().node ? recipe.simulated() : recipe.stages.back();
        stage.cached =
            CachedStates{(std::filesystem::path((*cache)->folder) / wanted.folder()).string(), wanted.key()};
    }
    return done();
}

Done checkCache(const Graph& graph, const ParticleCache& cache) {
    const auto useless = [&](const std::string& why) {
        return Error{.message = "the particle cache " + inQuotes(cache.folder) +
                                " is of another simulation: " + why +
                                ": simulate again (fieldwright simulate --overwrite)",
                     .code = Error::Code::uselessCache};
    };
    if (cache.simulations.empty()) return useless("it has none");
    for (const CachedSimulation& kept : cache.simulations) {
        const std::string_view id = std::string_view(kept.node).substr(0, kept.node.find('/'));
        if (!graph.node(id)) return useless("there is no node " + inQuotes(id));
        if (const std::string part = textBehind(graph, kept.node);
            part != kept.part || kept.algorithms != kAlgorithmVersion)
            return useless(differenceOf(kept, part));
    }
    return done();
}

bool simulatesAnew(const Graph& graph, std::string_view node) {
    const auto output = std::ranges::find_if(
        graph.nodes, [](const Node& each) { return roleOf(each.type) == NodeRole::output; });
    if (node.empty() && output == graph.nodes.end()) return false;
    const Graph part = partBehind(graph, node.empty() ? std::string_view(output->id) : node);
    // The part knows nothing of caches: those are looked up in the document.
    const auto anew = [](const std::vector<Node>& needed, const std::vector<Node>& nodes) {
        return std::ranges::any_of(nodes, [&](const Node& each) {
            const NodeType* type = findNodeType(each.type);
            return type && std::ranges::find(needed, each.id, &Node::id) != needed.end() &&
                   std::ranges::any_of(type->inputs, [&](const InputSpec& input) {
                       const InputValue* given = each.input(input.name);
                       const auto* path = given ? std::get_if<std::string>(&given->value) : nullptr;
                       return input.file == &kParticleCacheFile && (!given || (path && path->empty()));
                   });
        });
    };
    return anew(part.nodes, graph.nodes) || std::ranges::any_of(part.groups, [&](const Group& group) {
               const auto own = std::ranges::find(graph.groups, group.id, &Group::id);
               return own != graph.groups.end() && anew(group.nodes, own->nodes);
           });
}

void useCache(Graph& graph, const std::string& header) {
    const auto within = [&](std::vector<Node>& nodes) {
        for (Node& node : nodes)
            if (const NodeType* type = findNodeType(node.type))
                for (const InputSpec& input : type->inputs)
                    if (input.file == &kParticleCacheFile) node.set(input.name, InputValue{.value = header});
    };
    within(graph.nodes);
    for (Group& group : graph.groups) within(group.nodes);
}

}  // namespace fw
