// The field on the device equals the CPU reference: every node type alone, and random graphs.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "graph/check/check.h"
#include "graph/document/json.h"
#include "graph/emit/glsl.h"
#include "graph/library/node_type.h"
#include "tests/support/device_field.h"
#include "tests/support/graph/random_graph.h"

namespace fw::field_test {

/// What a comparison over many points found.
struct Agreement {
    int points = 0, close = 0, explained = 0;
    std::string firstFailure, firstFar;
};

/// The largest magnitude among the values of the operations that the distance is computed from; infinite if
/// one of them is not a number.
double largestWithin(const Program& program, std::span<const double> parameters, const Point& point) {
    std::array roots = {program.distance()};
    const Ir ir = program.ir.compact(roots);
    double largest = 0;
    for (IrId id = 0; id < ir.size(); ++id) {
        const double value = std::abs(evaluate(ir, id, parameters, point));
        largest = std::isnan(value) ? std::numeric_limits<double>::infinity() : std::max(largest, value);
    }
    return largest;
}

/// Compares value, row value, interval and gradient at `count` points. A value is close within 1e-4 relative;
/// a farther one is explained if the field takes it within float rounding of the point (a jump, a pole), or
/// of the largest value that it passes through on the way.
Agreement compare(const Program& program, int count, uint32_t seed, float reach = 2.5f) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(-reach, reach);
    std::vector<std::array<float, 3>> points(count);
    std::vector<Point> reference(count);
    for (int i = 0; i < count; ++i) {
        for (float& c : points[i]) c = unit(random);
        std::copy(points[i].begin(), points[i].end(), reference[i].begin());
    }
    const float halfSize = 0.05f;
    const auto samples = test::evaluateOnDevice(program, points, halfSize);
    std::vector<double> values(count);
    const std::vector<double> parameters = program.parameters();
    evaluate(program.ir, program.distance(), parameters, reference, values);

    Agreement result;
    const auto note = [&](std::string& first, int i, const char* what, double found) {
        if (!first.empty()) return;
        char text[200];
        std::snprintf(text, sizeof text, "%s at (%.9g, %.9g, %.9g): %.9g, reference %.9g, interval %.9g %.9g",
                      what, points[i][0], points[i][1], points[i][2], found, values[i],
                      samples[i].interval[0], samples[i].interval[1]);
        first = text;
    };
    for (int i = 0; i < count; ++i) {
        if (!std::isfinite(values[i]) || std::abs(values[i]) > 1e20) continue;
        ++result.points;
        const auto near = [&](double found) {
            return std::abs(found - values[i]) <= 1e-4 * (1.0 + std::abs(values[i]));
        };
        if (near(samples[i].value) && near(samples[i].rowValue) && near(samples[i].gradient[3])) {
            ++result.close;
        } else {
            note(result.firstFar, i, "value", samples[i].value);
            Box around;
            for (int axis = 0; axis < 3; ++axis) {
                const double slack = 2e-5 * (1.0 + std::abs(reference[i][axis]));
                around.lo[axis] = reference[i][axis] - slack, around.hi[axis] = reference[i][axis] + slack;
            }
            const Interval range = evaluateInterval(program.ir, program.distance(), parameters, around);
            const double slack =
                1e-3 * (1.0 + std::abs(values[i])) + 4e-7 * largestWithin(program, parameters, reference[i]);
            const auto explained = [&](double found) {
                return found >= range.lo - slack && found <= range.hi + slack;
            };
            if (explained(samples[i].value) && explained(samples[i].rowValue) &&
                explained(samples[i].gradient[3]))
                ++result.explained;
            else
                note(result.firstFailure, i, "value", samples[i].value);
        }
        const auto within = [&](double slack) {
            return samples[i].interval[0] <= samples[i].value + slack &&
                   samples[i].interval[1] >= samples[i].value - slack;
        };
        if (near(samples[i].value) && !within(1e-6 * (1.0 + std::abs(values[i]))) &&
            !within(4e-7 * largestWithin(program, parameters, reference[i])))
            note(result.firstFailure, i, "interval", samples[i].value);
    }
    return result;
}

