// The edge -> vertex lookup: for each strip its active edges along x, y and z, and the index of the vertex on the first,
// counted from the first of its group of bricks. The vertices of a strip are numbered by axis, then by bit: an edge's
// vertex is the first one's index plus the number of active edges before it.
layout(binding = MESHER_AT_EDGES, scalar) buffer Edges { uvec4 edges[]; };

// For each group of bricks: first active edge, first triangle (of dual contouring: patch), nothing, number of strips with
// active cells.
layout(binding = MESHER_AT_SUMS, scalar) buffer Sums { uvec4 sums[]; };
