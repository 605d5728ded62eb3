// Base colour at each vertex.
#define FIELD_MATERIAL
#include "mesher/mesher.glsl"
#include "field.glsl"

layout(local_size_x = MESHER_GROUP_VERTICES) in;
layout(binding = MESHER_AT_MESH, scalar) readonly buffer Vertices { uvec4 vertices[]; };
layout(binding = MESHER_AT_COLORS, scalar) writeonly buffer Colors { vec3 colors[]; };

void main() {
    fieldBegin();
    uint index = linearGroup() * MESHER_GROUP_VERTICES + gl_LocalInvocationIndex;
    bool valid = push.chunk * MESHER_VERTEX_CHUNK + index < counts.vertices && index < MESHER_VERTEX_CHUNK;
    vec3 p = uintBitsToFloat(vertices[valid ? index : 0].xyz);
    vec3 color = clamp(fieldMaterial(p).baseColor, 0.0, 1.0);
    if (valid) colors[index] = color;
}
