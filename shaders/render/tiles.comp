// Sorts the picture's tiles into lists, by what there is to do in them. The lists' order does not matter: a tile's result depends
// on nothing of another's.
#include "shared.h"
#include "render/render.h"
#include "render/view.glsl"
#include "lib/groups.glsl"

#define LANES 32  // of a tile

layout(local_size_x = LANES) in;  // not less than the pixels on two sides of a tile
// In storage, since Mesa's software device translates a kernel anew for each value of a uniform that branches depend on, and
// keeps them all.
layout(binding = 0, scalar) readonly buffer Frame { RenderFrame frame; };
layout(binding = 1, r32f) readonly uniform image2D seen;  // depth as it was drawn or traced
layout(binding = 3, scalar) writeonly buffer Tiles { uint tiles[]; };  // RENDER_LISTS lists, each with room for all tiles
// The lists' lengths, and for each list the dispatches over it, in slices of so many tiles.
#define MOST_TILES (MOST_GROUPS / 64 * 64)
layout(binding = 4, scalar) buffer Arguments {
    uint lengths[RENDER_LISTS];
    DispatchArguments arguments[];
};

#include "render/solid.glsl"

#include "render/shadow.glsl"

shared uint found;  // 1: solid, 2: ground that ambient occlusion may reach, 4: ground with a place in the shadow map

void add(uint list) {
    uint at = atomicAdd(lengths[list], 1), slices = (frame.tiles + MOST_TILES - 1) / MOST_TILES;
    tiles[list * frame.tiles + at] = gl_WorkGroupID.x | gl_WorkGroupID.y << 16;
    atomicAdd(arguments[list * slices + at / MOST_TILES].x, 1);
}

void main() {
    uint lane = gl_LocalInvocationIndex;
    if (lane == 0) found = 0;
    barrier();
    uvec2 corner = gl_WorkGroupID.xy * RENDER_TILE;
    bool solid = false;
    uint i = lane;
    do {
        uvec2 pixel = min(corner + uvec2(i % RENDER_TILE, i / RENDER_TILE), frame.size - 1);
        solid = solid || imageLoad(seen, ivec2(pixel)).x > 0.0;
    } while ((i += LANES) < RENDER_TILE * RENDER_TILE);
    // The ground is looked at along the tile's upper and lower side, with a margin for what lies between.
    uint side = RENDER_TILE - 1;
    vec3 ray = rayOf(frame.now, placeOf(corner + uvec2(lane & side, lane > side ? side : 0), frame.size));
    float along = groundAlong(frame.now, ray);
    vec3 p = frame.now.eye + ray * along;
    float margin = 0.5 * float(RENDER_TILE) * 2.0 * frame.now.pixel * along / max(-ray.y, 0.05);
    vec2 shaded = abs(inShadowMap(p).xy / float(max(frame.shadowSize, 1)) - 0.5) - margin / (frame.shadowTexel * float(frame.shadowSize));
    bool ground = along > 0.0, near = ground && nearSolid(p, margin);
    bool lit = ground && (unfolded(frame.studio) == 0 || unfolded(frame.lightCount) > 0 || near || (unfolded(frame.shadowSize) > 0 && max(shaded.x, shaded.y) < 0.5));
    uint kinds = (solid ? 3 : 0) | (near ? 2 : 0) | (lit ? 4 : 0), all = subgroupOr(kinds);
    if (all != 0 && subgroupElect()) atomicOr(found, all);
    barrier();
    if (lane == 0) add((found & 1) != 0 ? RENDER_SOLID : (found & 4) != 0 ? RENDER_GROUND : RENDER_BACK);
    if (lane == 0 && (found & 2) != 0) add(RENDER_NEAR);
}
