// What the talk's stages share: the grid, its samples, and the histopyramid.
#include "bench/talk.h"

layout(push_constant, scalar) uniform Push { TalkGrid grid; };

// The field at (2^levels + 1)^3 points, x fastest.
layout(binding = 0, scalar) buffer Samples { float samples[]; };
// Per pattern of a cell: the number of its triangles' corners, then each corner's edge as x | y << 1 | z << 2 | axis << 3.
layout(binding = 1, scalar) readonly buffer Cases { uint cases[256 * 16]; };

uint cellsPerSide() { return 1u << grid.levels; }

uint sampleIndex(uvec3 at) {
    uint side = cellsPerSide() + 1;
    return (at.z * side + at.y) * side + at.x;
}

float sampleAt(uvec3 at) { return samples[sampleIndex(at)]; }

vec3 positionOf(uvec3 at) { return grid.origin + vec3(at) * grid.spacing; }

uint cellIndex(uvec3 cell) { return (((cell.z << grid.levels) + cell.y) << grid.levels) + cell.x; }

uvec3 cellAt(uint index) {
    uint mask = cellsPerSide() - 1;
    return uvec3(index & mask, (index >> grid.levels) & mask, index >> (2 * grid.levels));
}

// Which corners of a cell are inside: bit x | y << 1 | z << 2.
uint patternOf(uvec3 cell) {
    uint side = cellsPerSide() + 1, at = sampleIndex(cell), above = at + side * side;
    return uint(samples[at] < 0.0) | uint(samples[at + 1] < 0.0) << 1 | uint(samples[at + side] < 0.0) << 2 |
           uint(samples[at + side + 1] < 0.0) << 3 | uint(samples[above] < 0.0) << 4 |
           uint(samples[above + 1] < 0.0) << 5 | uint(samples[above + side] < 0.0) << 6 |
           uint(samples[above + side + 1] < 0.0) << 7;
}

// Which of the three edges that leave a cell's lowest corner along x, y, z change sign, from the cell's pattern.
uint activeEdges(uint pattern) {
    uint low = pattern & 1u;
    return ((pattern >> 1 & 1u) ^ low) | ((pattern >> 2 & 1u) ^ low) << 1 | ((pattern >> 4 & 1u) ^ low) << 2;
}

// Where the field, linear between two samples, is zero.
vec3 crossing(uvec3 start, uint axis) {
    uvec3 along = uvec3(axis == 0, axis == 1, axis == 2);
    float a = sampleAt(start), b = sampleAt(start + along);
    return positionOf(start) + vec3(along) * (grid.spacing * (a / (a - b)));
}

// A histopyramid: level l has 2^l nodes a side, the levels lie one behind the other from the top, and a node holds
// the sum of its eight children in the level below; the lowest level holds a count a cell.
uint levelStart(uint level) { return ((1u << (3 * level)) - 1) / 7; }
uint nodeIndex(uvec3 node, uint level) { return levelStart(level) + (((node.z << level) + node.y) << level) + node.x; }
uvec3 childOffset(uint child) { return uvec3(child & 1u, child >> 1 & 1u, child >> 2); }

// Finds the cell that holds element `rank` of all that the pyramid counts: xyz, and the element's rank there in w.
#define DEFINE_DESCENT(name, pyramid)                                                         \
    uvec4 name(uint rank) {                                                                   \
        uvec3 node = uvec3(0);                                                                \
        for (uint level = 1; level <= grid.levels; level++) {                                 \
            uint child = 0, before = 0, sum = 0;                                              \
            for (uint i = 0; i < 7; i++) {                                                    \
                sum += pyramid[nodeIndex(2 * node + childOffset(i), level)];                  \
                bool beyond = rank >= sum;                                                    \
                child += uint(beyond);                                                        \
                before = beyond ? sum : before;                                               \
            }                                                                                 \
            rank -= before;                                                                   \
            node = 2 * node + childOffset(child);                                             \
        }                                                                                     \
        return uvec4(node, rank);                                                             \
    }
