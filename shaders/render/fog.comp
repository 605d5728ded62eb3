// Fog with the sun's rays in it, at half the picture's width and height: marched from the eye to what is seen, the sun's shadow
// map asked at each step. One step is taken somewhere in each of kSteps equal parts of the way, so that bands dissolve in the
// mean over frames. Phase function: Henyey and Greenstein's.
#include "shared.h"
#include "render/render.h"
#include "render/view.glsl"

layout(local_size_x = RENDER_TILE, local_size_y = RENDER_TILE) in;
layout(binding = 0, scalar) uniform Frame { RenderFrame frame; };
layout(binding = 2, rgba32ui) readonly uniform uimage2D surfaces;
layout(binding = 8) uniform sampler2D shadowMap;
layout(binding = 12, rgba16f) writeonly uniform image2D fog;

#include "render/shadow.glsl"

const uint kSteps = 32;
const float kForward = 0.6;  // how much of the light goes on: 0 equally everywhere, 1 straight on

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy, half2 = (frame.size + 1) / 2;
    uvec2 full = min(pixel * 2, frame.size - 1);
    float depth = uintBitsToFloat(imageLoad(surfaces, ivec2(full)).x);
    vec3 ray = rayOf(frame.now, placeOf(full, frame.size));
    float scale = length(ray), end = min(depth > 0.0 ? frame.now.near / depth * scale : frame.fogEnd, frame.fogEnd);
    vec3 d = ray / scale;
    float cosine = dot(d, frame.sun), g = kForward;
    float phase = (1.0 - g * g) / (12.566371 * pow(1.0 + g * g - 2.0 * g * cosine, 1.5));
    vec3 sunshine = frame.sunLight * phase, sky = 0.25 * (frame.zenith + frame.horizon + 2.0 * frame.groundColor) * 0.25;
    float start = evenly(pixel, frame.number).x, through = 1.0, step = end / float(kSteps);
    vec3 sum = vec3(0.0);
    uint i = 0;
    do {
        vec3 p = frame.now.eye + d * ((float(i) + start) * step);
        float density = frame.fogDensity * exp(-max(p.y - max(frame.ground, frame.centre.y - frame.radius), 0.0) * frame.fogFalloff);
        float lit = frame.shadowSize != 0 ? sunReaches(p, vec2(0.0)) : 1.0;
        float kept = exp(-density * step);
        sum += through * (1.0 - kept) * (sunshine * lit + sky);
        through *= kept;
    } while (++i < kSteps);
    if (all(lessThan(pixel, half2))) imageStore(fog, ivec2(pixel), vec4(sum * frame.fogColor, through));
}
