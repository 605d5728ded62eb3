// From the G-buffer to the finished picture, one listed tile a work group: sun with its shadow, sky with the ambient occlusion,
// lamps, fog; tone map, mean over frames, sRGB. It samples no field, so its pipelines serve all graphs.
// Where no surface is there is the sky, or a studio's wall, on which the ground, not drawn itself, catches the solid's shadow.
// Tone map: ACES, as fitted by Narkowicz ("ACES filmic tone mapping curve", 2015); or Khronos' PBR Neutral (its specification,
// 2024), which takes 4 % off, for a highlight's, leaves colours below 0.8 as they are, and lets brighter ones bleach as a whole.
// Defined as needed: LIST, the kind of tiles that are done; SKY rather than the studio; LAMPS; FOG; MEAN where the picture is the
// mean of frames; NEUTRAL.
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
layout(binding = 9, rg32ui) uniform uimage2D means;  // linear, 16 bits a channel
#endif
layout(binding = 10, r32ui) writeonly uniform uimage2D pixels;  // sRGB, red in the lowest byte
#ifdef LAMPS
layout(binding = 11, rgba16f) readonly uniform image2D lamps;
#endif
#ifdef FOG
layout(binding = 12, rgba16f) readonly uniform image2D fog;  // light that it sends; share of light that it lets through
#endif

#include "render/solid.glsl"
#include "render/shading.glsl"
#include "render/shadow.glsl"

// How much of the sun p sees: two places opposite of each other in a disc of two texels, others for each pixel and frame.
float sunSeen(vec3 p, vec3 n, uvec2 pixel) {
    vec3 at = inShadowMap(p + n * (1.5 * frame.shadowTexel) + frame.sun * (0.75 * frame.shadowTexel));
    vec2 u = evenly(pixel, frame.number), spot = vec2(cos(6.2831853 * u.x), sin(6.2831853 * u.x)) * (1.5 * sqrt(u.y));
    return 0.5 * (sunReaches(at, spot) + sunReaches(at, -spot));
}

vec3 toneMap(vec3 x) {
    x = min(x * frame.exposure, 1e4);  // far beyond white, and its square is finite
#ifdef NEUTRAL
    const float kHighlight = 0.04, kKept = 0.8 - kHighlight, kLeft = 1.0 - kKept, kBleaching = 0.15;
    float least = min(x.r, min(x.g, x.b));
    x -= least < 2.0 * kHighlight ? least - least * least / (4.0 * kHighlight) : kHighlight;
    float most = max(x.r, max(x.g, x.b));
    float pressed = most < kKept ? most : 1.0 - kLeft * kLeft / (most + kLeft - kKept);
    float bleached = 1.0 - 1.0 / (kBleaching * (most - pressed) + 1.0);
    return mix(x * (pressed / max(most, 1e-6)), vec3(pressed), bleached);
#endif
    return clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}

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
    vec3 behind = mix(vec3(0.76, 0.745, 0.72), vec3(0.36, 0.43, 0.53), smoothstep(-1.0, 1.2, place.y)) * (1.0 - 0.10 * dot(place, place));
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
    float sunlit = frame.shadowSize != 0 && there ? sunSeen(p, s.n, pixel) : 1.0;

    // The ground fades into what is behind it; of the wall's light a shadow on it leaves that of the sky.
    float away = length(p.xz - frame.centre.xz) / frame.radius;
    float fade = s.ground && there ? 1.0 - smoothstep(0.43 * frame.groundEnd, frame.groundEnd, away) : 0.0;
    vec3 lamplight = vec3(0.0);
#ifdef LAMPS
    lamplight = there ? imageLoad(lamps, at).rgb : vec3(0.0);
#endif
#ifdef SKY
    vec3 onGround = s.base * (frame.sunLight * (max(frame.sun.y, 0.0) * sunlit / kPi) + 0.66 * open * skylight(vec3(0, 1, 0)));
    vec3 color = mix(behind, onGround + lamplight, fade);
#else
    vec3 dimmed = mix(vec3(0.46, 0.50, 0.58), vec3(1.0), sunlit) * mix(0.35, 1.0, open);
    vec3 color = behind * mix(vec3(1.0), dimmed, fade) + fade * lamplight;
#endif
#if LIST == RENDER_SOLID
    vec3 lit = reflected(s, toEye, frame.sun, frame.sunLight * sunlit) + ambientLight(s, toEye, open) + s.emission + lamplight;
    color = there && !s.ground ? lit : color;
#endif
#endif
#ifdef FOG
    vec4 veil = imageLoad(fog, at / 2);
    color = color * veil.a + veil.rgb;
#endif
    vec3 linear = toneMap(color);
    bool solid = there && !s.ground;
    linear = frame.show == RENDER_AMBIENT ? vec3(open) : frame.show == RENDER_SHADOW ? vec3(sunlit) : linear;
    linear = frame.show == RENDER_NORMALS ? solid ? 0.5 + 0.5 * s.n : vec3(0.1) : linear;
    linear = frame.show == RENDER_BASE ? solid ? s.base : vec3(0.1) : linear;
#ifdef MEAN
    uvec2 words = imageLoad(means, at).xy;
    vec3 before = vec3(unpackUnorm2x16(words.x), unpackUnorm2x16(words.y).x);
    linear = mix(linear, before, float(frame.mean) / float(frame.mean + 1));
    if (inPicture) imageStore(means, at, uvec4(packUnorm2x16(linear.xy), packUnorm2x16(vec2(linear.z, 0.0)), 0, 0));
#endif
    // sRGB's curve, fitted to 0.16 of a step of eight bits.
    vec3 root = sqrt(linear), encoded = (root * (root * 1.66847 + 1.41553) - 0.03867) / (root * 2.04346 + 1.0);
    encoded = mix(12.92 * linear, encoded, greaterThan(linear, vec3(0.0031308)));
    // Half a step up or down by Bayer's 4 x 4 pattern keeps gradients from banding, and files small.
    uint bits = pixel.x ^ pixel.y;
    float rank = float((bits & 1u) << 3 | (pixel.y & 1u) << 2 | (bits & 2u) | (pixel.y & 2u) >> 1);
    float noise = (rank + 0.5) / 16.0 - 0.5;
    uvec3 bytes = uvec3(clamp(255.0 * encoded + noise + 0.5, 0.0, 255.0));
    if (inPicture) imageStore(pixels, at, uvec4(bytes.x | bytes.y << 8 | bytes.z << 16 | 255u << 24));
}
