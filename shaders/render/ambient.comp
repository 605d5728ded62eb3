// Ambient occlusion traced through the field, one listed tile of 16 x 16 pixels a work group.
//
// After Swoboda's "Advanced Procedural Rendering in DirectX 11", Illumination: short rays of few samples, turned each
// frame; what the last frame knew of a point is found again by reprojection and kept where depth and normal agree; a pixel
// without such a history gets many rays, all others one. The rays that a tile's pixels need are summed and shared evenly
// by its lanes, so that a hole costs its rays and no more, wherever it lies.
// Deviations: history is rejected by the distance to the surface's plane, not by depth alone, which would lose grazing
// surfaces; it remembers how many rays it stands for, so that a resting view converges to their plain mean.
#define FIELD_VALUE
#define HISTOPYRAMID_LANES (RENDER_TILE * RENDER_TILE)
#define HISTOPYRAMID_TYPE uint
#include "shared.h"
#include "render/render.h"
#include "field.glsl"
#include "lib/octahedral.glsl"
#include "lib/histopyramid.glsl"
#include "render/view.glsl"

layout(local_size_x = HISTOPYRAMID_LANES) in;
layout(binding = 0, scalar) uniform Frame { RenderFrame frame; };
layout(binding = 2, rgba32ui) readonly uniform uimage2D surfaces;
layout(binding = 3, scalar) readonly buffer Tiles { uint tiles[]; };
layout(binding = 5, rgba32ui) readonly uniform uimage2D surfacesBefore;
layout(binding = 6, r32ui) readonly uniform uimage2D historyBefore;  // openness, 16 bits | rays that it stands for << 16
layout(binding = 7, r32ui) writeonly uniform uimage2D historyNow;

#include "render/solid.glsl"

shared vec3 positions[HISTOPYRAMID_LANES];
shared vec3 directions[HISTOPYRAMID_LANES];                   // normals
shared uint rays[HISTOPYRAMID_LANES * RENDER_MOST_RAYS];      // pixel of the tile | number of its ray << 8
shared uint opened[HISTOPYRAMID_LANES];

const float kSamePlane = 0.01;    // of the distance to the eye
const float kSameNormal = 0.9;    // cosine
const float kHit = 0.4;           // of the bias: nearer is a hit,
const float kLeave = 0.25;        // or of the way gone, so that rays may leave a wall beside their start

/// Whether the ray is open.
bool trace(vec3 p, vec3 n, uvec2 pixel, uint number) {
    vec3 d = cosineDirection(n, evenly(pixel, number)), start = p + n * frame.bias;
    float t = 0.0;
    uint i = 0;
    bool open;
    do {
        float h = clearance(start + d * t);
        open = h > min(kHit * frame.bias, kLeave * t) || t == 0.0;
        float part = float(++i) / float(frame.ambientSamples);
        t = max(t + h, frame.ambientRadius * part * part);  // so that the last sample is at the ray's end
    } while (i < frame.ambientSamples && open && t < frame.ambientRadius);
    return open;
}

void main() {
    fieldBegin();
    uint lane = gl_LocalInvocationIndex, tile = tiles[gl_WorkGroupID.x];
    uvec2 corner = uvec2(tile & 0xffff, tile >> 16) * RENDER_TILE, size = frame.size;
    uvec2 pixel = corner + uvec2(lane % RENDER_TILE, lane / RENDER_TILE);
    bool inPicture = all(lessThan(pixel, size));
    uvec2 here = min(pixel, size - 1);
    uvec4 words = imageLoad(surfaces, ivec2(here));
    float depth = uintBitsToFloat(words.x);
    bool surface = inPicture && depth > 0.0;
    vec3 p = pointAt(frame.now, placeOf(pixel, size), surface ? depth : 1.0), n = unpackOctahedral(words.y);

    vec3 seen = project(frame.before, p);
    vec2 place = vec2(0.5 + 0.5 * seen.x, 0.5 - 0.5 * seen.y) * vec2(size);
    bool inBefore = seen.z > 0.0 && all(greaterThanEqual(place, vec2(0.0))) && all(lessThan(place, vec2(size)));
    uvec2 was = frame.resting != 0 ? here : inBefore ? uvec2(place) : uvec2(0);
    uvec4 old = imageLoad(surfacesBefore, ivec2(was));
    uint past = imageLoad(historyBefore, ivec2(was)).x;
    float oldDepth = uintBitsToFloat(old.x);
    vec3 pOld = pointAt(frame.before, placeOf(was, size), oldDepth > 0.0 ? oldDepth : 1.0);
    bool kept = surface && (inBefore || frame.resting != 0) && oldDepth > 0.0 &&
                abs(dot(n, pOld - p)) < kSamePlane * distance(p, frame.now.eye) &&
                dot(n, unpackOctahedral(old.y)) > kSameNormal;
    uint known = kept ? min(past >> 16, frame.mostKept) : 0;
    uint need = surface ? known > 0 ? frame.raysKept : frame.raysNew : 0;

    positions[lane] = p;
    directions[lane] = n;
    opened[lane] = 0;
    uint total, first = sumBefore(need, total);
    uint i = 0;
    do {
        if (i < need) rays[first + i] = lane | i << 8;
        ++i;
    } while (i < need);
    barrier();
    bool together = frame.balance != 0;
    i = together ? lane : 0;
    uint end = together ? total : need, step = together ? HISTOPYRAMID_LANES : 1;
    do {
        bool valid = i < end;
        uint ray = together ? rays[valid ? i : 0] : lane | i << 8;
        uint of = ray & 255;
        uvec2 ofPixel = corner + uvec2(of % RENDER_TILE, of / RENDER_TILE);
        bool open = trace(positions[of], directions[of], ofPixel, frame.number * RENDER_MOST_RAYS + (ray >> 8));
        if (valid && open) atomicAdd(opened[of], 1);
    } while ((i += step) < end);
    barrier();

    float openness = (float(past & 0xffff) / 65535.0 * float(known) + float(opened[lane])) / float(max(known + need, 1));
    if (surface) imageStore(historyNow, ivec2(pixel), uvec4(uint(openness * 65535.0 + 0.5) | min(known + need, 0xffff) << 16));
}
