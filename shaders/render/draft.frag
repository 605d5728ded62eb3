// The mesh's normal and colour, as draft.comp reads them.
#include "shared.h"
#include "lib/octahedral.glsl"

layout(location = 0) in vec3 normal;
#ifdef COLORS
layout(location = 1) in vec3 color;
#else
const vec3 color = vec3(0);
#endif
layout(location = 0) out uvec2 packedLook;

// Normals that oppose each other can meet in zero, which has no direction.
void main() {
    vec3 n = dot(normal, normal) > 1e-6 ? normalize(normal) : vec3(0, 1, 0);
    packedLook = uvec2(packOctahedral(n), packUnorm4x8(vec4(sqrt(clamp(color, 0.0, 1.0)), 0.0)));
}
