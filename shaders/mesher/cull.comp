// Culls the bricks of one block a work group; a lane tests a row of eight. The places within the block are summed up
// here, the block's number of survivors goes to the level above.
#define HISTOPYRAMID_LANES 64
#include "mesher/mesher.glsl"
#include "mesher/alive.glsl"
#include "mesher/rows.glsl"
#include "lib/histopyramid.glsl"

layout(local_size_x = HISTOPYRAMID_LANES) in;
layout(constant_id = 0) const bool kListed = true;  // blocks come from the list; else every block is tested
layout(binding = 1, scalar) readonly buffer BlockList { uint blockList[]; };
layout(binding = 4, scalar) writeonly buffer BlockCounts { uvec4 blockCounts[]; };

void main() {
    fieldBegin();
    uint group = linearGroup();
    bool valid = group < (kListed ? counts.blocks : push.blocks.x * push.blocks.y * push.blocks.z);
    uint block = !valid ? 0 : kListed ? blockList[group] : group;
    uvec3 at = uvec3(block % push.blocks.x, block / push.blocks.x % push.blocks.y, block / (push.blocks.x * push.blocks.y));
    uvec3 brick = at * 8 + uvec3(0, gl_LocalInvocationIndex & 7, gl_LocalInvocationIndex >> 3);
    uint bits = 0;
    uint x = 0;
    do {
        bits |= mayHoldSurface((brick + uvec3(x, 0, 0)) * 8, 8) ? 1u << x : 0u;
    } while (++x < 8);
    uvec4 total;
    uint place = sumBefore(uvec4(bitCount(bits), 0, 0, 0), total).x;
    if (valid) rows[block * 64 + gl_LocalInvocationIndex] = uvec2(bits, place);
    if (valid && gl_LocalInvocationIndex == 0) blockCounts[group] = uvec4(total.x, 0, 0, 0);
}
