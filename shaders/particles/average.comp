// How far each sample is from the average place of the particles around it; where they do not fill the space that they are spread
// over, from the nearest of them (runtime/particles/particle_surface.h).
#include "particles/around_block.glsl"

layout(binding = 0, rgba32ui) restrict readonly uniform uimageBuffer sorted;

const float kVolume = 4.18879 * pow(kReach / AVERAGE_REACH, 3.0);  // of a particle
const float kApart = 1.0, kTogether = 2.0;
const float kThin = 0.16;  // that lines and layers are thinner than a drop

// Sums of weights, of weighted offsets and of their squares; and the least of these.
mat2x4 weights, offX, offY, offZ, squares, nearest;

void nothing() {
    weights = offX = offY = offZ = squares = mat2x4(0.0);
    nearest = mat2x4(vec4(kReach * kReach), vec4(kReach * kReach));
}

uint particleAt(uint i) { return i; }
vec3 centreOf(uint particle) { return uintBitsToFloat(imageLoad(sorted, int(particle)).xyz); }

void add(uint a, uint b, bool both) {
    vec3 places[2] = {centreOf(a), both ? centreOf(b) : vec3(-1e4)};
    for (int layer = 0; layer < 2; ++layer) {
        vec4 w[2], x[2], apart[2];
        float y[2], z[2];
        for (int k = 0; k < 2; ++k) {
            x[k] = places[k].x - px, y[k] = places[k].y - py, z[k] = places[k].z - pz[layer];
            apart[k] = x[k] * x[k] + (y[k] * y[k] + z[k] * z[k]);
            vec4 s = max(1.0 - apart[k] * (1.0 / (kReach * kReach)), 0.0);
            w[k] = s * s * s;
        }
        weights[layer] += w[0] + w[1];
        offX[layer] += w[0] * x[0] + w[1] * x[1];
        offY[layer] += w[0] * y[0] + w[1] * y[1];
        offZ[layer] += w[0] * z[0] + w[1] * z[1];
        squares[layer] += w[0] * apart[0] + w[1] * apart[1];
        nearest[layer] = min(nearest[layer], min(apart[0], apart[1]));
    }
}

vec4 lengths(int layer) {
    vec4 many = weights[layer], per = 1.0 / max(many, 1e-30), x = offX[layer] * per, y = offY[layer] * per, z = offZ[layer] * per;
    vec4 mean = x * x + y * y + z * z, spread = max(squares[layer] * per - mean, 1e-6);
    vec4 together = smoothstep(kApart, kTogether, many * kVolume / (spread * sqrt(spread)));
    vec4 left = max(1.0 - mean * (1.0 / (kReach * kReach)), 0.5), crowd = many / (left * left * left * left);
    vec4 thin = kThin * smoothstep(1.2, 3.2, crowd) * (1.0 - smoothstep(4.0, 4.8, crowd));
    return mix(sqrt(nearest[layer]), sqrt(mean) + thin * push.drop, together);
}
