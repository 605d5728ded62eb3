// The mesh's normal, as draft.comp reads it.
#include "shared.h"
#include "lib/octahedral.glsl"

layout(location = 0) in vec3 normal;
layout(location = 0) out uint packedNormal;

// Normals that oppose each other can meet in zero, which has no direction.
void main() { packedNormal = packOctahedral(dot(normal, normal) > 1e-6 ? normalize(normal) : vec3(0, 1, 0)); }
