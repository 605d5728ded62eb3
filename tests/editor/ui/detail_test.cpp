// What pictures give up to come soon.
#include "editor/preview/detail.h"

#include <gtest/gtest.h>

namespace fw::editor::detail_test {

/// After so many pictures that took so long each.
HeldDetail after(HeldDetail now, int pictures, double took) {
    for (int i = 0; i < pictures; ++i) now = adapted(now, took, 128);
    return now;
}

TEST(Detail, PixelsGoFirstThenCellsAndComeBackTheOtherWayRound) {
    const HeldDetail slow = after({}, 2, 80.0);
    EXPECT_LT(slow.scale, 0.8);
    EXPECT_EQ(slow.cells, 0);
    const HeldDetail slower = after(slow, 20, 80.0);
    EXPECT_EQ(slower, (HeldDetail{0.5, 48}));
    EXPECT_EQ(after(slower, 20, 30.0), slower) << "what is soon enough stays";
    const HeldDetail better = after(slower, 5, 5.0);
    EXPECT_EQ(better.cells, 128);
    EXPECT_EQ(after(better, 20, 5.0).scale, 1.0);
}

TEST(Detail, TheFirstMeshOfALargeFieldHasFewCells) {
    EXPECT_EQ(firstCells(128, 0.0), 128);
    EXPECT_EQ(firstCells(128, 0.7), 128) << "half of it would be no great gain";
    EXPECT_EQ(firstCells(128, 1.6), 64);
    EXPECT_EQ(firstCells(128, 1000.0), 48);
    EXPECT_EQ(firstCells(40, 1000.0), 40) << "never more than were asked for";
}

}  // namespace fw::editor::detail_test
