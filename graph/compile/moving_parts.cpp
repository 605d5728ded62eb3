#include "graph/compile/moving_parts.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <set>
#include <utility>

#include "graph/compile/live_program.h"
#include "graph/evaluate/evaluate.h"
#include "graph/library/node_type.h"

namespace fw {
namespace {

/// Of the largest number: maps are told apart by it, and it is far above what double precision loses.
constexpr double kNearlyNone = 1e-9;
/// Parts of one document, and what carries them: more are meshes that take turns.
constexpr std::size_t kMostPartNodes = 1000;

class PartFinder {
  public:
    PartFinder(const Graph& document, std::span<const double> moments) : graph(document), times(moments) {}

    std::optional<std::vector<PartNode>> find() {
        const auto output = std::ranges::find_if(graph.nodes, [](const Node& node) {
            const NodeType* type = findNodeType(node.type);
            return type && type->role == NodeRole::output;
        });
        if (output == graph.nodes.end() || output->input("mesh")) return std::nullopt;
        const Link* shown = linkOf(*output, "surface");
        Result<Timeline> read = readTimeline(graph);
        if (!shown || !read) return std::nullopt;
        outputId = output->id;
        timeline = std::move(*read);
        animated = animatedInputs(graph, timeline);
        if (rests(graph) || !walk(*shown, std::nullopt) || nodes.size() > kMostPartNodes) return std::nullopt;
        return std::move(nodes);
    }

  private:
    static const Link* linkOf(const Node& node, std::string_view input) {
        const InputValue* value = node.input(input);
        return value ? std::get_if<Link>(&value->value) : nullptr;
    }

    static InputValue linkTo(Link link) {
        InputValue value;
        value.value = std::move(link);
        return value;
    }

    /// The document with its output showing this.
    Graph showing(const Link& link) const {
        Graph shown = graph;
        shown.node(outputId)->set("surface", linkTo(link));
        return shown;
    }

    /// Adds a surface whose distance is what the code says; its id.
    static std::string addField(Graph& to, const std::string& code) {
        std::string id = "field";
        while (to.node(id)) id += "_";
        to.nodes.push_back({.id = id,
                            .type = "expression",
                            .at = {},
                            .label = {},
                            .code = code,
                            .group = {},
                            .inputs = {},
                            .extra = {},
                            .place = {},
                            .codePlace = {}});
        return id;
    }

    /// Whether the field is the same at all times.
    bool rests(const Graph& shown) const {
        const Result<LiveProgram> live = compileLive(shown, {});
        if (!live) return false;
        if (!live->program.stages.empty()) return false;
        for (const FieldVolumePtr& volume : live->program.ir.volumes())
            if (volume->particles) return false;
        const auto valuesRead = [&](double time) {
            std::vector<double> values = live->valuesAt(time);
            for (std::size_t slot = 0; slot < values.size(); ++slot)
                if (!live->read[slot]) values[slot] = 0.0;
            return values;
        };
        const std::vector<double> first = valuesRead(times[0]);
        return std::ranges::all_of(times, [&](double time) { return valuesRead(time) == first; });
    }

    /// What the node makes of a field in place of its surface, at some places at each time; empty if it does
    /// not compile so.
    std::vector<std::vector<double>> seenThrough(const Node& node, const std::string& input,
                                                 const std::string& code,
                                                 std::span<const Point> places) const {
        Graph shown = showing({node.id, ""});
        const std::string field = addField(shown, code);
        shown.node(node.id)->set(input, linkTo({field, ""}));
        const Result<LiveProgram> live = compileLive(std::move(shown), {});
        std::vector<std::vector<double>> seen;
        if (!live) return seen;
        for (const double time : times) {
            seen.emplace_back(places.size());
            evaluate(live->program.ir, live->program.distance(), live->valuesAt(time), places, seen.back());
        }
        return seen;
    }

    /// How the node carries what is behind it; empty if it does something else.
    std::vector<Pose> posesOf(const Node& node, const std::string& input) const {
        // Three of them are more than a map that is affine needs, for it must be one.
        constexpr std::array<Point, 7> kPlaces = {{{0, 0, 0},
                                                   {1, 0, 0},
                                                   {0, 1, 0},
                                                   {0, 0, 1},
                                                   {-1.7, 0.9, 2.3},
                                                   {3.1, -2.2, -0.6},
                                                   {-0.4, -5.3, 1.9}}};
        std::array<std::vector<std::vector<double>>, 4> seen;
        constexpr std::array<const char*, 4> kFields = {"return p.x;", "return p.y;", "return p.z;",
                                                        "return 1.0;"};
        for (std::size_t i = 0; i < 4; ++i) {
            seen[i] = seenThrough(node, input, kFields[i], kPlaces);
            if (seen[i].empty()) return {};
        }
        std::vector<Pose> poses;
        for (std::size_t time = 0; time < times.size(); ++time) {
            const double size = seen[3][time][0];
            if (!(size > 0.0)) return {};
            const auto at = [&](std::size_t place) {
                return glm::dvec3(seen[0][time][place], seen[1][time][place], seen[2][time][place]) / size;
            };
            const glm::dvec3 origin = at(0);
            const glm::dmat3 map(at(1) - origin, at(2) - origin, at(3) - origin);
            // A similarity: size * map is a rotation.
            const glm::dmat3 turn = glm::transpose(map * size), square = turn * glm::transpose(turn);
            double off = std::abs(glm::determinant(turn) - 1.0);
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j)
                    off = std::max(off, std::abs(square[i][j] - (i == j ? 1.0 : 0.0)));
            for (std::size_t place = 0; place < kPlaces.size(); ++place) {
                const glm::dvec3 p(kPlaces[place][0], kPlaces[place][1], kPlaces[place][2]);
                const glm::dvec3 d = at(place) - (origin + map * p);
                off = std::max({off, std::abs(d.x), std::abs(d.y), std::abs(d.z),
                                std::abs(seen[3][time][place] / size - 1.0)});
            }
            const double scale = std::max({1.0, std::abs(origin.x), std::abs(origin.y), std::abs(origin.z)});
            if (!(off <= kNearlyNone * scale)) return {};
            const glm::dvec3 move = -size * (turn * origin);
            glm::dquat rotation = glm::normalize(glm::quat_cast(turn));
            if (!poses.empty()) {
                const auto& [x, y, z, w] = poses.back().turn;
                if (glm::dot(rotation, glm::dquat(w, x, y, z)) < 0.0) rotation = -rotation;
            }
            poses.push_back(
                {{move.x, move.y, move.z}, {rotation.x, rotation.y, rotation.z, rotation.w}, size});
        }
        return poses;
    }

