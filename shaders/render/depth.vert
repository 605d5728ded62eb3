// The mesh's triangles, for their depth alone.
#include "shared.h"
#include "render/render.h"

layout(push_constant, scalar) uniform Push { RenderPush view; };
layout(binding = 2, scalar) readonly buffer Vertices { MeshVertex vertices[]; };

void main() {
    vec3 v = vertices[gl_VertexIndex].position - view.eye;
    gl_Position = vec4(dot(view.right, v), dot(view.up, v), view.near, dot(view.forward, v));
}
