// Properties that every node type must have, sampled on the CPU evaluators over its defaults and over random
// settings, the ends of their ranges included: it compiles, gives finite numbers, its interval contains the
// samples, its gradient is the central difference, and its field is of the class that it declares.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "graph/compile/compile.h"
#include "graph/document/graph.h"
#include "graph/document/input_value.h"
#include "graph/evaluate/evaluate.h"
#include "graph/library/node_type.h"

namespace fw::nodes_test {

constexpr int kPointsANode = 100'000;
constexpr double kExtent = 1.6;

using Random = std::mt19937_64;

double uniform(Random& random, double lo, double hi) {
    return std::uniform_real_distribution(lo, hi)(random);
}
bool chance(Random& random, double share) { return uniform(random, 0, 1) < share; }
Point randomPoint(Random& random, double extent = kExtent) {
    return {uniform(random, -extent, extent), uniform(random, -extent, extent),
            uniform(random, -extent, extent)};
}

template <class T>
InputValue setting(T value) {
    InputValue input;
    input.value = std::move(value);
    return input;
}
InputValue number(double value) { return setting(value); }
InputValue numbers(std::vector<double> values) { return setting(std::move(values)); }
InputValue link(std::string node, std::string output = "") {
    return setting(Link{std::move(node), std::move(output)});
}

Node make(std::string id, std::string type, std::vector<std::pair<std::string, InputValue>> inputs) {
    Node node;
    node.id = std::move(id);
    node.type = std::move(type);
    node.inputs = std::move(inputs);
    return node;
}

Node expression(std::string id, std::string code) {
    Node node = make(std::move(id), "expression", {});
    node.code = std::move(code);
    return node;
}

/// Sources that the inputs of the node under test are linked to: exact solids and flat shapes that fit into
/// cells and sectors, and smooth
/// fields, of which `waves` keeps away from 0, where dividing by it has ever more jumps.
std::vector<Node> sources() {
    return {make("solid", "box", {{"half_extents", numbers({0.5, 0.4, 0.3})}, {"rounding", number(0.1)}}),
            make("ball", "sphere", {{"radius", number(0.45)}}),
            make("other", "translate", {{"surface", link("ball")}, {"offset", numbers({0.35, 0.2, 0.1})}}),
            make("bead", "sphere", {{"radius", number(0.15)}}),
            make("aside", "translate", {{"surface", link("bead")}, {"offset", numbers({0.9, 0, 0.02})}}),
            make("flat", "rectangle", {{"half_extents", numbers({0.4, 0.3})}}),
            make("star", "star", {}),
            make("ring", "torus", {{"major_radius", number(0.6)}}),
            make("block", "box_max", {{"half_extents", numbers({0.5, 0.4, 0.3})}}),
            make("raised", "translate", {{"surface", link("ball")}, {"offset", numbers({0, 0, 0.3})}}),
            make("tilted", "rotate", {{"surface", link("ring")}, {"angles", numbers({33, 20, 10})}}),
            make("leaning", "rotate", {{"surface", link("star")}, {"angles", numbers({40, 0, 15})}}),
            make("turned", "rotate", {{"surface", link("star")}, {"angles", numbers({0, 0, 15})}}),
            make("holed", "subtract", {{"a", link("solid")}, {"b", link("other")}}),
            make("wire", "spline", {}),
            make("position", "position", {}),
            make("axes", "separate_xyz", {{"vector", link("position")}}),
            expression("waves", "return vec3(1.5 + sin(2.0 * p.x), 1.5 + 0.5 * p.y * p.x, cos(p.z) - 1.5);"),
            expression("bumps", "return 0.1 * sin(3.0 * p.x) * cos(2.0 * p.y);")};
}

double randomNumber(Random& random, const InputSpec& input) {
    const bool hasMin = std::isfinite(input.min), hasMax = std::isfinite(input.max);
    if (hasMin && !input.positive && chance(random, 0.15)) return input.min;
    if (hasMax && chance(random, 0.15)) return input.max;
    if (input.unit.starts_with("degrees") && !hasMin)
        return chance(random, 0.3) ? 90 * std::floor(uniform(random, -4, 5)) : uniform(random, -90, 90);
    const double lo = input.positive ? 0.2 : hasMin ? input.min : -1.2;
    return uniform(random, lo, hasMax ? input.max : lo + (hasMin ? 1.2 : 2.4));
}

/// A setting in range for an input, most often a constant.
InputValue randomSetting(Random& random, const NodeType& type, const InputSpec& input, int variant) {
    const bool ofFields = type.category == Category::field || type.category == Category::maths;
    switch (input.type) {
        case Type::surface:
            if (type.id == "polar_repeat") return link("aside");
            if (type.category == Category::shape2d) return link("flat");
            return link(input.name == "b" ? "other" : "solid");
        case Type::image: return setting(input.value.text);
        case Type::spline: return link("wire");
        case Type::knots: {  // of a kind and closed as the variant has them
            std::vector<double> list;
            const int count = variant % 3 == 2 ? (variant % 2 == 1 ? 6 : 7) : 2 + variant % 5;
            for (int i = 0; i < count; i++)
                list.insert(list.end(),
                            {uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1),
                             uniform(random, 0, 2), uniform(random, -90, 90)});
            return listValue(Type::knots, std::move(list));
        }
        case Type::string:
            return setting(input.options.empty() ? input.value.text
                                                 : input.options[variant % input.options.size()]);
        case Type::boolean:
            if (type.id == "spline") return setting(variant % 2 == 1);
            return setting(chance(random, 0.7));
        case Type::integer:
            if (type.id == "drawing_spline") return number(1 + variant % 2);  // as many as a washer has
            return number(std::floor(uniform(random, input.min, std::min(input.max, input.min + 7) + 1)));
        case Type::stops: {
            std::vector<double> places, list;
            for (int i = 0; i < 1 + variant % 6; i++) places.push_back(uniform(random, -1, 1));
            if (chance(random, 0.3)) places.push_back(places.front());
            std::ranges::sort(places);
            for (const double place : places)
                list.insert(list.end(),
                            {place, uniform(random, 0, 1), uniform(random, 0, 2), uniform(random, 0, 1)});
            return listValue(Type::stops, std::move(list));
        }
        case Type::points: {
            if (input.ordered) {
                std::vector<double> places, list;
                for (int i = 0; i < 1 + variant % 6; i++) places.push_back(uniform(random, -1, 1));
                std::ranges::sort(places);
                for (const double place : places) list.insert(list.end(), {place, uniform(random, -1, 1)});
                return listValue(Type::points, std::move(list));
            }
            std::vector<double> corners;
            const int count = 1 + variant % 8;
            for (int i = 0; i < 2 * count; i++) corners.push_back(uniform(random, -1, 1));
            if (chance(random, 0.3)) corners.insert(corners.end(), corners.end() - 2, corners.end());
            InputValue outline = setting(std::move(corners));
            outline.entry = 2;
            return outline;
        }
        case Type::scalar:
            if (input.name == "turns") return number(uniform(random, 0.1, 6));
            if (ofFields && chance(random, 0.8))
                return link("axes", std::string(1, "xyz"[input.name.size() % 3]));
            if (type.id == "math")
                return link("axes", input.name == "a" ? "x" : input.name == "b" ? "y" : "z");
            if (type.id == "displace" && chance(random, 0.5)) return link("bumps");
            return number(randomNumber(random, input));
        default: break;
    }
    if (type.id == "repeat" && input.name == "count") {
        return numbers({std::floor(uniform(random, 0, 5)), std::floor(uniform(random, 0, 5)),
                        std::floor(uniform(random, 0, 5))});
    }
    if (type.id == "polar_repeat" && input.name == "axis") {
        return chance(random, 0.5) ? numbers({0, 2, 0}) : numbers({0, 0, -1});
    }
    if (input.name == "p") return type.id == "warp" ? link("waves") : link("position");
    if (ofFields && chance(random, 0.8)) return link(input.name == "a" ? "position" : "waves");
    std::vector<double> values;
    for (int i = 0; i < componentCount(input.type); i++) {
        const double value = randomNumber(random, input);
        const bool period = type.id == "repeat" || type.id == "scatter";
        values.push_back(!period ? value : value > 0.2 ? value + 1 : 0);
    }
    return numbers(values);
}

