// Lists for each box of a size, or for each brick that survived, the members of the field's families that can matter
// there, out of those listed for the box of twice the size that it is in. Where a list comes to lie depends on the order of work, what is in it does not.
#define FIELD_PRUNED
#define FIELD_INTERVAL
#define FIELD_PRUNE
#include "mesher/mesher.glsl"
#include "mesher/alive.glsl"
uint fieldAllocate(uint entries);
bool fieldMayHold(vec2 f);
#include "field.glsl"

layout(constant_id = 0) const uint kSize = 8;  // cells along a side: 64, 32, 16, or 8 for bricks
layout(local_size_x = MESHER_GROUP_LINKS) in;
layout(binding = MESHER_AT_BRICK_LIST, scalar) readonly buffer BrickList { uint brickList[]; };

uvec3 first;  // sample of the box

bool fieldMayHold(vec2 f) { return kSize == 8 || mayHoldSurface(first, kSize, f); }

#define FIELD_LISTED counts.listed
#include "lib/field_allocate.glsl"

void main() {
    fieldBegin();
    uint index = linearGroup() * MESHER_GROUP_LINKS + gl_LocalInvocationIndex;
    uvec3 boxes = push.blocks * (64 / kSize);
    bool valid = index < (kSize > 8 ? boxes.x * boxes.y * boxes.z : counts.bricks);
    index = valid ? index : 0;
    uvec3 at = uvec3(index % boxes.x, index / boxes.x % boxes.y, index / (boxes.x * boxes.y));
    first = kSize > 8 ? push.begin * 8 + at * kSize : unpackBrick(brickList[index]) * 8;
    fieldChoose(kSize < 64 ? placeOfBox(2 * kSize, first) : 0);
#ifdef FIELD_FAMILIES
    vec3 low = lowOf(first), high = max(low, highOf(first, kSize));
    if (valid) fieldPrune(low, high, kSize > 8 ? placeOfBox(kSize, first) : placeOfBrick(index));
#endif
}
