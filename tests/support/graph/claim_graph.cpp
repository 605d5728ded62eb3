#include "tests/support/graph/claim_graph.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "graph/document/input_value.h"

namespace fw::test {

namespace {

class ClaimGenerator {
  public:
    ClaimGenerator(const NodeType& tested, uint32_t seed, int variantNumber, const ClaimFiles& claimFiles)
        : type(tested), random(seed), variant(variantNumber), files(claimFiles) {}

    Graph graph() {
        made.path = files.graph;
        Node node;
        node.id = "tested", node.type = type.id;
        for (const InputSpec& input : type.inputs) fill(node, input);
        made.nodes.push_back(std::move(node));
        add("out", "output", {{"surface", link("tested")}});
        return std::move(made);
    }

  private:
    using Inputs = std::vector<std::pair<std::string, InputValue>>;

    double uniform(double lo, double hi) { return std::uniform_real_distribution(lo, hi)(random); }
    /// Uniform in the logarithm.
    double size(double lo, double hi) { return std::exp(uniform(std::log(lo), std::log(hi))); }
    bool chance(double probability) { return uniform(0, 1) < probability; }
    int below(int count) { return std::min(count - 1, int(uniform(0, count))); }

    static InputValue number(double value) { return {.value = value}; }
    static InputValue vector(std::vector<double> values) { return {.value = std::move(values)}; }
    static InputValue link(std::string node) { return {.value = Link{std::move(node), ""}}; }
    std::vector<double> point(double extent) {
        return {uniform(-extent, extent), uniform(-extent, extent), uniform(-extent, extent)};
    }

    std::string add(std::string id, std::string nodeType, Inputs inputs) {
        Node node;
        node.id = id, node.type = std::move(nodeType), node.inputs = std::move(inputs);
        made.nodes.push_back(std::move(node));
        return id;
    }
    std::string add(std::string nodeType, Inputs inputs) {
        return add("n" + std::to_string(made.nodes.size()), std::move(nodeType), std::move(inputs));
    }

    std::string primitive() {
        switch (below(9)) {
            case 0: return add("sphere", {{"radius", number(size(0.03, 1.5))}});
            case 1:
                return add("box", {{"half_extents", vector({size(0.05, 1), size(0.05, 1), size(0.05, 1)})}});
            case 2:
                return add("torus", {{"major_radius", number(size(0.1, 1))},
                                     {"minor_radius", number(size(0.05, 0.5))}});
            case 3:
                return add(
                    "capsule",
                    {{"a", vector(point(1))}, {"b", vector(point(1))}, {"radius", number(size(0.02, 0.3))}});
            case 4: return add("ellipsoid", {{"radii", vector({size(0.1, 1), size(0.1, 1), size(0.1, 1)})}});
            case 5:
                return add("box_max",
                           {{"half_extents", vector({size(0.05, 1), size(0.05, 1), size(0.05, 1)})}});
            case 6: return add("star", {});
            case 7: return add("rectangle", {{"half_extents", vector({size(0.1, 1), size(0.1, 1)})}});
            default: {
                // A thin cap of a large ball: far from exact, and far from symmetric.
                const std::string ball = add("sphere", {{"radius", number(10)}});
                const std::string moved =
                    add("translate", {{"surface", link(ball)}, {"offset", vector({10, 0, 0})}});
                const std::string side =
                    add("plane", {{"normal", vector({1, 0, 0})}, {"offset", number(uniform(0.05, 0.5))}});
                return add("intersect", {{"a", link(moved)}, {"b", link(side)}});
            }
        }
    }

    std::string solid(int depth) {
        std::string id;
        if (depth == 0 || chance(0.5)) {
            id = primitive();
        } else {
            const std::string a = solid(depth - 1), b = solid(depth - 1);
            Inputs inputs = {{"a", link(a)}, {"b", link(b)}};
            if (chance(0.3)) {
                inputs.push_back({"radius", number(size(0.05, 0.5))});
                if (chance(0.4)) inputs.push_back({"profile", {.value = std::string("chamfer")}});
            }
            id = add(std::array{"union", "subtract", "intersect"}[std::size_t(below(3))], std::move(inputs));
        }
        if (chance(0.4)) id = add("rotate", {{"surface", link(id)}, {"angles", vector(point(180))}});
        if (chance(0.5))
            id =
                add("translate", {{"surface", link(id)}, {"offset", vector(point(chance(0.2) ? 4.0 : 0.7))}});
        if (chance(0.1))
            id = add("offset", {{"surface", link(id)}, {"distance", number(uniform(-0.1, 0.2))}});
        return id;
    }

