// The mesh's triangles one by one, each corner knowing which it is.
#include "shared.h"

layout(push_constant, scalar) uniform Push { mat4 toClip; };
layout(binding = 1, scalar) readonly buffer Vertices { MeshVertex vertices[]; };
layout(binding = 2, scalar) readonly buffer Triangles { uint corners[]; };
layout(location = 0) out vec3 corner;

invariant gl_Position;  // wireframe.vert draws over depth.vert and draft.vert, and only what is as near

void main() {
    corner = vec3(equal(uvec3(gl_VertexIndex % 3), uvec3(0, 1, 2)));
    gl_Position = toClip * vec4(vertices[corners[gl_VertexIndex]].position, 1.0);
}
