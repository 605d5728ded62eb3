// Rows: which bricks survived, and the slot of each. A row is eight bricks along x: their bits, and the slot of the
// first survivor among them; a brick's slot is that plus the number of survivors before it.
layout(binding = MESHER_AT_ROWS, scalar) buffer Rows { uvec2 rows[]; };

/// `brick` is counted from the tile's first.
uint rowIndex(uvec3 brick) {
    uvec3 block = brick >> 3;
    return ((block.z * push.blocks.y + block.y) * push.blocks.x + block.x) * 64 + (brick.z & 7) * 8 + (brick.y & 7);
}

/// Slot of a brick, or `otherwise` if it was culled or is not of the grid.
uint slotOf(uvec3 brick, uint otherwise) {
    brick -= push.begin;  // wraps to what is not of the grid
    bool inGrid = all(lessThan(brick, push.blocks * 8));
    uvec2 row = rows[inGrid ? rowIndex(brick) : 0];
    uint bit = 1u << (brick.x & 7);
    return inGrid && (row.x & bit) != 0 ? row.y + bitCount(row.x & (bit - 1)) : otherwise;
}
