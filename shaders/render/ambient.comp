// Ambient occlusion traced through the field, one listed tile of 16 x 16 pixels a work group.
//
// After Swoboda's "Advanced Procedural Rendering in DirectX 11", Illumination: short rays of few samples, turned each
// frame; what the last frame knew of a point is found again by reprojection and kept where depth and normal agree; a pixel
// without such a history is a hole and gets many rays, all others one. Where rays are shared, a hole gets here what all
// pixels get and is listed, and ambient_holes.comp adds the rest.
// Deviations: history is rejected as reproject.glsl has it; it remembers how many rays it stands for, so that a resting view converges to their plain mean.
#define FIELD_VALUE
#define FIELD_BEFORE
#include "shared.h"
#include "render/render.h"
#include "render/places.glsl"
#include "lib/octahedral.glsl"
#include "render/view.glsl"
#include "render/history.glsl"

layout(local_size_x = RENDER_TILE * RENDER_TILE) in;
layout(binding = 0, scalar) uniform Frame { RenderFrame frame; };
layout(binding = 2, rgba32ui) readonly uniform uimage2D surfaces;
layout(binding = 3, scalar) readonly buffer Tiles { uint tiles[]; };
layout(binding = 8, scalar) writeonly buffer Holes { uint holes[]; };  // pixels, x | y << 16, in any order
layout(binding = 4, scalar) buffer HoleCount { AmbientHoles count; };
layout(binding = 5, rgba32ui) readonly uniform uimage2D surfacesBefore;
layout(binding = 6, r32ui) readonly uniform uimage2D historyBefore;  // packHistory
layout(binding = 7, r32ui) writeonly uniform uimage2D historyNow;

#include "render/solid.glsl"
#include "render/ambient.glsl"
#include "render/reproject.glsl"

void main() {
    fieldBegin();
    uint lane = gl_LocalInvocationIndex, tile = tiles[RENDER_NEAR * frame.tiles + gl_WorkGroupID.x];
    uvec2 size = frame.size, pixel = pixelOf(tile, lane);
    bool inPicture = all(lessThan(pixel, size));
    uvec2 here = min(pixel, size - 1);
    uvec4 words = imageLoad(surfaces, ivec2(here));
    float depth = uintBitsToFloat(words.x);
    bool surface = inPicture && depth > 0.0;
    vec3 p = pointAt(frame.now, placeOf(pixel, size), surface ? depth : 1.0), n = unpackOctahedral(words.y);
    surface = surface && nearSolid(p, 0.0);

    uvec2 was;
    bool kept = surface && pixelSeenBefore(words.w >> 24 == 0 ? p : placeBefore(p, n), n, here, was);
    uint past = imageLoad(historyBefore, ivec2(was)).x;
    uint known = kept ? min(past >> 16, frame.mostKept) : 0;
    bool hole = surface && known == 0, shares = unfolded(frame.balance) != 0;
    uint need = hole && !shares ? frame.raysNew : frame.raysKept;

    float opened = 0.0;
    uint i = 0;
    do opened += openRay(p, n, here, frame.number * RENDER_MOST_RAYS + i);
    while (++i < need);
    float openness = (opennessOf(past) * float(known) + opened) / float(known + need);
    // What awaits more rays stands for none yet.
    bool more = hole && shares && frame.raysNew > need;
    if (surface) imageStore(historyNow, ivec2(here), uvec4(packHistory(openness, more ? 0 : known + need)));

    // However the subgroups come, the groups that they add up to are those that cover all holes.
    uint mine = subgroupExclusiveAdd(more ? 1 : 0), all = subgroupAdd(more ? 1 : 0), base = 0;
    if (all > 0 && subgroupElect()) {
        base = atomicAdd(count.holes, all);
        uint groups = min((base + all + AMBIENT_HOLES - 1) / AMBIENT_HOLES, AMBIENT_MOST_GROUPS) -
                      min((base + AMBIENT_HOLES - 1) / AMBIENT_HOLES, AMBIENT_MOST_GROUPS);
        atomicAdd(count.arguments.x, groups);
    }
    base = subgroupBroadcastFirst(base);
    if (more) holes[base + mine] = here.x | here.y << 16;
}
