// Temporal antialiasing of a view that moves (Karis, "High quality temporal supersampling", 2014): each frame looks through other
// places within its pixels, and is mixed with what the frames before showed there, found again by the nearest depth about the
// pixel, so that edges take what is behind them along. What was shown is kept to the mean of the pixel's neighbours, give or take
// their deviation (Salvi, "An excursion in temporal supersampling", 2016): so nothing stays that is gone, however it moved.
// Colours are as a display shows them.
#include "shared.h"
#include "render/render.h"
#include "render/view.glsl"

layout(local_size_x = RENDER_TILE, local_size_y = RENDER_TILE) in;
layout(binding = 0, scalar) uniform Frame { RenderFrame frame; };
layout(binding = 1, r32f) readonly uniform image2D seen;
layout(binding = 2, r32ui) readonly uniform uimage2D drawn;
layout(binding = 3, rgba16f) readonly uniform image2D shownBefore;
layout(binding = 4, rgba16f) writeonly uniform image2D shownNow;
layout(binding = 5, r32ui) writeonly uniform uimage2D pixels;
layout(push_constant, scalar) uniform Push { uint known; };  // 1: shownBefore is of the frame before

const float kNew = 0.15;       // share of the frame in what is shown
const float kDeviations = 1.25;

// By Catmull and Rom's splines: what is sampled again with each frame would blur soon between straight lines.
vec4 sampleBefore(vec2 at, ivec2 last) {
    ivec2 corner = ivec2(floor(at));
    vec2 f = at - vec2(corner);
    vec2 weights[4] = vec2[4](f * (f * (1.0 - 0.5 * f) - 0.5), 1.0 + f * f * (1.5 * f - 2.5), f * (0.5 + f * (2.0 - 1.5 * f)), f * f * (0.5 * f - 0.5));
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 16; ++i) {
        ivec2 step = ivec2(i & 3, i >> 2);
        sum += imageLoad(shownBefore, clamp(corner + step - 1, ivec2(0), last)) * (weights[step.x].x * weights[step.y].y);
    }
    return sum;
}

void main() {
    ivec2 last = ivec2(frame.size) - 1, at = min(ivec2(gl_GlobalInvocationID.xy), last);
    vec4 own = vec4(0.0), sum = vec4(0.0), squares = vec4(0.0);
    float depth = 0.0;
    for (int i = 0; i < 9; ++i) {
        ivec2 there = clamp(at + ivec2(i % 3 - 1, i / 3 - 1), ivec2(0), last);
        vec4 color = unpackUnorm4x8(imageLoad(drawn, there).x);
        own = i == 4 ? color : own;
        sum += color;
        squares += color * color;
        depth = max(depth, imageLoad(seen, there).x);
    }
    vec4 mean = sum / 9.0, deviation = kDeviations * sqrt(max(squares / 9.0 - mean * mean, 0.0));

    // Where what is seen here was: what is not seen is endlessly far.
    vec3 ray = rayOf(frame.now, placeOf(uvec2(at), frame.size));
    float ground = (frame.ground - frame.now.eye.y) / min(ray.y, -1e-6);
    float along = depth > 0.0 ? frame.now.near / depth : ray.y < 0.0 && frame.groundEnd > 0.0 ? ground : 1e6 * frame.radius;
    vec3 p = frame.now.eye + ray * along, was = project(frame.before, p), now = project(frame.now, p);
    vec2 moved = was.xy + frame.before.jitter - now.xy - frame.now.jitter;
    vec2 from = vec2(at) + 0.5 * vec2(moved.x, -moved.y) * vec2(frame.size);
    bool inBefore = known != 0 && was.z > 0.0 && all(greaterThan(from, vec2(-0.5))) && all(lessThan(from, vec2(last) + 0.5));
    from = inBefore ? from : vec2(0.0);
    vec4 old = sampleBefore(from, last);
    old = clamp(old, mean - deviation, mean + deviation);
    vec4 shown = mix(own, old, inBefore ? 1.0 - kNew : 0.0);
    if (any(greaterThanEqual(gl_GlobalInvocationID.xy, frame.size))) return;
    imageStore(shownNow, at, shown);
    imageStore(pixels, at, uvec4(packUnorm4x8(shown)));
}
