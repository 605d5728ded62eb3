// From the G-buffer to the finished picture, one listed tile a work group: sun with its shadow, sky with the ambient occlusion,
// lamps, fog; tone map, mean over frames, sRGB. It samples no field, so its pipelines serve all graphs.
// Where no surface is there is the sky, or a studio's wall, on which the ground, not drawn itself, catches the solid's shadow.
// Defined as needed: LIST, the kind of tiles that are done; SKY rather than the studio; LAMPS; FOG; BOUNCE,
// REFLECTIONS and TRANSMITS, of secondary.comp; TRACED_SUN, of lamps.comp; CUTOUT where the solid alone is shown; MEAN where the picture is the
// mean of frames, of what a display shows, or, LINEAR, of the light itself, whose noise would darken what is shown; NEUTRAL, of tone.glsl.
#define SHADOW_MAP
#include "shared.h"
#include "render/render.h"
#include "lib/octahedral.glsl"
#include "render/view.glsl"
#include "render/history.glsl"
#include "render/gbuffer.glsl"

#ifndef LIST
#define LIST RENDER_SOLID
#endif

layout(local_size_x = RENDER_TILE * RENDER_TILE) in;
layout(binding = 0, scalar) uniform Frame { RenderFrame frame; };
layout(binding = 2, rgba32ui) readonly uniform uimage2D surfaces;
layout(binding = 3, scalar) readonly buffer Tiles { uint tiles[]; };
layout(binding = 7, r32ui) readonly uniform uimage2D history;  // ambient.comp
layout(binding = 8, r32f) readonly uniform image2D shadowMap;
#ifdef MEAN
#ifdef LINEAR
layout(binding = 9, rgba32f) uniform image2D means;  // of radiance, times alpha, and of alpha
#else
layout(binding = 9, rg32ui) uniform uimage2D means;  // of what a display shows, linear, times alpha, and of alpha: 16 bits a channel
#endif
#endif
layout(binding = 10, r32ui) writeonly uniform uimage2D pixels;  // sRGB, red in the lowest byte; alpha, not multiplied with, in the highest
#if defined(LAMPS) || defined(TRACED_SUN)
layout(binding = 11, rgba16f) readonly uniform image2D lamps;  // light; share of the sun
#endif
#ifdef FOG
layout(binding = 1, r32f) readonly uniform image2D seen;
layout(binding = 12, rgba16f) readonly uniform image2D fog;  // light that it sends; share of light that it lets through
#endif

#ifdef BOUNCE
layout(binding = 19, rgba16f) readonly uniform image2D bounce;
#endif
#ifdef REFLECTIONS
layout(binding = 21, rgba16f) readonly uniform image2D reflection;
#endif
#ifdef TRANSMITS
layout(binding = 22, rgba16f) readonly uniform image2D passed;
layout(binding = 23, rgba16f) readonly uniform image2D sunlight;
#endif

#include "render/solid.glsl"
#include "render/shading.glsl"
#include "render/shadow.glsl"
#include "render/tone.glsl"

// How much of the sun p sees: two places opposite of each other in a disc of two texels, others for each pixel and frame.
float sunSeen(vec3 p, vec3 n, uvec2 pixel) {
    vec3 at = surfaceInShadowMap(p, n);
    vec2 spot = spotInMap(evenly(pixel, frame.number));
    return 0.5 * (sunReaches(at, spot) + sunReaches(at, -spot));
}

#ifdef FOG
// Of the four nearest pixels of fog.comp, those alone that look as far.
vec4 fogAt(ivec2 pixel) {
    ivec2 offset = ivec2(frame.mean & 1, frame.mean >> 1 & 1), most = (ivec2(frame.size) + 1) / 2 - 1, last = ivec2(frame.size) - 1;
    vec2 at = max(vec2(pixel - offset) * 0.5, vec2(0.0)), part = fract(at);
    float depth = imageLoad(seen, pixel).x;
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 texel = min(ivec2(at) + ivec2(i & 1, i >> 1), most);
        vec2 near = mix(1.0 - part, part, vec2(i & 1, i >> 1));
        float other = imageLoad(seen, min(texel * 2 + offset, last)).x;
        float weight = near.x * near.y / (0.01 + abs(depth - other) / max(max(depth, other), 1e-12)) + 1e-6;
        sum += imageLoad(fog, texel) * weight;
        weights += weight;
    }
    return sum / weights;
}
#endif

