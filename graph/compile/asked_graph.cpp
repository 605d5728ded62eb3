#include "graph/compile/asked_graph.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

#include "graph/evaluate/evaluate.h"
#include "graph/library/node_type.h"

namespace fw {
namespace {

/// Of the largest number: maps are told apart by it, and it is far above what double precision loses.
constexpr double kNearlyNone = 1e-9;

const Node* outputOf(const Graph& graph) {
    const auto output = std::ranges::find_if(graph.nodes, [](const Node& node) {
        const NodeType* type = findNodeType(node.type);
        return type && type->role == NodeRole::output;
    });
    return output == graph.nodes.end() ? nullptr : &*output;
}

/// What is behind the mesh that is linked there, through all that is done to it.
const Link* surfaceOfMesh(const Graph& graph, const Link* mesh) {
    for (std::size_t steps = 0; mesh && steps < graph.nodes.size(); ++steps) {
        const Node* node = graph.node(mesh->node);
        if (!node) return nullptr;
        if (const Link* surface = AskedGraph::linkOf(*node, "surface")) return surface;
        mesh = AskedGraph::linkOf(*node, "mesh");
    }
    return nullptr;
}

}  // namespace

std::optional<AskedGraph> AskedGraph::of(const Graph& graph, std::span<const double> times,
                                         CompileOptions options) {
    const Node* output = outputOf(graph);
    if (!output || times.empty()) return std::nullopt;
    const Link* mesh = linkOf(*output, "mesh");
    const Link* shown = mesh ? surfaceOfMesh(graph, mesh) : linkOf(*output, "surface");
    Result<Timeline> timeline = readTimeline(graph);
    if (!shown || !timeline) return std::nullopt;
    AskedGraph asked(graph, times, std::move(options));
    asked.read = std::move(*timeline);
    asked.link = *shown;
    asked.mesh = mesh;
    asked.output = output->id;
    return asked;
}

const Link* AskedGraph::linkOf(const Node& node, std::string_view input) {
    const InputValue* value = node.input(input);
    return value ? std::get_if<Link>(&value->value) : nullptr;
}

InputValue AskedGraph::linkTo(Link to) {
    InputValue value;
    value.value = std::move(to);
    return value;
}

std::string AskedGraph::addField(Graph& to, const std::string& code,
                                 std::vector<std::pair<std::string, InputValue>> inputs) {
    std::string id = "field";
    while (to.node(id)) id += "_";
    to.nodes.push_back({.id = id,
                        .type = "expression",
                        .at = {},
                        .label = {},
                        .code = code,
                        .group = {},
                        .inputs = std::move(inputs),
                        .extra = {},
                        .place = {},
                        .codePlace = {}});
    return id;
}

Graph AskedGraph::showing(const Link& surface) const {
    Graph shown = *document;
    Node& node = *shown.node(output);
    std::erase_if(node.inputs, [](const auto& input) { return input.first == "mesh"; });
    node.set("surface", linkTo(surface));
    return shown;
}

Graph AskedGraph::showing(const Link& surface, std::span<const Step> through) const {
    Graph shown = showing(through.empty() ? surface : Link{through.front().node, ""});
    for (std::size_t i = 0; i < through.size(); ++i)
        shown.node(through[i].node)
            ->set(through[i].input, linkTo(i + 1 < through.size() ? Link{through[i + 1].node, ""} : surface));
    return shown;
}

const Node* AskedGraph::onlyOutputOf(const Link& to) const {
    const Node* node = document->node(to.node);
    const NodeType* type = node ? findNodeType(node->type) : nullptr;
    if (!type) return nullptr;
    const Group* group = type->role == NodeRole::group ? document->group(node->group) : nullptr;
    return (group ? group->outputs.size() : type->outputs.size()) == 1 ? node : nullptr;
}

std::vector<std::string> AskedGraph::surfacesOf(const Node& node) const {
    const NodeType* type = findNodeType(node.type);
    std::vector<std::string> surfaces;
    if (!type) return surfaces;
    if (!type->open) {
        for (const InputSpec& input : type->inputs)
            if (input.type == Type::surface && linkOf(node, input.name)) surfaces.push_back(input.name);
        return surfaces;
    }
    for (const auto& [name, value] : node.inputs)
        if (const Link* from = std::get_if<Link>(&value.value))
            if (compiledType(*document, {}, *from) == Type::surface) surfaces.push_back(name);
    return surfaces;
}

/// What the node makes of fields in place of its surfaces, code by input, at some places at each time; empty
/// if it does not compile so.
std::vector<std::vector<double>> AskedGraph::seenThrough(
    const Node& node, std::span<const std::pair<std::string, std::string>> fields,
    std::span<const Point> places) const {
    Graph shown = showing({node.id, ""});
    for (const auto& [input, code] : fields) {
        const std::string field = addField(shown, code);
        shown.node(node.id)->set(input, linkTo({field, ""}));
    }
    const Result<LiveProgram> live = compileLive(std::move(shown), how);
    std::vector<std::vector<double>> seen;
    if (!live) return seen;
    for (const double time : moments) {
        seen.emplace_back(places.size());
        evaluate(live->program.ir, live->program.distance(), live->valuesAt(time), places, seen.back());
    }
    return seen;
}

std::vector<Pose> AskedGraph::posesOf(const Node& node, const std::string& input) const {
    // More of them than a map that is affine needs, for it must be one; and far away, for of what is copied
    // at large distances the nearest copy alone looks like that.
    constexpr std::array<Point, 10> kPlaces = {{{0, 0, 0},
                                                {1, 0, 0},
                                                {0, 1, 0},
                                                {0, 0, 1},
                                                {-1.7, 0.9, 2.3},
                                                {3.1, -2.2, -0.6},
                                                {-0.4, -5.3, 1.9},
                                                {31.3, -47.7, 58.1},
                                                {-673.3, 521.9, -433.1},
                                                {7219.7, 6143.3, 8311.9}}};
    std::array<std::vector<std::vector<double>>, 5> seen;
    constexpr std::array<const char*, 5> kFields = {"return p.x;", "return p.y;", "return p.z;",
                                                    "return 1.0;", "return -1.0;"};
    for (std::size_t i = 0; i < kFields.size(); ++i) {
        const std::pair<std::string, std::string> field(input, kFields[i]);
        seen[i] = seenThrough(node, std::span(&field, 1), kPlaces);
        if (seen[i].empty()) return {};
    }
    std::vector<Pose> poses;
    for (std::size_t time = 0; time < moments.size(); ++time) {
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
            for (int j = 0; j < 3; ++j) off = std::max(off, std::abs(square[i][j] - (i == j ? 1.0 : 0.0)));
        for (std::size_t place = 0; place < kPlaces.size(); ++place) {
            const glm::dvec3 p(kPlaces[place][0], kPlaces[place][1], kPlaces[place][2]);
            const glm::dvec3 d = (at(place) - (origin + map * p)) / std::max(1.0, glm::length(p));
            off = std::max({off, std::abs(d.x), std::abs(d.y), std::abs(d.z),
                            std::abs(seen[3][time][place] / size - 1.0),
                            std::abs(seen[4][time][place] / size + 1.0)});
        }
        const double scale = std::max({1.0, std::abs(origin.x), std::abs(origin.y), std::abs(origin.z)});
        if (!(off <= kNearlyNone * scale)) return {};
        const glm::dvec3 move = -size * (turn * origin);
        glm::dquat rotation = glm::normalize(glm::quat_cast(turn));
        if (!poses.empty()) {
            const auto& [x, y, z, w] = poses.back().turn;
            if (glm::dot(rotation, glm::dquat(w, x, y, z)) < 0.0) rotation = -rotation;
        }
        poses.push_back({{move.x, move.y, move.z}, {rotation.x, rotation.y, rotation.z, rotation.w}, size});
    }
    return poses;
}

bool AskedGraph::isUnion(const Node& node, const std::string& a, const std::string& b) const {
    // Of the coordinates x and y: a blend of two shows most where they are equal, or nearly so.
    constexpr std::array<Point, 7> kPairs = {{{1, 2, 0},
                                              {2, 1.75, 0},
                                              {-1, 0.25, 0},
                                              {-0.5, -0.375, 0},
                                              {0.7, 0.7, 0},
                                              {0, 0, 0},
                                              {-0.3, -0.2999, 0}}};
    const std::array<std::pair<std::string, std::string>, 2> fields = {
        {{a, "return p.x;"}, {b, "return p.y;"}}};
    const std::vector<std::vector<double>> seen = seenThrough(node, fields, kPairs);
    if (seen.empty()) return false;
    for (const std::vector<double>& values : seen)
        for (std::size_t i = 0; i < kPairs.size(); ++i)
            if (values[i] != std::min(kPairs[i][0], kPairs[i][1])) return false;
    return true;
}

}  // namespace fw
