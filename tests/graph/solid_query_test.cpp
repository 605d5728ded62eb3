// Bounds of level sets: found, empty, or not known.
#include "graph/compile/solid_query.h"

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "graph/bounds/region.h"
#include "graph/language/lower.h"

namespace fw::solid_query_test {

struct Field {
    Ir ir;
    IrId distance;
};

Field fieldOf(const std::string& code) {
    language::Lowering state;
    state.time = state.ir.constant(0.0);
    const auto value = language::lowerText(state, code);
    EXPECT_TRUE(value) << format(value.error());
    std::array<IrId, 1> root{value->ids[0]};
    Ir ir = state.ir.compact(root);
    return {std::move(ir), root[0]};
}

TEST(SolidQuery, LevelBounds) {
    const Field ball = fieldOf("return sphere(p, 1);");
    const auto found = levelBounds(ball.ir, ball.distance, 1.0);
    ASSERT_TRUE(found);
    EXPECT_LE(found->lo[0], -2.0);
    EXPECT_NEAR(longestSide(*found), 4.0, 0.1);
    const auto empty = levelBounds(ball.ir, ball.distance, -2.0);
    ASSERT_TRUE(empty);
    EXPECT_GT(empty->lo[0], empty->hi[0]);
    const Field plane = fieldOf("return p.y;");
    EXPECT_FALSE(levelBounds(plane.ir, plane.distance, 0.0));
}

TEST(SolidQuery, BoundsThatAreNotProven) {
    // Far away there is solid only near the crossings of three surfaces, which no sample hits.
    const Field field = fieldOf("return sphere(p * sin(p.yzx), 1);");
    ASSERT_EQ(findRegion(field.ir, field.distance, {}).extent, Extent::unproven);
    EXPECT_FALSE(levelBounds(field.ir, field.distance, 0.0));
    EXPECT_EQ(solidBounds(field.ir, field.distance, {}), cubeAround(64.0));
}

}  // namespace fw::solid_query_test
