#include "runtime/mesher/connect.h"

#include <algorithm>
#include <atomic>
#include <barrier>
#include <bit>
#include <cassert>
#include <glm/vector_relational.hpp>
#include <thread>

#include "runtime/mesher/grid_edge.h"
#include "runtime/mesher/marching_cubes_table.h"
#include "runtime/mesher/sizes.h"

namespace fw::mesher {

using gpu::MesherCounts;
using gpu::MesherPush;
using gpu::uvec2;
using gpu::uvec3;
using gpu::uvec4;

namespace {

// The two functions that do the work are compiled for newer processors too, with all that they call; which of
// them it is, is found out before the thread sanitizer is there.
#define FW_WITHIN [[gnu::always_inline]] inline
#if defined(__x86_64__) && defined(__GLIBC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__)
#define FW_FOR_PROCESSORS [[gnu::target_clones("default", "arch=x86-64-v3")]]
#else
#define FW_FOR_PROCESSORS
#endif

constexpr uint64_t kRow = 0x0101010101010101;  // y = 0 of every column
constexpr uint32_t kSome = 32;                 // bricks that a thread takes at a time

/// Bits that are set. Not every processor of this architecture has an instruction for it.
FW_WITHIN int bitCount(uint64_t bits) {
    bits -= bits >> 1 & 0x5555555555555555;
    bits = (bits & 0x3333333333333333) + (bits >> 2 & 0x3333333333333333);
    return int(((bits + (bits >> 4)) & 0x0f0f0f0f0f0f0f0f) * kRow >> 56);
}

/// Signs of the samples of a plane at (x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1) of its 8 x 8 cells, bit
/// x * 8 + y: both strips of strips.glsl.
struct PlaneSigns {
    uint64_t at, x, y, xy;
};

/// Puts bit i of the low eight bits into bit 7 of byte i.
FW_WITHIN uint64_t spreadToTop(uint64_t bits) {
    return ((((bits & 127) * 0x0002040810204081) & kRow) | (bits >> 7 & 1) << 56) << 7;
}

FW_WITHIN PlaneSigns signsOf(uvec3 plane) {
    PlaneSigns s;
    s.at = plane.x | uint64_t(plane.y) << 32;
    s.x = s.at >> 8 | uint64_t(plane.z & 255) << 56;
    s.y = (s.at >> 1 & ~(kRow << 7)) | spreadToTop(plane.z >> 9);
    s.xy = (s.x >> 1 & ~(kRow << 7)) | spreadToTop(plane.z >> 10);
    return s;
}

FW_WITHIN uint64_t activeCells(const PlaneSigns& a, const PlaneSigns& b) {
    return (a.at | a.x | a.y | a.xy | b.at | b.x | b.y | b.xy) &
           ~(a.at & a.x & a.y & a.xy & b.at & b.x & b.y & b.xy);
}

/// Two edges across a cell from each other, both ends of each inside and the other four corners outside.
FW_WITHIN uint64_t opposite(uint64_t p, uint64_t q, uint64_t r, uint64_t s, uint64_t t, uint64_t u,
                            uint64_t v, uint64_t w) {
    return (p & q & r & s & ~(t | u | v | w)) | (t & u & v & w & ~(p | q | r | s));
}

/// Sum of three bits in each place: its low bit and its high bit.
struct Sum {
    uint64_t low, high;
};
FW_WITHIN Sum add(uint64_t a, uint64_t b, uint64_t c) {
    const uint64_t either = a ^ b;
    return {either ^ c, (a & b) | (either & c)};
}

/// Closed loops in which the edges of the cells cross the surface: strips.glsl has the reasons.
FW_WITHIN uint32_t loopCount(const PlaneSigns& a, const PlaneSigns& b) {
    const uint64_t lonely0 = a.at & ~(a.x | a.y | b.at), lonely1 = a.x & ~(a.at | a.xy | b.x),
                   lonely2 = a.y & ~(a.at | a.xy | b.y), lonely3 = a.xy & ~(a.x | a.y | b.xy),
                   lonely4 = b.at & ~(b.x | b.y | a.at), lonely5 = b.x & ~(b.at | b.xy | a.x),
                   lonely6 = b.y & ~(b.at | b.xy | a.y), lonely7 = b.xy & ~(b.x | b.y | a.xy);
    const uint64_t everyCorner = a.at & a.x & a.y & a.xy & b.at & b.x & b.y & b.xy;
    const uint64_t joined = (a.at & ~lonely0) | (a.x & ~lonely1) | (a.y & ~lonely2) | (a.xy & ~lonely3) |
                            (b.at & ~lonely4) | (b.x & ~lonely5) | (b.y & ~lonely6) | (b.xy & ~lonely7);
    const uint64_t pairs = opposite(a.at, a.x, b.y, b.xy, a.y, a.xy, b.at, b.x) |
                           opposite(a.at, a.y, b.x, b.xy, a.x, a.xy, b.at, b.y) |
                           opposite(a.at, b.at, a.xy, b.xy, a.x, b.x, a.y, b.y);
    const uint64_t holes = (a.x & a.y & a.xy & b.at & b.x & b.y & ~(a.at | b.xy)) |
                           (a.at & a.y & a.xy & b.at & b.x & b.xy & ~(a.x | b.y)) |
                           (a.at & a.x & a.xy & b.at & b.y & b.xy & ~(a.y | b.x)) |
                           (a.at & a.x & a.y & b.x & b.y & b.xy & ~(a.xy | b.at));
    const Sum l0 = add(lonely0, lonely1, lonely2), l1 = add(lonely3, lonely4, lonely5),
              l2 = add(lonely6, lonely7, joined), l3 = add(l0.low, l1.low, l2.low),
              l4 = add(l3.low, pairs, holes), m0 = add(l0.high, l1.high, l2.high),
              m1 = add(m0.low, l3.high, l4.high);
    return uint32_t(bitCount(l4.low) + 2 * bitCount(m1.low) + 4 * bitCount(m0.high ^ m1.high) -
                    bitCount(everyCorner));
}

/// Edges of the cells that cross the surface, each counted for every cell that it is an edge of.
FW_WITHIN uint32_t useCount(const PlaneSigns& a, const PlaneSigns& b) {
    const Sum e0 = add(a.at ^ a.x, a.y ^ a.xy, b.at ^ b.x), e1 = add(b.y ^ b.xy, a.at ^ a.y, a.x ^ a.xy),
              e2 = add(b.at ^ b.y, b.x ^ b.xy, a.at ^ b.at), e3 = add(a.x ^ b.x, a.y ^ b.y, a.xy ^ b.xy),
              e4 = add(e0.low, e1.low, e2.low), e5 = add(e4.low, e3.low, 0),
              f0 = add(e0.high, e1.high, e2.high), f1 = add(e3.high, e4.high, e5.high),
              f2 = add(f0.low, f1.low, 0), g = add(f0.high, f1.high, f2.high);
    return uint32_t(bitCount(e5.low) + 2 * bitCount(f2.low) + 4 * bitCount(g.low) + 8 * bitCount(g.high));
}

/// Which corners of one cell are inside: marching_cubes_table.h numbers them.
FW_WITHIN uint32_t cornerPattern(const PlaneSigns& a, const PlaneSigns& b, int bit) {
    return uint32_t((a.at >> bit & 1) | (a.x >> bit & 1) << 1 | (a.y >> bit & 1) << 2 |
                    (a.xy >> bit & 1) << 3 | (b.at >> bit & 1) << 4 | (b.x >> bit & 1) << 5 |
                    (b.y >> bit & 1) << 6 | (b.xy >> bit & 1) << 7);
}

using Crossed = std::array<uint64_t, 3>;  // edges from a plane's samples along each axis

/// Whether an edge that starts or ends in the outside layer is active: there the surface was closed.
FW_WITHIN bool hasCap(uvec3 first, uint32_t z, const Crossed& edges, uvec3 cells) {
    const uvec3 last = cells + 1u - first;  // the last sample of the region, huge if it lies before
    const uint64_t x = (first.x == 0 ? 255 : 0) | (last.x < 8 ? uint64_t(255) << last.x * 8 : 0),
                   y = (first.y == 0 ? kRow : 0) | (last.y < 8 ? kRow << last.y : 0);
    const bool rim = first.z + z == 0 || z == last.z;
    return ((edges[0] & x) | (edges[1] & y) | (rim ? edges[2] : 0)) != 0;
}

/// Faces of the brick (bits as in links.glsl) on which an edge of the plane of cells between a and b is
/// active.
FW_WITHIN uint32_t crossedFaces(uint32_t z, uvec3 a, uvec3 b, const Crossed& edges, const PlaneSigns& top) {
    const uint32_t column = a.z & 511, topColumn = b.z & 511, row = a.z >> 9, topRow = b.z >> 9;
    const uint32_t columnEdges = (column ^ column >> 1) & 255, rowEdges = (row ^ row >> 1) & 255;
    const uint64_t topEdges = (top.at ^ top.x) | (top.at ^ top.y) | ((topRow ^ topRow >> 1) & 255) |
                              ((topColumn ^ topColumn >> 1) & 255);
    const uint32_t columnUp = column ^ topColumn, rowUp = (row ^ topRow) & 255;
    uint32_t faces = 0;
    if (columnEdges | columnUp) faces |= 1;
    if (rowEdges | rowUp) faces |= 2;
    if (z == 7 && topEdges) faces |= 4;
    if (((edges[1] | edges[2]) & 255) | (rowUp & 1)) faces |= 8;
    if (((edges[0] | edges[2]) & kRow) | (columnUp & 1)) faces |= 16;
    if (z == 0 && (edges[0] | edges[1] | columnEdges | rowEdges)) faces |= 32;
    return faces;
}

/// The patterns' polygons as places in a brick's array of edges, from the place of the cell.
constexpr uint32_t kAlongY = 1, kAlongX = 9, kAlongZ = 81, kOfAxis = 729;
uint32_t placeOf(const CellEdge& edge) {
    return uint32_t(edge.axis) * kOfAxis + edge.corner.z * kAlongZ + edge.corner.x * kAlongX +
           edge.corner.y * kAlongY;
}

struct Fans {
    uint32_t corners = 0;  // three a triangle
    std::array<uint16_t, 15> places{};
};
const std::array<Fans, 256>& fans() {
    static const std::array<Fans, 256> all = [] {
        std::array<Fans, 256> made;
        for (int pattern = 0; pattern < 256; ++pattern)
            for (const CellPolygon& polygon : cellPolygons(pattern))
                for (std::size_t i = 2; i < polygon.size(); ++i)
                    for (uint8_t edge : {polygon[0], polygon[i - 1], polygon[i]})
                        made[pattern].places[made[pattern].corners++] = uint16_t(placeOf(cellEdge(edge)));
        return made;
    }();
    return all;
}

/// The patches of dual contouring: of each edge its place, and the bits that contour.comp gives a corner of
/// its quad.
struct Patch {
    uint32_t count = 0;
    std::array<uint16_t, 12> places{};
    std::array<uint8_t, 12> corners{};  // of the four of the edge
    std::array<uint32_t, 12> twice{};   // bits 30 and 31
};
using Patches = std::vector<Patch>;
const std::array<Patches, 256>& patchesOf() {
    static const std::array<Patches, 256> all = [] {
        std::array<Patches, 256> made;
        for (int pattern = 0; pattern < 256; ++pattern)
            for (std::size_t n = 0; n < cellPolygons(pattern).size(); ++n) {
                Patch patch;
                const uvec3 words = packedCellPatches()[std::size_t(pattern) * kMostCellPolygons + n];
                for (uint8_t edge : cellPolygons(pattern)[n]) {
                    const uint32_t i = patch.count++, code = words[int(i) / 4] >> i % 4 * 8 & 255;
                    const uint32_t axis = code >> 3 & 3, x = code >> 5 & 1, y = code & 1, up = code >> 2 & 1;
                    patch.places[i] = uint16_t(placeOf(cellEdge(edge)));
                    patch.corners[i] = uint8_t((axis == 0 ? y : x) | (axis == 2 ? y : up) << 1);
                    patch.twice[i] = (code & 2) << 29 | (code & 64) << 25;
                }
                made[pattern].push_back(patch);
            }
        return made;
    }();
    return all;
}

/// A run: what is counted for each brick, and what became of it.
class Connection {
  public:
    Connection(const Device& device_, const MesherBuffers& buffers, const MesherPush& push_, bool dual_)
        : device(device_),
          b(buffers),
          push(push_),
          dual(dual_),
          counts(b.counts.as<MesherCounts>()[0]),
          bricks(counts.bricks <= push.brickCapacity ? counts.bricks : 0),
          brickList(b.brickList.as<uint32_t>()),
          planes(b.planes.as<uvec3>()),
          rows(b.rows.as<uvec2>()),
          strips(b.edges.as<uvec4>()),
          totals(bricks) {}

