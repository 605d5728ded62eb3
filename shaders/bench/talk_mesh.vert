// An indexed mesh in a pass that keeps depth alone.
#include "bench/talk.glsl"

layout(constant_id = 0) const uint kStride = 3;  // floats a vertex, the position first
layout(binding = 6, scalar) readonly buffer Vertices { float vertices[]; };

void main() {
    uint at = uint(gl_VertexIndex) * kStride;
    gl_Position = grid.view * vec4(vertices[at], vertices[at + 1], vertices[at + 2], 1);
}
