// The field at a list of points, in each of its meanings: how tests compare the device with the CPU reference, and
// what `fieldwright compile --emit spirv` shows.
#define FIELD_VALUE
#define FIELD_GRADIENT
#define FIELD_INTERVAL
#define FIELD_ROWS
#define FIELD_MATERIAL
#include "field.glsl"

layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint count; float halfSize; };
layout(binding = 0, scalar) readonly buffer Points { vec3 points[]; };

struct FieldSample {
    float value, rowValue;
    vec2 interval;   // over the cube of halfSize around the point
    vec4 gradient;   // xyz, and the value found beside it
    vec3 baseColor;
    float roughness;
};
layout(binding = 1, scalar) writeonly buffer Samples { FieldSample samples[]; };

#ifndef FIELD_ALONG
const ivec3 axes = ivec3(2, 0, 1);
#elif FIELD_ALONG == 0
const ivec3 axes = ivec3(2, 1, 0);
#else
const ivec3 axes = ivec3(0, 1, 2);
#endif

float byRows(vec3 p) {
    FieldRow row = fieldRow(fieldPlane(p[axes.x]), p[axes.y]);
#ifdef FIELD_FAMILIES
    float at[9];
    for (int k = 0; k < 9; ++k) at[k] = p[axes.z] + float(k);
    return fieldAt(row, fieldColumn(row, at), 0, p[axes.z]);
#else
    return fieldAt(row, p[axes.z]);
#endif
}

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    fieldBegin();
    vec3 p = points[i];
    FieldMaterial material = fieldMaterial(p);
    samples[i] = FieldSample(fieldValue(p), byRows(p),
                             fieldInterval(p - halfSize, p + halfSize), fieldGradient(p), material.baseColor,
                             material.roughness);
}