void main() {
    uint lane = gl_LocalInvocationIndex, tile = tiles[LIST * frame.tiles + gl_WorkGroupID.x];
    uvec2 pixel = pixelOf(tile, lane);
    bool inPicture = all(lessThan(pixel, frame.size));
    ivec2 at = ivec2(min(pixel, frame.size - 1));
    vec2 place = placeOf(pixel, frame.size);
    vec3 ray = rayOf(frame.now, place), toEye = normalize(-ray);
#ifdef SKY
    vec3 behind = skySeen(-toEye);
#else
    vec3 behind = wallAt(place);
#endif
#if LIST == RENDER_BACK
    bool there = false;
    float open = 1.0, sunlit = 1.0;
    Surface s = groundSurface(0.0);
    vec3 color = behind;
#else
#if LIST == RENDER_GROUND
    float toGround = groundAlong(frame.now, ray);
    Surface s = groundSurface(toGround > 0.0 ? frame.now.near / toGround : 0.0);
#else
    Surface s = unpackSurface(imageLoad(surfaces, at));
#endif
    bool there = s.depth > 0.0;
    vec3 p = frame.now.eye + ray * (frame.now.near / (there ? s.depth : 1.0));
    bool occluded = there && nearSolid(p, 0.0);
    float open = mix(1.0, occluded ? opennessOf(imageLoad(history, at).x) : 1.0, frame.ambientStrength);
#ifdef TRACED_SUN
    float sunlit = there ? imageLoad(lamps, at).w : 1.0;
#else
    float sunlit = unfolded(frame.shadowSize) != 0 && there ? sunSeen(p, s.n, pixel) : 1.0;
#endif
    vec3 sunned = vec3(sunlit);
#ifdef TRANSMITS
    // Through what transmits, which the map takes for opaque.
    vec3 fromIt = max(max(frame.lo - p, p - frame.hi), 0.0);
    float far = smoothstep(0.5, 1.0, length(fromIt) / frame.ambientRadius);
    if (unfolded(frame.shadowSize) != 0 && occluded) sunned = mix(imageLoad(sunlight, at).rgb, sunned, far);
    sunlit = (sunned.r + sunned.g + sunned.b) / 3.0;
#endif

    float fade = s.ground && there ? groundLeft(p) : 0.0;
    vec3 lamplight = vec3(0.0);
#ifdef LAMPS
    lamplight = there ? imageLoad(lamps, at).rgb : vec3(0.0);
#endif
#ifdef SKY
    vec3 around = 0.66 * open * skylight(vec3(0, 1, 0));
#ifdef BOUNCE
    // Rays know the ground as far as they may reach the solid; there it goes over to what an open sky sends.
    around = skylight(vec3(0, 1, 0));
    vec3 from = max(max(frame.lo - p, p - frame.hi), 0.0);
    if (occluded) around = mix(imageLoad(bounce, at).rgb, around, smoothstep(0.5, 1.0, length(from) / frame.ambientRadius));
#endif
    vec3 onGround = s.base * (frame.sunLight * sunned * (max(frame.sun.y, 0.0) / kPi) + around);
    vec3 color = mix(behind, onGround + lamplight, fade);
#else
    vec3 color = behind * mix(vec3(1.0), wallDimmed(vec3(sunlit), open), fade) + fade * lamplight;
#endif
#if LIST == RENDER_SOLID
    vec3 behindIt = vec3(0.0);
#ifdef TRANSMITS
    vec4 through = imageLoad(passed, at);
    behindIt = through.rgb;
    s.base *= 1.0 - through.a;
#endif
    vec3 diffuse = 0.66 * bounced(open, s.base) * skylight(s.n), mirror = open * surroundings(mirrorAxis(s, toEye), s.roughness);
#ifdef BOUNCE
    diffuse = imageLoad(bounce, at).rgb;
#endif
#ifdef REFLECTIONS
    mirror = imageLoad(reflection, at).rgb;
#endif
    vec3 share = mirroredShare(s, toEye), kept = vec3(1.0);
#ifdef REFLECTIONS
    // What facets mask is mirrored once more (Turquin, "Practical multiple scattering compensation for microfacet models", 2019).
    Surface white = s;
    white.base = vec3(1.0), white.metallic = 1.0;
    share *= 1.0 + mirrored(s) * (1.0 / mirroredShare(white, toEye) - 1.0);
#endif
#ifdef BOUNCE
    kept -= share;  // what facets mirror does not reach the base
#endif
    vec3 lit = reflected(s, toEye, frame.sun, frame.sunLight * sunned) + s.base * (1.0 - s.metallic) * kept * diffuse + share * mirror + behindIt +
               s.emission + lamplight;
    color = there && !s.ground ? lit : color;
#endif
#endif
#ifdef FOG
    vec4 veil = fogAt(at);
    color = color * veil.a + veil.rgb;
#endif
    bool solid = there && !s.ground;
    float alpha = 1.0;
#ifdef CUTOUT
    alpha = solid ? 1.0 : 0.0;
    color *= alpha;
#endif
#if defined(MEAN) && defined(LINEAR)
    vec4 mean = vec4(any(isnan(color)) ? vec3(0.0) : min(color, vec3(1e6)), alpha);
    if (unfolded(frame.mean) > 0) mean = mix(mean, imageLoad(means, at), float(frame.mean) / float(frame.mean + 1));
    if (inPicture) imageStore(means, at, mean);
    color = mean.rgb;
#ifdef CUTOUT
    alpha = mean.a;
    color /= max(alpha, 1e-4);
#endif
#endif
    vec3 linear = toneMap(color);
    linear = frame.show == RENDER_AMBIENT ? vec3(open) : frame.show == RENDER_SHADOW ? vec3(sunlit) : linear;
    linear = frame.show == RENDER_NORMALS ? solid ? 0.5 + 0.5 * s.n : vec3(0.1) : linear;
    linear = frame.show == RENDER_BASE ? solid ? s.base : vec3(0.1) : linear;
#if defined(MEAN) && !defined(LINEAR)
    uvec2 words = imageLoad(means, at).xy;
    vec4 before = vec4(unpackUnorm2x16(words.x), unpackUnorm2x16(words.y)), mean = mix(vec4(linear * alpha, alpha), before, float(frame.mean) / float(frame.mean + 1));
    if (inPicture) imageStore(means, at, uvec4(packUnorm2x16(mean.xy), packUnorm2x16(mean.zw), 0, 0));
    linear = mean.rgb;
#ifdef CUTOUT
    alpha = mean.a;
    linear /= max(alpha, 1e-4);
#endif
#endif
    if (inPicture) imageStore(pixels, at, uvec4(displayed(linear, alpha, pixel)));
}
