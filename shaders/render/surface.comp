// The G-buffer of one tile with anything near the solid: from depth to the surface that the mesh stands for, with its exact normal and its material,
// all from the field. So both are sharp whatever the mesh's resolution, and no interpolated attribute is drawn.
// Where the solid is not, there may be the ground.
#define FIELD_GRADIENT
#define FIELD_MATERIAL
#include "shared.h"
#include "render/render.h"
#include "render/places.glsl"
#include "lib/octahedral.glsl"
#include "render/view.glsl"
#include "render/gbuffer.glsl"

layout(local_size_x = RENDER_TILE * RENDER_TILE) in;
layout(binding = 0, scalar) uniform Frame { RenderFrame frame; };
layout(binding = 1, r32f) readonly uniform image2D seen;
layout(binding = 2, rgba32ui) writeonly uniform uimage2D surfaces;
layout(binding = 3, scalar) readonly buffer Tiles { uint tiles[]; };

#include "render/solid.glsl"

const float kAbove = 0.6;    // cells
const float kBehind = 0.05;  // cells: what is deeper within than curved surfaces are behind their planes

void main() {
    fieldBegin();
    uint lane = gl_LocalInvocationIndex, tile = tiles[RENDER_NEAR * frame.tiles + gl_WorkGroupID.x];
    uvec2 pixel = pixelOf(tile, lane);
    bool inPicture = all(lessThan(pixel, frame.size));
    float depth = imageLoad(seen, ivec2(min(pixel, frame.size - 1))).x;
    bool hit = depth > 0.0;
    View view = frame.now;
    vec3 ray = rayOf(view, placeOf(pixel, frame.size));
    vec3 toEye = normalize(-ray);

    float toGround = groundAlong(view, ray);

    // The surface is the field's own, which lies within a cell of the mesh, or the side of the region.
    // It is looked for a little above the ground: where the mesh's edge on it is bevelled, what is nearest is the solid's
    // foot, or the ground shows through where the solid stands.
    float rise = min(kAbove * frame.cellSize / max(-ray.y, 1e-6), 0.5 * toGround), above = toGround > 0.0 ? toGround - rise : 1e30;
    float first = min(hit ? view.near / depth : above, above);
    vec3 p = view.eye + ray * first;
    chooseMembers(fromMiddle(p));
    vec4 g = fieldGradient(p), region = regionDistance(p);
    hit = hit || (toGround > 0.0 && max(g.w + min(dot(g.xyz, ray), 0.0) * rise, region.w) < 0.0);
    float slope = max(length(g.xyz), 1e-6), off = g.w / slope;
    bool cap = region.w > off || !(abs(off) < 2.0 * frame.cellSize);
    vec3 n = cap ? region.xyz : g.xyz / slope;
    p -= n * clamp(cap ? region.w : off, -frame.cellSize, frame.cellSize);
    float facing = dot(n, toEye);  // never away from the eye, as bevelled edges can have it
    n = facing < 0.0 ? normalize(n - 1.02 * facing * toEye) : n;

    // What is stored is a depth: where the pixel's ray meets the surface's plane.
    float along = dot(n, p - view.eye) / min(dot(n, ray), -1e-6);
    along = clamp(along, first - 2.0 * frame.cellSize, first + 2.0 * frame.cellSize);
    // In a concave edge, whose bevel lies before both its sides, the ray may meet that side behind the other one: the point
    // is then within what it meets first.
    vec4 met = fieldGradient(view.eye + ray * along);
    float steep = max(length(met.xyz), 1e-6), within = -met.w / steep, against = dot(met.xyz, ray) / steep;
    bool behind = !cap && within > kBehind * frame.cellSize && against < -0.01;
    n = behind ? met.xyz / steep : n;
    along = behind ? max(along + within / against, first - 2.0 * frame.cellSize) : along;
    FieldMaterial material = fieldMaterial(view.eye + ray * along);
    uvec4 surface = packSurface(view.near / along, n, material);
    surface = hit ? surface : toGround > 0.0 ? packGround(view.near / toGround) : uvec4(0);
    if (inPicture) imageStore(surfaces, ivec2(pixel), surface);
}
