// Lists the tiles that hold surface. Their order does not matter: a tile's result depends on nothing of another's.
#include "shared.h"
#include "render/ambient.h"

layout(local_size_x = AMBIENT_TILE * AMBIENT_TILE) in;
layout(binding = 0, r32f) readonly uniform image2D depth;
layout(binding = 5, scalar) writeonly buffer Tiles { uint tiles[]; };
layout(binding = 6, scalar) readonly buffer View { AmbientView view; };
layout(binding = 7, scalar) buffer Arguments { DispatchArguments arguments; };

shared uint surfaces;

void main() {
    uint lane = gl_LocalInvocationIndex;
    if (lane == 0) surfaces = 0;
    barrier();
    uvec2 pixel = gl_WorkGroupID.xy * AMBIENT_TILE + uvec2(lane % AMBIENT_TILE, lane / AMBIENT_TILE);
    bool surface = all(lessThan(pixel, uvec2(view.width, view.height))) && imageLoad(depth, ivec2(pixel)).x < 1.0;
    bool any = subgroupAny(surface);
    if (any && subgroupElect()) atomicOr(surfaces, 1);
    barrier();
    if (lane == 0 && surfaces != 0) tiles[atomicAdd(arguments.x, 1)] = gl_WorkGroupID.x | gl_WorkGroupID.y << 16;
}
