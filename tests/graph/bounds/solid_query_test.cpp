// Bounds of level sets: found, empty, or not known.
#include "graph/compile/solid_query.h"

#include <gtest/gtest.h>

#include <string>

#include "graph/bounds/region.h"
#include "tests/support/graph/code_field.h"

namespace fw::solid_query_test {

using Field = test::CodeField;
using test::fieldOfCode;

TEST(SolidQuery, LevelBounds) {
    const Field ball = fieldOfCode("return sphere(p, 1);");
    const auto found = levelBounds(ball.ir, ball.distance, 1.0);
    ASSERT_TRUE(found);
    EXPECT_LE(found->lo[0], -2.0);
    EXPECT_NEAR(longestSide(*found), 4.0, 0.1);
    const auto empty = levelBounds(ball.ir, ball.distance, -2.0);
    ASSERT_TRUE(empty);
    EXPECT_GT(empty->lo[0], empty->hi[0]);
    const Field plane = fieldOfCode("return p.y;");
    EXPECT_FALSE(levelBounds(plane.ir, plane.distance, 0.0));
}

TEST(SolidQuery, BoundsThatAreNotProven) {
    // Far away there is solid only near the crossings of three surfaces, which no sample hits.
    const Field field = fieldOfCode("return sphere(p * sin(p.yzx), 1);");
    ASSERT_EQ(findRegion(field.ir, field.distance, {}).extent, Extent::unproven);
    EXPECT_FALSE(levelBounds(field.ir, field.distance, 0.0));
    EXPECT_EQ(solidBounds(field.ir, field.distance, {}), cubeAround(64.0));
}

}  // namespace fw::solid_query_test
