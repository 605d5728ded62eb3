// Of all kernels of the fluid (runtime/particles/fluid.h says how): the kernel W, the cells, the walls. Densities are in units of
// the density at rest.
#include "shared.h"
#include "particles/fluid.h"

layout(push_constant, scalar) uniform PushConstants { FluidPush push; };

uint item() { return (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * FLUID_GROUP + gl_LocalInvocationIndex; }

ivec3 cellOf(vec3 p) { return clamp(ivec3((p - push.first) / push.cell), ivec3(2), push.cells - 3); }
uint cellIndex(ivec3 c) { return uint((c.z * push.cells.y + c.y) * push.cells.x + c.x); }

// Wendland's C2 kernel times a particle's volume: what it adds to the density at a distance, and the derivative of that over the
// distance, so that times (a - b) it is the gradient.
float weightAt(float r) {
    float u = max(1.0 - r / push.support, 0.0), v = u * u;
    return push.volume * 21.0 / (2.0 * PI * push.support * push.support * push.support) * v * v * (5.0 - 4.0 * u);
}
float slopeAt(float r) {
    float u = max(1.0 - r / push.support, 0.0), s = push.support * push.support;
    return -push.volume * 21.0 * 10.0 / (PI * s * s * push.support) * u * u * u;
}

// What a wall adds to the density at the distance d before it, as if it were full of particles: the integral of the kernel
// beyond the plane; and how it falls off with d.
vec2 wallAt(float d) {
    float u = clamp(1.0 - abs(d) / push.support, 0.0, 1.0), u2 = u * u, u5 = u2 * u2 * u, u6 = u5 * u;
    float beyond = u6 * (3.5 + u * (1.5 * u - 4.5));
    float fall = (21.0 / push.support) * (u5 - u6 * (1.5 - (4.0 / 7.0) * u));
    return vec2(d < 0.0 ? 1.0 - beyond : beyond, fall);
}

// The density of all walls and its gradient. `plane` is the obstacle's nearest: its normal, and how far it is from the origin.
vec4 wallsAt(vec3 p, vec4 plane) {
    vec4 sum = vec4(0.0);
    for (int k = 0; k < 3; ++k) {
        vec2 low = wallAt(p[k] - push.lo[k]), high = wallAt(push.hi[k] - p[k]);
        sum[k] += high.y - low.y;
        sum.w += low.x + high.x;
    }
    vec2 own = wallAt(dot(plane.xyz, p) - plane.w);
    return sum + vec4(-own.y * plane.xyz, own.x);
}

vec3 inTank(vec3 p) { return clamp(p, push.lo, push.hi); }
