#include "editor/document/unit_edits.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <utility>

#include "editor/document/scene_edits.h"
#include "editor/document/timeline_json.h"
#include "graph/document/input_value.h"
#include "graph/document/named_parameters.h"
#include "graph/document/unit.h"
#include "graph/library/node_type.h"

namespace fw::editor {

namespace {

constexpr int kMostHops = 64;  // from a number to the inputs that it reaches

/// The number in the other unit, without what is but rounding.
double reckonedInto(double number, int power, double factor) {
    char text[40];
    std::snprintf(text, sizeof text, "%.15g", number * std::pow(factor, power));
    return std::strtod(text, nullptr);
}

/// In which power lengths are in the numbers of a document's inputs.
class Powers {
  public:
    explicit Powers(const Graph& graph_) : graph(graph_) {}

    /// Of an input; none if nobody knows.
    std::optional<int> of(std::string_view scope, const Node& node, std::string_view input) const {
        if (roleOf(node.type) == NodeRole::expression) return std::nullopt;
        if (roleOf(node.type) == NodeRole::group) return ofGroupInput(node.group, input, 0);
        const std::string_view unit = unitOfInput(node, input);
        if (unit != "any") return lengthPower(unit);
        const NodeType* type = findNodeType(node.type);
        return type && passesOn(*type) ? ofOutput(scope, node.id, {}, 0) : std::nullopt;
    }
    std::optional<int> ofGroupInput(std::string_view group, std::string_view input, int hops) const {
        for (const Node& node : nodesOf(graph, group))
            if (roleOf(node.type) == NodeRole::groupInput) return ofOutput(group, node.id, input, hops);
        return 0;  // nothing hears of it
    }

  private:
    /// Whether its numbers leave it as they are.
    static bool passesOn(const NodeType& type) {
        return type.id == "value" || type.id == "vector" || type.id == "combine_xyz" ||
               type.role == NodeRole::parameter;
    }

    /// What all inputs are that an output reaches.
    std::optional<int> ofOutput(std::string_view scope, std::string_view id, std::string_view output,
                                int hops) const {
        std::optional<int> found;
        if (hops > kMostHops) return std::nullopt;
        for (const Node& node : nodesOf(graph, scope))
            for (const auto& [name, value] : node.inputs) {
                const Link* link = std::get_if<Link>(&value.value);
                if (!link || link->node != id || (!output.empty() && link->output != output)) continue;
                const std::optional<int> here = reached(scope, node, name, hops + 1);
                if (!here || (found && *found != *here)) return std::nullopt;
                found = here;
            }
        return found.value_or(0);
    }
    std::optional<int> reached(std::string_view scope, const Node& node, std::string_view input,
                               int hops) const {
        switch (roleOf(node.type)) {
            case NodeRole::reroute: return ofOutput(scope, node.id, {}, hops);
            case NodeRole::group: return ofGroupInput(node.group, input, hops);
            case NodeRole::expression:
            case NodeRole::groupOutput: return std::nullopt;
            default: break;
        }
        const std::string_view unit = unitOfInput(node, input);
        if (unit != "any") return lengthPower(unit);
        const NodeType* type = findNodeType(node.type);
        return type && passesOn(*type) ? ofOutput(scope, node.id, {}, hops) : std::nullopt;
    }

    const Graph& graph;
};

/// Nodes that nothing is known of. What goes into a calculation is the calculation's.
bool staysAsItIs(const Node& node) {
    const NodeType* type = findNodeType(node.type);
    if (!type) return false;
    if (type->role == NodeRole::expression) return true;
    const bool reads = std::ranges::any_of(type->inputs, [](const InputSpec& input) {
        return input.file && (input.type == Type::string) && input.name == "path";
    });
    if (reads) return true;
    if (type->category != Category::maths) return false;
    return std::ranges::any_of(
        node.inputs, [](const auto& input) { return std::holds_alternative<Link>(input.second.value); });
}

void reckon(InputValue& value, int power, double factor) {
    if (auto* number = std::get_if<double>(&value.value)) *number = reckonedInto(*number, power, factor);
    auto* list = std::get_if<std::vector<double>>(&value.value);
    if (!list) return;
    // Of knots only the places are lengths.
    const std::size_t size = value.entry == entrySize(Type::knots) ? 5 : 1, lengths = size == 5 ? 3 : 1;
    for (std::size_t i = 0; i < list->size(); ++i)
        if (i % size < lengths) (*list)[i] = reckonedInto((*list)[i], power, factor);
}

class Reckoning {
  public:
    Reckoning(const Graph& graph, double factor_) : before(graph), powers(before), factor(factor_) {
        made.graph = graph;
    }

    OtherUnit all() {
        inScope("");
        for (const Group& group : before.groups) {
            inScope(group.id);
            inSockets(group.id);
        }
        for (ExposedParameter& parameter : made.graph.parameters) {
            const Node* node = before.node(parameter.node);
            const int power = node ? powers.of("", *node, parameter.input).value_or(0) : 0;
            for (std::optional<double>* bound : {&parameter.min, &parameter.max})
                if (*bound) **bound = reckonedInto(**bound, power, factor);
        }
        inScene();
        inTimeline();
        return std::move(made);
    }

