#include "tests/support/graph/random_graph.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "graph/check/check.h"
#include "graph/document/input_value.h"
#include "graph/document/sockets.h"
#include "graph/library/node_type.h"

namespace fw::test {

namespace {

struct Source {
    std::string id, output;
    Type type;
};

class Generator {
  public:
    explicit Generator(uint32_t seed) : random(seed) {}

    Graph graph(int maxNodes) {
        Graph made;
        const int count = 1 + static_cast<int>(random() % maxNodes);
        if (chance(0.2)) addGroup(made);
        for (int i = 0; i < count; ++i) made.nodes.push_back(node(made, "n" + std::to_string(i)));
        Node output;
        output.id = "out", output.type = "output";
        output.set("surface", {link(Type::surface, 1.0).value_or(Link{made.nodes.back().id, ""})});
        if (sources.empty() ||
            !converts(typeOf(std::get<Link>(output.inputs[0].second.value)), Type::surface)) {
            Node sphere;
            sphere.id = "last", sphere.type = "sphere";
            made.nodes.push_back(sphere);
            output.set("surface", {Link{"last", ""}});
        }
        made.nodes.push_back(output);
        return made;
    }

  private:
    /// The node types that a graph is made of: those that a body says all of. What has none, as particles,
    /// stages and groups, has no part in the draw, so that a new one of those leaves all graphs as they are.
    static const std::vector<const NodeType*>& usable() {
        static const std::vector<const NodeType*> types = [] {
            std::vector<const NodeType*> list;
            for (const NodeType& type : nodeTypes())
                if (!type.outputs.empty() && !type.body.empty() && !type.open &&
                    type.category != Category::spline)  // which take nothing but each other
                    list.push_back(&type);
            return list;
        }();
        return types;
    }

    double unit() { return std::uniform_real_distribution<double>(0.0, 1.0)(random); }
    bool chance(double p) { return unit() < p; }

    Type typeOf(const Link& wanted) const {
        for (const Source& source : sources)
            if (source.id == wanted.node && (wanted.output.empty() || wanted.output == source.output))
                return source.type;
        return Type::string;
    }

    /// A link to an earlier output that may feed `type`, the latest ones most often.
    std::optional<Link> link(Type type, double likely) {
        if (!chance(likely)) return std::nullopt;
        std::vector<const Source*> fitting;
        for (const Source& source : sources)
            if (converts(source.type, type)) fitting.push_back(&source);
        if (fitting.empty()) return std::nullopt;
        const double recent = std::sqrt(unit());
        const Source& chosen =
            *fitting[std::min(fitting.size() - 1, static_cast<std::size_t>(recent * fitting.size()))];
        return Link{chosen.id, chosen.output};
    }

    double number(const InputSpec& spec, double usual) {
        double value = usual + (usual == 0.0 ? 1.0 : std::abs(usual)) * (2.0 * unit() - 1.0);
        value = std::clamp(value, spec.min, spec.max);
        if (spec.positive && value <= 0.0) value = std::abs(usual) > 0.0 ? std::abs(usual) : 0.5;
        const double rounded = std::clamp(std::round(value * 1000.0) / 1000.0, spec.min, spec.max);
        return rounded == 0.0 && spec.positive ? 0.25 : rounded;
    }

    void fill(Node& node, const InputSpec& spec) {
        const double likely = spec.type == Type::surface                        ? 0.95
                              : spec.value.kind == InputDefault::Kind::position ? 0.15
                                                                                : 0.12;
        const bool linkable = spec.type == Type::surface || spec.type == Type::scalar ||
                              spec.type == Type::vec3 || spec.type == Type::vec2;
        if (linkable && !spec.known)
            if (const auto chosen = link(spec.type, likely)) {
                node.set(spec.name, {*chosen});
                return;
            }
        if (spec.value.kind == InputDefault::Kind::position || spec.type == Type::surface || chance(0.4))
            return;
        if (spec.type == Type::image) return;
        if (spec.type == Type::string) {
            if (!spec.options.empty()) node.set(spec.name, {spec.options[random() % spec.options.size()]});
            return;
        }
        if (spec.value.kind != InputDefault::Kind::numbers) return;
        if (spec.type == Type::stops || spec.ordered) {
            std::vector<double> list;
            double place = 2.0 * unit() - 1.0;
            for (int count = 1 + int(random() % 6); count > 0; --count, place += unit()) {
                list.push_back(std::round(place * 1000.0) / 1000.0);
                for (int i = 1; i < entrySize(spec.type); ++i)
                    list.push_back(std::round(unit() * 1000.0) / 1000.0);
            }
            node.set(spec.name, listValue(spec.type, std::move(list)));
            return;
        }
        if (spec.type == Type::points || spec.type == Type::knots) return;
        if (spec.type == Type::boolean) {
            node.set(spec.name, {chance(0.5)});
        } else if (spec.type == Type::integer || spec.type == Type::scalar) {
            double value = number(spec, spec.value.numbers[0]);
            if (spec.type == Type::integer)
                value = std::clamp(std::round(value), spec.min, std::min(spec.max, 8.0));
            node.set(spec.name, {value});
        } else {
            std::vector<double> values;
            for (int i = 0; i < componentCount(spec.type); ++i)
                values.push_back(number(
                    spec, spec.value.numbers[std::min<std::size_t>(i, spec.value.numbers.size() - 1)]));
            node.set(spec.name, {values});
        }
    }

