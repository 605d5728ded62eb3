// Light of the scene's lamps on one listed tile, each with a shadow traced through the field, and, with TRACED_SUN, how much of
// the sun is seen. The penumbra is Quilez' ("Soft
// shadows in raymarched SDFs"): how closely the ray passes by, over how far.
#define FIELD_VALUE
#include "shared.h"
#include "render/render.h"
#include "render/places.glsl"
#include "lib/octahedral.glsl"
#include "render/view.glsl"
#include "render/gbuffer.glsl"

layout(local_size_x = RENDER_TILE * RENDER_TILE) in;
layout(binding = 0, scalar) uniform Frame { RenderFrame frame; };
layout(binding = 2, rgba32ui) readonly uniform uimage2D surfaces;
layout(binding = 3, scalar) readonly buffer Tiles { uint tiles[]; };
layout(push_constant, scalar) uniform Push { uint list; };  // of tiles
layout(binding = 13, rgba16f) writeonly uniform image2D lamps;  // light; share of the sun

#include "render/solid.glsl"
#include "render/shading.glsl"

const uint kSteps = 64, kSunSteps = 256;  // the sun is low at times, and streets are long

// Share of a lamp of this size, `far` away, that p sees in direction d.
float lampSeen(vec3 p, vec3 d, float far, float size, uint steps) {
    Bounds bounds = solidBounds();
    float bias = frame.bias, t = bias, seen = 1.0;
    uint i = 0;
    do {
        float clear = clearance(bounds, p + t * d);
        seen = min(seen, clear * far / (max(size, 0.002 * far) * t));
        t += max(0.9 * clear, 0.5 * bias + 0.004 * t);
    } while (++i < steps && seen > 0.0 && t < far);
    return smoothstep(0.0, 1.0, seen);
}

void main() {
    fieldBegin();
    uint lane = gl_LocalInvocationIndex, tile = tiles[list * frame.tiles + gl_WorkGroupID.x];
    uvec2 pixel = pixelOf(tile, lane);
    uvec2 here = min(pixel, frame.size - 1);
    float toGround = groundAlong(frame.now, rayOf(frame.now, placeOf(here, frame.size)));
    Surface s = unpackSurface(imageLoad(surfaces, ivec2(here)));
    if (list != RENDER_SOLID) s = groundSurface(toGround > 0.0 ? frame.now.near / toGround : 0.0);
    bool there = s.depth > 0.0;
    vec3 p = pointAt(frame.now, placeOf(here, frame.size), there ? s.depth : 1.0), toEye = normalize(frame.now.eye - p);
    vec3 from = p + s.n * frame.bias, sum = vec3(0.0);
    uint lights = unfolded(frame.lightCount);
    for (uint i = 0; i < lights; ++i) {
        Light light = frame.lights[i];
        vec3 d;
        float far;
        vec3 sent = lampSends(light, from, d, far);
        float seen = lampSeen(from, d, far, light.directional != 0 ? 0.02 * far : light.size, kSteps);
        sum += reflected(s, toEye, d, sent * seen);
    }
    float sunlit = 1.0;
#ifdef TRACED_SUN
    float away = 4.0 * frame.radius;
    sunlit = dot(s.n, frame.sun) > 0.0 ? lampSeen(from, frame.sun, away, frame.sunWide * away, kSunSteps) : 0.0;
#endif
    if (there && all(lessThan(pixel, frame.size))) imageStore(lamps, ivec2(pixel), vec4(min(sum, vec3(6e4)), sunlit));
}
