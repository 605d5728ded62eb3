// Repetitions: claims and warnings for copies that fit into their cells and sectors, and for others.
#include <gtest/gtest.h>

#include <cmath>

#include "graph/compile/compile.h"
#include "graph/document/json.h"

namespace fw::repetitions_test {

Program programOf(const std::string& nodes, const CompileOptions& options = {}) {
    const Result<Graph> graph = parseGraph(R"({"fieldwright": 1, "nodes": [)" + nodes +
                                               R"(, {"id": "out", "type": "output",
                                                    "inputs": {"surface": {"from": "copies"}}}]})",
                                           "repetitions.field.json", nullptr);
    EXPECT_TRUE(graph) << format(graph.error());
    if (!graph) return {};
    const Result<Program> program = compile(*graph, options);
    EXPECT_TRUE(program) << format(program.error());
    return program ? *program : Program();
}
std::string node(const std::string& id, const std::string& type, const std::string& inputs) {
    return R"({"id": ")" + id + R"(", "type": ")" + type + R"(", "inputs": {)" + inputs + "}}";
}
/// The node "copies" of a surface that these nodes make under the id "it".
Program copiesOf(const std::string& surface, const std::string& type, const std::string& inputs,
                 const CompileOptions& options = {}) {
    return programOf(surface + "," + node("copies", type, R"("surface": {"from": "it"}, )" + inputs),
                     options);
}
/// A shape "it", moved.
std::string moved(const std::string& type, const std::string& inputs, const std::string& offset) {
    return node("shape", type, inputs) + "," +
           node("it", "translate", R"("surface": {"from": "shape"}, "offset": )" + offset);
}
void expectWarning(const Program& program, const std::string& words) {
    ASSERT_EQ(program.notes.size(), 1u);
    EXPECT_EQ(program.notes[0].severity, Error::Severity::warning);
    const std::string text = format(program.notes[0]);
    EXPECT_NE(text.find("node 'copies', input 'surface'"), std::string::npos) << text;
    EXPECT_NE(text.find(words), std::string::npos) << text;
}
void expectNoWarning(const Program& program) {
    for (const Error& note : program.notes) ADD_FAILURE() << format(note);
}

TEST(Repetitions, AreExactOutsideWhereCopiesFit) {
    for (const auto& [surface, type, inputs] : std::vector<std::array<std::string, 3>>{
             {node("it", "box", ""), "repeat", R"("period": [2, 2, 2])"},  // they touch
             {node("it", "box", ""), "repeat", R"("period": [2, 0, 3], "count": [4, 1, 0])"},
             {node("it", "slab", R"("half_thickness": 0.2)"), "repeat", R"("period": [0, 1, 0])"},
             {moved("sphere", R"("radius": 0.5)", "[0, 7, 0]"), "repeat", R"("period": [1, 0, 1])"},
             {moved("sphere", R"("radius": 0.3)", "[1, 0, 0]"), "polar_repeat", R"("count": 8)"},
             {moved("box", R"("half_extents": [0.2, 5, 0.2])", "[1, 3, 0.1]"), "polar_repeat",
              R"("count": 7)"},
             {moved("sphere", R"("radius": 0.3)", "[1, -1, 0]"), "polar_repeat",
              R"("count": 12, "axis": [1, 1, 0])"},
             // Up to four copies are all sampled, wherever they are.
             {moved("box", "", "[0, 0, 5]"), "polar_repeat", R"("count": 4)"}}) {
        SCOPED_TRACE(surface + type + inputs);
        const Program program = copiesOf(surface, type, inputs);
        EXPECT_TRUE(program.exactness.outside);
        EXPECT_EQ(program.exactness.lipschitz, 1);
        expectNoWarning(program);
    }
}

TEST(Repetitions, ClaimNothingAndWarnWhereCopiesDoNotFit) {
    for (const auto& [surface, type, inputs, words] : std::vector<std::array<std::string, 4>>{
             {moved("box", "", "[0.4, 0, 0]"), "repeat", R"("period": [2, 2, 2])", "one period along x"},
             {moved("sphere", R"("radius": 0.1)", "[0, 0, 3]"), "repeat", R"("period": [1, 1, 1])",
              "one period along z"},
             {moved("box", R"("half_extents": [0.4, 0.3, 0.3])", "[0, 0, 0.6]"), "polar_repeat",
              R"("count": 5)", "sector around +x"},
             {moved("sphere", R"("radius": 0.2)", "[1, 0, 1]"), "polar_repeat",
              R"("count": 9, "neighbours": false)", "sector around +x"},
             {moved("sphere", R"("radius": 1.2)", "[0.5, 0, 0]"), "repeat",
              R"("period": [2, 0, 0], "neighbours": false)", "one period along x"},
             {moved("sphere", R"("radius": 0.3)", "[4, 0, 0]"), "scatter", R"("period": [2, 2, 2])",
              "a cell along x whichever way it is turned"},
             {moved("sphere", R"("radius": 0.3)", "[0, 3, 0]"), "scatter",
              R"("period": [2, 2, 2], "turn": 0)", "a cell along y,"}}) {
        SCOPED_TRACE(surface + type + inputs);
        const Program program = copiesOf(surface, type, inputs);
        EXPECT_FALSE(program.exactness.outside);
        EXPECT_TRUE(std::isinf(program.exactness.lipschitz));
        EXPECT_EQ(program.spoiledBy, "copies");
        expectWarning(program, words);
    }
}

