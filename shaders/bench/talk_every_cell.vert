// A point per cell of the grid.
#include "bench/talk.glsl"

layout(location = 0) flat out uvec3 cell;

void main() { cell = cellAt(gl_VertexIndex); }
