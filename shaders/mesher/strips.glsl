// From the signs of two planes to active edges, active cells and the number of triangles, 32 cells at a time.
//
// A strip is four columns of eight cells: bit (x & 3) * 8 + y. A plane has two of them, x < 4 and x >= 4. All below is
// bit-parallel over the cells of a strip.

layout(binding = 7, scalar) readonly buffer Planes { uvec3 planes[]; };

/// Signs of the samples of a plane at (x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1) of each cell of both strips.
struct PlaneSigns {
    uvec2 at, x, y, xy;
};

/// Puts bit i of the low four bits into bit 7 of byte i.
uint spreadToTop(uint bits) { return ((bits & 1) << 7) | ((bits & 2) << 14) | ((bits & 4) << 21) | ((bits & 8) << 28); }

PlaneSigns planeSigns(uvec3 plane) {
    uint columnEight = plane.z & 511, rowEight = plane.z >> 9;
    PlaneSigns s;
    s.at = plane.xy;
    s.x = uvec2(plane.x >> 8 | plane.y << 24, plane.y >> 8 | columnEight << 24);
    s.y = (s.at >> 1 & 0x7f7f7f7fu) | uvec2(spreadToTop(rowEight), spreadToTop(rowEight >> 4));
    s.xy = (s.x >> 1 & 0x7f7f7f7fu) | uvec2(spreadToTop(rowEight >> 1), spreadToTop(rowEight >> 5));
    return s;
}

/// Edges of the brick's own cells from (x, y, z) along each axis that cross the surface, for both strips of a plane.
struct ActiveEdges {
    uvec2 x, y, z;
};
ActiveEdges activeEdges(PlaneSigns a, PlaneSigns b) { return ActiveEdges(a.at ^ a.x, a.at ^ a.y, a.at ^ b.at); }

uvec2 activeCells(PlaneSigns a, PlaneSigns b) {
    return (a.at | a.x | a.y | a.xy | b.at | b.x | b.y | b.xy) & ~(a.at & a.x & a.y & a.xy & b.at & b.x & b.y & b.xy);
}

/// Inside corners none of whose three neighbours is inside.
uvec2 lonely(uvec2 corner, uvec2 n0, uvec2 n1, uvec2 n2) { return corner & ~(n0 | n1 | n2); }

/// Number of triangles in each strip. A cell whose edges cross the surface e times in c closed loops has e - 2 c
/// triangles. Loops are counted by the regions that they part on the cell's boundary, a sphere: c = inside regions +
/// outside regions - 1. Inside corners join along edges only: a region is a lonely corner, or there is one of several
/// corners, or two of those, which are then opposite edges. Outside corners join across faces too, so that there
/// is one region unless just two opposite corners are outside. (The table has the same by construction, a test compares.)
uvec2 triangleCount(PlaneSigns a, PlaneSigns b) {
    uvec2 lonely0 = lonely(a.at, a.x, a.y, b.at), lonely1 = lonely(a.x, a.at, a.xy, b.x);
    uvec2 lonely2 = lonely(a.y, a.at, a.xy, b.y), lonely3 = lonely(a.xy, a.x, a.y, b.xy);
    uvec2 lonely4 = lonely(b.at, b.x, b.y, a.at), lonely5 = lonely(b.x, b.at, b.xy, a.x);
    uvec2 lonely6 = lonely(b.y, b.at, b.xy, a.y), lonely7 = lonely(b.xy, b.x, b.y, a.xy);
    uvec2 anyInside = a.at | a.x | a.y | a.xy | b.at | b.x | b.y | b.xy;
    uvec2 allInside = a.at & a.x & a.y & a.xy & b.at & b.x & b.y & b.xy;
    uvec2 joined = (a.at & ~lonely0) | (a.x & ~lonely1) | (a.y & ~lonely2) | (a.xy & ~lonely3) | (b.at & ~lonely4) |
                   (b.x & ~lonely5) | (b.y & ~lonely6) | (b.xy & ~lonely7);
    // Two opposite edges: both ends of each inside, the other four corners outside.
    uvec2 ax = a.at & a.x, ax1 = a.y & a.xy, bx = b.at & b.x, bx1 = b.y & b.xy;
    uvec2 nax = ~(a.at | a.x), nax1 = ~(a.y | a.xy), nbx = ~(b.at | b.x), nbx1 = ~(b.y | b.xy);
    uvec2 opposite = (ax & bx1 & nax1 & nbx) | (ax1 & bx & nax & nbx1);
    uvec2 ay = a.at & a.y, ay1 = a.x & a.xy, by = b.at & b.y, by1 = b.x & b.xy;
    uvec2 nay = ~(a.at | a.y), nay1 = ~(a.x | a.xy), nby = ~(b.at | b.y), nby1 = ~(b.x | b.xy);
    opposite |= (ay & by1 & nay1 & nby) | (ay1 & by & nay & nby1);
    uvec2 az = a.at & b.at, az3 = a.xy & b.xy, az1 = a.x & b.x, az2 = a.y & b.y;
    uvec2 naz = ~(a.at | b.at), naz3 = ~(a.xy | b.xy), naz1 = ~(a.x | b.x), naz2 = ~(a.y | b.y);
    opposite |= (az & az3 & naz1 & naz2) | (az1 & az2 & naz & naz3);
    // Two opposite corners outside, all others inside.
    uvec2 holes = (~a.at & a.x & ax1 & bx & b.y & ~b.xy) | (a.at & ~a.x & ax1 & bx & ~b.y & b.xy) |
                  (ax & ~a.y & a.xy & b.at & ~b.x & bx1) | (ax & a.y & ~a.xy & ~b.at & b.x & bx1);
    uvec2 loops = uvec2(bitCount(lonely0)) + bitCount(lonely1) + bitCount(lonely2) + bitCount(lonely3) +
                  bitCount(lonely4) + bitCount(lonely5) + bitCount(lonely6) + bitCount(lonely7) + bitCount(joined) +
                  bitCount(opposite) + bitCount(holes) - bitCount(allInside);
    uvec2 edges = uvec2(bitCount(a.at ^ a.x)) + bitCount(a.y ^ a.xy) + bitCount(b.at ^ b.x) + bitCount(b.y ^ b.xy) +
                  bitCount(a.at ^ a.y) + bitCount(a.x ^ a.xy) + bitCount(b.at ^ b.y) + bitCount(b.x ^ b.xy) +
                  bitCount(a.at ^ b.at) + bitCount(a.x ^ b.x) + bitCount(a.y ^ b.y) + bitCount(a.xy ^ b.xy);
    return edges - 2 * loops;
}
