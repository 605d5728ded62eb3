// Culls the bricks of one block a work group; a lane tests a row of eight. The places within the block are summed up
// here, the block's number of survivors goes to the level above.
#define HISTOPYRAMID_LANES 64
#define HISTOPYRAMID_TYPE uint
#define FIELD_PRUNED
#define FIELD_INTERVAL
#include "mesher/mesher.glsl"
#include "mesher/alive.glsl"
#include "field.glsl"
#include "mesher/rows.glsl"
#include "lib/histopyramid.glsl"

layout(local_size_x = HISTOPYRAMID_LANES) in;
layout(binding = MESHER_AT_BLOCK_LIST, scalar) readonly buffer BlockList { uint blockList[]; };
layout(binding = MESHER_AT_SUMS, scalar) writeonly buffer BlockCounts { uvec4 blockCounts[]; };

void main() {
    fieldBegin();
    uint group = linearGroup();
    bool listed = push.blocksListed != 0;
    bool valid = group < (listed ? counts.blocks : blockCount());
    uint block = listed ? blockList[valid ? group : 0] : valid ? group : 0;
    uvec3 brick = blockAt(block) * 8 + uvec3(0, gl_LocalInvocationIndex & 7, gl_LocalInvocationIndex >> 3);
    uint bits = 0;
    uint x = 0;
    uint end = min(min((push.cells.x + 9) / 8, push.end.x + 1) - brick.x, 8);  // bricks of the grid in this row
    do {
        uvec3 first = (brick + uvec3(x, 0, 0)) * 8;
        bool alive = fieldChoose(placeOfBox(16, first));
        alive = mayHoldSurface(first, 8, fieldInterval(lowOf(first), highOf(first, 8))) && alive;
        bits |= alive ? 1u << x : 0u;
    } while (++x < end);
    uint total;
    uint place = sumBefore(bitCount(bits), total);
    if (valid) rows[block * 64 + gl_LocalInvocationIndex] = uvec2(bits, place);
    if (valid && gl_LocalInvocationIndex == 0) blockCounts[group] = uvec4(total, 0, 0, 0);
}
