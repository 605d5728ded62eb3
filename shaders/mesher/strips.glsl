// From the signs of two planes to active edges, active cells and the number of triangles, 32 cells at a time.
//
// A strip is four columns of eight cells: bit (x & 3) * 8 + y. A plane has two of them, x < 4 and x >= 4. All below is
// bit-parallel over the cells of a strip.

layout(binding = MESHER_AT_PLANES, scalar) readonly buffer Planes { uvec3 planes[]; };  // sample.comp tells what the words hold

/// Signs of the samples of a plane at (x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1) of each cell of a strip.
struct StripSigns {
    uint at, x, y, xy;
};

/// Puts bit i of the low four bits into bit 7 of byte i.
uint spreadToTop(uint bits) { return ((bits & 1) << 7) | ((bits & 2) << 14) | ((bits & 4) << 21) | ((bits & 8) << 28); }

StripSigns stripSigns(uvec3 plane, uint strip) {
    uint columnFive = strip == 0 ? plane.y : plane.z;  // its low byte
    uint rowEight = plane.z >> (9 + 4 * strip);
    StripSigns s;
    s.at = strip == 0 ? plane.x : plane.y;
    s.x = s.at >> 8 | columnFive << 24;
    s.y = (s.at >> 1 & 0x7f7f7f7fu) | spreadToTop(rowEight);
    s.xy = (s.x >> 1 & 0x7f7f7f7fu) | spreadToTop(rowEight >> 1);
    return s;
}

/// Edges from (x, y, z) along each axis that cross the surface.
uvec3 activeEdges(StripSigns a, StripSigns b) { return uvec3(a.at ^ a.x, a.at ^ a.y, a.at ^ b.at); }

uint activeCells(StripSigns a, StripSigns b) {
    return (a.at | a.x | a.y | a.xy | b.at | b.x | b.y | b.xy) & ~(a.at & a.x & a.y & a.xy & b.at & b.x & b.y & b.xy);
}

/// Which corners of one cell are inside, by bits: marching_cubes_table.h numbers them.
uint cornerPattern(StripSigns a, StripSigns b, uint bit) {
    return (a.at >> bit & 1) | (a.x >> bit & 1) << 1 | (a.y >> bit & 1) << 2 | (a.xy >> bit & 1) << 3 |
           (b.at >> bit & 1) << 4 | (b.x >> bit & 1) << 5 | (b.y >> bit & 1) << 6 | (b.xy >> bit & 1) << 7;
}

/// Two edges across a cell from each other, both ends of each inside and the other four corners outside.
uint opposite(uint p, uint q, uint r, uint s, uint t, uint u, uint v, uint w) {
    return (p & q & r & s & ~(t | u | v | w)) | (t & u & v & w & ~(p | q | r | s));
}

/// Sum of three bits in each place: (its low bit, its high bit). Counting by adders first leaves few words to
/// count the bits of, which is dear where it is not one instruction.
uvec2 add(uint a, uint b, uint c) {
    uint either = a ^ b;
    return uvec2(either ^ c, (a & b) | (either & c));
}

/// Number of closed loops in which the edges of a strip's cells cross the surface. Loops are counted by the regions that they part on the cell's boundary, a sphere: c = inside regions +
/// outside regions - 1. Inside corners join along edges only: a region is a lonely corner, or there is one of several
/// corners, or two of those, which are then opposite edges. Outside corners join across faces too, so that there
/// is one region unless just two opposite corners are outside. (The table has the same by construction, a test compares.)
uint loopCount(StripSigns a, StripSigns b) {
    uint lonely0 = a.at & ~(a.x | a.y | b.at), lonely1 = a.x & ~(a.at | a.xy | b.x);
    uint lonely2 = a.y & ~(a.at | a.xy | b.y), lonely3 = a.xy & ~(a.x | a.y | b.xy);
    uint lonely4 = b.at & ~(b.x | b.y | a.at), lonely5 = b.x & ~(b.at | b.xy | a.x);
    uint lonely6 = b.y & ~(b.at | b.xy | a.y), lonely7 = b.xy & ~(b.x | b.y | a.xy);
    uint everyCorner = a.at & a.x & a.y & a.xy & b.at & b.x & b.y & b.xy;
    uint joined = (a.at & ~lonely0) | (a.x & ~lonely1) | (a.y & ~lonely2) | (a.xy & ~lonely3) | (b.at & ~lonely4) |
                  (b.x & ~lonely5) | (b.y & ~lonely6) | (b.xy & ~lonely7);
    uint pairs = opposite(a.at, a.x, b.y, b.xy, a.y, a.xy, b.at, b.x) |
                 opposite(a.at, a.y, b.x, b.xy, a.x, a.xy, b.at, b.y) |
                 opposite(a.at, b.at, a.xy, b.xy, a.x, b.x, a.y, b.y);
    // Two opposite corners outside, all others inside.
    uint holes = a.x & a.y & a.xy & b.at & b.x & b.y & ~(a.at | b.xy);
    holes |= a.at & a.y & a.xy & b.at & b.x & b.xy & ~(a.x | b.y);
    holes |= a.at & a.x & a.xy & b.at & b.y & b.xy & ~(a.y | b.x);
    holes |= a.at & a.x & a.y & b.x & b.y & b.xy & ~(a.xy | b.at);
    uvec2 l0 = add(lonely0, lonely1, lonely2), l1 = add(lonely3, lonely4, lonely5), l2 = add(lonely6, lonely7, joined);
    uvec2 l3 = add(l0.x, l1.x, l2.x), l4 = add(l3.x, pairs, holes);
    uvec2 m0 = add(l0.y, l1.y, l2.y), m1 = add(m0.x, l3.y, l4.y);
    return bitCount(l4.x) + 2 * bitCount(m1.x) + 4 * bitCount(m0.y ^ m1.y) - bitCount(everyCorner);
}

/// Number of triangles of a strip: a cell whose edges cross the surface e times in c closed loops has e - 2 c.
uint triangleCount(StripSigns a, StripSigns b) {
    uvec2 e0 = add(a.at ^ a.x, a.y ^ a.xy, b.at ^ b.x), e1 = add(b.y ^ b.xy, a.at ^ a.y, a.x ^ a.xy);
    uvec2 e2 = add(b.at ^ b.y, b.x ^ b.xy, a.at ^ b.at), e3 = add(a.x ^ b.x, a.y ^ b.y, a.xy ^ b.xy);
    uvec2 e4 = add(e0.x, e1.x, e2.x), e5 = add(e4.x, e3.x, 0);
    uvec2 f0 = add(e0.y, e1.y, e2.y), f1 = add(e3.y, e4.y, e5.y), f2 = add(f0.x, f1.x, 0);
    uvec2 g = add(f0.y, f1.y, f2.y);
    uint edges = bitCount(e5.x) + 2 * bitCount(f2.x) + 4 * bitCount(g.x) + 8 * bitCount(g.y);
    return edges - 2 * loopCount(a, b);
}
