// The mean of the paths that were traced (path.comp), as a display shows it; if CUTOUT is defined, with the share of them that
// met something as alpha. Or, with LIGHT, as light, in the fourth number that share.
#include "shared.h"
#include "render/render.h"

layout(local_size_x = RENDER_TILE, local_size_y = RENDER_TILE) in;
layout(binding = 0, scalar) uniform Frame { RenderFrame frame; };
layout(binding = 8, scalar) readonly buffer Sums { vec4 sums[]; };
#ifdef LIGHT
layout(binding = 9, rgba32f) writeonly uniform image2D means;
#else
layout(binding = 10, r32ui) writeonly uniform uimage2D pixels;
#endif

layout(push_constant, scalar) uniform Push { uint paths; };

#include "render/tone.glsl"

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, frame.size))) return;
    vec4 sum = sums[pixel.y * frame.size.x + pixel.x];
#ifdef LIGHT
    imageStore(means, ivec2(pixel), sum / float(max(paths, 1)));
#else
    float seen = float(max(paths, 1)), alpha = 1.0;
#ifdef CUTOUT
    seen = max(sum.w, 1.0), alpha = sum.w / float(max(paths, 1));
#endif
    imageStore(pixels, ivec2(pixel), uvec4(displayed(toneMap(sum.rgb / seen), alpha, pixel)));
#endif
}
