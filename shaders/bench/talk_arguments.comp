// Turns the tops of the pyramids into the arguments of indirect draws and dispatches; nothing is read back.
#include "bench/talk.glsl"

layout(binding = 2, scalar) readonly buffer CellPyramid { uint cellCounts[]; };
layout(binding = 3, scalar) readonly buffer VertexPyramid { uint vertexCounts[]; };
layout(binding = 4, scalar) writeonly buffer Arguments { uint arguments[]; };

layout(local_size_x = 1) in;

void main() {
    uint cells = cellCounts[0], vertices = vertexCounts[0];
    uint values[20] = uint[](cells, 1, 0, 0,                 // draw: a point per active cell
                             (vertices + 255) / 256, 1, 1,   // dispatch: an invocation per vertex
                             (cells + 255) / 256, 1, 1,      // dispatch: an invocation per triangle
                             3 * cells, 1, 0, 0, 0,          // indexed draw
                             vertices, cells, 0, 0, 0);      // for whoever wants to know
    for (uint i = 0; i < 20; i++) arguments[i] = values[i];
}