/// A graph whose output shows one scalar that the node under test gives.
struct Sample {
    Graph graph;
    Program program;
    std::string what;
    bool isSurface;
};

/// One of the surfaces of sources(), whether it is what the node is meant for or not.
InputValue anySurface(Random& random) {
    const std::vector<std::string> ids = {"solid", "ball",   "other",  "flat",    "ring",   "star",
                                          "block", "raised", "tilted", "leaning", "turned", "holed"};
    return link(ids[std::size_t(uniform(random, 0, double(ids.size())))]);
}

/// Variant 0 has the defaults; later ones random settings, going round the choices.
std::vector<Sample> samples(const NodeType& type, Random& random, int variants, bool ofAnySurface = false) {
    std::vector<Sample> all;
    for (int variant = 0; variant < variants; variant++) {
        Node node = make("tested", type.id, {});
        std::string settings;
        for (const InputSpec& input : type.inputs) {
            if (variant == 0 && input.type != Type::surface && input.type != Type::spline) continue;
            node.set(input.name, ofAnySurface && input.type == Type::surface
                                     ? anySurface(random)
                                     : randomSetting(random, type, input, variant));
            const auto& value = node.input(input.name)->value;
            settings += " " + input.name + "=";
            if (const auto* n = std::get_if<double>(&value)) settings += std::to_string(*n);
            if (const auto* s = std::get_if<std::string>(&value)) settings += *s;
            if (const auto* l = std::get_if<Link>(&value)) settings += "<-" + l->node + "." + l->output;
            if (const auto* v = std::get_if<std::vector<double>>(&value)) {
                for (double n : *v) settings += std::to_string(n) + ",";
            }
            if (const auto* flag = std::get_if<bool>(&value)) settings += *flag ? "true" : "false";
        }
        for (const OutputSpec& output : type.outputs) {
            const int components = output.type == Type::vec3 ? 3 : 1;
            for (int component = 0; component < components; component++) {
                Sample sample{{},
                              {},
                              "variant " + std::to_string(variant) + settings,
                              output.type == Type::surface || output.type == Type::spline};
                sample.graph.nodes = sources();
                sample.graph.nodes.push_back(node);
                if (components == 3)
                    sample.graph.nodes.push_back(
                        make("parts", "separate_xyz", {{"vector", link("tested", output.name)}}));
                if (output.type == Type::spline)
                    sample.graph.nodes.push_back(make("tube", "tube", {{"spline", link("tested")}}));
                const InputValue shown = output.type == Type::spline ? link("tube")
                                         : components == 3 ? link("parts", std::string(1, "xyz"[component]))
                                                           : link("tested", output.name);
                sample.graph.nodes.push_back(make("out", "output", {{"surface", shown}}));
                const Result<Program> program = compile(sample.graph);
                if (!program) {
                    ADD_FAILURE() << sample.what << ": " << format(program.error());
                    continue;
                }
                sample.program = *program;
                all.push_back(std::move(sample));
            }
        }
    }
    return all;
}

