// One pass over a pyramid of ever smaller pictures, for light that spills from bright places (runtime/render/bloom.h):
//   DOWN    a picture from the one that is twice as large, by a filter that has a part of each texel's neighbours (1, 3, 3, 1)
//   ACROSS  a picture blurred from left to right, by a Gaussian
//   UP      a picture, with what ACROSS made of it blurred from top to bottom and, smoothly enlarged, the smaller one below it,
//           weighed, in place of itself
//   none of them: as UP, of the largest, which is kept beside it and shown as light.comp would
// NEUTRAL and CUTOUT are as in light.comp. In the fourth number is alpha, by which light is multiplied.
#include "shared.h"
#include "render/render.h"

layout(local_size_x = RENDER_TILE, local_size_y = RENDER_TILE) in;
layout(binding = 1, rgba32f) readonly uniform image2D from;  // UP: the smaller one
layout(push_constant, scalar) uniform Push { BloomPush push; };
#if defined(DOWN) || defined(ACROSS) || defined(UP)
layout(binding = 2, rgba32f) uniform image2D to;
#else
layout(binding = 0, scalar) uniform Frame { RenderFrame frame; };
layout(binding = 2, rgba32f) readonly uniform image2D light;
layout(binding = 3, rgba32f) writeonly uniform image2D to;
layout(binding = 10, r32ui) writeonly uniform uimage2D pixels;
#include "render/tone.glsl"
#endif
#ifdef UP
layout(binding = 4, rgba32f) readonly uniform image2D across;
#endif

vec4 texel(ivec2 at) { return imageLoad(from, clamp(at, ivec2(0), imageSize(from) - 1)); }

// Of the smaller one, by its four nearest.
vec4 enlarged(ivec2 at) {
    ivec2 first = (at + 1) / 2 - 1;
    vec2 part = mix(vec2(0.75), vec2(0.25), equal(at & 1, ivec2(1)));
    return mix(mix(texel(first), texel(first + ivec2(1, 0)), part.x), mix(texel(first + ivec2(0, 1)), texel(first + 1), part.x), part.y);
}

// How much a texel has of that `away` from it, before all are made to sum to 1.
const int kReach = 6;
float gaussian(int away) { return exp(-0.5 * float(away * away) / push.variance); }

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, imageSize(to)))) return;
    vec4 sum = vec4(0.0);
#ifdef DOWN
    const float kPart[] = {0.125, 0.375, 0.375, 0.125};
    for (int i = 0; i < 16; ++i) sum += kPart[i % 4] * kPart[i / 4] * texel(2 * at - 1 + ivec2(i % 4, i / 4));
    imageStore(to, at, sum);
#elif defined(ACROSS)
    float weights = 0.0;
    for (int i = -kReach; i <= kReach; ++i) {
        sum += gaussian(i) * texel(at + ivec2(i, 0));
        weights += gaussian(i);
    }
    imageStore(to, at, sum / weights);
#elif defined(UP)
    float weights = 0.0;
    for (int i = -kReach; i <= kReach; ++i) {
        sum += gaussian(i) * imageLoad(across, clamp(at + ivec2(0, i), ivec2(0), imageSize(across) - 1));
        weights += gaussian(i);
    }
    imageStore(to, at, push.plain * imageLoad(to, at) + push.blurred / weights * sum + push.smaller * enlarged(at));
#else
    vec4 own = imageLoad(light, at);
    sum = vec4(push.plain * own.rgb + push.smaller * enlarged(at).rgb, own.a);  // what glows does not cover
    imageStore(to, at, sum);
    float alpha = 1.0;
#ifdef CUTOUT
    alpha = clamp(sum.a, 0.0, 1.0);
    sum.rgb /= max(alpha, 1e-4);
#endif
    imageStore(pixels, at, uvec4(displayed(toneMap(sum.rgb), alpha, uvec2(at))));
#endif
}
