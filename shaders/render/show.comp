// Views into the field and the mesher, over the finished picture: see RENDER_STEPS and the following in render.h.
#define FIELD_GRADIENT
#include "shared.h"
#include "render/render.h"
#include "render/places.glsl"
#include "render/view.glsl"

layout(local_size_x = RENDER_TILE, local_size_y = RENDER_TILE) in;
layout(binding = 0, scalar) uniform Frame { RenderFrame frame; };
layout(binding = 1, r32f) readonly uniform image2D seen;
layout(binding = 10, r32ui) uniform uimage2D pixels;

#include "render/solid.glsl"

const uint kMostSteps = 128;

// Dark blue over green and yellow to red for 0 to 1.
vec3 heat(float x) {
    return clamp(vec3(2.5 * x - 0.9, 1.6 - abs(3.2 * x - 1.6), 1.2 - 2.6 * x), 0.0, 1.0);
}

// Steps that sphere tracing takes along the ray.
float steps(vec3 origin, vec3 ray, float end) {
    float t = frame.now.near, stepScale = frame.stepScale / length(ray), close = frame.now.pixel, f;
    // As steppingPoint() of solid.glsl.
    bvec3 local = bvec3(frame.localSteps != 0);
    vec3 stepLo = mix(vec3(-1e30), frame.lo, local), stepHi = mix(vec3(1e30), frame.hi, local);
    uint i = 0;
    do {
        vec3 p = origin + ray * t, within = clamp(p, stepLo, stepHi), at = fromMiddle(within);
        chooseMembers(at);
        float region = regionDistance(p).w;
        f = fieldGradient(within).w;
        f = withinPlaces(at) ? f : region;
        f = local.x && region > 0.0 ? max(f, region / frame.stepScale) : f;
        t += max(f, 0.0) * stepScale;
    } while (f > close * t && t < end && ++i < kMostSteps);
    return float(i);
}

void main() {
    fieldBegin();
    uvec2 pixel = gl_GlobalInvocationID.xy;
    bool inPicture = all(lessThan(pixel, frame.size));
    ivec2 at = ivec2(min(pixel, frame.size - 1));
    vec3 ray = rayOf(frame.now, placeOf(pixel, frame.size));
    float depth = imageLoad(seen, at).x;
    vec3 color = unpackUnorm4x8(imageLoad(pixels, at).x).rgb;

    // Where the ray meets the plane of the slice.
    uint upright = abs(frame.now.forward.x) > abs(frame.now.forward.z) ? 0 : 2;
    uint axis = frame.sliceAxis < 3 ? frame.sliceAxis : upright;
    float across = (frame.centre[axis] + frame.sliceAt - frame.now.eye[axis]) / ray[axis];
    vec3 onSlice = frame.now.eye + ray * across;
    bool inSlice = across > 0.0 && all(greaterThan(onSlice, frame.lo)) && all(lessThan(onSlice, frame.hi));
    chooseMembers(fromMiddle(onSlice));
    vec4 g = fieldGradient(onSlice);

    if (unfolded(frame.show) == RENDER_STEPS)
        color = heat(steps(frame.now.eye, ray, length(frame.centre - frame.now.eye) + 2.0 * frame.radius) / 48.0);
    if (unfolded(frame.show) == RENDER_SLICE && inSlice) {
        float period = 0.1 * frame.radius, width = 3.0 * frame.now.pixel * across / period;
        float line = abs(fract(g.w / period + 0.5) - 0.5), far = 1.0 - exp(-2.0 * abs(g.w) / frame.radius);
        color = g.w < 0.0 ? mix(vec3(0.75, 0.88, 1.0), vec3(0.1, 0.3, 0.75), far) : mix(vec3(1.0, 0.9, 0.75), vec3(0.8, 0.35, 0.1), far);
        color *= line < 0.5 * width ? 0.7 : 1.0;
        color = abs(g.w) < 3.0 * frame.now.pixel * across ? vec3(0.0) : color;
    }
    if (unfolded(frame.show) == RENDER_EXACTNESS && inSlice) {
        float off = length(g.xyz) - 1.0;  // white: a distance; red: too steep to trace; blue: flatter than a distance
        color = off > 0.0 ? mix(vec3(1.0), vec3(0.85, 0.1, 0.1), min(off, 1.0)) : mix(vec3(1.0), vec3(0.1, 0.25, 0.85), min(-off, 1.0));
        color = abs(g.w) < 3.0 * frame.now.pixel * across ? vec3(0.0) : color;
    }
    if (unfolded(frame.show) == RENDER_CELLS && depth > 0.0) {
        vec3 cell = (frame.now.eye + ray * (frame.now.near / depth) - frame.lo) / frame.cellSize, index = floor(cell);
        vec3 fromSide = abs(cell - index - 0.5), thin = vec3(0.5 - frame.now.pixel * frame.now.near / depth * 2.0 / frame.cellSize);
        bool line = fromSide.x > thin.x || fromSide.y > thin.y || fromSide.z > thin.z;
        bool even = (uint(index.x + index.y + index.z) & 1u) == 0;
        color *= line ? vec3(0.35) : even ? vec3(1.0) : vec3(0.8, 0.9, 1.0);
    }
    uvec3 bytes = uvec3(255.0 * color + 0.5);
    if (inPicture) imageStore(pixels, at, uvec4(bytes.x | bytes.y << 8 | bytes.z << 16 | 255u << 24));
}