Point moved(const Point& p, const Point& direction, double t) {
    return {p[0] + t * direction[0], p[1] + t * direction[1], p[2] + t * direction[2]};
}
double norm(const Point& v) { return std::hypot(v[0], v[1], v[2]); }

class EveryNode : public testing::TestWithParam<std::string> {
  protected:
    const NodeType& type = *findNodeType(GetParam());
    Random random{20240607};
    int variants() const {
        std::size_t options = 1;
        for (const InputSpec& input : type.inputs) options = std::max(options, input.options.size());
        return static_cast<int>(std::max<std::size_t>(24, 2 * options + 1));
    }
    int pointsEach(const std::vector<Sample>& all) const {
        return std::max(1000, kPointsANode / static_cast<int>(std::max<std::size_t>(all.size(), 1)));
    }
};

TEST_P(EveryNode, GivesFiniteNumbersWithRightGradients) {
    const std::vector<Sample> all = samples(type, random, variants());
    int smooth = 0, total = 0;
    for (const Sample& sample : all) {
        SCOPED_TRACE(sample.what);
        const Ir& ir = sample.program.ir;
        const IrId root = sample.program.distance();
        // First some places where terms vanish or meet: finite there, but the gradient is that of either
        // side.
        std::vector<Point> points = {{0, 0, 0}, {0.5, 0, 0}, {0, -0.5, 0}, {0, 0, 1}, {1, 1, 1}, {-1, 1, 0}};
        const std::size_t special = points.size();
        for (int i = pointsEach(all); i > 0; i--) points.push_back(randomPoint(random));
        std::vector<Point> around;
        for (const Point& p : points) {
            for (int axis = 0; axis < 3; axis++) {
                for (double step : {1e-5, -1e-5, 1e-6, -1e-6}) {
                    around.push_back(p);
                    around.back()[axis] += step;
                }
            }
        }
        std::vector<ValueGradient> at(points.size());
        std::vector<double> near(around.size());
        evaluateGradient(ir, root, {}, points, at);
        evaluate(ir, root, {}, around, near);
        for (std::size_t i = 0; i < points.size(); i++) {
            const Point& p = points[i];
            ASSERT_TRUE(std::isfinite(at[i].value)) << p[0] << " " << p[1] << " " << p[2];
            for (int axis = 0; axis < 3; axis++) {
                const double gradient = at[i].gradient[axis];
                ASSERT_TRUE(std::isfinite(gradient)) << p[0] << " " << p[1] << " " << p[2];
                if (i < special) continue;
                const double* side = &near[12 * i + 4 * axis];
                const double up = (side[0] - at[i].value) / 1e-5, down = (at[i].value - side[1]) / 1e-5;
                const double closer = (side[2] - side[3]) / 2e-6;
                // Where one-sided slopes or those over two distances differ there is a kink, a jump or a pole
                // nearby.
                const double tolerance = 1e-3 * (1 + std::abs(up));
                total++;
                if (std::abs(up - down) > tolerance || std::abs(up - closer) > tolerance) continue;
                smooth++;
                ASSERT_NEAR(gradient, closer, tolerance)
                    << "axis " << axis << " at " << p[0] << " " << p[1] << " " << p[2];
            }
        }
    }
    EXPECT_GT(smooth, 0.85 * total) << "hardly any place was smooth enough to compare";
}

