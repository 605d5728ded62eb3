// Lists the tiles that hold surface or ground, and clears the others. Their order does not matter: a tile's result depends on
// nothing of another's.
#include "shared.h"
#include "render/render.h"
#include "render/view.glsl"

layout(local_size_x = RENDER_TILE * RENDER_TILE) in;
layout(binding = 0, scalar) uniform Frame { RenderFrame frame; };
layout(binding = 1) uniform sampler2D seen;  // depth as it was drawn or traced
layout(binding = 2, rgba32ui) writeonly uniform uimage2D surfaces;
layout(binding = 3, scalar) writeonly buffer Tiles { uint tiles[]; };
layout(binding = 4, scalar) buffer Arguments { DispatchArguments arguments; };

shared uint surfacesHere;

void main() {
    uint lane = gl_LocalInvocationIndex;
    if (lane == 0) surfacesHere = 0;
    barrier();
    uvec2 pixel = gl_WorkGroupID.xy * RENDER_TILE + uvec2(lane % RENDER_TILE, lane / RENDER_TILE);
    bool inPicture = all(lessThan(pixel, frame.size));
    vec3 ray = rayOf(frame.now, placeOf(pixel, frame.size));
    vec3 p = frame.now.eye + ray * ((frame.ground - frame.now.eye.y) / min(ray.y, -1e-6));
    bool ground = ray.y < 0.0 && distance(p.xz, frame.centre.xz) < frame.groundEnd * frame.radius;
    bool surface = inPicture && (ground || texelFetch(seen, ivec2(inPicture ? pixel : uvec2(0)), 0).x > 0.0);
    bool any = subgroupAny(surface);
    if (any && subgroupElect()) atomicOr(surfacesHere, 1);
    barrier();
    bool listed = surfacesHere != 0;
    if (lane == 0 && listed) tiles[atomicAdd(arguments.x, 1)] = gl_WorkGroupID.x | gl_WorkGroupID.y << 16;
    if (inPicture && !listed) imageStore(surfaces, ivec2(pixel), uvec4(0));
}
