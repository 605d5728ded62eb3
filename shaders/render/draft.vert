// The mesh's triangles with their vertices' normals and, where there are some, colours, for a draft.
#include "shared.h"
#include "lib/octahedral.glsl"

layout(push_constant, scalar) uniform Push { mat4 toClip; };
layout(location = 0) in vec3 position;
layout(location = 1) in uint packedNormal;
layout(location = 0) out vec3 normal;
#ifdef COLORS
layout(binding = 0, scalar) readonly buffer Colors { vec3 colors[]; };
layout(location = 1) out vec3 color;
#endif

invariant gl_Position;  // wireframe.vert draws over depth.vert and draft.vert, and only what is as near

void main() {
    normal = unpackOctahedral(packedNormal);
#ifdef COLORS
    color = colors[gl_VertexIndex];
#endif
    gl_Position = toClip * vec4(position, 1.0);
}
