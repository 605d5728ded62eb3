// Samples the field on the dense grid.
#include "bench/talk.glsl"
#define FIELD_VALUE
#include "field.glsl"

layout(local_size_x = 64, local_size_y = 4) in;

void main() {
    fieldBegin();
    uvec3 at = gl_GlobalInvocationID;
    if (any(greaterThan(at, uvec3(cellsPerSide())))) return;
    samples[sampleIndex(at)] = fieldValue(positionOf(at));
}
