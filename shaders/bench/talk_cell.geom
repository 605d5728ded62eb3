// Marching cubes of one cell: no triangle to five.
#include "bench/talk.glsl"

#ifdef CAPTURE
// The triangles as nine floats each behind their count, in no particular order: for tests.
layout(binding = 8, scalar) buffer Captured { uint capturedCount; vec3 captured[]; };
#endif

layout(points) in;
layout(triangle_strip, max_vertices = 15) out;
layout(location = 0) flat in uvec3 cell[];

void main() {
    uint first = patternOf(cell[0]) * 16, end = first + cases[first];
    for (uint corner = first; corner < end; corner += 3) {
#ifdef CAPTURE
        uint triangle = atomicAdd(capturedCount, 1);
#endif
        for (uint i = 1; i <= 3; i++) {
            uint edge = cases[corner + i];
            vec3 p = crossing(cell[0] + childOffset(edge & 7u), edge >> 3);
#ifdef CAPTURE
            captured[3 * triangle + i - 1] = p;
#endif
            gl_Position = grid.view * vec4(p, 1);
            EmitVertex();
        }
        EndPrimitive();
    }
}
