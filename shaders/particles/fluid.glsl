// Of all kernels of the fluid (runtime/particles/fluid.h says how): the kernel W, the cells, the lists, the walls. Densities are
// in units of the density at rest.
//
// Kernels write words and read texels: for software devices imageStore() takes three times as long as a store to a buffer, and
// a load from a buffer twice as long as imageLoad().
#include "shared.h"
#include "particles/fluid.h"

layout(push_constant, scalar) uniform PushConstants { FluidPush push; };

uint item() { return (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * FLUID_GROUP + gl_LocalInvocationIndex; }

ivec3 cellOf(vec3 p) { return clamp(ivec3((p - push.first) * push.perCell), ivec3(0), push.cells - 1); }
uint cellIndex(ivec3 c) { return uint((c.z * push.cells.y + c.y) * push.cells.x + c.x); }

// A particle's neighbours stand four to a texel, and so do those of the others of its work group in turn; the last texel is filled
// up with the particle itself. A particle of no neighbours has one such texel.
const int kNextTexel = FLUID_GROUP;
int firstTexel(uint index) {
    return int(index / FLUID_GROUP * (FLUID_GROUP * FLUID_MOST_NEIGHBOURS / 4) + index % FLUID_GROUP);
}

// Wendland's C2 kernel at the share `u` = 1 - r / support of the support that is left. Times push.weight, the shape of the weight is
// what a particle adds to the density; that of the slope, times push.slope and the offset a - b, is the gradient of that.
float weightShape(float u) { return (u * u) * (u * u) * (5.0 - 4.0 * u); }
float slopeShape(float u) { return u * u * u; }
float leftOf(float squared) { return max(1.0 - sqrt(squared) * push.perSupport, 0.0); }

// What walls add to the density at the distances d before them, each as if it were full of particles: the integral of the kernel
// beyond its plane; and how that falls off with d.
struct Walls {
    vec3 density, fall;
};
Walls wallsAt(vec3 d) {
    vec3 u = clamp(1.0 - abs(d) * push.perSupport, 0.0, 1.0), u2 = u * u, u5 = u2 * u2 * u, u6 = u5 * u;
    vec3 beyond = u6 * (3.5 + u * (1.5 * u - 4.5));
    return Walls(mix(beyond, 1.0 - beyond, lessThan(d, vec3(0.0))), 21.0 * push.perSupport * (u5 - u6 * (1.5 - (4.0 / 7.0) * u)));
}

// How the fall of that falls off with d, 1/m^2.
vec3 bendAt(vec3 d) {
    vec3 u = clamp(1.0 - abs(d) * push.perSupport, 0.0, 1.0), u2 = u * u;
    return 21.0 * push.perSupport * push.perSupport * u2 * u2 * (1.0 - u) * (5.0 - 4.0 * u) * sign(d);
}

// The gradient of the density of all walls, and that density. `plane` is the obstacle's nearest: its normal, and how far it is
// from the origin.
vec4 wallsAt(vec3 p, vec4 plane) {
    Walls low = wallsAt(p - push.lo), high = wallsAt(push.hi - p), own = wallsAt(vec3(dot(plane.xyz, p) - plane.w));
    return vec4(high.fall - low.fall - own.fall.x * plane.xyz, dot(low.density + high.density, vec3(1.0)) + own.density.x);
}

// The second derivatives of the density of all walls, times a vector.
vec3 wallsBent(vec3 p, vec4 plane, vec3 by) {
    vec3 bent = (bendAt(p - push.lo) + bendAt(push.hi - p)) * by;
    return bent + bendAt(vec3(dot(plane.xyz, p) - plane.w)).x * dot(plane.xyz, by) * plane.xyz;
}

// Of a kilogramme at p, kinetic and potential, m^2/s^2.
float energyAt(vec3 p, float squaredSpeed) { return 0.5 * squaredSpeed - dot(push.gravity, p); }

vec3 inTank(vec3 p) { return clamp(p, push.lo, push.hi); }
