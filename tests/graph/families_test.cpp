// Families: what is found alike in the IR, and that the table has the members' numbers.
#include "graph/ir/families.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "graph/compile/compile.h"
#include "graph/emit/glsl.h"
#include "tests/support/graph/expression_graph.h"

namespace fw {
namespace {

Program programOf(const std::string& code) {
    Result<Program> program = compile(test::expressionGraph(code));
    if (!program) throw std::runtime_error(format(program.error()));
    return std::move(*program);
}

const std::string kPlace =
    "c = vec3(hash(vec3(i, 1, 0), 1), hash(vec3(i, 2, 0), 1), hash(vec3(i, 3, 0), 1)) * 4;\n";

std::string unionOf(int count, const std::string& shape, const std::string& before = "d = 1000.0;\n") {
    return before + "for (int i = 0; i < " + std::to_string(count) + "; i++) {\n" + kPlace + "d = min(d, " +
           shape + ");\n}\nreturn d;";
}

/// The family's member in that row by its steps and numbers, at a point.
double memberAt(const Ir& ir, const Family& family, uint32_t row, const std::vector<double>& values) {
    std::vector<double> own = values;
    for (IrId step : family.steps) {
        double operands[kMaxArity] = {};
        for (int i = 0; i < opInfo(ir[step].op).arity; ++i) {
            const IrId operand = ir[step].operands[i];
            const auto column = family.columns.find({step, i});
            operands[i] = column != family.columns.end()
                              ? double(family.table[row * family.width + column->second])
                          : ir.isConstant(operand) ? ir.number(operand)
                                                   : own[operand];
        }
        own[step] = opInfo(ir[step].op).value(operands, ir.layer(ir[step]));
    }
    return own[family.steps.back()];
}

/// Folds all groups from tables and compares with the IR's own values.
void expectTablesGiveTheGroups(const Program& program) {
    const std::vector<Point> points = {{0.3, 0.2, 0.1}, {-1.5, 0.7, 2.0}, {3.1, -0.4, 1.2}, {0, 0, 0}};
    const std::vector<double> parameters = program.parameters();
    for (const Point& point : points) {
        std::vector<double> values(point.begin(), point.end());
        for (IrId id = 3; id < program.ir.size(); ++id) {
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
                    const auto column = family.columns.find({family.link, 2});
                    const double operands[kMaxArity] = {
                        chain, memberAt(program.ir, family, row, values),
                        column != family.columns.end()
                            ? double(family.table[row * family.width + column->second])
                            : program.ir.number(program.ir[family.link].operands[2])};
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
            for (uint32_t f : group.families)
                for (uint32_t row = 0; row < program.families.all[f].members; ++row)
                    offer(memberAt(program.ir, program.families.all[f], row, values));
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

}  // namespace
}  // namespace fw
