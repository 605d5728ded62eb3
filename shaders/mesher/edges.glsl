// The edge -> vertex lookup: for each axis and plane of a brick two strips of active edges, and the index of the vertex
// on the first of each. An edge's vertex is that plus the number of active edges before it in the strip. One buffer an
// axis, so that each stays within what a binding can hold.
layout(binding = 8, scalar) buffer EdgesX { uvec4 edgesX[]; };  // (strip 0, first vertex, strip 1, first vertex)
layout(binding = 9, scalar) buffer EdgesY { uvec4 edgesY[]; };
layout(binding = 10, scalar) buffer EdgesZ { uvec4 edgesZ[]; };
