// The density at each sample from the cells around it, each taken for as many particles as it holds, all at their mean.
#include "particles/density.glsl"

layout(local_size_x = DENSITY_GROUP) in;
layout(binding = 0, rgba32ui) restrict readonly uniform uimageBuffer grid;
layout(binding = 1, scalar) writeonly buffer Density { float density[]; };

void main() {
    uint index = item();
    if (index >= sampleCount()) return;
    ivec3 at = placeOf(index);
    float perRadius = push.cell / push.radius, sum = 0.0;
    int side = 2 * push.reach + 1, i = 0;
    do {
        ivec3 off = ivec3(i % side, i / side % side, i / (side * side)) - push.reach, cell = at + off;
        bool within = all(greaterThanEqual(cell, ivec3(0))) && all(lessThan(cell, push.size));
        uvec4 own = imageLoad(grid, within ? indexOf(cell) : 0);
        vec3 mean = vec3(own.xyz) / (push.unit * max(float(own.w), 1.0)) - 0.5;
        vec3 away = (vec3(off) + mean) * perRadius;
        float s = max(1.0 - dot(away, away), 0.0);
        sum += within ? float(own.w) * s * s * s : 0.0;
    } while (++i < side * side * side);
    density[index] = sum;
}
