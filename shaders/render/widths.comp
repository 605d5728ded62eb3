// How thick the solid's wall is, or how wide the gap before it, at each pixel of one listed tile, over the finished picture: RENDER_THICKNESS
// and RENDER_GAP. As runtime/measure/widths.h measures it: along the normal, inward to where the solid ends or outward to where there is some
// again, if what is met there faces the surface. Red to blue are widthColor(); grey is what nothing faces. No ray goes farther than the colours
// do, in steps of no less than a part of the width that is asked for, so that a field that is no distance, or is 0 within the solid, costs
// little.
#define FIELD_GRADIENT
#include "shared.h"
#include "render/render.h"
#include "render/places.glsl"
#include "lib/octahedral.glsl"
#include "render/view.glsl"
#include "render/gbuffer.glsl"

layout(local_size_x = RENDER_TILE * RENDER_TILE) in;
layout(binding = 0, scalar) uniform Frame { RenderFrame frame; };
layout(binding = 2, rgba32ui) readonly uniform uimage2D surfaces;
layout(binding = 3, scalar) readonly buffer Tiles { uint tiles[]; };
layout(binding = 10, r32ui) writeonly uniform uimage2D pixels;

#include "render/solid.glsl"

const float kStepsToLeast = 64.0, kFaces = -0.5;  // cosine between normals of what faces each other, at most
const float kFinest = 4e-6;                        // of a step, in the solid's radii: single precision tells no less

// Of the solid as it was meshed, its value in w and its slope outward.
vec4 solidAt(vec3 p) {
    vec3 at = fromMiddle(p);
    chooseMembers(at);
    vec4 g = fieldGradient(p), region = regionDistance(p);
    return withinPlaces(at) && g.w > region.w ? g : region;
}

// The width at p, whose normal is n; RENDER_MOST_WIDTHS of them or more if nothing is met; negative if nothing faces it.
float widthAt(vec3 p, vec3 n, bool inward) {
    float side = inward ? -1.0 : 1.0, least = frame.leastWidth, far = RENDER_MOST_WIDTHS * least;
    float safe = frame.stepScale, shortest = max(least / kStepsToLeast, kFinest * frame.radius);
    float start = 0.0, t = 0.0, free = 0.0, clear = 0.0, width = far;
    uint i = 0, most = uint(RENDER_MOST_WIDTHS * kStepsToLeast) + 2u;
    bool met = false;
    do {
        vec4 solid = solidAt(p + side * t * n);
        float slope = max(length(solid.xyz), 1e-6), value = side * solid.w;
        if (i == 0) {  // p is beside the surface by as much as its pixel's plane is
            start = t = clamp(-value / slope, -frame.cellSize, frame.cellSize);
            value = 0.0;
        }
        bool meets = value < 0.0 && !met;
        float facing = dot(solid.xyz, n) / slope, between = mix(free, t, clear / max(clear - value, 1e-30)) - start;
        width = meets ? facing <= kFaces ? between : -1.0 : width;
        met = met || meets;
        free = t, clear = value;
        t += max(value * safe, shortest);
    } while (!met && t - start < far && ++i < most);
    return width;
}

void main() {
    fieldBegin();
    uint lane = gl_LocalInvocationIndex, tile = tiles[RENDER_SOLID * frame.tiles + gl_WorkGroupID.x];
    uvec2 pixel = pixelOf(tile, lane), here = min(pixel, frame.size - 1);
    Surface s = unpackSurface(imageLoad(surfaces, ivec2(here)));
    bool solid = s.depth > 0.0 && !s.ground;
    vec3 p = pointAt(frame.now, placeOf(here, frame.size), solid ? s.depth : 1.0);
    float width = widthAt(p, s.n, unfolded(frame.show) == RENDER_THICKNESS);
    vec3 color = width < 0.0 ? vec3(0.75) : widthColor(width / frame.leastWidth);
    color *= 0.6 + 0.4 * dot(s.n, normalize(frame.now.eye - p));
    uvec3 bytes = uvec3(255.0 * clamp(color, 0.0, 1.0) + 0.5);
    if (solid && all(lessThan(pixel, frame.size))) imageStore(pixels, ivec2(pixel), uvec4(bytes.x | bytes.y << 8 | bytes.z << 16 | 255u << 24));
}
