// Samples the field on the dense grid, eight samples along y an invocation: half the time of one each on software
// Vulkan.
#include "bench/talk.glsl"
#define FIELD_VALUE
#include "field.glsl"

layout(local_size_x = 16, local_size_y = 2) in;

void main() {
    fieldBegin();
    uint k = 0;
    do {
        // Beyond the grid's end the last sample is written again.
        uvec3 at = min(gl_GlobalInvocationID * uvec3(1, 8, 1) + uvec3(0, k, 0), uvec3(cellsPerSide()));
        samples[sampleIndex(at)] = fieldValue(positionOf(at));
    } while (++k < 8);
}