/// A vertex may lie on the surface to the last bit; its normal is the gradient there. Solids with flat faces
/// through representable places are where a field may come out as 0 with the wrong case.
TEST(Gradient, HasUnitLengthOnTheSurfaceItself) {
    const auto onSurface = [](const char* id, std::vector<std::pair<std::string, InputValue>> inputs,
                              const Point& p, const Point& normal) {
        Graph graph;
        graph.nodes = sources();
        graph.nodes.push_back(make("tested", id, std::move(inputs)));
        graph.nodes.push_back(make("out", "output", {{"surface", link("tested")}}));
        const Result<Program> program = compile(graph);
        ASSERT_TRUE(program) << id << ": " << format(program.error());
        ValueGradient at{};
        evaluateGradient(program->ir, program->distance(), {}, std::span(&p, 1), std::span(&at, 1));
        EXPECT_NEAR(at.value, 0, 1e-15) << id;
        for (int axis = 0; axis < 3; axis++)
            EXPECT_NEAR(at.gradient[axis], normal[axis], 1e-12) << id << " axis " << axis;
    };
    onSurface("box", {}, {1, 0.25, 0.5}, {1, 0, 0});
    onSurface("box", {}, {0.25, 0.5, -1}, {0, 0, -1});
    onSurface("box_max", {}, {0.25, -1, 0.5}, {0, -1, 0});
    onSurface("box_frame", {}, {0.9375, 1, 0.5}, {0, 1, 0});
    onSurface("slab", {}, {1, 0.5, 1}, {0, 1, 0});
    onSurface("cylinder", {}, {0.25, 1, 0.25}, {0, 1, 0});
    onSurface("cylinder", {}, {0.5, 0.25, 0}, {1, 0, 0});
    onSurface("cone", {{"height", number(1)}}, {0.25, -1, 0}, {0, -1, 0});
    onSurface("capped_cone", {}, {0.125, 0.5, 0}, {0, 1, 0});
    onSurface("capped_cone", {{"radius_top", number(0.5)}}, {0.5, 0.25, 0}, {1, 0, 0});
    onSurface("pyramid", {}, {0.25, 0, 0.125}, {0, -1, 0});
    onSurface("prism", {}, {0.125, -0.5, 0.25}, {0, -1, 0});
    onSurface("prism", {}, {0.125, 0.25, 0.5}, {0, 0, 1});
    onSurface("cut_sphere", {}, {0.25, 0, 0.125}, {0, -1, 0});
    onSurface("solid_angle", {{"half_angle", number(90)}}, {0.5, 0, 0}, {0, -1, 0});
    onSurface("rectangle", {}, {-0.5, 0.25, 7}, {-1, 0, 0});
    onSurface("regular_polygon", {{"sides", number(4)}}, {0.5, 0.125, 0}, {1, 0, 0});
    const std::vector<double> square = {-0.5, -0.5, 0.5, -0.5, 0.5, 0.5, -0.5, 0.5};
    for (const std::vector<double>& outline : {square, std::vector<double>(square.rbegin(), square.rend())}) {
        InputValue points = numbers(outline);
        points.entry = 2;
        onSurface("polygon", {{"points", points}}, {0.5, 0.25, 0}, {1, 0, 0});
        onSurface("polygon", {{"points", points}}, {-0.5, 0.25, 0}, {-1, 0, 0});
        onSurface("polygon", {{"points", points}}, {0.25, 0.5, 0}, {0, 1, 0});
        onSurface("polygon", {{"points", points}}, {0.25, -0.5, 0}, {0, -1, 0});
    }
    onSurface("extrude", {{"surface", link("flat")}}, {0.125, 0.25, 0.5}, {0, 0, 1});
}

