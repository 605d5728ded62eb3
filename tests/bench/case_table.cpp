#include "tests/bench/case_table.h"

#include <cassert>
#include <utility>
#include <vector>

namespace fw::bench {
namespace {

/// The edge between two corners that differ in one coordinate.
CellEdge edgeBetween(int a, int b) {
    const int low = a & b, difference = a ^ b;
    return {uint8_t(low & 1), uint8_t(low >> 1 & 1), uint8_t(low >> 2), uint8_t(difference >> 1)};
}

int edgeNumber(CellEdge edge) { return edge.axis * 8 + (edge.x | edge.y << 1 | edge.z << 2); }

/// Whether one face of the cell holds both edges.
bool shareFace(CellEdge a, CellEdge b) {
    const bool x = a.axis != 0 && b.axis != 0 && a.x == b.x;
    const bool y = a.axis != 1 && b.axis != 1 && a.y == b.y;
    const bool z = a.axis != 2 && b.axis != 2 && a.z == b.z;
    return x || y || z;
}

/// Where in a loop a fan of triangles may start. A diagonal within a face of the cell is not allowed: the
/// neighbour may draw the same one, and four triangles would share it.
std::size_t fanApex(const std::vector<CellEdge>& loop) {
    const std::size_t n = loop.size();
    for (std::size_t apex = 0; apex < n; apex++) {
        bool allowed = true;
        for (std::size_t i = 2; i + 1 < n; i++)
            allowed = allowed && !shareFace(loop[apex], loop[(apex + i) % n]);
        if (allowed) return apex;
    }
    assert(!"every loop of a cell has an apex");
    return 0;
}

Case deriveCase(int pattern) {
    const auto inside = [&](int corner) { return (pattern >> corner & 1) != 0; };
    // Where a loop goes on from an edge; every cut edge is left once, through one of its two faces.
    std::array<int, 24> next;
    std::array<CellEdge, 24> edges;
    next.fill(-1);
    for (int axis = 0; axis < 3; axis++) {
        for (int high = 0; high < 2; high++) {
            // The face's corners, counter-clockwise seen from outside the cell.
            const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3, base = high << axis;
            const int ring[4] = {base, base | (high ? u : v), base | u | v, base | (high ? v : u)};
            for (int i = 0; i < 4; i++) {
                if (inside(ring[i]) || !inside(ring[(i + 1) % 4])) continue;
                // A run of inside corners begins after ring[i]: cut it off with one segment.
                int last = i + 1;
                while (inside(ring[(last + 1) % 4])) last++;
                const CellEdge entry = edgeBetween(ring[i], ring[(i + 1) % 4]);
                const CellEdge exit = edgeBetween(ring[last % 4], ring[(last + 1) % 4]);
                edges[edgeNumber(entry)] = entry;
                next[edgeNumber(entry)] = edgeNumber(exit);
            }
        }
    }
    Case result;
    for (int first = 0; first < 24; first++) {
        if (next[first] < 0) continue;
        std::vector<CellEdge> loop;
        for (int edge = first; next[edge] >= 0;) {
            loop.push_back(edges[edge]);
            edge = std::exchange(next[edge], -1);
        }
        const std::size_t n = loop.size(), apex = fanApex(loop);
        for (std::size_t i = 1; i + 1 < n; i++) {
            for (std::size_t k : {apex, apex + i, apex + i + 1})
                result.edges.at(result.count++) = loop[k % n];
        }
    }
    return result;
}

}  // namespace

const std::array<Case, 256>& caseTable() {
    static const std::array<Case, 256> table = [] {
        std::array<Case, 256> cases;
        for (int pattern = 0; pattern < 256; pattern++) cases[pattern] = deriveCase(pattern);
        return cases;
    }();
    return table;
}

}  // namespace fw::bench
