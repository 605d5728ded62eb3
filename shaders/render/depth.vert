// The mesh's triangles, for their depth alone.
#include "shared.h"

layout(push_constant, scalar) uniform Push { mat4 toClip; };
layout(location = 0) in vec3 position;

invariant gl_Position;  // wireframe.vert draws over depth.vert and draft.vert, and only what is as near

void main() { gl_Position = toClip * vec4(position, 1.0); }