TEST_P(EveryNode, IntervalContainsItsSamples) {
    const std::vector<Sample> all = samples(type, random, variants());
    for (const Sample& sample : all) {
        SCOPED_TRACE(sample.what);
        for (int boxes = pointsEach(all) / 16; boxes > 0; boxes--) {
            const double size = std::array{0.0, 1e-3, 0.05, 0.3, 1.5}[boxes % 5];
            const Point centre = randomPoint(random);
            const Box box{{centre[0] - size, centre[1] - size, centre[2] - size},
                          {centre[0] + size, centre[1] + size, centre[2] + size}};
            const Interval bound = evaluateInterval(sample.program.ir, sample.program.distance(), {}, box);
            std::vector<Point> points = {box.lo, box.hi, centre};
            while (points.size() < 16) points.push_back(moved(centre, randomPoint(random, 1), size));
            std::vector<double> values(points.size());
            evaluate(sample.program.ir, sample.program.distance(), {}, points, values);
            for (std::size_t i = 0; i < points.size(); i++) {
                const double slack = 1e-12 * (1 + std::abs(values[i]));
                ASSERT_TRUE(values[i] >= bound.lo - slack && values[i] <= bound.hi + slack)
                    << values[i] << " is not in [" << bound.lo << ", " << bound.hi << "] around " << centre[0]
                    << " " << centre[1] << " " << centre[2] << " ± " << size;
            }
        }
    }
}

