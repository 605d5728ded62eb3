// Hands nearest points on from one slice to the next along an axis: a sample takes the nearest of those that the nine
// samples before it have, unless its own is nearer. One that has none takes the side that it is on as well.
#include "bake/bake.glsl"

layout(local_size_x = BAKE_GROUP) in;
layout(binding = 4, rgba32ui) restrict uniform uimageBuffer state;

void main() {
    int u = push.axis == 0 ? 1 : 0, v = push.axis == 2 ? 1 : 2;
    int lane = int(item());
    if (lane >= push.size[u] * push.size[v]) return;
    ivec3 at;
    at[push.axis] = push.slice;
    at[u] = lane % push.size[u];
    at[v] = lane / push.size[u];
    vec3 p = vec3(at);
    uvec4 own = imageLoad(state, indexOf(at)), best = own;
    bool reached = uintBitsToFloat(own.x) < BAKE_UNREACHED;
    vec3 off = p - uintBitsToFloat(own.xyz);
    float least = reached ? dot(off, off) : BAKE_UNREACHED;
    for (int n = 0; n < 9; ++n) {
        ivec3 other = at;
        other[push.axis] -= push.step;
        other[u] = clamp(other[u] + n % 3 - 1, 0, push.size[u] - 1);
        other[v] = clamp(other[v] + n / 3 - 1, 0, push.size[v] - 1);
        uvec4 tried = imageLoad(state, indexOf(other));
        vec3 point = uintBitsToFloat(tried.xyz);
        off = p - point;
        float squared = dot(off, off);
        bool better = point.x < BAKE_UNREACHED && squared < least;
        least = better ? squared : least;
        best = better ? tried : best;
    }
    uint side = (reached ? own.w : best.w) & BAKE_INSIDE;
    if (best.xyz != own.xyz) imageStore(state, indexOf(at), uvec4(best.xyz, best.w & ~BAKE_INSIDE | side));
}
