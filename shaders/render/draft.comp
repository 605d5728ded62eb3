// The G-buffer of one tile with anything near the solid from what was drawn of the mesh: surface.comp's place, where
// the mesh is to be seen and not the field. It samples no field, so its pipeline serves all graphs.
#define FIELD_MATERIAL
#include "shared.h"
#include "render/render.h"
#include "field.glsl"
#include "lib/octahedral.glsl"
#include "render/view.glsl"
#include "render/gbuffer.glsl"

layout(local_size_x = RENDER_TILE * RENDER_TILE) in;
layout(push_constant, scalar) uniform Push { DraftMaterial look; };
layout(binding = 0, scalar) uniform Frame { RenderFrame frame; };
layout(binding = 1, r32f) readonly uniform image2D seen;
layout(binding = 2, rgba32ui) writeonly uniform uimage2D surfaces;
layout(binding = 3, scalar) readonly buffer Tiles { uint tiles[]; };
layout(binding = 4, rg32ui) readonly uniform uimage2D looks;  // draft.frag

#include "render/solid.glsl"

const float kOnSide = 0.1;  // cells: what is so near to the region's side was capped there

void main() {
    uint lane = gl_LocalInvocationIndex, tile = tiles[RENDER_NEAR * frame.tiles + gl_WorkGroupID.x];
    uvec2 pixel = pixelOf(tile, lane);
    bool inPicture = all(lessThan(pixel, frame.size));
    ivec2 at = ivec2(min(pixel, frame.size - 1));
    View view = frame.now;
    vec3 ray = rayOf(view, placeOf(pixel, frame.size)), toEye = normalize(-ray);
    float depth = imageLoad(seen, at).x, toGround = groundAlong(view, ray), along = view.near / max(depth, 1e-30);
    bool hit = depth > 0.0 && !(toGround > 0.0 && toGround < along);
    vec4 region = regionDistance(view.eye + ray * along);
    uvec2 drawn = imageLoad(looks, at).xy;
    vec3 n = abs(region.w) < kOnSide * frame.cellSize ? region.xyz : unpackOctahedral(drawn.x);
    float facing = dot(n, toEye);  // never away from the eye, as between vertices it can be
    n = facing < 0.0 ? normalize(n - 1.02 * facing * toEye) : n;
    vec3 color = unpackUnorm4x8(drawn.y).rgb;
    FieldMaterial material = FieldMaterial(look.colored != 0 ? color * color : look.base, look.roughness, look.metallic, look.emission, 0.0, 1.5, vec3(0.0));
    uvec4 surface = hit ? packSurface(depth, n, material) : toGround > 0.0 ? packGround(view.near / toGround) : uvec4(0);
    if (inPicture) imageStore(surfaces, ivec2(pixel), surface);
}
