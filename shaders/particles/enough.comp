// Ends a fluid's turns once its mean error is small enough: kernels of turns that follow, this one too, find no groups to run.
#include "particles/fluid.glsl"

layout(local_size_x = 1) in;
layout(binding = 0, scalar) buffer Errors { uint errors[FLUID_ERROR_SUMS]; };
layout(binding = 1, scalar) buffer Turns { FluidTurns turns; };

void main() {
    float sum = 0.0;
    int i = 0;
    do {
        sum += float(errors[i]) / FLUID_ERROR_UNIT;
        errors[i] = 0;
    } while (++i < FLUID_ERROR_SUMS);
    bool enough = sum <= push.error * float(push.particles);
    turns.groups = enough ? uvec3(0) : turns.groups;
    turns.one = enough ? uvec3(0) : turns.one;
    turns.taken += enough ? 0 : 1;
}
