// Which maps of the position are affine, and what they are.
#include "graph/evaluate/affine.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <random>

#include "graph/evaluate/evaluate.h"
#include "graph/language/lower.h"

namespace fw::affine_test {

struct Lowered {
    Ir ir;
    std::array<IrId, 3> values{};
};

Lowered lowered(const std::string& code) {
    Lowered made;
    language::Lowering state;
    state.time = state.ir.parameter(0);
    const auto value = language::lowerText(state, code);
    EXPECT_TRUE(value) << format(value.error());
    for (std::size_t i = 0; i < 3; ++i) made.values[i] = value->ids[i];
    made.ir = state.ir.compact(made.values);
    return made;
}

TEST(Affine, IsWhatTheValuesAre) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-2.0, 2.0);
    const std::vector<double> parameters{0.7};
    for (const char* code : {
             "return p;",
             "return p - vec3(1, 2, 3);",
             "return -(p + vec3(0, 1, 0)) / 4;",
             "return vec3(p.y * 2, p.z - p.x, p.x);",
             "return vec3(p.x * cos(time) - p.y * sin(time), p.x * sin(time) + p.y * cos(time), p.z + time);",
             "return time > 0.5 ? p * time : p / time;",
         }) {
        SCOPED_TRACE(code);
        const Lowered map = lowered(code);
        const std::optional<Affine> found = affineOf(map.ir, map.values, parameters);
        ASSERT_TRUE(found);
        const Affine back = inverse(*found);
        for (int i = 0; i < 20; ++i) {
            const glm::dvec3 p(unit(random), unit(random), unit(random));
            const glm::dvec3 q = found->linear * p + found->offset, again = back.linear * q + back.offset;
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_NEAR(q[axis],
                            evaluate(map.ir, map.values[std::size_t(axis)], parameters, {p.x, p.y, p.z}),
                            1e-12);
                EXPECT_NEAR(again[axis], p[axis], 1e-12);
            }
        }
    }
}

TEST(Affine, OthersAreNone) {
    for (const char* code : {
             "return abs(p);",
             "return mod(p, 2.0);",
             "return vec3(p.x * p.y, p.y, p.z);",
             "return vec3(1 / p.x, p.y, p.z);",
             "return p.x > 0 ? p : p * 2;",
             "return vec3(p.x, p.x, p.z);",  // without an inverse
             "return p * time;",
         }) {
        SCOPED_TRACE(code);
        const Lowered map = lowered(code);
        EXPECT_FALSE(affineOf(map.ir, map.values, std::vector<double>{0.0}));
    }
}

TEST(Affine, OfManyTurnsOneAfterTheOther) {
    std::string code = "vec3 q = p;\n";
    for (int i = 0; i < 60; ++i) code += "q = vec3(q.x * 0.6 - q.y * 0.8, q.x * 0.8 + q.y * 0.6, q.z);\n";
    const Lowered map = lowered(code + "return q;");
    const std::optional<Affine> found = affineOf(map.ir, map.values, std::vector<double>{0.0});
    ASSERT_TRUE(found);
    EXPECT_NEAR(glm::length(found->linear * glm::dvec3(1, 0, 0)), 1.0, 1e-9);
}

}  // namespace fw::affine_test
