// An edge-aware filter over what secondary.comp made, for one listed tile: a pixel and the four beside it, as far as they are of
// the same plane (Dammertz et al., "Edge-avoiding a-trous wavelet transform for fast global illumination filtering", 2010). One
// pass of it a frame: what it makes is the history of the next frame, so that each reaches farther, as the first level of Schied
// et al.'s ("Spatiotemporal variance-guided filtering", 2017). The more rays a pixel is the mean of, the less it takes of its
// neighbours, so that a resting view sharpens; a mirror takes nothing.
#include "shared.h"
#include "render/render.h"
#include "lib/octahedral.glsl"
#include "render/view.glsl"
#include "render/gbuffer.glsl"

layout(local_size_x = RENDER_TILE * RENDER_TILE) in;
layout(binding = 0, scalar) uniform Frame { RenderFrame frame; };
layout(binding = 2, rgba32ui) readonly uniform uimage2D surfaces;
layout(binding = 3, scalar) readonly buffer Tiles { uint tiles[]; };
#ifdef BOUNCE
layout(binding = 18, rgba16f) readonly uniform image2D bounceFrom;
layout(binding = 19, rgba16f) writeonly uniform image2D bounceTo;
#endif
#ifdef REFLECTIONS
layout(binding = 20, rgba16f) readonly uniform image2D reflectionFrom;
layout(binding = 21, rgba16f) writeonly uniform image2D reflectionTo;
#endif

#include "render/solid.glsl"

const float kFew = 64.0;          // rays, of which a pixel's neighbours count for half
const float kSamePlane = 0.004;   // of the distance to the eye
const float kRough = 0.35;        // roughness from which reflections are blurred like light from all around

void main() {
    uint lane = gl_LocalInvocationIndex, tile = tiles[RENDER_NEAR * frame.tiles + gl_WorkGroupID.x];
    uvec2 pixel = pixelOf(tile, lane);
    ivec2 last = ivec2(frame.size) - 1, at = min(ivec2(pixel), last);
    Surface s = unpackSurface(imageLoad(surfaces, at));
    bool surface = all(equal(ivec2(pixel), at)) && s.depth > 0.0;
    float depth = max(s.depth, 1e-6);
    vec3 ray = rayOf(frame.now, placeOf(uvec2(at), frame.size)), p = ray * (frame.now.near / depth);
    // Elsewhere there are no rays.
    surface = surface && nearSolid(frame.now.eye + p, 0.0);
    float perPlane = 1.0 / (kSamePlane * length(p));
#ifdef BOUNCE
    vec4 ownBounce = imageLoad(bounceFrom, at);
    vec3 bounce = ownBounce.rgb;
    float bounceWeight = 1.0, bounceTaken = kFew / (kFew + ownBounce.w);
#endif
#ifdef REFLECTIONS
    vec4 ownReflection = imageLoad(reflectionFrom, at);
    vec3 reflection = ownReflection.rgb;
    float reflectionWeight = 1.0, reflectionTaken = kFew / (kFew + ownReflection.w) * smoothstep(0.1, kRough, s.roughness);
#endif
    ivec2 step = ivec2(1, 0);
    for (int i = 0; i < 4; ++i) {
        step = ivec2(-step.y, step.x);
        ivec2 there = at + step;
        bool inside = all(greaterThanEqual(there, ivec2(0))) && all(lessThanEqual(there, last));
        there = clamp(there, ivec2(0), last);
        uvec4 words = imageLoad(surfaces, there);
        float otherDepth = uintBitsToFloat(words.x);
        vec3 q = rayOf(frame.now, placeOf(uvec2(there), frame.size)) * (frame.now.near / max(otherDepth, 1e-6));
        float facing = max(dot(s.n, unpackOctahedral(words.y)), 0.0), off = dot(s.n, q - p) * perPlane;
        facing *= facing;
        facing *= facing;
        facing *= facing;
        float weight = inside && otherDepth > 0.0 && nearSolid(frame.now.eye + q, 0.0) ? facing * facing * exp(-off * off) : 0.0;
#ifdef BOUNCE
        vec4 otherBounce = imageLoad(bounceFrom, there);
        bounce += otherBounce.rgb * (weight * bounceTaken);
        bounceWeight += weight * bounceTaken;
#endif
#ifdef REFLECTIONS
        float same = weight * reflectionTaken * (abs(unpackUnorm4x8(words.w).w - s.roughness) < 0.1 ? 1.0 : 0.0);
        vec4 otherReflection = imageLoad(reflectionFrom, there);
        reflection += otherReflection.rgb * same;
        reflectionWeight += same;
#endif
    }
#ifdef BOUNCE
    if (surface) imageStore(bounceTo, at, vec4(bounce / bounceWeight, ownBounce.w));
#endif
#ifdef REFLECTIONS
    if (surface) imageStore(reflectionTo, at, vec4(reflection / reflectionWeight, ownReflection.w));
#endif
}
