// The mesh's triangles with their vertices' normals, for a draft.
#include "shared.h"
#include "lib/octahedral.glsl"

layout(push_constant, scalar) uniform Push { mat4 toClip; };
layout(location = 0) in vec3 position;
layout(location = 1) in uint packedNormal;
layout(location = 0) out vec3 normal;

void main() {
    normal = unpackOctahedral(packedNormal);
    gl_Position = toClip * vec4(position, 1.0);
}