class EachNode : public testing::TestWithParam<int> {};

/// A graph that shows the node alone, its surfaces fed by shapes.
Graph alone(const NodeType& type) {
    Graph graph;
    const auto add = [&](std::string id, std::string kind) -> Node& {
        Node node;
        node.id = std::move(id), node.type = std::move(kind);
        graph.nodes.push_back(std::move(node));
        return graph.nodes.back();
    };
    const bool flat = type.id == "extrude" || type.id == "revolve";
    add("first", flat ? "rectangle" : "box");
    add("second", "sphere").set("radius", {1.2});
    Node& node = add("node", type.id);
    int fed = 0;
    bool along = false;
    for (const InputSpec& input : type.inputs) {
        if (input.type == Type::surface) node.set(input.name, {Link{fed++ ? "second" : "first", ""}});
        if (input.type == Type::spline) node.set(input.name, {Link{"curve", ""}}), along = true;
    }
    if (along) add("curve", "spline");
    std::string shown = "node", output;
    if (type.outputs[0].type == Type::spline) {
        add("tube", "tube").set("spline", {Link{"node", ""}});
        shown = "tube";
    }
    if (type.outputs[0].type == Type::vec3) {
        Node& length = add("length", "vector_math");
        length.set("op", {std::string("length")});
        length.set("a", {Link{"node", ""}});
        shown = "length", output = "value";
    }
    add("out", "output").set("surface", {Link{shown, output}});
    return graph;
}

TEST_P(EachNode, EqualsTheReference) {
    const NodeType& type = nodeTypes()[GetParam()];
    if (type.body.empty() || type.outputs.empty())
        return;  // stages and structure are covered by the graphs they stand in
    const Graph graph = alone(type);
    for (const Error& error : check(graph))
        ASSERT_NE(error.severity, Error::Severity::error) << format(error);
    const Result<Program> program = compile(graph);
    ASSERT_TRUE(program) << format(program.error());
    const Agreement found = compare(*program, 100'000, 1);
    EXPECT_EQ(found.firstFailure, "");
    EXPECT_GE(found.close, 0.995 * found.points);
    EXPECT_GT(found.points, 90'000);
}

INSTANTIATE_TEST_SUITE_P(Library, EachNode, testing::Range(0, static_cast<int>(nodeTypes().size())),
                         [](const auto& row) { return nodeTypes()[row.param].id; });

TEST(RandomGraphs, CompileAndEqualTheReference) {
    const int wanted = std::getenv("FIELDWRIGHT_LONG") ? 10'000 : 40;
    int compiled = 0, tooLarge = 0, chaotic = 0;
    double points = 0, close = 0;
    for (uint32_t seed = 1; compiled < wanted; ++seed) {
        ASSERT_LT(seed, 3u * wanted);
        const Graph graph = test::randomGraph(seed, 60);
        const std::string text = writeGraph(graph);
        const Result<Graph> again = parseGraph(text, "random", nullptr);
        ASSERT_TRUE(again) << "seed " << seed << ": " << format(again.error());
        ASSERT_EQ(writeGraph(*again), text) << "seed " << seed;
        bool sound = true;
        std::string message;
        for (const Error& error : check(graph))
            if (error.severity == Error::Severity::error) sound = false, message = format(error);
        if (!sound) {
            // What is wired may be out of a range, too.
            const bool wired = message.find("out of range") != std::string::npos;
            ASSERT_TRUE(wired || message.find("operations") != std::string::npos)
                << "seed " << seed << ": " << message;
            ++tooLarge;
            continue;
        }
        const Result<Program> program = compile(graph);
        ASSERT_TRUE(program) << "seed " << seed << ": " << format(program.error());
        if (program->ir.size() > test::kMostOperations) {
            ++tooLarge;
            continue;
        }
        ++compiled;
        const Agreement found = compare(*program, 512, seed);
        ASSERT_EQ(found.firstFailure, "") << "seed " << seed;
        chaotic +=
            found.close < 0.8 * found.points;  // such as a noise at coordinates of 1e9: no float has them
        points += found.points, close += found.close;
    }
    EXPECT_LE(chaotic, 0.04 * compiled);
    EXPECT_GE(close, 0.95 * points);
    std::printf("close: %.3f %% of %.0f points; chaotic graphs: %d\n", 100.0 * close / points, points,
                chaotic);
    std::printf("seeds 1 to %d: %d compiled, %d too large\n", compiled + tooLarge, compiled, tooLarge);
    EXPECT_LT(tooLarge, compiled / 2);
}

/// The program of one expression node with this code.
Result<Program> compiledExpression(const std::string& code) {
    const Result<Graph> graph = parseGraph(R"({"fieldwright": 1, "nodes": [
        {"id": "code", "type": "expression", "code": ")" +
                                               code + R"("},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "code"}}}]})",
                                           "code", nullptr);
    if (!graph) return graph.error();
    return compile(*graph);
}

