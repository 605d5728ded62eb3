// Density to what would be the distance for a particle alone; with DISTANCES these are given. Each lane does a block of 4 x 4 x 4 samples, and keeps its least.
#include "particles/volume.glsl"

layout(local_size_x = VOLUME_GROUP) in;
layout(binding = 0, rgba32ui) readonly uniform uimageBuffer density;  // floats
layout(binding = 2, scalar) writeonly buffer Distance { vec4 distances[]; };  // in its place
layout(binding = 1, scalar) writeonly buffer Least { float least[]; };

#ifdef DISTANCES
vec4 distanceAt(vec4 distance) { return distance; }
#else
vec4 distanceAt(vec4 density) {
    vec4 s = pow(max(density, 1e-30), vec4(1.0 / 3.0));
    float at = sqrt(push.most - push.least);
    vec4 outside = sqrt(max(push.most - s, 0.0)) - at, inside = (push.least - s) * (0.5 / at);
    return push.radius * mix(inside, outside, lessThan(s, vec4(push.least)));
}
#endif

void main() {
    uint index = item();
    if (index >= countOf(push.blocks)) return;
    ivec3 block = placeIn(push.blocks, index);
    ivec2 many = min(push.size.yz - 4 * block.yz, 4);
    float lowest = 1e30;
    int row = 0;
    do {
        ivec3 at = ivec3(block.x, 4 * block.y + row % 4, 4 * block.z + row / 4);
        bool there = row % 4 < many.x && row / 4 < many.y;
        int texel = indexIn(texels(), there ? at : ivec3(block.x, 4 * block.yz));
        vec4 f = distanceAt(uintBitsToFloat(imageLoad(density, texel)));
        bool border = at.y == 0 || at.z == 0 || at.y == push.size.y - 1 || at.z == push.size.z - 1;
        for (int k = 0; k < 4; ++k) {
            int x = 4 * at.x + k;
            if (border || x == 0 || x >= push.size.x - 1) f[k] = max(f[k], 0.5);
            lowest = there ? min(lowest, f[k]) : lowest;
        }
        if (there) distances[texel] = f;
    } while (++row < 16);
    least[index] = lowest;
}
