// Samples the field in the surviving bricks and keeps the signs. A lane takes one plane of 9x9 samples, so that what
// a plane has in common is computed once, and what a row has nine times. Rows are along y, unless the field
// says that another axis saves more (FIELD_ALONG); where that is z, planes are those of constant x, and the lanes of a
// brick exchange their signs.
//
// A plane is three words: the samples x < 4 and x < 8, a byte of eight y for each x, and the samples on the upper rim,
// x = 8 (bits 0 to 8, by y) and y = 8 (bits 9 to 17, by x).
#define FIELD_PRUNED
#define FIELD_ROWS
#include "mesher/mesher.glsl"
#include "field.glsl"

layout(local_size_x = 9 * MESHER_GROUP_BRICKS) in;
layout(binding = MESHER_AT_BRICK_LIST, scalar) readonly buffer BrickList { uint brickList[]; };
layout(binding = MESHER_AT_PLANES, scalar) writeonly buffer Planes { uvec3 planes[]; };

#ifdef FIELD_ALONG
// Bits 0, 9 and 18 of each word: one of each row.
uint ofEachRow(uvec3 rows) {
    uvec3 three = rows & 0x40201, at = (three | three >> 8 | three >> 16) & 7;
    return at.x | at.y << 3 | at.z << 6;
}
#endif

#ifndef FIELD_ALONG
const ivec3 axes = ivec3(2, 0, 1);  // of planes, rows and samples
uint columnAt(uvec3 rows, uint x, uint z) { return (x < 3 ? rows.x : x < 6 ? rows.y : rows.z) >> (x % 3) * 9 & 511; }
#elif FIELD_ALONG == 0
const ivec3 axes = ivec3(2, 1, 0);
uint columnAt(uvec3 rows, uint x, uint z) { return ofEachRow(rows >> x); }
#else
const ivec3 axes = ivec3(0, 1, 2);
shared uvec3 signs[9 * MESHER_GROUP_BRICKS];  // of planes of constant x
uint columnAt(uvec3 rows, uint x, uint z) { return ofEachRow(signs[gl_LocalInvocationIndex - z + x] >> z); }
#endif

// The signs of a plane of samples, of which columnAt() gives nine along y: nine bits a row, three rows a word.
uvec3 signsOf(uvec3 first, uint plane) {
    FieldPlane common_ = fieldPlane(samplePosition(axes.x, first[axes.x] + plane));
    uvec3 rows = uvec3(0);
    uint r = 0;
    do {
        FieldRow row = fieldRow(common_, samplePosition(axes.y, first[axes.y] + r));
        uint bits = 0;
        uint k = 0;
#ifdef FIELD_FAMILIES
        float at[9];
        for (int i = 0; i < 9; ++i) at[i] = samplePosition(axes.z, first[axes.z] + i);
        FieldColumn nine = fieldColumn(row, at);
#endif
        do {
#ifdef FIELD_FAMILIES
            float f = fieldAt(row, nine, k, samplePosition(axes.z, first[axes.z] + k));
#else
            float f = fieldAt(row, samplePosition(axes.z, first[axes.z] + k));
#endif
            bits |= f < 0.0 ? 1u << k : 0u;
        } while (++k < 9);
        bits <<= (r % 3) * 9;
        rows |= uvec3(r < 3 ? bits : 0, r >= 3 && r < 6 ? bits : 0, r >= 6 ? bits : 0);
    } while (++r < 9);
    return rows;
}

void main() {
    fieldBegin();
    uint slot = linearGroup() * MESHER_GROUP_BRICKS + gl_LocalInvocationIndex / 9;
    uint z = gl_LocalInvocationIndex % 9;  // of the signs that the lane writes
    bool valid = slot < counts.bricks;
    fieldChoose(placeOfBrick(valid ? slot : 0));
    uvec3 first = unpackBrick(brickList[valid ? slot : 0]) * 8;
    uvec3 rows = signsOf(first, z);
#if defined(FIELD_ALONG) && FIELD_ALONG == 2
    signs[gl_LocalInvocationIndex] = rows;
    barrier();
#endif
    // Samples that are not of the region are outside: bit i of a mask tells whether sample first + i is of it.
    uvec3 begin = uvec3(equal(first, uvec3(0)));
    uvec3 end = min(push.cells + 2 - min(first, push.cells + 2), uvec3(9));
    uvec3 within = ((uvec3(1) << end) - 1) & ~begin;
    bool planeWithin = (within.z >> z & 1) != 0;

    uvec3 bits = uvec3(0);
    uint x = 0;
    do {
        uint column = (within.x >> x & 1) != 0 ? columnAt(rows, x, z) & within.y : 0;
        uint low = (column & 255) << (x & 3) * 8;
        bits.x |= x < 4 ? low : 0;
        bits.y |= x >= 4 && x < 8 ? low : 0;
        bits.z |= (x == 8 ? column : 0) | (column >> 8) << (9 + x);
    } while (++x < 9);
    if (valid) planes[slot * 9 + z] = planeWithin ? bits : uvec3(0);
}
