// Depth of a view by sphere tracing the field (Hart 1996), with no mesh: on software devices often the faster way to see a
// solid, and what a picture is compared with. In two passes: a cone about each 8 x 8 pixels (CONES defined) finds how far all of
// their rays are free, and the rays go on from there.
#define FIELD_VALUE
#include "shared.h"
#include "render/render.h"
#include "render/places.glsl"
#include "lib/unfolded.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push { TracePush push; };
#ifdef CONES
layout(binding = 0, r32f) writeonly uniform image2D starts;
#else
layout(binding = 0, r32f) writeonly uniform image2D depth;
layout(binding = 1, r32f) readonly uniform image2D starts;
#endif

const uint kMostConeSteps = 48;

void main() {
    fieldBegin();
    uvec2 pixel = gl_GlobalInvocationID.xy;
    bool parallel = (push.flags & RENDER_PARALLEL) != 0;
    float pixels = 1.0;
#ifdef CONES
    pixels = float(RENDER_CONE);
#endif
    vec2 place = (vec2(pixel) + 0.5) * pixels / vec2(push.size) * vec2(2.0, -2.0) + vec2(-1.0, 1.0);
    vec3 origin = push.origin + place.x * push.originX + place.y * push.originY;
    vec3 ray = push.direction + place.x * push.directionX + place.y * push.directionY;
    float scale = length(ray);
    // Read once: no compiler moves loads of push constants out of a loop.
    vec3 centre = 0.5 * (push.lo + push.hi), perHalf = 2.0 / (push.hi - push.lo);
    float stepScale = push.stepScale / scale, t = parallel ? 0.0 : push.near;
#ifdef CONES
    // All rays of the cone are within `wide` of its middle, or `wide` times t unless parallel.
    float wide = 1.5 * pixels * push.pixel, end = (distance(origin, centre) + distance(push.hi, centre)) / scale;
    float safe = push.stepScale, back = 1.0 / (scale + (parallel ? 0.0 : wide)), f;
    // As steppingPoint() of solid.glsl.
    bvec3 local = bvec3((push.flags & RENDER_LOCAL_STEPS) != 0);
    vec3 stepLo = mix(vec3(-1e30), push.lo, local), stepHi = mix(vec3(1e30), push.hi, local);
    uint i = 0;
    do {
        float radius = parallel ? wide : wide * t;
        vec3 p = origin + ray * t, within = clamp(p, stepLo, stepHi), at = (within - centre) * perHalf;
        chooseMembers(at);
        float solid = fieldValue(within) * safe, region = length(max(abs((p - centre) * perHalf) - 1.0, 0.0) / perHalf);
        f = (withinPlaces(at) ? max(solid, region) : region) - radius;
        t += max(f, 0.0) * back;
    } while (f > 0.5 * wide * (parallel ? 1.0 : t) && t < end && ++i < kMostConeSteps);
    imageStore(starts, ivec2(pixel), vec4(t));
#else
    vec3 a = (push.lo - origin) / ray, b = (push.hi - origin) / ray;
    vec3 first = min(a, b), last = max(a, b);
    float start = imageLoad(starts, ivec2(min(pixel, push.size - 1) / RENDER_CONE)).x;
    float free = max(max(first.x, max(first.y, first.z)), t);  // as far as the ray is known to be
    t = max(free, start);
    float end = min(last.x, min(last.y, last.z));
    bool outside = !(t < end);
    float close = push.close, f = 0.0;
    uint i = 0, steps = unfolded(push.steps);
    // Kept: a ray that has ended goes on beside its neighbours on some drivers, with loads that yield nothing.
    bool hit = false;
    do {
        chooseMembers((origin + ray * t - centre) * perHalf);
        f = fieldValue(origin + ray * t);
        // Steps of a field without a known constant, of rays or of cones, may be too long and end inside: the surface is behind.
        float least = close * (parallel ? 1.0 : t);
        bool inside = f < -least && t - free > least;
        hit = hit || (f < least && !inside && !outside);
        float onward = inside ? 0.5 * (free - t) : max(f * stepScale, 0.0);
        free = inside ? free : t;
        t += hit ? 0.0 : onward;
        outside = outside || t > end;
    } while (!hit && !outside && ++i < steps);
    // A ray that runs out of steps beside a surface grazes it: it is there.
    bool seen = hit || (!outside && f * push.stepScale < 8.0 * close * (parallel ? 1.0 : t));
    float z = parallel ? 1.0 - t * push.near : push.near / t;
    if (all(lessThan(pixel, push.size))) imageStore(depth, ivec2(pixel), vec4(seen ? z : 0.0));
#endif
}
