#include "runtime/play/particles_at.h"

#include <algorithm>
#include <cmath>
#include <glm/vec4.hpp>

#include "graph/base/words.h"
#include "graph/compile/live_program.h"
#include "runtime/particles/simulation.h"

namespace fw {

namespace {

bool givesParticles(const Graph& graph, const std::string& node) {
    return compiledType(graph, "", Link{node, ""}) == Type::particles;
}

/// The graph with the node's particles as all that it shows, in a grid that nobody fills.
Graph showingParticles(Graph graph, const std::string& node, const std::string& field) {
    Node shown;
    shown.id = field, shown.type = "particles_to_field";
    shown.set("particles", {Link{node, ""}});
    shown.set("region_min", {std::vector{0.0, 0.0, 0.0}});
    shown.set("region_max", {std::vector{1.0, 1.0, 1.0}});
    for (Node& each : graph.nodes)
        if (each.type == "output") each.set("surface", {Link{field, ""}});
    graph.nodes.push_back(std::move(shown));
    return graph;
}

}  // namespace

Done checkGivesParticles(const Graph& graph, const std::string& node) {
    std::vector<std::string> all, giving;
    for (const Node& each : graph.nodes) {
        all.push_back(each.id);
        if (givesParticles(graph, each.id)) giving.push_back(each.id);
    }
    const std::string known =
        giving.empty() ? "; no node of this graph does" : "; those that do: " + listed(giving);
    if (std::ranges::find(all, node) == all.end()) {
        const std::string near = nearestName(node, giving.empty() ? all : giving);
        return Error{.message = "there is no node '" + node + "' that could give particles" +
                                (near.empty() ? known : ": did you mean '" + near + "'?")};
    }
    if (std::ranges::find(giving, node) != giving.end()) return done();
    return Error{.message = "gives no particles" + known, .node = node};
}

Result<ParticlePoints> particlesAt(const Graph& graph, const std::string& node, double seconds,
                                   const CompileOptions& options, const Device& device,
                                   const std::function<bool(int, int)>& progress) {
    if (const Done gives = checkGivesParticles(graph, node); !gives) return gives.error();
    std::string field = "particles";
    while (graph.node(field)) field += "_";
    const Result<LiveProgram> live = compileLive(showingParticles(graph, node, field), options);
    if (!live) return live.error();
    const auto& volumes = live->program.ir.volumes();
    const auto made = std::ranges::find_if(volumes, [&](const FieldVolumePtr& volume) {
        return volume->particles && volume->particles->node == field;
    });
    if (made == volumes.end()) return Error{.message = "gives no particles", .node = node};
    Simulation simulation(device, (*made)->particles);
    const Result<bool> moved = simulation.goTo(
        timelineTime(live->timeline, seconds), [&](double at) { return live->valuesAt(at); }, progress);
    if (!moved) {
        Error error = moved.error();
        if (error.node.empty()) error.node = node;
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
