// From the G-buffer to the finished picture, one pixel an invocation: sun with its shadow, sky with the ambient occlusion,
// lamps, fog; tone map, mean over frames, sRGB. It samples no field, so one pipeline serves all graphs.
// Where no surface is there is the sky, or a studio's wall, on which the ground, not drawn itself, catches the solid's shadow.
// Tone map: ACES, as fitted by Narkowicz ("ACES filmic tone mapping curve", 2015).
// LAMPS and FOG are defined where there are any.
#include "shared.h"
#include "render/render.h"
#include "lib/octahedral.glsl"
#include "render/view.glsl"
#include "render/gbuffer.glsl"

layout(local_size_x = RENDER_TILE, local_size_y = RENDER_TILE) in;
layout(binding = 0, scalar) uniform Frame { RenderFrame frame; };
layout(binding = 2, rgba32ui) readonly uniform uimage2D surfaces;
layout(binding = 7, r32ui) readonly uniform uimage2D history;  // ambient.comp
layout(binding = 8) uniform sampler2D shadowMap;
layout(binding = 9, rg32ui) uniform uimage2D means;  // of the frames since the view came to rest, 16 bits a channel
layout(binding = 10, scalar) writeonly buffer Pixels { uint pixels[]; };  // sRGB, red in the lowest byte
#ifdef LAMPS
layout(binding = 11, rgba16f) readonly uniform image2D lamps;
#endif
#ifdef FOG
layout(binding = 12, rgba16f) readonly uniform image2D fog;  // light that it sends; share of light that it lets through
#endif

#include "render/shading.glsl"
#include "render/shadow.glsl"

// How much of the sun p sees: four places of a disc of two texels, turned for each pixel and frame.
float sunSeen(vec3 p, vec3 n, uvec2 pixel) {
    vec3 from = p + n * (1.5 * frame.shadowTexel) + frame.sun * (0.75 * frame.shadowTexel);
    float angle = 6.2831853 * evenly(pixel, frame.number).x;
    vec2 spot = 1.4 * vec2(cos(angle), sin(angle));
    float sum = sunReaches(from, spot) + sunReaches(from, -spot);
    spot = 0.7 * vec2(-spot.y, spot.x);
    return 0.25 * (sum + sunReaches(from, spot) + sunReaches(from, -spot));
}

vec3 toneMap(vec3 x) {
    x *= frame.exposure;
    return clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    bool inPicture = all(lessThan(pixel, frame.size));
    ivec2 at = ivec2(min(pixel, frame.size - 1));
    Surface s = unpackSurface(imageLoad(surfaces, at));
    bool there = s.depth > 0.0;
    vec2 place = placeOf(pixel, frame.size);
    vec3 ray = rayOf(frame.now, place), toEye = normalize(-ray);
    vec3 p = frame.now.eye + ray * (frame.now.near / (there ? s.depth : 1.0));
    float open = there ? float(imageLoad(history, at).x & 0xffff) / 65535.0 : 1.0;
    open = mix(1.0, open, frame.ambientStrength);
    float sunlit = frame.shadowSize != 0 && there ? sunSeen(p, s.n, pixel) : 1.0;

    vec3 color = reflected(s, toEye, frame.sun, frame.sunLight * sunlit) + ambientLight(s, toEye, open) + s.emission;
#ifdef LAMPS
    color += there ? imageLoad(lamps, at).rgb : vec3(0.0);
#endif
    float height = 0.5 + 0.5 * place.y;
    vec3 wall = mix(vec3(0.76, 0.745, 0.72), vec3(0.36, 0.43, 0.53), smoothstep(0.0, 1.1, height)) * (1.0 - 0.10 * dot(place, place));
    // The ground fades into what is behind it; of its light the shadow leaves that of the sky.
    float away = length(p.xz - frame.centre.xz) / frame.radius;
    float fade = s.ground && there ? 1.0 - smoothstep(0.43 * frame.groundEnd, frame.groundEnd, away) : 0.0;
    vec3 dimmed = mix(vec3(0.46, 0.50, 0.58), vec3(1.0), sunlit) * mix(0.35, 1.0, open);
    vec3 studio = wall * mix(vec3(1.0), dimmed, fade);
    vec3 outdoors = mix(skySeen(-toEye), color, fade);
    color = !there || s.ground ? frame.backdrop != 0 ? studio : outdoors : color;
#ifdef FOG
    vec4 veil = imageLoad(fog, at / 2);
    color = color * veil.a + veil.rgb;
#endif
    vec3 linear = toneMap(color);
    if (frame.show != RENDER_PICTURE) {
        vec3 part = frame.show == RENDER_AMBIENT ? vec3(open) : frame.show == RENDER_NORMALS ? 0.5 + 0.5 * s.n
                    : frame.show == RENDER_BASE ? s.base : vec3(sunlit);
        linear = there ? part : vec3(0.1);
    }

    uvec2 words = imageLoad(means, at).xy;
    vec3 before = vec3(unpackUnorm2x16(words.x), unpackUnorm2x16(words.y).x);
    linear = mix(linear, before, float(frame.mean) / float(frame.mean + 1));
    vec3 encoded = mix(12.92 * linear, 1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055, greaterThan(linear, vec3(0.0031308)));
    // Half a step up or down by Bayer's 4 x 4 pattern keeps gradients from banding, and files small.
    uint bits = pixel.x ^ pixel.y;
    float rank = float((bits & 1u) << 3 | (pixel.y & 1u) << 2 | (bits & 2u) | (pixel.y & 2u) >> 1);
    float noise = (rank + 0.5) / 16.0 - 0.5;
    uvec3 bytes = uvec3(clamp(255.0 * encoded + noise + 0.5, 0.0, 255.0));
    if (inPicture) {
        imageStore(means, at, uvec4(packUnorm2x16(linear.xy), packUnorm2x16(vec2(linear.z, 0.0)), 0, 0));
        pixels[pixel.y * frame.size.x + pixel.x] = bytes.x | bytes.y << 8 | bytes.z << 16 | 255u << 24;
    }
}