/// A point has no volume, but a distance.
TEST(Repetitions, ClaimNothingOfAPointBeyondItsCell) {
    const Program program =
        copiesOf(moved("sphere", R"("radius": 0)", "[3, 0, 0]"), "repeat", R"("period": [1, 1, 1])");
    EXPECT_FALSE(program.exactness.outside);
    EXPECT_TRUE(std::isinf(program.exactness.lipschitz));
}

/// The field of a surface that fits, but is only a bound, may still jump: here by half its value.
TEST(Repetitions, ClaimNothingOfBoundsThatMayJump) {
    const std::string thinCap =
        node("ball", "sphere", R"("radius": 10)") + "," +
        node("off", "translate", R"("surface": {"from": "ball"}, "offset": [10, 0, 0])") + "," +
        node("side", "plane", R"("normal": [1, 0, 0], "offset": 0.4)") + "," +
        node("it", "intersect", R"("a": {"from": "off"}, "b": {"from": "side"})");
    const Program program = copiesOf(thinCap, "repeat", R"("period": [1, 0, 0])");
    const auto at = [&](double x) { return evaluate(program.ir, program.distance(), {}, Point{x, 5, 0}); };
    EXPECT_GT(std::abs(at(1e-9) - at(-1e-9)), 0.5);
    EXPECT_TRUE(std::isinf(program.exactness.lipschitz));
    expectNoWarning(program);
}

/// Spokes that meet in a hub are more than a sector there, but no copy is cut off, and mirror images of one
/// value meet on each plane between copies.
TEST(Repetitions, KeepTheConstantOfSymmetricSurfaces) {
    const Program spokes = copiesOf(moved("box", R"("half_extents": [0.5, 0.1, 0.05])", "[0.5, 0, 0]"),
                                    "polar_repeat", R"("count": 12)");
    EXPECT_FALSE(spokes.exactness.outside);
    EXPECT_EQ(spokes.exactness.lipschitz, 1);
    expectNoWarning(spokes);
    const std::string tilted =
        node("shape", "box", R"("half_extents": [0.5, 0.1, 0.05])") + "," +
        node("turned", "rotate", R"("surface": {"from": "shape"}, "angles": [0, 30, 0])") + "," +
        node("it", "translate", R"("surface": {"from": "turned"}, "offset": [0.4, 0, 0])");
    EXPECT_TRUE(std::isinf(copiesOf(tilted, "polar_repeat", R"("count": 12)").exactness.lipschitz));
    const std::string dimpled = node("ball", "sphere", R"("radius": 0.8)") + "," +
                                node("hole", "infinite_cylinder", R"("radius": 0.2)") + "," +
                                node("it", "subtract", R"("a": {"from": "ball"}, "b": {"from": "hole"})");
    const Program endless = copiesOf(dimpled, "repeat", R"("period": [2, 2, 2])");
    EXPECT_EQ(endless.exactness.lipschitz, 1);
    expectNoWarning(endless);
    // A row that ends drops its last copy but one for nothing.
    EXPECT_TRUE(std::isinf(
        copiesOf(dimpled, "repeat", R"("period": [2, 2, 2], "count": [3, 3, 3])").exactness.lipschitz));
}

/// A live radius may grow out of its cell while the program stays the same.
TEST(Repetitions, ClaimNothingOfASurfaceThatMoves) {
    const std::string surface = node("it", "sphere", R"("radius": 0.3)");
    for (const auto& [type, inputs] :
         std::vector<std::array<std::string, 2>>{{"repeat", R"("period": [1, 1, 1])"},
                                                 {"scatter", R"("period": [1, 1, 1])"},
                                                 {"polar_repeat", R"("count": 8)"}}) {
        SCOPED_TRACE(type);
        const Program program = copiesOf(surface, type, inputs, {.live = {"it.radius"}});
        EXPECT_TRUE(std::isinf(program.exactness.lipschitz));
    }
}

TEST(Repetitions, ScatterKeepsTheConstantWhereCopiesFit) {
    for (const char* inputs : {R"("period": [1, 1, 1])", R"("period": [1, 0, 2], "jitter": 0.8)",
                               R"("period": [1, 1, 1], "size_variation": 0, "turn": 0)"}) {
        SCOPED_TRACE(inputs);
        const Program ball = copiesOf(node("it", "sphere", R"("radius": 0.4)"), "scatter", inputs);
        EXPECT_EQ(ball.exactness.lipschitz, 1);
        expectNoWarning(ball);
    }
    // Only a bound, but one that is large enough where copies are dropped.
    const Program block = copiesOf(node("it", "box_max", R"("half_extents": [0.2, 0.2, 0.2])"), "scatter",
                                   R"("period": [1, 1, 1], "turn": 0, "size_variation": 0.2)");
    EXPECT_EQ(block.exactness.lipschitz, 1);
    expectNoWarning(block);
}

}  // namespace fw::repetitions_test
