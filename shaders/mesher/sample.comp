// Samples the field in the surviving bricks and keeps the signs. A lane takes one plane of 9x9 samples, so that what
// depends on z alone is computed once, and what depends on x and z nine times.
//
// A plane is three words: the samples x < 4 and x < 8, a byte of eight y for each x, and the samples on the upper rim,
// x = 8 (bits 0 to 8, by y) and y = 8 (bits 9 to 17, by x).
#define FIELD_PRUNED
#define FIELD_ROWS
#include "mesher/mesher.glsl"
#include "field.glsl"

layout(local_size_x = 9 * MESHER_GROUP_BRICKS) in;
layout(binding = 5, scalar) readonly buffer BrickList { uint brickList[]; };
layout(binding = 7, scalar) writeonly buffer Planes { uvec3 planes[]; };

void main() {
    fieldBegin();
    uint slot = linearGroup() * MESHER_GROUP_BRICKS + gl_LocalInvocationIndex / 9;
    uint z = gl_LocalInvocationIndex % 9;
    bool valid = slot < counts.bricks;
    fieldChoose(placeOfBrick(valid ? slot : 0));
    uvec3 first = unpackBrick(brickList[valid ? slot : 0]) * 8;
    FieldPlane plane = fieldPlane(samplePosition(2, first.z + z));
    // Samples that are not of the region are outside: bit i of a mask tells whether sample first + i is of it.
    uvec3 begin = uvec3(equal(first, uvec3(0)));
    uvec3 end = min(push.cells + 2 - min(first, push.cells + 2), uvec3(9));
    uvec3 within = ((uvec3(1) << end) - 1) & ~begin;
    bool planeWithin = (within.z >> z & 1) != 0;

    uvec3 bits = uvec3(0);
    uint x = 0;
    do {
        FieldRow row = fieldRow(plane, samplePosition(0, first.x + x));
        uint column = 0;
        uint y = 0;
#ifdef FIELD_FAMILIES
        float ys[9];
        for (int k = 0; k < 9; ++k) ys[k] = samplePosition(1, first.y + k);
        FieldColumn nine = fieldColumn(row, ys);
#endif
        do {
#ifdef FIELD_FAMILIES
            float f = fieldAt(row, nine, y, samplePosition(1, first.y + y));
#else
            float f = fieldAt(row, samplePosition(1, first.y + y));
#endif
            column |= f < 0.0 ? 1u << y : 0u;
        } while (++y < 9);
        column = (within.x >> x & 1) != 0 ? column & within.y : 0;
        uint low = (column & 255) << (x & 3) * 8;
        bits.x |= x < 4 ? low : 0;
        bits.y |= x >= 4 && x < 8 ? low : 0;
        bits.z |= (x == 8 ? column : 0) | (column >> 8) << (9 + x);
    } while (++x < 9);
    if (valid) planes[slot * 9 + z] = planeWithin ? bits : uvec3(0);
}
