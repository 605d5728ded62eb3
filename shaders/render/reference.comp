// Ambient occlusion as it should be, for one listed tile: many rays a pixel, each traced until it is at its end or at the
// surface, none shared, none kept from earlier frames. What the fast way (ambient.comp) is judged by, and independent of it.
#define FIELD_VALUE
#include "shared.h"
#include "render/render.h"
#include "render/places.glsl"
#include "lib/octahedral.glsl"
#include "render/view.glsl"
#include "render/history.glsl"

layout(local_size_x = RENDER_TILE * RENDER_TILE) in;
layout(binding = 0, scalar) uniform Frame { RenderFrame frame; };
layout(binding = 2, rgba32ui) readonly uniform uimage2D surfaces;
layout(binding = 3, scalar) readonly buffer Tiles { uint tiles[]; };
layout(binding = 7, r32ui) writeonly uniform uimage2D historyNow;
layout(push_constant, scalar) uniform Push { uint rays; };

#include "render/solid.glsl"
#include "lib/random.glsl"

const float kLeastStep = 1.0 / 1024.0;  // of a ray's length

void main() {
    fieldBegin();
    uint lane = gl_LocalInvocationIndex, tile = tiles[RENDER_NEAR * frame.tiles + gl_WorkGroupID.x];
    uvec2 pixel = pixelOf(tile, lane);
    uvec2 here = min(pixel, frame.size - 1);
    uvec4 words = imageLoad(surfaces, ivec2(here));
    float depth = uintBitsToFloat(words.x);
    bool surface = all(equal(pixel, here)) && depth > 0.0;
    vec3 n = unpackOctahedral(words.y), p = pointAt(frame.now, placeOf(here, frame.size), surface ? depth : 1.0) + n * frame.bias;
    Bounds bounds = solidBounds();
    float radius = frame.ambientRadius, close = radius * kLeastStep, open = 0.0;
    uint state = (here.y * frame.size.x + here.x) * 9781u + frame.number * 6271u + 1u, ray = 0, all = unfolded(rays);
    do {
        vec2 u = vec2(random(state), random(state));
        vec3 d = cosineDirection(n, u);
        float t = 0.0, least = 1.0;
        do {
            float h = clearance(bounds, p + d * t);
            least = min(least, h);
            t += max(h, close);
        } while (least > 0.0 && t < radius);
        open += least > 0.0 ? 1.0 : 0.0;
    } while (++ray < all);
    if (surface) imageStore(historyNow, ivec2(here), uvec4(packHistory(open / float(rays), rays)));
}
