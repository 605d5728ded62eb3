// Families: what is found alike in the IR, and that the table has the members' numbers.
#include "graph/ir/families.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <random>
#include <set>

#include "graph/compile/compile.h"
#include "graph/compile/effort.h"
#include "graph/document/json.h"
#include "graph/emit/glsl.h"
#include "tests/support/graph/expression_graph.h"
#include "tests/support/graph/random_graph.h"

namespace fw::families_test {

Program programOf(const std::string& code) {
    Result<Program> program = compile(test::expressionGraph(code));
    if (!program) throw std::runtime_error(format(program.error()));
    return std::move(*program);
}

/// Of nodes in JSON, of which `end` is put out.
Program programOfNodes(const std::string& nodes, CompileOptions options = {}) {
    const Result<Graph> graph =
        parseGraph(R"({"fieldwright": 1, "nodes": [)" + nodes +
                       R"(, {"id": "out", "type": "output", "inputs": {"surface": {"from": "end"}}}]})",
                   "test.field.json", nullptr);
    if (!graph) throw std::runtime_error(format(graph.error()));
    Result<Program> program = compile(*graph, options);
    if (!program) throw std::runtime_error(format(program.error()));
    return std::move(*program);
}

const std::string kPlace =
    "c = vec3(hash(vec3(i, 1, 0), 1), hash(vec3(i, 2, 0), 1), hash(vec3(i, 3, 0), 1)) * 4;\n";

std::string unionOf(int count, const std::string& shape, const std::string& before = "d = 1000.0;\n") {
    return before + "for (int i = 0; i < " + std::to_string(count) + "; i++) {\n" + kPlace + "d = min(d, " +
           shape + ");\n}\nreturn d;";
}

/// A value of the family in that row by its steps and numbers, at a point.
double inRow(const Ir& ir, const Family& family, uint32_t row, const std::vector<double>& values, IrId of) {
    std::vector<double> own = values;
    own.resize(ir.size());
    for (IrId id = IrId(values.size()); id < ir.size(); ++id) {
        if (ir[id].op == Op::constant) own[id] = ir.number(id);
        if (ir[id].op == Op::column && ir.number(id) >= family.firstColumn &&
            ir.number(id) < family.firstColumn + family.width)
            own[id] = family.table[row * family.width + std::size_t(ir.number(id)) - family.firstColumn];
    }
    for (IrId step : family.steps) {
        double operands[kMaxArity] = {};
        for (int i = 0; i < opInfo(ir[step].op).arity; ++i) operands[i] = own[ir[step].operands[i]];
        own[step] = opInfo(ir[step].op).value(operands, ir.layer(ir[step]));
    }
    return own[of];
}

/// Folds all groups from tables and compares with the IR's own values.
void expectTablesGiveTheGroups(const Program& program) {
    const std::vector<Point> points = {{0.3, 0.2, 0.1}, {-1.5, 0.7, 2.0}, {3.1, -0.4, 1.2}, {0, 0, 0}};
    const std::vector<double> parameters = program.parameters();
    for (const Point& point : points) {
        std::vector<double> values(point.begin(), point.end());
        for (IrId id = 3; id <= program.distance(); ++id) {
            const IrNode& node = program.ir[id];
            double operands[kMaxArity] = {};
            for (int i = 0; i < opInfo(node.op).arity; ++i) operands[i] = values[node.operands[i]];
            values.push_back(node.op == Op::constant ? node.number
                             : node.op == Op::parameter
                                 ? parameters[std::size_t(node.number)]
                                 : opInfo(node.op).value(operands, program.ir.layer(node)));
        }
        for (const auto& [root, group] : program.families.groups) {
            if (group.chain()) {
                const Family& family = program.families.all[group.families.at(0)];
                double chain = values[group.others.at(0)];
                for (uint32_t row = 0; row < family.members; ++row) {
                    const double operands[kMaxArity] = {chain,
                                                        inRow(program.ir, family, row, values, family.value),
                                                        inRow(program.ir, family, row, values, family.blend)};
                    chain = opInfo(group.op).value(operands, {});
                }
                EXPECT_NEAR(chain, values[root], 1e-6 * (1 + std::abs(values[root])));
                continue;
            }
            const bool less = group.op == Op::minimum;
            double best = less ? HUGE_VAL : -HUGE_VAL;
            const auto offer = [&](double value) {
                best = less ? std::min(best, value) : std::max(best, value);
            };
            for (uint32_t f : group.families) {
                const Family& family = program.families.all[f];
                for (uint32_t row = 0; row < family.members; ++row)
                    offer(inRow(program.ir, family, row, values, family.value));
            }
            for (IrId other : group.others) offer(values[other]);
            EXPECT_NEAR(best, values[root], 1e-6 * (1 + std::abs(values[root])));
        }
    }
}

TEST(Families, AUnionOfBoxesIsOneTable) {
    const Program program =
        programOf(unionOf(40, "box(p - c, vec3(0.1, 0.2, 0.1 + 0.01 * i), 0.02).distance"));
    ASSERT_EQ(program.families.all.size(), 1u);
    const Family& family = program.families.all[0];
    EXPECT_EQ(family.members, 40u);
    EXPECT_EQ(family.width, kTexel);  // place and one half extent; what is the same in all is code
    EXPECT_EQ(family.table.size(), 160u);
    EXPECT_EQ(std::set<IrId>(family.inputs.begin(), family.inputs.end()), (std::set<IrId>{0, 1, 2}));
    ASSERT_EQ(program.families.groups.size(), 1u);
    EXPECT_EQ(program.families.groups.begin()->first, program.distance());
    expectTablesGiveTheGroups(program);
}

TEST(Families, EachKindHasItsOwnAndTheRestStaysCode) {
    const Program program =
        programOf(unionOf(20, "box(p - c, vec3(0.1), 0.02).distance", "d = torus(p, 1, 0.1).distance;\n"));
    ASSERT_EQ(program.families.all.size(), 1u);
    EXPECT_EQ(program.families.groups.begin()->second.others.size(), 1u);
    const Program two =
        programOf(unionOf(40,
                          "(i % 2 == 0 ? box(p - c, vec3(0.1), 0.02).distance : capsule(p - c, "
                          "vec3(0), vec3(0, 1, 0), 0.1).distance)"));
    ASSERT_EQ(two.families.all.size(), 2u);
    EXPECT_EQ(two.families.all[0].members + two.families.all[1].members, 40u);
    expectTablesGiveTheGroups(program);
    expectTablesGiveTheGroups(two);
}

TEST(Families, HolesAreAMaximum) {
    std::string code = "d = box(p, vec3(3)).distance;\nfor (int i = 0; i < 30; i++) {\n" + kPlace +
                       "d = max(d, -box(p - c, vec3(0.2), 0.05).distance);\n}\nreturn d;";
    const Program program = programOf(code);
    ASSERT_EQ(program.families.all.size(), 1u);
    EXPECT_EQ(program.families.groups.begin()->second.op, Op::maximum);
    expectTablesGiveTheGroups(program);
}

TEST(Families, WhatAllShareIsComputedOnce) {
    const Program program = programOf("p = vec3(0.8 * p.x + 0.6 * p.z, p.y, 0.8 * p.z - 0.6 * p.x);\n" +
                                      unionOf(30, "box(p - c, vec3(0.1), 0.02).distance"));
    ASSERT_EQ(program.families.all.size(), 1u);
    for (IrId step : program.families.all[0].steps)
        for (IrId operand : program.ir[step].operands)
            EXPECT_FALSE(program.ir.isConstant(operand, 0.6)) << "the turn belongs ahead of the loop";
    EXPECT_EQ(program.families.all[0].inputs.size(), 3u);
    EXPECT_EQ(program.families.all[0].width, kTexel);  // three numbers, and one to fill up
    expectTablesGiveTheGroups(program);
}

std::string blendOf(int count, const std::string& shape, const std::string& before,
                    const std::string& width) {
    return before + "for (int i = 0; i < " + std::to_string(count) + "; i++) {\n" + kPlace +
           "d = smooth_min(d, " + shape + ", " + width + ");\n}\nreturn d;";
}

TEST(Families, ABlendOfBallsIsAChain) {
    const Program program = programOf(blendOf(60, "length(p - c) - 0.1", "d = p.y;\n", "0.2"));
    ASSERT_EQ(program.families.all.size(), 1u);
    const Family& family = program.families.all[0];
    EXPECT_EQ(family.members, 60u);
    EXPECT_EQ(family.width, kTexel);  // a place; the radius and the width are the same in all
    ASSERT_EQ(program.families.groups.size(), 1u);
    const auto& [root, group] = *program.families.groups.begin();
    EXPECT_EQ(root, program.distance());
    EXPECT_TRUE(group.chain());
    EXPECT_EQ(group.others, std::vector<IrId>{program.ir.position(1)});
    expectTablesGiveTheGroups(program);
    expectTablesGiveTheGroups(programOf(blendOf(60, "length(p - c) - 0.1", "d = p.y;\n", "0.1 + 0.01 * i")));
}

TEST(Families, AChainIsInOrder) {
    // Runs of one kind are chains, each of which begins with the one before it.
    const Program two = programOf(
        "d = p.y;\nfor (int i = 0; i < 80; i++) {\n" + kPlace +
        "d = smooth_min(d, i < 40 ? length(p - c) - 0.1 : box(p - c, vec3(0.1), 0.02).distance, 0.2);\n}\n"
        "return d;");
    ASSERT_EQ(two.families.all.size(), 2u);
    EXPECT_EQ(two.families.groups.rbegin()->second.others,
              std::vector<IrId>{two.families.groups.begin()->first});
    expectTablesGiveTheGroups(two);
    // Where kinds take turns there is no run, and the order must not change.
    EXPECT_TRUE(programOf("d = p.y;\nfor (int i = 0; i < 80; i++) {\n" + kPlace +
                          "d = smooth_min(d, i % 2 == 0 ? length(p - c) - 0.1 : box(p - c, vec3(0.1), "
                          "0.02).distance, 0.2);\n}\nreturn d;")
                    .families.empty());
    // Holes with round edges: the chain of what is outside.
    const Program holes = programOf("d = box(p, vec3(3)).distance;\nfor (int i = 0; i < 40; i++) {\n" +
                                    kPlace + "d = smooth_max(d, -(length(p - c) - 0.2), 0.1);\n}\nreturn d;");
    ASSERT_EQ(holes.families.all.size(), 1u);
    EXPECT_EQ(holes.families.all[0].members, 40u);
    expectTablesGiveTheGroups(holes);
}

TEST(Families, NoneWhereALoopWouldNotPay) {
    EXPECT_TRUE(programOf(unionOf(6, "box(p - c, vec3(0.1), 0.02).distance")).families.empty());
    EXPECT_TRUE(programOf(unionOf(100, "p.x - c.x")).families.empty());
    EXPECT_EQ(emitField(programOf(unionOf(6, "box(p - c, vec3(0.1), 0.02).distance"))).find("FIELD_FAMILIES"),
              std::string::npos);
}

TEST(Families, LoopsAreNotNested) {
    // Thirty unions of twenty boxes: one group of six hundred, or thirty members that are each a union, never
    // both.
    const Program program = programOf(
        "d = 1000.0;\nfor (int i = 0; i < 30; i++) {\n" + kPlace +
        "e = 1000.0;\nfor (int k = 0; k < 20; k++) e = min(e, box(p - c - vec3(k * 0.11, 0.07 * k * k, 0), "
        "vec3(0.1), 0.02).distance);\nd = min(d, abs(e) - 0.01 * i);\n}\nreturn d;");
    ASSERT_FALSE(program.families.empty());
    for (const auto& [root, group] : program.families.groups)
        for (uint32_t f : group.families)
            for (IrId step : program.families.all[f].steps)
                EXPECT_FALSE(program.families.groups.contains(step));
    expectTablesGiveTheGroups(program);
}

// ---- Common forms

const std::string kTurnedBoxes =
    R"({"id": "body", "type": "expression", "code": "d = 1000.0; vec3 q = p; for (int i = 0; i < 9; i++) {
    q = vec3(0.9 * q.x + 0.4 * q.z, q.y + 0.1 * sin(q.x + i), 0.9 * q.z - 0.4 * q.x);
    d = smooth_min(d, box(q - vec3(0.2, 0.1 * i, 0.3), vec3(0.5, 0.3, 0.2), 0.05).distance, 0.2); }
    return d;"})";

Program repeated(const std::string& inputs) {
    std::string body = kTurnedBoxes;
    std::ranges::replace(body, '\n', ' ');
    return programOfNodes(body +
                          R"(, {"id": "end", "type": "repeat", "inputs": {"surface": {"from": "body"},)" +
                          inputs + "}}");
}

TEST(Families, NeighboursOfARepeatAreRows) {
    for (const char* count : {"[0, 0, 0]", "[3, 2, 5]", "[0, 3, 0]"}) {
        SCOPED_TRACE(count);
        const Program program = repeated(R"("period": [2, 2, 2], "count": )" + std::string(count));
        ASSERT_EQ(program.families.all.size(), 1u);
        EXPECT_EQ(program.families.all[0].members, 8u);
        EXPECT_EQ(program.families.listed, 0u);
        EXPECT_LT(codeWeight(program.ir, program.distance(), program.families),
                  0.4 * codeWeight(program.ir, program.distance(), {}));
        EXPECT_LT(effortByNode(program)[0].code, 0.4 * effortByNode(program)[0].sample);
        expectTablesGiveTheGroups(program);
    }
}

TEST(Families, WhatIsAheadOfTheLoopMayBeLong) {
    const std::string warp = "for (int i = 0; i < 300; i++) p = p + 0.001 * sin(p.yzx * 3.0 + i);\n";
    const Program program = programOf(warp + unionOf(30, "box(p - c, vec3(0.1), 0.02).distance"));
    ASSERT_EQ(program.families.all.size(), 1u);
    EXPECT_LT(program.families.all[0].steps.size(), 40u);
    expectTablesGiveTheGroups(program);
}

TEST(Families, ABlendMayHaveALiveWidth) {
    std::string code = blendOf(40, "length(p - c) - 0.1", "d = p.y;\n", "k");
    std::ranges::replace(code, '\n', ' ');
    const Program program = programOfNodes(
        R"({"id": "end", "type": "expression", "inputs": {"k": 0.2}, "code": ")" + code + R"("})",
        {.live = {"end.k"}});
    ASSERT_EQ(program.live.size(), 1u);
    ASSERT_EQ(program.families.all.size(), 1u);
    EXPECT_EQ(program.families.all[0].members, 40u);
    expectTablesGiveTheGroups(program);
}

TEST(Families, NumbersThatFoldInSomeMakeNoDifference) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> fraction(0.1, 2);
    const auto number = [&](std::initializer_list<const char*> special) {
        const std::size_t kind = random() % (special.size() + 1);
        return kind < special.size() ? std::string(special.begin()[kind]) : std::to_string(fraction(random));
    };
    for (int i = 0; i < 40; ++i) {
        std::string code = "d = 1000.0;\n";
        for (int member = 0; member < 24; ++member) {
            const auto place = [&](const char* axis) {
                return std::string(axis) + " * " + number({"1.0", "(-1.0)", "2.0"}) + " - " +
                       number({"0.0", "(-0.5)"});
            };
            code += "d = min(d, length(vec3(" + place("p.x") + ", " + place("p.y") + ", " + place("p.z") +
                    ")) * " + number({"1.0"}) + " + sin(" + place("p.x") + ") * " + number({"0.5"}) + ");\n";
        }
        const Program program = programOf(code + "return d;");
        ASSERT_EQ(program.families.all.size(), 1u);
        EXPECT_EQ(program.families.all[0].members, 24u);
        expectTablesGiveTheGroups(program);
    }
}

