// Where a particle is seen, the G-buffer gets what it shows.
#define FIELD_MATERIAL
#include "shared.h"
#include "render/render.h"
#include "field.glsl"
#include "lib/octahedral.glsl"
#include "render/view.glsl"
#include "render/gbuffer.glsl"

layout(local_size_x = RENDER_TILE * RENDER_TILE) in;
layout(binding = 0, scalar) uniform Frame { RenderFrame frame; };
layout(binding = 1, r32f) readonly uniform image2D seen;
layout(binding = 2, rgba32ui) writeonly uniform uimage2D surfaces;
layout(binding = 3, scalar) readonly buffer Tiles { uint tiles[]; };
layout(binding = 4, rg32ui) readonly uniform uimage2D looks;  // sprite.frag

#include "render/solid.glsl"

void main() {
    uint lane = gl_LocalInvocationIndex, tile = tiles[RENDER_NEAR * frame.tiles + gl_WorkGroupID.x];
    uvec2 pixel = pixelOf(tile, lane);
    bool inPicture = all(lessThan(pixel, frame.size));
    ivec2 at = ivec2(min(pixel, frame.size - 1));
    float depth = imageLoad(seen, at).x;
    float toGround = groundAlong(frame.now, rayOf(frame.now, placeOf(pixel, frame.size)));
    bool hidden = toGround > 0.0 && toGround * depth < frame.now.near;
    uvec2 look = imageLoad(looks, at).xy;
    vec3 color = unpackUnorm4x8(look.y).rgb;
    uvec4 surface = packSurface(depth, unpackOctahedral(look.x), FieldMaterial(color * color, 0.5, 0.0, vec3(0.0), 0.0, 1.5, vec3(0.0)));
    surface = hidden ? packGround(frame.now.near / toGround) : surface;
    if (inPicture && look.y != 0) imageStore(surfaces, at, surface);
}
