// Culls blocks of 64^3 cells and lists the survivors in order. One work group: there are few blocks.
#define HISTOPYRAMID_LANES 256
#define HISTOPYRAMID_TYPE uint
#define FIELD_PRUNED
#define FIELD_INTERVAL
#include "mesher/mesher.glsl"
#include "mesher/alive.glsl"
#include "field.glsl"
#include "lib/histopyramid.glsl"

layout(local_size_x = HISTOPYRAMID_LANES) in;
layout(binding = MESHER_AT_BLOCK_LIST, scalar) writeonly buffer BlockList { uint blockList[]; };
layout(binding = MESHER_AT_BLOCK_ALIVE, scalar) buffer BlockAlive { uint blockAlive[]; };

void main() {
    fieldBegin();
    uint all = blockCount();
    uint each = (all + HISTOPYRAMID_LANES - 1) / HISTOPYRAMID_LANES;
    uint first = min(gl_LocalInvocationIndex * each, all), last = min(first + each, all);
    uint found = 0;
    uint i = 0;
    do {  // each >= 1
        uint block = min(first + i, all - 1);
        uvec3 at = blockAt(block) * 64;
        bool alive = fieldChoose(placeOfBox(64, at));
        alive = alive && first + i < last && mayHoldSurface(at, 64, fieldInterval(lowOf(at), highOf(at, 64)));
        if (first + i < last) blockAlive[first + i] = alive ? 1 : 0;
        found += alive ? 1 : 0;
    } while (++i < each);
    uint total;
    uint place = sumBefore(found, total);
    i = first;
    do {
        bool alive = i < last && blockAlive[min(i, all - 1)] != 0;
        if (alive) blockList[place] = i;
        place += alive ? 1 : 0;
    } while (++i < first + each);
    if (gl_LocalInvocationIndex == 0) {
        counts.blocks = total;
        counts.groups[MESHER_BLOCKS] = groupsFor(total, 1);
    }
}
