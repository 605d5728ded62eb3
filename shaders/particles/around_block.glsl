// What stands at each sample, by the particles around its block: of the blocks that are listed, one for each work group. First its lanes
// go through the rows of buckets, each through its own, and list who is near enough; then all go through that list, by twos. A kernel
// defines the functions below.
#include "particles/surface.glsl"

layout(local_size_x = SURFACE_LANES) in;
layout(binding = 2, scalar) writeonly buffer Distance { vec4 distances[]; };                 // cells; rows padded to texels
layout(binding = 4, scalar) readonly buffer Blocks { uvec3 groups; uint count, blocks[]; };  // how many, and which

const int kListed = 64;  // of a lane's, at a time
shared uint found[SURFACE_LANES * kListed], near[SURFACE_LANES * kListed];
shared uint many[SURFACE_LANES];  // that each lane has found
shared bool more;                 // whether one has not seen all of its own

// A lane has four samples along x in two layers.
vec4 px;
float py;
vec2 pz;

void nothing();                       // what is known before the first particle
uint particleAt(uint i);              // the i-th in the order of buckets
vec3 centreOf(uint particle);
void add(uint a, uint b, bool both);  // two particles, or one
vec4 lengths(int layer);              // of this lane's samples; 0 deep inside

// Lists a lane's particles within reach of the block, while there is room: from `i` to `end`, and of its rows from `row` on. Returns how
// many; `some` is whether there may be more.
uint find(Block block, Rows rows, int lane, inout int row, inout uint i, inout uint end, out bool some) {
    int all = rows.count.x * rows.count.y;
    uint listed = 0;
    do {
        if (i >= end) {
            uvec2 range = row < all ? particlesOf(block, rows, row) : uvec2(0);
            i = range.x, end = range.y;
            row += SURFACE_LANES;
        }
        do {
            uint particle = particleAt(min(i, push.particles - 1));
            vec3 centre = centreOf(particle), away = max(max(block.lo - centre, centre - block.hi), 0.0);
            bool within = i < end && dot(away, away) < kReach * kReach;
            if (within) found[lane * kListed + int(listed)] = particle;
            listed += within ? 1 : 0;
        } while (++i < end && listed < kListed);
        some = i < end || row < all;
    } while (some && listed < kListed);
    return listed;
}

// Puts what the lanes have found behind one another; returns how many.
uint join(int lane) {
    uint before = 0, all = 0, own = many[lane], k = 0;
    for (int other = 0; other < SURFACE_LANES; ++other) {
        before += other < lane ? many[other] : 0;
        all += many[other];
    }
    if (own > 0) do {
        near[before + k] = found[lane * kListed + int(k)];
    } while (++k < own);
    return all;
}

void main() {
    uint group = linearGroup();
    if (group >= count) return;
    Block block = blockOf(blocks[group]);
    int lane = int(gl_LocalInvocationIndex);
    px = block.lo.x + block.cell * vec4(0.0, 1.0, 2.0, 3.0);
    py = block.lo.y + block.cell * float(lane % 4);
    pz = block.lo.z + block.cell * (float(lane / 4) + vec2(0.0, 2.0));
    nothing();
    Rows rows = rowsAround(block);
    int row = lane;
    uint from = 0, end = 0;
    bool some, again;
    do {
        many[lane] = find(block, rows, lane, row, from, end, some);
        more = false;
        barrier();
        if (some) more = true;
        uint all = join(lane), i = 0;
        barrier();
        again = more;
        if (all > 0) do {
            add(near[i], near[min(i + 1, all - 1)], i + 1 < all);
        } while ((i += 2) < all);
        barrier();
    } while (again);
    for (int layer = 0; layer < 2; ++layer) {
        ivec3 at = block.first + ivec3(0, lane % 4, lane / 4 + 2 * layer);
        if (all(lessThan(at, texels())))
            distances[(at.z * texels().y + at.y) * texels().x + at.x] = (lengths(layer) - push.drop) / block.cell;
    }
}
