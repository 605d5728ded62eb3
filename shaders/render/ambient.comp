// Ambient occlusion traced through the field, one tile of 16 x 16 pixels a work group.
//
// After Swoboda's "Advanced Procedural Rendering in DirectX 11", Illumination: short rays of few samples, turned each
// frame; what the last frame knew of a point is found again by reprojection and kept where depth and normal agree; a pixel
// without such a history gets many rays, all others one. The rays that a tile's pixels need are summed and shared evenly
// by its lanes, so that a hole costs its rays and no more, wherever it lies.
// Deviations: history is rejected by the distance to the surface's plane, not by depth alone, which would lose grazing
// surfaces; it remembers how many rays it stands for, so that a resting view converges to their plain mean.
#define FIELD_VALUE
#define HISTOPYRAMID_LANES (AMBIENT_TILE * AMBIENT_TILE)
#define HISTOPYRAMID_TYPE uint
#include "shared.h"
#include "render/ambient.h"
#include "field.glsl"
#include "lib/octahedral.glsl"
#include "lib/histopyramid.glsl"

layout(local_size_x = HISTOPYRAMID_LANES) in;
layout(binding = 0, r32f) readonly uniform image2D depth;
layout(binding = 1, r32ui) readonly uniform uimage2D normals;
// As bits: openness, rays that it stands for, clip depth, octahedral normal.
layout(binding = 2, rgba32ui) readonly uniform uimage2D historyBefore;
layout(binding = 3, rgba32ui) writeonly uniform uimage2D historyNow;
layout(binding = 4, r32f) writeonly uniform image2D result;
layout(binding = 5, scalar) readonly buffer Tiles { uint tiles[]; };
layout(binding = 6, scalar) readonly buffer View { AmbientView view; };

shared vec3 positions[HISTOPYRAMID_LANES];
shared vec3 directions[HISTOPYRAMID_LANES];                    // normals
shared uint rays[HISTOPYRAMID_LANES * AMBIENT_MOST_RAYS];      // pixel of the tile | number of its ray << 8
shared uint opened[HISTOPYRAMID_LANES];                        // in 1/256

const float kSamePlane = 0.01;    // of the distance to the eye
const float kSameNormal = 0.9;    // cosine
const float kHit = 0.4;           // of the bias

vec3 unproject(mat4 inverse, uvec2 pixel, float z) {
    vec2 place = (vec2(pixel) + 0.5) / vec2(view.width, view.height) * 2.0 - 1.0;
    vec4 p = inverse * vec4(place, z, 1.0);
    return p.xyz / p.w;
}

/// 1 if the ray is open. Directions are cosine-distributed; a pixel's own follow the R2 sequence (Roberts 2018) from a place
/// that its position in the picture gives.
float trace(vec3 p, vec3 n, uvec2 pixel, uint number) {
    uint bits = (pixel.x * 0x9E3779B1u) ^ (pixel.y * 0x85EBCA77u);
    bits = (bits ^ bits >> 15) * 0x2C1B3C6Du;
    bits ^= bits >> 13;
    uvec2 turned = uvec2(bits, bits * 0x297A2D39u) + number * uvec2(3242174889u, 2447445414u);  // 0.7549, 0.5698 of 2^32
    vec2 u = vec2(turned >> 8) / 16777216.0;
    float angle = 6.2831853 * u.x, r = sqrt(u.y);
    float s = n.z < 0.0 ? -1.0 : 1.0, a = -1.0 / (s + n.z), b = n.x * n.y * a;  // Duff et al. 2017
    vec3 x = vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x), y = vec3(b, s + n.y * n.y * a, -n.y);
    vec3 d = r * cos(angle) * x + r * sin(angle) * y + sqrt(1.0 - u.y) * n;
    vec3 start = p + n * view.bias;
    float t = 0.0, h;
    uint i = 0;
    do {
        h = fieldValue(start + d * t) * view.stepScale;
        float part = float(++i) / float(view.samples);
        t = max(t + h, view.radius * part * part);  // so that the last sample is at the ray's end
    } while (i < view.samples && h > kHit * view.bias && t < view.radius);
    return h > kHit * view.bias || t >= view.radius ? 1.0 : 0.0;
}

void main() {
    fieldBegin();
    uint lane = gl_LocalInvocationIndex, tile = tiles[gl_WorkGroupID.x];
    uvec2 corner = uvec2(tile & 0xffff, tile >> 16) * AMBIENT_TILE, size = uvec2(view.width, view.height);
    uvec2 pixel = corner + uvec2(lane % AMBIENT_TILE, lane / AMBIENT_TILE);
    bool inPicture = all(lessThan(pixel, size));
    float z = inPicture ? imageLoad(depth, ivec2(pixel)).x : 1.0;
    bool surface = z < 1.0;
    uint normalBits = imageLoad(normals, ivec2(inPicture ? pixel : uvec2(0))).x;
    vec3 p = unproject(view.inverseNow, pixel, z), n = unpackOctahedral(normalBits);

    vec4 clip = view.before * vec4(p, 1.0);
    vec2 place = (clip.xy / clip.w * 0.5 + 0.5) * vec2(size);
    bool wasSeen = clip.w > 0.0 && all(greaterThanEqual(place, vec2(0.0))) && all(lessThan(place, vec2(size)));
    uvec2 was = wasSeen ? uvec2(place) : uvec2(0);
    uvec4 old = imageLoad(historyBefore, ivec2(was));
    vec3 pOld = unproject(view.inverseBefore, was, uintBitsToFloat(old.z));
    bool kept = surface && wasSeen && old.y != 0 &&
                abs(dot(n, pOld - p)) < kSamePlane * distance(p, view.eye) &&
                dot(n, unpackOctahedral(old.w)) > kSameNormal;
    uint known = kept ? min(old.y, view.mostKept) : 0;
    uint need = surface ? kept ? view.raysKept : view.raysNew : 0;

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
    bool together = view.balance != 0;
    i = together ? lane : 0;
    uint end = together ? total : need, step = together ? HISTOPYRAMID_LANES : 1;
    do {
        bool valid = i < end;
        uint ray = together ? rays[valid ? i : 0] : lane | i << 8;
        uint of = ray & 255;
        uvec2 ofPixel = corner + uvec2(of % AMBIENT_TILE, of / AMBIENT_TILE);
        float open = trace(positions[of], directions[of], ofPixel, view.frame * AMBIENT_MOST_RAYS + (ray >> 8));
        if (valid) atomicAdd(opened[of], uint(open * 256.0));
    } while ((i += step) < end);
    barrier();

    float mean = float(opened[lane]) / (256.0 * float(max(need, 1)));
    float openness = (uintBitsToFloat(old.x) * float(known) + mean * float(need)) / float(max(known + need, 1));
    openness = known == 0 ? mean : openness;
    if (surface) {
        imageStore(historyNow, ivec2(pixel), uvec4(floatBitsToUint(openness), known + need, floatBitsToUint(z), normalBits));
        imageStore(result, ivec2(pixel), vec4(openness));
    }
}