    Node node(Graph& graph, const std::string& id) {
        Node made;
        made.id = id;
        if (!graph.groups.empty() && chance(0.1)) {
            made.type = "group", made.group = graph.groups[0].id;
            if (const auto surface = link(Type::surface, 1.0)) made.set("shape", {*surface});
            made.set("size", {0.25 + unit()});
            sources.push_back({id, "result", Type::surface});
            return made;
        }
        if (chance(0.08)) {
            made.type = "expression";
            static const char* codes[] = {
                "return length(p) - r;", "d = max(abs(p.x), abs(p.y)) - r; return min(d, s);",
                "if (p.x > 0.0) { return r; } return s * 0.5;",
                "a = 0; for (int i = 0; i < 3; i++) a += abs(p.y - float(i)) * 0.3; return a - r;"};
            made.code = codes[random() % std::size(codes)];
            made.set("r", {0.5 + unit()});
            auto other = link(Type::scalar, 0.7);
            if (other && typeOf(*other) != Type::scalar)
                other.reset();  // a surface would make the result one
            made.set("s", other ? InputValue{*other} : InputValue{unit()});
            sources.push_back({id, "", Type::scalar});
            return made;
        }
        const std::vector<const NodeType*>& types = usable();
        while (true) {
            const NodeType& type = *types[random() % types.size()];
            // Repeats copy all that feeds them; a few are enough.
            if ((type.id == "repeat" || type.id == "polar_repeat") && !chance(0.3)) continue;
            made.type = type.id;
            for (const InputSpec& spec : type.inputs) fill(made, spec);
            const bool fed = std::any_of(made.inputs.begin(), made.inputs.end(), [&](const auto& input) {
                const Link* from = std::get_if<Link>(&input.second.value);
                return from && converts(typeOf(*from), type.outputs[0].type);
            });
            made.muted = fed && chance(0.05);
            for (const OutputSpec& output : type.outputs) sources.push_back({id, output.name, output.type});
            return made;
        }
    }

    void addGroup(Graph& graph) {
        Group group;
        group.id = "rounded";
        group.inputs = {{"shape", "surface", std::nullopt, {}, {}},
                        {"size", "float", InputValue{0.5}, {}, {}}};
        group.outputs = {{"result", "surface", {}, {}}};
        Node in, ball, join, out;
        in.id = "in", in.type = "group_input";
        ball.id = "ball", ball.type = "sphere";
        ball.set("radius", {Link{"in", "size"}});
        join.id = "join", join.type = "union";
        join.set("a", {Link{"in", "shape"}});
        join.set("b", {Link{"ball", ""}});
        out.id = "out", out.type = "group_output";
        out.set("result", {Link{"join", ""}});
        group.nodes = {in, ball, join, out};
        graph.groups.push_back(group);
    }

    std::mt19937 random;
    std::vector<Source> sources;
};

}  // namespace

Graph randomGraph(uint32_t seed, int maxNodes) { return Generator(seed).graph(maxNodes); }

std::optional<Program> randomProgram(uint32_t seed, int maxNodes) {
    Result<Program> program = compile(randomGraph(seed, maxNodes));
    if (!program || program->ir.size() > kMostOperations) return std::nullopt;
    return std::move(*program);
}

}  // namespace fw::test
