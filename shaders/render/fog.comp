// Fog with the sun's rays in it, at half the picture's width and height: marched from the eye to what is seen, the sun's shadow
// map asked at each step. One step is taken somewhere in each of kSteps parts of the way, which grow with the distance, so that
// bands dissolve in the mean over frames: of the picture, or, while the view moves, of the fog itself, found again by the
// middle of what sends the light. Upwards the way ends where the fog has thinned out. Phase function: Henyey and Greenstein's.
#define SHADOW_MAP
#include "shared.h"
#include "render/render.h"
#include "render/view.glsl"

layout(local_size_x = RENDER_TILE, local_size_y = RENDER_TILE) in;
layout(binding = 0, scalar) uniform Frame { RenderFrame frame; };
layout(binding = 1, r32f) readonly uniform image2D seen;
layout(binding = 8, r32f) readonly uniform image2D shadowMap;
layout(binding = 12, rgba16f) writeonly uniform image2D fog;
layout(binding = 14, rg32f) writeonly uniform image2D ways;  // metres to the middle of what sends the light, frames that are known
layout(binding = 15, rgba16f) readonly uniform image2D fogBefore;
layout(binding = 16, rg32f) readonly uniform image2D waysBefore;

#include "render/solid.glsl"
#include "render/shadow.glsl"

const uint kSteps = 32;
const float kSameWay = 0.1;  // share by which ways may differ
const float kDark = 0.1;     // what fog in shadow counts for beside fog in the sun
const float kThin = 7.0;     // heights of the fog, above which there is next to none
const float kForward = 0.6;  // how much of the light goes on: 0 equally everywhere, 1 straight on

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy, half2 = (frame.size + 1) / 2;
    // Each frame of a mean looks at another of the four pixels, so that edges get the fog of both their sides.
    uvec2 full = min(pixel * 2 + uvec2(frame.mean & 1, frame.mean >> 1 & 1), frame.size - 1);
    float depth = imageLoad(seen, ivec2(full)).x;
    vec3 ray = rayOf(frame.now, placeOf(full, frame.size));
    float scale = length(ray), ground = groundAlong(frame.now, ray);
    float along = depth > 0.0 ? frame.now.near / depth : ground > 0.0 ? ground : 1e30, end = min(along * scale, frame.fogEnd);
    vec3 d = ray / scale;
    float cosine = dot(d, frame.sun), g = kForward;
    float phase = (1.0 - g * g) / (12.566371 * pow(1.0 + g * g - 2.0 * g * cosine, 1.5));
    vec3 sunshine = frame.sunLight * phase, sky = 0.25 * (frame.zenith + frame.horizon + 2.0 * frame.groundColor) * 0.25;
    // Read once: no compiler moves loads of uniforms out of a loop.
    vec3 eye = frame.now.eye;
    float densest = frame.fogDensity, falloff = frame.fogFalloff, low = max(frame.ground, frame.centre.y - frame.radius);
    bool shadows = unfolded(frame.shadowSize) != 0;
    if (falloff > 0.0 && d.y > 0.0) end = min(end, max(kThin / falloff + low - eye.y, 0.0) / d.y);
    float start = evenly(pixel, frame.number).x, through = 1.0, step = 1.0 / float(kSteps);
    vec3 sum = vec3(0.0);
    float far = 0.0, shares = 1e-9;  // of where the light comes from, sums
    uint i = 0;
    do {
        float u = (float(i) + start) * step;
        vec3 p = eye + d * (end * u * u);
        float density = densest * exp(-max(p.y - low, 0.0) * falloff);
        float lit = shadows ? sunReaches(inShadowMap(p), vec2(0.0)) : 1.0;
        float kept = exp(-density * (2.0 * end * step) * u);
        float share = through * (1.0 - kept);
        sum += share * (sunshine * lit + sky);
        far += share * (lit + kDark) * end * u * u;
        shares += share * (lit + kDark);
        through *= kept;
    } while (++i < kSteps);
    // Where the middle of what sends the light was seen.
    far /= shares;
    vec3 middle = eye + d * far, was = project(frame.before, middle);
    vec2 place = (vec2(0.5) + 0.5 * vec2(was.x, -was.y)) * vec2(half2);
    bool inBefore = unfolded(frame.fogKept) > 0 && was.z > 0.0 && all(greaterThanEqual(place, vec2(0.0))) && all(lessThan(place, vec2(half2)));
    ivec2 texel = ivec2(inBefore ? place : vec2(0.0));
    vec2 old = imageLoad(waysBefore, texel).xy;
    vec4 fogOld = imageLoad(fogBefore, texel);
    float way = distance(frame.before.eye, middle);
    float known = inBefore && abs(old.x - way) < kSameWay * way ? min(old.y, float(frame.fogKept) - 1.0) : 0.0;
    vec4 made = vec4(sum * frame.fogColor, through);
    if (known > 0.0) made.rgb = (made.rgb + fogOld.rgb * known) / (known + 1.0);
    if (all(lessThan(pixel, half2))) {
        imageStore(fog, ivec2(pixel), made);
        imageStore(ways, ivec2(pixel), vec4(far, known + 1.0, 0.0, 0.0));
    }
}