    /// Small, and where the copies of a repetition are meant to be.
    std::string fittingSolid() {
        std::string id =
            chance(0.5)
                ? add("sphere", {{"radius", number(size(0.02, 0.2))}})
                : add("box", {{"half_extents", vector({size(0.02, 0.2), size(0.02, 0.2), size(0.02, 0.1)})}});
        if (type.id == "polar_repeat")
            id = add("translate",
                     {{"surface", link(id)}, {"offset", vector({uniform(0.4, 1.5), 0, uniform(-0.1, 0.1)})}});
        if (chance(0.3)) {
            const std::string hole = add("sphere", {{"radius", number(0.05)}});
            id = add("subtract", {{"a", link(id)}, {"b", link(hole)}});
        }
        return id;
    }

    double randomNumber(const InputSpec& input) {
        const bool hasMin = std::isfinite(input.min), hasMax = std::isfinite(input.max);
        if (input.type == Type::integer) {
            // Few most often: counts of copies, sides and teeth have a range of magnitudes.
            const double span = size(1, std::min(input.max - input.min, 200.0) + 1) - 1;
            return std::min(input.max, std::floor(input.min + span + 0.5));
        }
        if (hasMin && !input.positive && chance(0.1)) return input.min;
        if (hasMax && chance(0.1)) return input.max;
        if (hasMin && hasMax) return uniform(input.min, input.max);
        if (input.unit.starts_with("degrees"))
            return chance(0.3) ? 90 * std::floor(uniform(-4, 5)) : uniform(-180, 180);
        if (hasMin) return input.min + size(0.02, 2);
        return chance(0.1) ? 0.0 : uniform(-1.2, 1.2);
    }

    void fill(Node& node, const InputSpec& input) {
        if (input.value.kind == InputDefault::Kind::position) return;
        switch (input.type) {
            case Type::surface: node.set(input.name, link(chance(0.25) ? fittingSolid() : solid(2))); return;
            case Type::image: node.set(input.name, {.value = files.picture}); return;
            case Type::mesh:
                node.set(input.name, link(add("mesh_file", {{"path", {.value = files.mesh}}})));
                return;
            case Type::spline: {
                std::vector<double> knots;
                const int count = 2 + below(5);
                for (int i = 0; i < count; ++i) {
                    const std::vector<double> at = point(1);
                    knots.insert(knots.end(), at.begin(), at.end());
                    knots.insert(knots.end(), {chance(0.5) ? 1.0 : uniform(0, 2), uniform(-90, 90)});
                }
                node.set(
                    input.name,
                    link(add("spline", {{"knots", listValue(Type::knots, std::move(knots))},
                                        {"kind", {.value = std::string(chance(0.5) ? "smooth" : "straight")}},
                                        {"closed", {.value = chance(0.3)}},
                                        {"bend", number(chance(0.5) ? 0.0 : size(0.02, 0.5))}})));
                return;
            }
            case Type::string:
                if (input.options.empty()) return;
                // The threads of the standard are much like each other.
                if (type.id == "thread" && input.name == "size" && chance(0.7))
                    node.set(input.name, {.value = std::string("own")});
                else
                    node.set(input.name,
                             {.value = input.options[std::size_t(variant) % input.options.size()]});
                return;
            case Type::boolean: node.set(input.name, {.value = chance(0.7)}); return;
            case Type::points: {
                std::vector<double> corners;
                for (int count = 1 + below(24); count > 0; --count)
                    corners.insert(corners.end(), {uniform(-1, 1), uniform(-1, 1)});
                node.set(input.name, listValue(Type::points, std::move(corners)));
                return;
            }
            case Type::integer:
            case Type::scalar: break;
            case Type::vec2:
            case Type::vec3: {
                std::vector<double> values;
                const int components = componentCount(input.type);
                if (input.name == "axis" || input.name == "normal") {
                    values = point(1);
                    if (chance(0.5)) {
                        values = {0, 0, 0};
                        if (chance(0.95)) values[std::size_t(below(3))] = chance(0.5) ? 1 : -1;
                    }
                } else if (input.name == "count") {
                    for (int i = 0; i < components; ++i) values.push_back(below(5));
                } else {
                    for (int i = 0; i < components; ++i) values.push_back(randomNumber(input));
                    if (chance(0.15)) std::ranges::fill(values, values[0]);
                }
                node.set(input.name, vector(std::move(values)));
                return;
            }
            default: return;
        }
        double value = randomNumber(input);
        if (input.name == "resolution") value = 16 + below(16);
        node.set(input.name, number(value));
    }

    const NodeType& type;
    std::mt19937 random;
    int variant;
    const ClaimFiles& files;
    Graph made;
};

}  // namespace

bool hasClaimGraph(const NodeType& type) {
    if (type.open || type.outputs.empty() || type.outputs[0].type != Type::surface) return false;
    return std::ranges::none_of(type.inputs,
                                [](const InputSpec& input) { return input.type == Type::particles; });
}

Graph claimGraph(const NodeType& type, uint32_t seed, int variant, const ClaimFiles& files) {
    return ClaimGenerator(type, seed, variant, files).graph();
}

}  // namespace fw::test