  private:
    void inScope(std::string_view scope) {
        for (const Node& node : nodesOf(before, scope)) {
            if (staysAsItIs(node)) {
                made.left.push_back(std::string(scope) + (scope.empty() ? "" : "/") + node.id);
                continue;
            }
            auto& nodes = nodesOf(made.graph, scope);
            Node& to = *std::ranges::find(nodes, node.id, &Node::id);
            for (auto& [name, value] : to.inputs)
                if (!std::holds_alternative<Link>(value.value)) inInput(scope, node, name, value);
            // A length that is not given is one in the new unit too.
            const NodeType* type = findNodeType(node.type);
            if (!type) continue;
            for (const InputSpec& spec : type->inputs) {
                if (node.input(spec.name) || spec.value.kind != InputDefault::Kind::numbers) continue;
                if (std::ranges::all_of(spec.value.numbers, [](double number) { return number == 0.0; }))
                    continue;
                const std::optional<int> power = powers.of(scope, node, spec.name);
                if (!power || *power == 0) continue;
                InputValue value;
                if (const int entry = entrySize(spec.type))
                    value.value = spec.value.numbers, value.entry = entry;
                else
                    value = numbersValue(spec.value.numbers);
                reckon(value, *power, factor);
                to.set(spec.name, std::move(value));
            }
        }
    }
    void inInput(std::string_view scope, const Node& node, const std::string& name, InputValue& value) {
        const std::optional<int> power = powers.of(scope, node, name);
        if (power) return reckon(value, *power, factor);
        const std::string path = std::string(scope) + (scope.empty() ? "" : "/") + node.id;
        if (std::ranges::find(made.left, path) == made.left.end()) made.left.push_back(path);
    }

    void inSockets(const std::string& id) {
        Group& group = *std::ranges::find(made.graph.groups, id, &Group::id);
        for (GroupInput& input : group.inputs)
            if (input.value) reckon(*input.value, powers.ofGroupInput(id, input.name, 0).value_or(0), factor);
    }

    /// Of a value of the scene, by its path.
    int powerInScene(std::string_view path) const {
        const auto is = [&](std::string_view name) { return path.find(name) != path.npos; };
        if (path.starts_with("camera."))
            return is(".position") || is(".target") || is(".aperture") || is(".focus") ? 1 : 0;
        // A lamp's light thins with the square of the distance; the sun's does not.
        if (path.starts_with("lights.")) {
            if (!is(".strength")) return is(".position") || is(".target") || is(".size") ? 1 : 0;
            const Result<Scene> scene = readScene(before.scene);
            const auto at = std::size_t(std::atoi(std::string(path.substr(7)).c_str()));
            return scene && at < scene->lights.size() && scene->lights[at].type != Lamp::Type::directional
                       ? 2
                       : 0;
        }
        if (path == "ao.radius" || path == "ground.height" || path == "fog.height") return 1;
        return path == "fog.density" ? -1 : 0;
    }

    void inScene() {
        const Result<Scene> scene = readScene(before.scene);
        if (!scene || !before.scene->is_object()) return;
        const auto set = [&](const std::string& path, std::vector<double> numbers) {
            const int power = powerInScene(path);
            for (double& number : numbers) number = reckonedInto(number, power, factor);
            made.graph = setSceneValue(made.graph, path, numbersJson(numbers));
        };
        const auto triple = [](const Triple& of) { return std::vector<double>(of.begin(), of.end()); };
        const auto has = [&](const char* part) {
            return before.scene->contains(part) && (*before.scene)[part].is_object();
        };
        if (has("camera") && scene->camera) {
            set("camera.position", triple(scene->camera->position));
            set("camera.target", triple(scene->camera->target));
            if (scene->camera->aperture != 0.0) set("camera.aperture", {scene->camera->aperture});
            if (scene->camera->focus != 0.0) set("camera.focus", {scene->camera->focus});
        }
        if (has("ao") && scene->ao && scene->ao->radius != 0.0) set("ao.radius", {scene->ao->radius});
        if (has("ground") && scene->ground && scene->ground->height)
            set("ground.height", {*scene->ground->height});
        if (has("fog") && scene->fog) {
            set("fog.density", {scene->fog->density});
            if (scene->fog->height != 0.0) set("fog.height", {scene->fog->height});
        }
        for (std::size_t i = 0; i < scene->lights.size(); ++i) {
            const Lamp& lamp = scene->lights[i];
            const std::string at = "lights." + std::to_string(i) + ".";
            set(at + "position", triple(lamp.position));
            set(at + "target", triple(lamp.target));
            set(at + "size", {lamp.size});
            if (lamp.type != Lamp::Type::directional) set(at + "strength", {lamp.strength});
        }
    }

    int powerOf(const Track& track) const {
        if (track.target == Track::Target::scene) return powerInScene(track.name);
        const auto input = animatedInput(before, track);
        const Node* node = input ? before.node(input->node) : nullptr;
        return node ? powers.of("", *node, input->input).value_or(0) : 0;
    }

    void inTimeline() {
        if (before.timeline->is_null()) return;
        made.graph = editedTimeline(made.graph, [&](Json& json, const Timeline& timeline) {
            for (std::size_t t = 0; t < timeline.tracks.size(); ++t) {
                const int power = powerOf(timeline.tracks[t]);
                if (power == 0) continue;
                for (Json& key : json["tracks"][t]["keys"])
                    for (const char* name : {"value", "in", "out"}) {
                        if (!key.contains(name)) continue;
                        Json& numbers = key[name];
                        const auto one = [&](Json& number) {
                            number = reckonedInto(number.get<double>(), power, factor);
                        };
                        if (numbers.is_array())
                            for (Json& number : numbers) one(number);
                        else
                            one(numbers);
                    }
            }
        });
    }

    const Graph& before;
    Powers powers;
    double factor;
    OtherUnit made;
};

}  // namespace

OtherUnit keepSizes(const Graph& graph, const LengthUnit& to) {
    OtherUnit other = Reckoning(graph, unitOf(graph).metres / to.metres).all();
    setUnit(other.graph, to);
    return other;
}

}  // namespace fw::editor
