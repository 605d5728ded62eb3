#include "runtime/play/particles_at.h"

#include <algorithm>
#include <cmath>
#include <glm/vec4.hpp>

#include "graph/base/words.h"
#include "graph/compile/live_program.h"
#include "graph/library/node_type.h"
#include "runtime/particles/simulation.h"

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

/// The graph with the node's particles as all that it shows, in a grid that nobody fills.
Graph showingParticles(Graph graph, const Link& from, const std::string& field) {
    Node shown;
    shown.id = field, shown.type = "particles_to_field";
    shown.set("particles", {from});
    shown.set("region_min", {std::vector{0.0, 0.0, 0.0}});
    shown.set("region_max", {std::vector{1.0, 1.0, 1.0}});
    for (Node& each : graph.nodes)
        if (each.type == "output") each.set("surface", {Link{field, ""}});
    graph.nodes.push_back(std::move(shown));
    return graph;
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

Result<ParticlePoints> particlesAt(const Graph& graph, const Link& from, double seconds,
                                   const CompileOptions& options, const Device& device,
                                   const std::function<bool(int, int)>& progress) {
    std::string field = "particles";
    while (graph.node(field)) field += "_";
    const Result<LiveProgram> live = compileLive(showingParticles(graph, from, field), options);
    if (!live) return live.error();
    const auto& volumes = live->program.ir.volumes();
    const auto made = std::ranges::find_if(volumes, [&](const FieldVolumePtr& volume) {
        return volume->particles && volume->particles->node == field;
    });
    if (made == volumes.end()) return Error{.message = "gives no particles", .node = from.node};
    Simulation simulation(device, (*made)->particles);
    const Result<bool> moved = simulation.goTo(
        timelineTime(live->timeline, seconds), [&](double at) { return live->valuesAt(at); }, progress);
    if (!moved) {
        Error error = moved.error();
        if (error.node.empty()) error.node = from.node;
        return error;
    }
    ParticlePoints points;
    const uint32_t slots = simulation.slots();
    if (slots == 0) return points;
    const auto places = download<glm::vec4>(device, simulation.places(), slots);
    const Buffer* const fast = simulation.velocities();
    const auto velocities =
        fast ? download<glm::vec4>(device, *fast, slots) : std::vector<glm::vec4>(slots, glm::vec4(0.0f));
    for (uint32_t i = 0; i < slots; ++i) {
        if (std::isnan(places[i].x)) continue;
        points.places.emplace_back(places[i]);
        points.velocities.emplace_back(velocities[i]);
    }
    return points;
}

}  // namespace fw
