// Depth of a view by sphere tracing the field (Hart 1996), with no mesh: on software devices often the faster way to see a
// solid, and what a picture is compared with.
#define FIELD_VALUE
#include "shared.h"
#include "render/render.h"
#include "field.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, r32f) writeonly uniform image2D depth;
layout(push_constant, scalar) uniform Push { TracePush push; };

const uint kMostSteps = 160;

void main() {
    fieldBegin();
    uvec2 pixel = gl_GlobalInvocationID.xy;
    vec2 place = (vec2(pixel) + 0.5) / vec2(push.size) * vec2(2.0, -2.0) + vec2(-1.0, 1.0);
    vec3 origin = push.origin + place.x * push.originX + place.y * push.originY;
    vec3 ray = push.direction + place.x * push.directionX + place.y * push.directionY;
    float perMetre = inversesqrt(dot(ray, ray));
    vec3 a = (push.lo - origin) / ray, b = (push.hi - origin) / ray;
    vec3 first = min(a, b), last = max(a, b);
    bool parallel = push.parallel != 0;
    float t = max(max(first.x, max(first.y, first.z)), parallel ? 0.0 : push.near), end = min(last.x, min(last.y, last.z));
    bool outside = !(t < end);
    float f = 0.0;
    uint i = 0;
    bool hit;
    do {
        f = fieldValue(origin + ray * t);
        hit = f < push.pixel * (parallel ? 1.0 : t) && !outside;
        t += hit ? 0.0 : max(f * push.stepScale * perMetre, 0.0);
        outside = outside || t > end;
    } while (!hit && !outside && ++i < kMostSteps);
    // A ray that runs out of steps grazes a surface: it is there.
    bool seen = hit || (!outside && f * push.stepScale < 8.0 * push.pixel * (parallel ? 1.0 : t));
    float z = parallel ? 1.0 - t * push.near : push.near / t;
    if (all(lessThan(pixel, push.size))) imageStore(depth, ivec2(pixel), vec4(seen ? z : 0.0));
}
