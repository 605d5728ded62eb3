// The mean of the paths that were traced (path.comp), as a display shows it.
#include "shared.h"
#include "render/render.h"

layout(local_size_x = RENDER_TILE, local_size_y = RENDER_TILE) in;
layout(binding = 0, scalar) uniform Frame { RenderFrame frame; };
layout(binding = 8, scalar) readonly buffer Sums { vec4 sums[]; };
layout(binding = 10, r32ui) writeonly uniform uimage2D pixels;

#include "render/tone.glsl"

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, frame.size))) return;
    vec4 sum = sums[pixel.y * frame.size.x + pixel.x];
    imageStore(pixels, ivec2(pixel), uvec4(displayed(toneMap(sum.rgb / max(sum.w, 1.0)), pixel)));
}