    static bool leaveAll(const std::vector<Pose>& poses) {
        return std::ranges::all_of(poses, [](const Pose& pose) { return pose == Pose{}; });
    }

    /// Whether its other inputs are plain numbers that nothing moves: then it is the same wherever it stands.
    bool isPlain(const Node& node, const std::string& surface) const {
        return std::ranges::all_of(node.inputs, [&](const auto& input) {
            return input.first == surface || (!std::holds_alternative<Link>(input.second.value) &&
                                              !animated.contains(node.id + "." + input.first));
        });
    }

    /// Whether it gives the lesser of two surfaces.
    bool isUnion(const Node& node, const std::string& a, const std::string& b) const {
        constexpr std::array<std::pair<double, double>, 4> kPairs = {
            {{1, 2}, {2, 1.75}, {-1, 0.25}, {-0.5, -0.375}}};
        for (const auto& [left, right] : kPairs) {
            Graph shown = showing({node.id, ""});
            const auto constant = [&](double value) {
                return addField(shown, "return " + std::to_string(value) + ";");
            };
            const std::string first = constant(left), second = constant(right);
            shown.node(node.id)->set(a, linkTo({first, ""}));
            shown.node(node.id)->set(b, linkTo({second, ""}));
            const Result<LiveProgram> live = compileLive(std::move(shown), {});
            if (!live) return false;
            for (const double time : times)
                if (evaluate(live->program.ir, live->program.distance(), live->valuesAt(time),
                             Point{0.3, -0.7, 1.1}) != std::min(left, right))
                    return false;
        }
        return true;
    }

    /// The part that is behind the link, with what goes to each part that is behind it, as it is at the first
    /// of the times: it has no timeline of its own.
    Graph partOf(const Link& link) const {
        Graph part = graph;
        Link behind = link;
        for (auto wrapper = wrappers.rbegin(); wrapper != wrappers.rend(); ++wrapper) {
            part.node(wrapper->first)->set(wrapper->second, linkTo(behind));
            behind = {wrapper->first, ""};
        }
        part.node(outputId)->set("surface", linkTo(behind));
        part.timeline = nullptr;
        return atTime(part, timeline, timelineTime(timeline, times[0]));
    }

    bool walk(const Link& link, std::optional<std::size_t> parent) {
        const Node* node = graph.node(link.node);
        const NodeType* type = node ? findNodeType(node->type) : nullptr;
        if (!type || nodes.size() > kMostPartNodes) return false;
        const std::string name = node->label.empty() ? node->id : node->label;
        if (rests(showing(link))) {
            nodes.push_back({.name = name, .parent = parent, .part = partOf(link)});
            return true;
        }
        if (type->outputs.size() != 1) return false;
        std::vector<std::string> surfaces;
        for (const InputSpec& input : type->inputs)
            if (input.type == Type::surface && linkOf(*node, input.name)) surfaces.push_back(input.name);
        if (surfaces.size() == 2 && isUnion(*node, surfaces[0], surfaces[1]))
            return walk(*linkOf(*node, surfaces[0]), parent) && walk(*linkOf(*node, surfaces[1]), parent);
        if (surfaces.size() != 1) return false;
        std::vector<Pose> poses = posesOf(*node, surfaces[0]);
        if (poses.empty()) return false;
        const Link behind = *linkOf(*node, surfaces[0]);
        if (leaveAll(poses)) {
            if (!isPlain(*node, surfaces[0])) return false;
            wrappers.emplace_back(node->id, surfaces[0]);
            const bool found = walk(behind, parent);
            wrappers.pop_back();
            return found;
        }
        nodes.push_back({.name = name, .parent = parent, .poses = std::move(poses)});
        return walk(behind, nodes.size() - 1);
    }

    const Graph& graph;
    std::span<const double> times;
    Timeline timeline;
    std::string outputId;
    std::set<std::string> animated;                             ///< "node.input"
    std::vector<std::pair<std::string, std::string>> wrappers;  ///< on the way, and their inputs
    std::vector<PartNode> nodes;
};

}  // namespace

std::optional<std::vector<PartNode>> movingParts(const Graph& graph, std::span<const double> times) {
    if (times.empty()) return std::nullopt;
    return PartFinder(graph, times).find();
}

}  // namespace fw