TEST(Noise, EqualCoordinatesAreNoSpecialCase) {
    for (const char* kind : {"perlin", "simplex", "worley", "cell_wall"}) {
        const Result<Program> program =
            compiledExpression("return " + std::string(kind) + "(floor(p * 4.0) / 4.0 + p.zxy * 0.0);");
        ASSERT_TRUE(program) << format(program.error());
        // Multiples of 1/4, on most of which two or three coordinates tie within their cell.
        const Agreement found = compare(*program, 4096, 1, 2.0f);
        EXPECT_EQ(found.firstFailure, "") << kind;
        EXPECT_EQ(found.close, found.points) << kind << ": " << found.firstFar;
    }
}

TEST(Noise, WorleyLooksTwoCellsFar) {
    // Where none of the 27 points around is within a metre, and one beyond them is nearer.
    const Result<Program> program =
        compiledExpression("return worley(p * 0.002 + vec3(-14.006, -20.025, 18.035));");
    ASSERT_TRUE(program) << format(program.error());
    const Agreement found = compare(*program, 4096, 1, 2.0f);
    EXPECT_EQ(found.firstFailure, "");
    EXPECT_EQ(found.close, found.points) << found.firstFar;
}

TEST(Power, OfNoughtIsWithinItsInterval) {
    // All three signs of the exponent, none of which folds.
    for (const char* exponent : {"max(p.y - 100.0, 0.0)", "max(p.y - 100.0, 0.0) + 1.0", "p.y"}) {
        const Result<Program> program =
            compiledExpression("return pow(max(p.x - 100.0, 0.0), " + std::string(exponent) + ") - 0.5;");
        ASSERT_TRUE(program) << format(program.error());
        EXPECT_EQ(compare(*program, 1024, 1).firstFailure, "") << exponent;
    }
}

TEST(LiveParameters, KeepTheHashAndFollowTheBuffer) {
    int tried = 0;
    for (uint32_t seed = 1; tried < 40; ++seed) {
        Graph graph = test::randomGraph(seed, 20);
        Node* node = nullptr;
        std::string input;
        for (Node& candidate : graph.nodes)
            for (auto& [name, value] : candidate.inputs)
                if (std::holds_alternative<double>(value.value)) {
                    const NodeType* type = findNodeType(candidate.type);
                    const int index = type ? inputIndex(*type, name) : -1;
                    if (index >= 0 && type->inputs[index].type == Type::scalar)
                        node = &candidate, input = name;
                }
        if (!node) continue;
        CompileOptions options;
        options.live.insert(node->id + "." + input);
        const Result<Program> before = compile(graph, options);
        if (!before || before->ir.size() > 1500) continue;
        ++tried;
        InputValue changed{std::get<double>(node->input(input)->value) * 1.01 + 0.001};
        node->set(input, changed);
        const Result<Program> after = compile(graph, options);
        if (!after) continue;  // out of the input's range
        EXPECT_EQ(before->structureHash, after->structureHash) << "seed " << seed;
        EXPECT_EQ(emitField(*before), emitField(*after)) << "seed " << seed;
        const Agreement found = compare(*after, 256, seed);
        EXPECT_EQ(found.firstFailure, "") << "seed " << seed;
    }
}

}  // namespace fw::field_test
