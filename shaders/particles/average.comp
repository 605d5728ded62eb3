// How far each sample is from the average place of the particles around it; where they do not fill the space that they are spread
// over, from the nearest of them (runtime/particles/particle_surface.h).
#include "particles/around_block.glsl"

layout(binding = 0, rgba32ui) restrict readonly uniform uimageBuffer sorted;

const float kVolume = 4.18879 * pow(kReach / AVERAGE_REACH, 3.0);  // of a particle
const float kApart = 1.0, kTogether = 2.0;

// Sums of weights, of weighted offsets and of their squares; and the least of these.
mat2x4 weights, offX, offY, offZ, squares, nearest;

void nothing() {
    weights = offX = offY = offZ = squares = mat2x4(0.0);
    nearest = mat2x4(vec4(kReach * kReach), vec4(kReach * kReach));
}

void add(uint i) {
    vec3 place = uintBitsToFloat(imageLoad(sorted, int(i)).xyz);
    vec4 x = place.x - px, xx = x * x;
    float y = place.y - py;
    for (int layer = 0; layer < 2; ++layer) {
        float z = place.z - pz[layer];
        vec4 apart = xx + (y * y + z * z), s = max(1.0 - apart * (1.0 / (kReach * kReach)), 0.0), w = s * s * s;
        weights[layer] += w;
        offX[layer] += w * x, offY[layer] += w * y, offZ[layer] += w * z;
        squares[layer] += w * apart;
        nearest[layer] = min(nearest[layer], apart);
    }
}

vec4 lengths(int layer) {
    vec4 per = 1.0 / max(weights[layer], 1e-30), x = offX[layer] * per, y = offY[layer] * per, z = offZ[layer] * per;
    vec4 mean = x * x + y * y + z * z, spread = max(squares[layer] * per - mean, 1e-6);
    vec4 full = smoothstep(kApart, kTogether, weights[layer] * kVolume / (spread * sqrt(spread)));
    return mix(sqrt(nearest[layer]), sqrt(mean), full);
}
