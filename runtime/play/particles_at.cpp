#include "runtime/play/particles_at.h"

#include <algorithm>
#include <cmath>
#include <glm/vec4.hpp>

#include "graph/base/words.h"
#include "graph/library/node_type.h"

namespace fw {

namespace {

/// The node's outputs that give particles.
std::vector<Link> givenBy(const Graph& graph, const Node& node) {
    std::vector<std::string> outputs;
    if (const Group* group = graph.group(node.group)) {
        for (const GroupOutput& each : group->outputs) outputs.push_back(each.name);
    } else if (const NodeType* type = findNodeType(node.type)) {
        for (const OutputSpec& each : type->outputs) outputs.push_back(each.name);
    }
    std::vector<Link> giving;
    for (const std::string& output : outputs)
        if (compiledType(graph, "", Link{node.id, output}) == Type::particles)
            giving.push_back({node.id, output});
    return giving;
}

/// "node", or "node.output" of one with several such outputs.
std::vector<std::string> namesOf(const std::vector<Link>& giving) {
    if (giving.size() == 1) return {giving[0].node};
    std::vector<std::string> names;
    for (const Link& each : giving) names.push_back(each.node + "." + each.output);
    return names;
}

}  // namespace

Result<Link> linkToParticles(const Graph& graph, const std::string& asked) {
    const std::size_t point = graph.node(asked) ? std::string::npos : asked.find('.');
    const std::string name = asked.substr(0, point);
    const Node* const node = graph.node(name);
    const std::vector<Link> own = node ? givenBy(graph, *node) : std::vector<Link>();
    if (point == std::string::npos && own.size() == 1) return own[0];
    if (point != std::string::npos)
        for (const Link& each : own)
            if (each.output == asked.substr(point + 1)) return each;
    std::vector<std::string> giving = namesOf(own);
    if (giving.empty())
        for (const Node& each : graph.nodes)
            std::ranges::copy(namesOf(givenBy(graph, each)), std::back_inserter(giving));
    const std::string known =
        giving.empty() ? "; no node of this graph does" : "; those that do: " + listed(giving);
    if (node && own.empty()) return Error{.message = "gives no particles" + known, .node = name};
    if (node)
        return Error{.message = "gives particles by its outputs alone: ask for " + listed(giving),
                     .node = name};
    const std::string near = nearestName(name, giving);
    return Error{.message = "there is no node '" + name + "' that could give particles" +
                            (near.empty() ? known : ": did you mean '" + near + "'?")};
}

Graph showingParticles(Graph graph, const Link& from) {
    Node shown;
    shown.id = "particles";
    while (graph.node(shown.id)) shown.id += "_";
    shown.type = "particles_to_field";
    shown.set("particles", {from});
    shown.set("region_min", {std::vector{0.0, 0.0, 0.0}});
    shown.set("region_max", {std::vector{1.0, 1.0, 1.0}});
    for (Node& each : graph.nodes)
        if (each.type == "output") each.set("surface", {Link{shown.id, ""}});
    graph.nodes.push_back(std::move(shown));
    return graph;
}

Result<NodeParticles> NodeParticles::open(const Graph& graph, const Link& from, const CompileOptions& options,
                                          const Device& device) {
    Result<LiveProgram> live = compileLive(showingParticles(graph, from), options);
    if (!live) return live.error();
    for (const FieldVolumePtr& volume : live->program.ir.volumes())
        if (const ParticleFieldPtr recipe = volume->particles)
            return NodeParticles(std::move(*live), recipe, from, device);
    return Error{.message = "gives no particles", .node = from.node};
}

std::vector<Error> NodeParticles::notes() const {
    std::vector<Error> list;
    for (const Error& note : live.program.notes)
        if (note.code == Error::Code::uselessCache) list.push_back(note), list.back().node = from.node;
    return list;
}

Result<ParticlePoints> NodeParticles::at(double seconds, const std::function<bool(int, int)>& progress) {
    const Result<bool> moved = simulation.goTo(
        timelineTime(live.timeline, seconds), [&](double time) { return live.valuesAt(time); }, progress);
    if (!moved) {
        Error error = moved.error();
        if (error.node.empty()) error.node = from.node;
        return error;
    }
    ParticlePoints points;
    const uint32_t slots = simulation.slots();
    if (slots == 0) return points;
    const auto places = download<glm::vec4>(*device, simulation.places(), slots);
    const Buffer* const fast = simulation.velocities();
    const auto velocities =
        fast ? download<glm::vec4>(*device, *fast, slots) : std::vector<glm::vec4>(slots, glm::vec4(0.0f));
    const std::vector<uint32_t> ids = simulation.ids();
    for (uint32_t i = 0; i < slots; ++i) {
        if (std::isnan(places[i].x)) continue;
        points.places.emplace_back(places[i]);
        points.velocities.emplace_back(velocities[i]);
        points.ids.push_back(ids[i]);
    }
    return points;
}

}  // namespace fw