    void run();

  private:
    /// Of a brick, and, once they are summed, of all before it.
    struct Total {
        uint32_t edges = 0, parts = 0;  // parts: triangles or patches
        uint32_t uses = 0;              // of edges by patches
    };

    uvec3 brickAt(uint32_t slot) const { return unpackBrick(brickList[slot]); }
    FW_WITHIN uint32_t slotOf(uvec3 brick) const;
    FW_WITHIN void countBrick(uint32_t slot);
    FW_FOR_PROCESSORS void countBricks(uint32_t from, uint32_t to);
    FW_FOR_PROCESSORS void writeBricks(uint32_t from, uint32_t to, uint32_t* vertexAt);
    void sumUp();
    FW_WITHIN void numberEdges(uint32_t slot, uint32_t* vertexAt);
    FW_WITHIN void borrowEdges(uint32_t slot, uint32_t* vertexAt) const;
    FW_WITHIN void writeTriangles(uint32_t slot, const uint32_t* vertexAt);
    FW_WITHIN void writePatches(uint32_t slot, const uint32_t* vertexAt);

    const Device& device;
    const MesherBuffers& b;
    const MesherPush& push;
    const bool dual;
    MesherCounts& counts;
    const uint32_t bricks;
    std::span<const uint32_t> brickList;
    std::span<const uvec3> planes;
    std::span<const uvec2> rows;
    std::span<uvec4> strips;  // active edges, and the first's number in its brick
    std::vector<Total> totals;
    std::atomic<bool> capped = false, leaking = false;
    bool fits = false;
};

constexpr uint32_t kNone = ~0u;

/// As in rows.glsl.
uint32_t Connection::slotOf(uvec3 brick) const {
    brick -= push.begin;  // wraps to what is not of the grid
    if (!glm::all(glm::lessThan(brick, push.blocks * 8u))) return kNone;
    const uvec3 block = brick >> 3u;
    const uvec2 row = rows[((block.z * push.blocks.y + block.y) * push.blocks.x + block.x) * 64 +
                           (brick.z & 7) * 8 + (brick.y & 7)];
    const uint32_t bit = 1u << (brick.x & 7);
    return (row.x & bit) != 0 ? row.y + uint32_t(bitCount(row.x & (bit - 1))) : kNone;
}

void Connection::countBrick(uint32_t slot) {
    const uvec3 brick = brickAt(slot), first = brick * 8u;
    const auto beyond = glm::greaterThanEqual(brick, push.end);
    const bool isBeyond = glm::any(beyond);
    // Faces that must have a brick beyond them if surface crosses them: classify.comp has the rule.
    uint32_t checked = 0;
    for (int axis = 0; axis < 3; ++axis)
        if (isBeyond ? beyond[axis] : brick[axis] == push.first[axis]) checked |= 8u << axis;
    if (!isBeyond) checked = 63 - checked;
    bool cap = false;
    uint32_t crossedAll = 0;
    Total& total = totals[slot];
    PlaneSigns low = signsOf(planes[slot * 9]);
    for (uint32_t z = 0; z < 8; ++z) {
        const uvec3 a = planes[slot * 9 + z], top = planes[slot * 9 + z + 1];
        const PlaneSigns high = signsOf(top);
        Crossed crossed = {low.at ^ low.x, low.at ^ low.y, low.at ^ high.at};
        const bool active = activeCells(low, high) != 0;
        if (active) {
            cap = cap || hasCap(first, z, crossed, push.cells);
            crossedAll |= crossedFaces(z, a, top, crossed, high);
        }
        if (isBeyond) {  // only the edges that lie in the tile's far faces are the tile's
            const uint64_t inFaces = (beyond.x ? 255 : ~uint64_t(0)) & (beyond.y ? kRow : ~uint64_t(0)) &
                                     (beyond.z && z != 0 ? 0 : ~uint64_t(0));
            for (int axis = 0; axis < 3; ++axis) crossed[std::size_t(axis)] &= beyond[axis] ? 0 : inFaces;
        } else if (active) {
            const uint32_t loops = loopCount(low, high), uses = useCount(low, high);
            total.parts += dual ? loops : uses - 2 * loops;  // of a cell with e edges in c loops
            total.uses += uses;
        }
        for (uint32_t side = 0; side < 2; ++side) {
            uvec4& strip = strips[slot * 16 + z * 2 + side];
            strip = {uint32_t(crossed[0] >> side * 32), uint32_t(crossed[1] >> side * 32),
                     uint32_t(crossed[2] >> side * 32), total.edges};
            if (strip.x | strip.y | strip.z)
                total.edges += uint32_t(bitCount(strip.x | uint64_t(strip.y) << 32) + bitCount(strip.z));
        }
        low = high;
    }
    if (cap) capped = true;
    checked &= crossedAll;
    for (int axis = 0; axis < 3 && checked; ++axis) {
        uvec3 next = brick, before = brick;
        ++next[axis], --before[axis];
        if (((checked >> axis & 1) && slotOf(next) == kNone) ||
            ((checked >> axis & 8) && slotOf(before) == kNone))
            leaking = true;
    }
}

void Connection::sumUp() {
    Total sum;
    for (Total& total : totals) {
        const Total own = total;
        total = sum;
        sum.edges += own.edges;
        sum.parts += own.parts;
        sum.uses += own.uses;
    }
    counts.edges = sum.edges;
    counts.vertices = dual ? sum.parts : sum.edges;
    counts.triangles = dual ? 2 * sum.edges : sum.parts;
    counts.caps = capped;
    counts.leaks = leaking;
    fits = bricks == counts.bricks && counts.vertices <= push.vertexCapacity &&
           counts.triangles <= push.triangleCapacity;
    // As top_groups.comp sets up what follows.
    const auto setUp = [&](uint32_t at, uint64_t items, uint64_t each) {
        for (uint32_t chunk = 0; chunk < MESHER_CHUNKS; ++chunk) {
            const uint64_t left = items - std::min(items, chunk * each);
            const glm::uvec3 groups =
                spread(device, groupsFor(fits ? std::min(left, each) : 0, MESHER_GROUP_VERTICES));
            counts.groups[at + chunk] = {groups.x, groups.y, 1};
        }
    };
    setUp(MESHER_EDGES, counts.edges, MESHER_VERTEX_CHUNK);
    setUp(MESHER_VERTICES, counts.vertices, MESHER_VERTEX_CHUNK);
    setUp(MESHER_QUADS, counts.edges, MESHER_QUAD_CHUNK);
    counts.draw[0] = fits ? 3 * counts.triangles : 0;
    counts.draw[1] = 1;
    const bool isTile = push.first != uvec3(0) || glm::any(glm::lessThan(push.end * 8u, push.cells + 2u));
    if (dual && fits && isTile)  // record.cpp has the reason
        std::ranges::fill(b.corners.as<uint32_t>().first(4 * std::size_t(counts.edges)), 0u);
}

/// Numbers the brick's own edges, by strip, axis and bit, and lists them as list_edges.glsl does.
void Connection::numberEdges(uint32_t slot, uint32_t* vertexAt) {
    uint32_t vertex = totals[slot].edges;
    uint32_t* list = b.vertexList.as<uint32_t>().data() + vertex;
    for (uint32_t s = 0; s < 16; ++s) {
        const uint32_t own = slot * 16 + s, z = s / 2, side = s & 1;
        const uvec4 strip = strips[own];
        if ((strip.x | strip.y | strip.z) == 0) continue;
        const uvec3 plane = planes[slot * 9 + z];
        const uint32_t inside = side == 0 ? plane.x : plane.y;
        for (uint32_t axis = 0; axis < 3; ++axis) {
            uint32_t* to = vertexAt + axis * kOfAxis + z * kAlongZ + side * 4 * kAlongX;
            for (uint32_t bits = strip[int(axis)]; bits != 0; bits &= bits - 1) {
                const auto bit = uint32_t(std::countr_zero(bits));
                to[(bit >> 3) * kAlongX + (bit & 7)] = vertex++;
                *list++ = own << 7 | axis << 5 | bit | (inside >> bit & 1) << 31;
            }
        }
    }
}

/// Brings the numbers of the edges on the brick's far faces from the bricks there.
void Connection::borrowEdges(uint32_t slot, uint32_t* vertexAt) const {
    const uvec3 brick = brickAt(slot);
    for (uint32_t n = 1; n < 7; ++n) {
        const uvec3 offset(n & 1, n >> 1 & 1, n >> 2);
        const uint32_t from = slotOf(brick + offset);
        if (from == kNone) continue;
        uint32_t* corner =
            vertexAt + offset.x * 8 * kAlongX + offset.y * 8 * kAlongY + offset.z * 8 * kAlongZ;
        // Its edges on the face, or on the line, that is shared; none along an axis that leads away from it.
        const uint32_t mask = (offset.x ? 255u : ~0u) & (offset.y ? uint32_t(kRow) : ~0u);
        const uvec3 masks(offset.x ? 0 : mask, offset.y ? 0 : mask, offset.z ? 0 : mask);
        for (uint32_t s = 0; s < (offset.z ? 2u : 16u); s += offset.x ? 2 : 1) {
            const uvec4 strip = strips[from * 16 + s];
            if (((strip.x & masks.x) | (strip.y & masks.y) | (strip.z & masks.z)) == 0) continue;
            uint32_t* to = corner + s / 2 * kAlongZ + (s & 1) * 4 * kAlongX;
            uint32_t base =
                totals[from].edges + strip.w;  // a strip's edges are numbered by axis, then by bit
            for (int axis = 0; axis < 3; ++axis) {
                for (uint32_t bits = strip[axis] & masks[axis]; bits != 0; bits &= bits - 1) {
                    const auto bit = uint32_t(std::countr_zero(bits));
                    to[(bit >> 3) * kAlongX + (bit & 7)] =
                        base + uint32_t(bitCount(strip[axis] & ((1u << bit) - 1)));
                }
                base += uint32_t(bitCount(strip[axis]));
                to += kOfAxis;
            }
        }
    }
}

/// Calls `use` with the pattern of each active cell, its number in the brick and its place in the array of
/// edges.
template <class Use>
FW_WITHIN void forEachCell(const uvec3* planes, Use&& use) {
    PlaneSigns low = signsOf(planes[0]);
    for (uint32_t z = 0; z < 8; ++z) {
        const PlaneSigns high = signsOf(planes[z + 1]);
        for (uint64_t cells = activeCells(low, high); cells != 0; cells &= cells - 1) {
            const int bit = std::countr_zero(cells);
            use(cornerPattern(low, high, bit), z * 64 + uint32_t(bit),
                z * kAlongZ + uint32_t(bit >> 3) * kAlongX + uint32_t(bit & 7));
        }
        low = high;
    }
}

void Connection::writeTriangles(uint32_t slot, const uint32_t* vertexAt) {
    uint32_t* const triangles = b.triangles.as<uint32_t>().data();
    uint32_t* out = triangles + 3 * std::size_t(totals[slot].parts);
    // As far as nothing of the next brick lies there, some are written that the next cell overwrites: their
    // number is no branch then that the processor has to guess.
    const uint32_t* const safe =
        triangles + 3 * std::size_t(slot + 1 < bricks ? totals[slot + 1].parts : counts.triangles) - 15;
    const std::array<Fans, 256>& table = fans();
    forEachCell(&planes[slot * 9], [&](uint32_t pattern, uint32_t, uint32_t place) {
        const Fans& cell = table[pattern];
        const uint32_t* at = vertexAt + place;
        const auto write = [&](uint32_t from, uint32_t to) {
            for (uint32_t i = from; i < to; ++i) out[i] = at[cell.places[i]];
        };
        if (out <= safe) {
            write(0, 6);
            if (cell.corners > 6) write(6, 15);
        } else {
            write(0, cell.corners);
        }
        out += cell.corners;
    });
}

void Connection::writePatches(uint32_t slot, const uint32_t* vertexAt) {
    uint32_t patch = totals[slot].parts, use = totals[slot].uses;
    uvec4* list = b.patchList.as<uvec4>().data();
    uint32_t* uses = b.uses.as<uint32_t>().data();
    uint32_t* corners = b.corners.as<uint32_t>().data();
    const std::array<Patches, 256>& table = patchesOf();
    forEachCell(&planes[slot * 9], [&](uint32_t pattern, uint32_t cell, uint32_t place) {
        const Patches& all = table[pattern];
        for (const Patch& one : all) {
            list[patch] = {slot << 9 | cell, use, one.count, all.size() == 1};
            for (uint32_t i = 0; i < one.count; ++i) {
                const uint32_t edge = vertexAt[place + one.places[i]];
                uses[use++] = edge;
                corners[std::size_t(edge) * 4 + one.corners[i]] = patch | one.twice[i];
            }
            ++patch;
        }
    });
}

void Connection::countBricks(uint32_t from, uint32_t to) {
    for (uint32_t slot = from; slot < to; ++slot) countBrick(slot);
}

void Connection::writeBricks(uint32_t from, uint32_t to, uint32_t* vertexAt) {
    for (uint32_t slot = from; slot < to; ++slot) {
        numberEdges(slot, vertexAt);
        if (glm::any(glm::greaterThanEqual(brickAt(slot), push.end))) continue;
        borrowEdges(slot, vertexAt);
        if (dual)
            writePatches(slot, vertexAt);
        else
            writeTriangles(slot, vertexAt);
    }
}

void Connection::run() {
    const unsigned threads = std::max(1u, std::thread::hardware_concurrency());
    std::atomic<uint32_t> next = 0;
    std::barrier counted(std::ptrdiff_t(threads), [&]() noexcept {
        sumUp();
        next = 0;
    });
    const auto work = [&] {
        for (uint32_t from; (from = next.fetch_add(kSome)) < bricks;)
            countBricks(from, std::min(from + kSome, bricks));
        counted.arrive_and_wait();
        if (!fits) return;
        std::vector<uint32_t> vertexAt(3 * kOfAxis);
        for (uint32_t from; (from = next.fetch_add(kSome)) < bricks;)
            writeBricks(from, std::min(from + kSome, bricks), vertexAt.data());
    };
    std::vector<std::jthread> others;
    for (unsigned i = 1; i < threads; ++i) others.emplace_back(work);
    work();
}

}  // namespace

void connect(const Device& device, const MesherBuffers& buffers, const MesherPush& push, bool dual) {
    Connection(device, buffers, push, dual).run();
}

}  // namespace fw::mesher
