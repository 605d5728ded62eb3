// More rays of ambient occlusion where history was missing. The pixels that ambient.comp listed are dealt out evenly, each to
// AMBIENT_LANES lanes, which share its rays: so a hole costs its rays and no more, wherever it lies.
// Swoboda (Illumination) shares the rays that a tile of 16 x 16 pixels needs among its lanes; one list for the whole picture
// costs tiles without holes nothing, and a tile full of them no longer than others.
#define FIELD_VALUE
#include "shared.h"
#include "render/render.h"
#include "render/places.glsl"
#include "lib/octahedral.glsl"
#include "render/view.glsl"
#include "render/history.glsl"

layout(local_size_x = AMBIENT_HOLES * AMBIENT_LANES) in;
layout(binding = 0, scalar) uniform Frame { RenderFrame frame; };
layout(binding = 2, rgba32ui) readonly uniform uimage2D surfaces;
layout(binding = 7, r32ui) uniform uimage2D history;
layout(binding = 8, scalar) readonly buffer Holes { uint holes[]; };
layout(binding = 4, scalar) readonly buffer HoleCount { AmbientHoles count; };

#include "render/solid.glsl"
#include "render/ambient.glsl"

shared uint opened[AMBIENT_HOLES];  // of the rays of each

void main() {
    fieldBegin();
    uint lane = gl_LocalInvocationIndex, mine = lane / AMBIENT_LANES, total = count.holes;
    uint first = frame.raysKept, end = unfolded(frame.raysNew);
    uint at = gl_WorkGroupID.x * AMBIENT_HOLES;
    do {
        bool valid = at + mine < total;
        uint packed = holes[valid ? at + mine : 0];
        uvec2 pixel = uvec2(packed & 0xffff, packed >> 16);
        uvec4 words = imageLoad(surfaces, ivec2(pixel));
        float before = opennessOf(imageLoad(history, ivec2(pixel)).x);
        vec3 p = pointAt(frame.now, placeOf(pixel, frame.size), uintBitsToFloat(words.x)), n = unpackOctahedral(words.y);
        if (lane < AMBIENT_HOLES) opened[lane] = 0;
        barrier();
        uint i = first + lane % AMBIENT_LANES;
        float open = 0.0;
        do {
            float one = openRay(p, n, pixel, frame.number * RENDER_MOST_RAYS + i);
            open += i < end ? one : 0.0;
        } while ((i += AMBIENT_LANES) < end);
        atomicAdd(opened[mine], uint(open));
        barrier();
        float openness = (before * float(first) + float(opened[mine])) / float(end);
        if (valid && lane % AMBIENT_LANES == 0) imageStore(history, ivec2(pixel), uvec4(packHistory(openness, end)));
        at += gl_NumWorkGroups.x * AMBIENT_HOLES;
        barrier();  // the next turn clears what is read here
    } while (at < total);
}
