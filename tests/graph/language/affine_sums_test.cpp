// Coordinates of coordinates are written out: the same values, in fewer operations, with intervals no wider.
#include "graph/ir/affine_sums.h"

#include <gtest/gtest.h>

#include <random>

#include "graph/evaluate/evaluate.h"
#include "graph/language/lower.h"

namespace fw::affine_sums_test {

struct Written {
    Ir before, after;
    IrId old = 0, now = 0;
    std::size_t saved() const { return before.size() - after.size(); }
};

Written written(const std::string& code) {
    language::Lowering state;
    state.time = state.ir.parameter(0);
    const auto value = language::lowerText(state, code);
    EXPECT_TRUE(value) << format(value.error());
    Written result;
    result.old = result.now = value->ids[0];
    result.before = state.ir.compact(std::span(&result.old, 1));
    Ir ir = result.before;
    result.now = result.old;
    writeOutAffine(ir, std::span(&result.now, 1));
    result.after = ir.compact(std::span(&result.now, 1));
    return result;
}

const std::string kTurn =
    "vec3 turn(vec3 q, float a, float b) {\n"
    "    q = vec3(cos(a) * q.x + sin(a) * q.y, cos(a) * q.y - sin(a) * q.x, q.z);\n"
    "    return vec3(q.x, cos(b) * q.y + sin(b) * q.z, cos(b) * q.z - sin(b) * q.y);\n}\n";

/// Equal values, and intervals that are within those of before.
void expectNoWider(const Written& field) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(-2.0, 2.0);
    const std::vector<double> parameters{0.7};
    for (int i = 0; i < 200; ++i) {
        const Point p{unit(random), unit(random), unit(random)};
        const double value = evaluate(field.before, field.old, parameters, p);
        EXPECT_NEAR(evaluate(field.after, field.now, parameters, p), value, 1e-12);
        Box box{p, p};
        for (double& side : box.hi) side += std::abs(unit(random));
        const Interval old = evaluateInterval(field.before, field.old, parameters, box);
        const Interval now = evaluateInterval(field.after, field.now, parameters, box);
        EXPECT_GE(now.lo, old.lo - 1e-12);
        EXPECT_LE(now.hi, old.hi + 1e-12);
    }
}

TEST(AffineSums, TurnsOfTurnsAreOneTurn) {
    const std::string shape = "return length(max(abs(q) - vec3(1, 0.5, 0.2), vec3(0))) - 0.1;";
    const Written once = written(kTurn + "q = turn(p, 0.3, 0.4) - vec3(1, 2, 3);\n" + shape);
    const Written thrice =
        written(kTurn +
                "q = turn(p, 0.3, 0.4) - vec3(1, 2, 3);\nq = turn(q * 2, 1, 0.2) + vec3(1, "
                "0, 0);\nq = turn(q, 0.1, 0.5);\n" +
                shape);
    EXPECT_GT(thrice.saved(), 20u);
    EXPECT_LE(thrice.after.size(), once.after.size() + 9);  // terms and numbers that one turn leaves out
    expectNoWider(once);
    expectNoWider(thrice);
    const Box box{{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}};
    const Interval wide = evaluateInterval(thrice.before, thrice.old, {}, box),
                   tight = evaluateInterval(thrice.after, thrice.now, {}, box);
    EXPECT_LT(tight.hi - tight.lo, 0.7 * (wide.hi - wide.lo));
}

TEST(AffineSums, ATurnAndBackIsNone) {
    const Written field = written(
        "q = vec3(0.6 * p.x + 0.8 * p.y, 0.6 * p.y - 0.8 * p.x, p.z);\n"
        "q = vec3(0.6 * q.x - 0.8 * q.y, 0.6 * q.y + 0.8 * q.x, q.z);\nreturn abs(q.x) - sqrt(q.y);");
    EXPECT_EQ(field.after.text(std::span(&field.now, 1)),
              "%0 = x\n%1 = y\n%2 = z\n%3 = abs %0\n%4 = sqrt %1\n%5 = subtract %3 %4\nreturn %5\n");
}

TEST(AffineSums, WhatIsSharedStaysShared) {
    const std::string code = kTurn +
                             "q = turn(p, 0.3, 0.4);\nd = 100.0;\nfor (int i = 0; i < 20; i++) d = min(d, "
                             "length(q - vec3(i, i * i, 3)));"
                             "\nreturn d;";
    const Written field = written(code);
    EXPECT_GE(field.before.size(), field.after.size());
    expectNoWider(field);
}

TEST(AffineSums, WhatIsSampledStaysThat) {
    Written field;
    Ir& ir = field.before;
    const auto turned = [&](double by) {
        std::array<IrId, 2> q{ir.position(0), ir.position(1)};
        for (int i = 0; i < 3; ++i) {
            const auto times = [&](IrId a, double factor) {
                return ir.add(Op::multiply, a, ir.constant(factor));
            };
            q = {ir.add(Op::add, times(q[0], std::cos(by)), times(q[1], std::sin(by))),
                 ir.add(Op::subtract, times(q[1], std::cos(by)), times(q[0], std::sin(by)))};
        }
        return q;
    };
    const auto a = turned(0.3), b = turned(0.4), c = turned(0.5);
    const uint32_t square =
        ir.addOutline(outlineThrough(std::array{-1.0, -1.0, 1.0, -1.0, 1.0, 1.0, -1.0, 1.0}));
    const uint32_t other = ir.addOutline(outlineThrough(std::array{0.0, 0.0, 0.5, 0.0, 0.5, 0.7}));
    const uint32_t image = ir.addImage(plainImage());
    field.old = ir.add(Op::add, ir.add(Op::add, ir.sample(square, a[0], a[1]), ir.sample(other, b[0], b[1])),
                       ir.sample(image, kGreyLayer, c[0], c[1]));
    Ir work = ir;
    field.now = field.old;
    writeOutAffine(work, std::span(&field.now, 1));
    field.after = work.compact(std::span(&field.now, 1));
    EXPECT_GT(field.saved(), 6u);
    expectNoWider(field);
}

TEST(AffineSums, WhatIsLiveOrNotAffineStays) {
    for (const char* code :
         {"return abs(p.x * cos(time) - p.y * sin(time));", "return sin(p.x) + p.y * p.z - 1;",
          "return abs(p.x * 2 - 1) + abs(p.y + p.z);", "return p.x;", "return 3;"}) {
        const Written field = written(code);
        EXPECT_EQ(field.after.hash(std::span(&field.now, 1)), field.before.hash(std::span(&field.old, 1)))
            << code;
    }
}

}  // namespace fw::affine_sums_test