/// Small boxes have narrow intervals, or culling would not work; where a body jumps or chooses, they may be
/// wide.
TEST_P(EveryNode, IntervalOfASmallBoxIsNarrow) {
    if (type.id == "sweep") GTEST_SKIP() << "narrow near the spline alone: SplineTable.IntervalsAreNarrow";
    for (const Sample& sample : samples(type, random, 1)) {
        if (!sample.isSurface) continue;
        constexpr double kSize = 1e-4;
        int narrow = 0, boxes = 2000;
        for (int i = 0; i < boxes; i++) {
            const Point c = randomPoint(random);
            const Interval bound =
                evaluateInterval(sample.program.ir, sample.program.distance(), {},
                                 {moved(c, {1, 1, 1}, -kSize), moved(c, {1, 1, 1}, kSize)});
            if (bound.hi - bound.lo < 30 * kSize) narrow++;
        }
        EXPECT_GT(narrow, 0.97 * boxes);
    }
}

/// Samples of the field are as far from its surface, and differ as little, as its class says.
void expectClass(const Sample& sample, Random& random, int count) {
    SCOPED_TRACE(sample.what);
    const Exactness declared = sample.program.exactness;
    std::vector<Point> points, partners;
    for (int i = count; i > 0; i--) {
        points.push_back(randomPoint(random));
        partners.push_back(
            moved(points.back(), randomPoint(random, 1), std::pow(10, uniform(random, -4, 0.3))));
    }
    std::vector<ValueGradient> at(points.size());
    std::vector<double> values(points.size()), feet(points.size());
    evaluateGradient(sample.program.ir, sample.program.distance(), {}, points, at);
    evaluate(sample.program.ir, sample.program.distance(), {}, partners, values);
    if (std::isfinite(declared.lipschitz)) {
        for (std::size_t i = 0; i < points.size(); i++) {
            const double apart = norm(moved(partners[i], points[i], -1));
            ASSERT_LE(std::abs(values[i] - at[i].value), declared.lipschitz * apart * (1 + 1e-9) + 1e-9)
                << "from " << points[i][0] << " " << points[i][1] << " " << points[i][2] << " to "
                << partners[i][0] << " " << partners[i][1] << " " << partners[i][2];
        }
    }
    std::vector<Point> ends;
    for (std::size_t i = 0; i < points.size(); i++)
        ends.push_back(moved(points[i], at[i].gradient, -at[i].value));
    evaluate(sample.program.ir, sample.program.distance(), {}, ends, feet);
    for (std::size_t i = 0; i < points.size(); i++) {
        if (std::abs(at[i].value) > 1e6 || !(at[i].value > 0 ? declared.outside : declared.inside)) continue;
        ASSERT_NEAR(feet[i], 0, 1e-6) << "the foot of " << points[i][0] << " " << points[i][1] << " "
                                      << points[i][2] << ", value " << at[i].value;
    }
}

TEST_P(EveryNode, HasTheClassItDeclares) {
    const std::vector<Sample> all = samples(type, random, variants());
    for (const Sample& sample : all)
        if (sample.isSurface) expectClass(sample, random, pointsEach(all));
}

/// Also of what it is not meant for, but for the nodes that are told that a surface fits into a cell.
TEST_P(EveryNode, HasTheClassItDeclaresOfAnySurface) {
    const bool repeats = type.id == "repeat" || type.id == "polar_repeat" || type.id == "scatter";
    const bool takesSurfaces = inputIndex(type, "surface") >= 0 || inputIndex(type, "a") >= 0;
    if (repeats || !takesSurfaces || type.outputs[0].type != Type::surface) return;
    for (const Sample& sample : samples(type, random, 2 * variants(), true))
        if (sample.isSurface) expectClass(sample, random, 1000);
}

std::vector<std::string> nodesWithABody() {
    std::vector<std::string> ids;
    for (const NodeType& type : nodeTypes()) {
        if (!type.body.empty()) ids.push_back(type.id);
    }
    return ids;
}

INSTANTIATE_TEST_SUITE_P(Nodes, EveryNode, testing::ValuesIn(nodesWithABody()),
                         [](const auto& test) { return test.param; });

}  // namespace fw::nodes_test