TEST(Families, WhatFoldedAwayIsRestored) {
    // At the origin no number is taken off, at unit size none multiplies, and signs turn sums around.
    const std::string members = R"(
d = 1000.0;
for (int i = 0; i < 30; i++) {
    vec3 c = vec3(mod(i, 3) - 1, mod(floor(i / 3), 3) - 1, floor(i / 9) - 1);
    float s = mod(i, 4) == 0 ? 1.0 : mod(i, 4) == 1 ? -1.0 : 0.3 * i;
    vec3 q = (mod(i, 5) == 0 ? c - p : p - c) * s;
    d = min(d, length(vec2(length(q.xz) - 0.6, q.y)) * (i == 7 ? 1.0 : 0.9) - (i == 3 ? 0.0 : 0.1));
}
return d;)";
    const Program program = programOf(members);
    ASSERT_EQ(program.families.all.size(), 1u);
    EXPECT_EQ(program.families.all[0].members, 30u);
    expectTablesGiveTheGroups(program);
}

TEST(Families, CoordinatesAreChosenAmong) {
    // The same shape along each axis: three orders of the coordinates.
    const Program program = programOf(R"(
d = 1000.0;
for (int i = 0; i < 30; i++) {
    vec3 q = mod(i, 3) == 0 ? p.xyz : mod(i, 3) == 1 ? p.yzx : p.zxy;
    d = min(d, atan2(q.x - 0.1 * i, sqrt(abs(q.y))) + sin(q.z) * 0.1 + length(vec2(q.x + i, q.z)));
}
return d;)");
    ASSERT_EQ(program.families.all.size(), 1u);
    EXPECT_EQ(program.families.all[0].members, 30u);
    expectTablesGiveTheGroups(program);
}

TEST(Families, SamplesAndRandomGraphsHaveTheValuesOfTheirTables) {
    int with = 0;
    for (const auto& entry : std::filesystem::directory_iterator(FIELDWRIGHT_SOURCE_DIR "/samples")) {
        if (!entry.path().string().ends_with(".field.json")) continue;
        SCOPED_TRACE(entry.path().filename().string());
        const Result<Graph> graph = readGraph(entry.path(), nullptr);
        ASSERT_TRUE(graph);
        CompileOptions options;
        options.bake = boxInPlace;
        const Result<Program> program = compile(*graph, options);
        ASSERT_TRUE(program);
        with += !program->families.empty();
        expectTablesGiveTheGroups(*program);
    }
    for (uint32_t seed = 0; seed < 300; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const std::optional<Program> program = test::randomProgram(seed, 40);
        if (!program) continue;
        with += !program->families.empty();
        expectTablesGiveTheGroups(*program);
    }
    RecordProperty("with", with);
}

}  // namespace fw::families_test
