// Hands nearest points on along the rows of one axis, one lane a row, forwards and then backwards: a sample takes that
// of the sample before it if it is nearer than its own. One that has none takes the side that it is on as well.
#include "bake/bake.glsl"

layout(local_size_x = BAKE_GROUP) in;
layout(binding = 4, rgba32ui) restrict uniform uimageBuffer state;

void main() {
    ivec3 along = ivec3(equal(ivec3(0, 1, 2), ivec3(push.axis)));
    int u = push.axis == 0 ? 1 : 0, v = push.axis == 2 ? 1 : 2;  // rows lie side by side in memory
    int row = int(item()), length = push.size[push.axis];
    if (row >= push.size[u] * push.size[v]) return;
    ivec3 first = ivec3(0);
    first[u] = row % push.size[u];
    first[v] = row / push.size[u];
    int start = indexOf(first), stride = indexOf(along);

    for (int way = 0; way < 2; ++way) {
        vec3 held = vec3(BAKE_UNREACHED, 0.0, 0.0);
        uint heldElement = 0;
        int i = way == 0 ? 0 : length - 1, step = way == 0 ? 1 : -1;
        for (int n = 0; n < length; ++n, i += step) {
            uvec4 own = imageLoad(state, start + i * stride);
            vec3 p = vec3(first + i * along), point = uintBitsToFloat(own.xyz);
            vec3 a = p - point, b = p - held;
            float mine = point.x < BAKE_UNREACHED ? dot(a, a) : BAKE_UNREACHED;
            float other = held.x < BAKE_UNREACHED ? dot(b, b) : BAKE_UNREACHED;
            bool better = other < mine;
            // The side stays that which is known.
            uint side = (point.x < BAKE_UNREACHED ? own.w : heldElement) & BAKE_INSIDE;
            uint element = heldElement & ~BAKE_INSIDE | side;
            if (better) imageStore(state, start + i * stride, uvec4(floatBitsToUint(held), element));
            held = better ? held : point;
            heldElement = better ? element : own.w;
        }
    }
}
