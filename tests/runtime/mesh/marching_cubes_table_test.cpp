// The derived table: every pattern, and every pair of patterns that share a face.
#include "runtime/mesher/marching_cubes_table.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

namespace fw::marching_cubes_table_test {

bool inside(int pattern, glm::uvec3 corner) {
    return pattern >> (corner.x + 2 * corner.y + 4 * corner.z) & 1;
}

bool crossed(int pattern, int edge) {
    CellEdge e = cellEdge(edge);
    glm::uvec3 other = e.corner;
    other[e.axis] += 1;
    return inside(pattern, e.corner) != inside(pattern, other);
}

/// The middle of an edge in half cells: exact, and the same for the two cells that share the edge.
using Point = std::array<int, 3>;
Point middle(int edge, Point cell = {0, 0, 0}) {
    CellEdge e = cellEdge(edge);
    Point p;
    for (int i = 0; i < 3; ++i) p[i] = 2 * (cell[i] + int(e.corner[i])) + (i == e.axis);
    return p;
}

using Segment = std::pair<Point, Point>;

/// Directed edges of the fans of a pattern, with their multiplicity.
std::map<Segment, int> fanEdges(int pattern, Point cell = {0, 0, 0}) {
    std::map<Segment, int> edges;
    for (const CellPolygon& polygon : cellPolygons(pattern)) {
        for (std::size_t i = 2; i < polygon.size(); ++i) {
            Point a = middle(polygon[0], cell), b = middle(polygon[i - 1], cell),
                  c = middle(polygon[i], cell);
            ++edges[{a, b}], ++edges[{b, c}], ++edges[{c, a}];
        }
    }
    return edges;
}

TEST(MarchingCubesTable, EveryCrossedEdgeHasOneVertexInOnePolygon) {
    for (int pattern = 0; pattern < 256; ++pattern) {
        std::multiset<int> used;
        for (const CellPolygon& polygon : cellPolygons(pattern)) {
            EXPECT_GE(polygon.size(), 3u);
            used.insert(polygon.begin(), polygon.end());
        }
        for (int edge = 0; edge < 12; ++edge) EXPECT_EQ(used.count(edge), crossed(pattern, edge)) << pattern;
    }
}

TEST(MarchingCubesTable, FansAreOrientedAndOpenOnlyOnFacesOfTheCell) {
    for (int pattern = 0; pattern < 256; ++pattern) {
        std::map<Segment, int> edges = fanEdges(pattern);
        for (const auto& [segment, times] : edges) {
            EXPECT_EQ(times, 1) << "pattern " << pattern << " runs an edge twice in one direction";
            bool inFace = false;
            for (int axis = 0; axis < 3; ++axis)
                inFace |= segment.first[axis] == segment.second[axis] && segment.first[axis] % 2 == 0;
            // A line in a face is the cell's border and belongs to one triangle, one across the cell to two.
            EXPECT_EQ(edges.count({segment.second, segment.first}), inFace ? 0u : 1u) << pattern;
        }
    }
}

TEST(MarchingCubesTable, TrianglesTurnTowardsTheOutside) {
    // A single inside corner: the polygon's normal points away from it.
    for (int corner = 0; corner < 8; ++corner) {
        ASSERT_EQ(cellPolygons(1 << corner).size(), 1u);
        const CellPolygon& polygon = cellPolygons(1 << corner)[0];
        ASSERT_EQ(polygon.size(), 3u);
        Point a = middle(polygon[0]), b = middle(polygon[1]), c = middle(polygon[2]);
        int u[3], v[3];
        for (int i = 0; i < 3; ++i) u[i] = b[i] - a[i], v[i] = c[i] - a[i];
        int normal[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
        for (int i = 0; i < 3; ++i) EXPECT_EQ(normal[i] > 0, (corner >> i & 1) == 0) << corner;
    }
}

TEST(MarchingCubesTable, AllPairsAcrossAFaceMeetWithoutGapOrFlip) {
    // Twelve corners, two cells side by side along each axis: what they draw in the shared face must cancel.
    for (int axis = 0; axis < 3; ++axis) {
        for (int signs = 0; signs < 4096; ++signs) {
            auto patternAt = [&](int offset) {
                int pattern = 0;
                for (int corner = 0; corner < 8; ++corner) {
                    int along = (corner >> axis & 1) + offset;
                    int across = (corner >> (axis + 1) % 3 & 1) + 2 * (corner >> (axis + 2) % 3 & 1);
                    pattern |= (signs >> (along * 4 + across) & 1) << corner;
                }
                return pattern;
            };
            Point second = {0, 0, 0};
            second[axis] = 1;
            std::map<Segment, int> edges = fanEdges(patternAt(0));
            for (const auto& [segment, times] : fanEdges(patternAt(1), second)) edges[segment] += times;
            for (const auto& [segment, times] : edges) {
                ASSERT_EQ(times, 1) << "axis " << axis << " signs " << signs;
                if (segment.first[axis] != 2 || segment.second[axis] != 2) continue;
                ASSERT_TRUE(edges.count({segment.second, segment.first}))
                    << "axis " << axis << " signs " << signs;
            }
        }
    }
}

TEST(MarchingCubesTable, PackedTableHoldsTheSame) {
    for (int pattern = 0; pattern < 256; ++pattern) {
        glm::uvec3 packed = packedCellPolygons()[pattern];
        std::size_t at = 0, all = 0;
        for (const CellPolygon& polygon : cellPolygons(pattern)) all += polygon.size();
        for (const CellPolygon& polygon : cellPolygons(pattern)) {
            for (std::size_t i = 0; i < polygon.size(); ++i, ++at) {
                uint32_t code = packed[int(at / 4)] >> at % 4 * 8 & 255;
                CellEdge edge = cellEdge(polygon[i]);
                EXPECT_EQ(code >> 5 & 1, edge.corner.x);
                EXPECT_EQ(code & 1, edge.corner.y);
                EXPECT_EQ(code >> 2 & 1, edge.corner.z);
                EXPECT_EQ(int(code >> 3 & 3), edge.axis);
                EXPECT_EQ((code & 64) != 0, i == 0);
                EXPECT_EQ((code & 128) != 0, at + 1 == all);
            }
        }
    }
}

TEST(MarchingCubesTable, PackedPatchesAreThePolygonsOneByOne) {
    int twice = 0;
    for (int pattern = 0; pattern < 256; ++pattern) {
        const std::vector<CellPolygon>& polygons = cellPolygons(pattern);
        ASSERT_LE(polygons.size(), std::size_t(kMostCellPolygons));
        for (std::size_t n = 0; n < std::size_t(kMostCellPolygons); ++n) {
            const glm::uvec3 packed = packedCellPatches()[std::size_t(pattern * kMostCellPolygons) + n];
            if (n >= polygons.size()) {
                EXPECT_EQ(packed, glm::uvec3(0));
                continue;
            }
            EXPECT_NE(packed.x, 0u);
            const CellPolygon& polygon = polygons[n];
            for (std::size_t i = 0; i < polygon.size(); ++i) {
                const uint32_t code = packed[int(i / 4)] >> i % 4 * 8 & 255;
                const CellEdge edge = cellEdge(polygon[i]);
                EXPECT_EQ(code >> 5 & 1, edge.corner.x);
                EXPECT_EQ(code & 1, edge.corner.y);
                EXPECT_EQ(code >> 2 & 1, edge.corner.z);
                EXPECT_EQ(int(code >> 3 & 3), edge.axis);
                EXPECT_EQ((code & 128) != 0, i + 1 == polygon.size());
                // A face is run over twice if all four of its edges belong to the polygon.
                const int others[2] = {edge.axis == 0 ? 1 : 0, edge.axis == 2 ? 1 : 2};
                for (int k = 0; k < 2; ++k) {
                    int onFace = 0;
                    for (const uint8_t other : polygon) {
                        const CellEdge at = cellEdge(other);
                        onFace += at.axis != others[k] && at.corner[others[k]] == edge.corner[others[k]];
                    }
                    EXPECT_EQ((code & (k == 0 ? 2u : 64u)) != 0, onFace == 4);
                    twice += onFace == 4;
                }
            }
        }
    }
    EXPECT_GT(twice, 0);
}

}  // namespace fw::marching_cubes_table_test
